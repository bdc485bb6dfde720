"""Geometry becomes a picture: what lines are comes in, what they look like is decided here."""

from dataclasses import dataclass

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.curves import Paths, PlaneArcs
from molviz.geometry.planar_map import Loops
from molviz.geometry.rows import lists_taken, offsets
from molviz.model.molecule import Molecule
from molviz.picture.chains import Chains, linked, merged
from molviz.picture.coloring import CONTINUOUS, atom_colors, order_of_appearance
from molviz.picture.legend import WIDTH as LEGEND_WIDTH
from molviz.picture.legend import legend
from molviz.picture.marks import marks
from molviz.picture.page import Page, Placement, place
from molviz.picture.picture import SPREAD, Color, FillLayer, Layer, Picture, StackedLayer, StrokeLayer
from molviz.picture.style import Style
from molviz.visibility.lines import CREASE, OUTLINE, ROLES, SILHOUETTE, line_roles, slivers
from molviz.visibility.map import BACKGROUND, VisibilityMap
from molviz.visibility.painter import Pieces


@dataclass(frozen=True)
class DrawOptions:
    """How the user wants a picture; widths in points, None for the style's."""

    style: Style
    color_by: str = "element"
    fill: str = "flat"
    outline: float | None = None
    crease: float | None = None
    background: Color | None = None
    page: Page = Page()
    legend: bool = False


@dataclass(frozen=True)
class Subject:
    """The molecule of a drawing, and how its atoms and its size relate to the geometry."""

    molecule: Molecule
    atom: Ints  # (s,) the atom of each sphere
    low: Floats  # (2,) ångström, of the bounding box of all images
    high: Floats  # (2,)
    values: Floats  # (n,) per atom, what a continuous scheme colours by


def picture_of_map(view_map: VisibilityMap, subject: Subject, options: DrawOptions) -> Picture:
    """Return the drawing of a visibility map: regions that do not overlap, and on top every visible edge once."""
    placement, widths = _placement(subject, options)
    arcs, on_curves = view_map.arcs.moved(placement.scale, placement.shift), view_map.curve_arcs
    sliver = slivers(view_map)
    layers: list[Layer] = []
    if options.fill != "none":
        layers.append(_regions(view_map, arcs, sliver, subject, options))
    roles = line_roles(view_map, sliver)
    for role, width in ((CREASE, widths[1]), (OUTLINE, widths[0]), (SILHOUETTE, widths[0])):
        rows = np.flatnonzero(roles == role)
        if width > 0 and len(rows):
            chains = linked(on_curves.origin, on_curves.target, on_curves.curve, rows)
            paths = _paths(arcs, on_curves.curve, chains)
            layers.append(StrokeLayer(ROLES[role], paths, width, options.style.line_color))
    return _picture(subject, options, placement, widths, layers)


def _regions(
    view_map: VisibilityMap, arcs: PlaneArcs, sliver: Bools, subject: Subject, options: DrawOptions
) -> FillLayer:
    """One shape per visible atom, ordered by chain and residue so that these can be groups."""
    keep = np.flatnonzero((view_map.loops.face != BACKGROUND) & ~sliver)
    rank = _file_order(subject.molecule)[subject.atom]
    order = keep[np.argsort(rank[view_map.loops.face[keep]], kind="stable")]
    face = view_map.loops.face[order]
    shape = np.cumsum(np.append(False, np.diff(face) != 0)[: len(face)])
    paths = _paths(arcs, view_map.curve_arcs.curve, _chains_of(view_map.loops, order), shape)
    first = np.searchsorted(shape, np.arange(len(paths.shape_start) - 1))
    return _fills("atoms", paths, subject, face[first], options, True)


def _file_order(molecule: Molecule) -> Ints:
    """The rank of each atom when chains and, in them, residues stay together in order of appearance."""
    chain = order_of_appearance(molecule.chain)
    place = np.char.add(np.char.add(molecule.residue_name, " "), molecule.residue)
    residue = order_of_appearance(place)
    chain_number = np.array([chain[name] for name in molecule.chain.tolist()])
    residue_number = np.array([residue[name] for name in place.tolist()])
    rank = np.empty(len(molecule), dtype=np.int64)
    rank[np.lexsort((residue_number, chain_number))] = np.arange(len(molecule))
    return rank


def _chains_of(loops: Loops, rows: Ints) -> Chains:
    """The given loops as closed chains."""
    place, start = lists_taken(loops.start, rows)
    return Chains(loops.half_edge[place], start, np.ones(len(rows), dtype=bool))


def _paths(arcs: PlaneArcs, circle: Ints, chains: Chains, shape: Ints | None = None) -> Paths:
    """Chains as paths; all of one shape unless ``shape`` says of which (ascending from 0)."""
    rows, start = merged(arcs, circle, chains)
    shape = np.zeros(len(start) - 1, dtype=np.int64) if shape is None else shape
    return Paths(rows, start, offsets(shape, int(shape.max()) + 1 if len(shape) else 0))


def _fills(name: str, paths: Paths, subject: Subject, sphere: Ints, options: DrawOptions, grouped: bool) -> FillLayer:
    atoms = subject.atom[sphere]
    everyone = atom_colors(options.color_by, subject.molecule, subject.values, options.style)
    colors = [everyone[atom] for atom in atoms.tolist()]
    if options.fill == "none":
        colors = [options.background or (255, 255, 255)] * len(colors)
    spread = 0.0 if options.color_by == "index" else SPREAD
    return FillLayer(name, paths, colors, marks(subject.molecule.take(atoms), grouped), spread)


def picture_of_pieces(pieces: Pieces, subject: Subject, options: DrawOptions) -> Picture:
    """Return the drawing of painter's pieces, back to front, each with the strokes of its own edges."""
    placement, widths = _placement(subject, options)
    arcs, is_crease = pieces.arcs.moved(placement.scale, placement.shift), pieces.is_crease()
    rank = np.full(len(subject.atom), -1)
    rank[pieces.order] = np.arange(len(pieces.order))
    order = np.argsort(rank[pieces.loops.face], kind="stable")
    chains = _chains_of(pieces.loops, order)
    shape = rank[pieces.loops.face[order]]
    fills = _fills("fills", _paths(arcs, pieces.curve_arcs.curve, chains, shape), subject, pieces.order, options, False)
    edge_shape = np.repeat(shape, np.diff(chains.start))
    edge = chains.half_edge >> 1
    strokes = [
        _strokes_of_pieces(name, pieces, arcs, edge[wanted[edge]], edge_shape[wanted[edge]], width, options)
        for name, wanted, width in (("crease", is_crease, widths[1]), ("outline", ~is_crease, widths[0]))
        if width > 0
    ]
    return _picture(subject, options, placement, widths, [StackedLayer("atoms", fills, strokes)])


def _strokes_of_pieces(
    name: str, pieces: Pieces, arcs: PlaneArcs, edge: Ints, shape: Ints, width: float, options: DrawOptions
) -> StrokeLayer:
    """The edges of one kind, one shape per piece, each chained within its piece only."""
    vertex = pieces.curve_arcs.origin * len(pieces.order), pieces.curve_arcs.target * len(pieces.order)
    owner = np.zeros(len(pieces.curve_arcs.origin), dtype=np.int64)
    owner[edge] = shape
    chains = linked(vertex[0] + owner, vertex[1] + owner, pieces.curve_arcs.curve, edge)
    of_chain = owner[chains.half_edge[chains.start[:-1]] >> 1]
    order = np.argsort(of_chain, kind="stable")
    loops = Loops(chains.half_edge, chains.start, of_chain)
    ordered = _chains_of(loops, order)._replace(closed=chains.closed[order])
    rows, start = merged(arcs, pieces.curve_arcs.curve, ordered)
    return StrokeLayer(name, Paths(rows, start, offsets(of_chain, len(pieces.order))), width, options.style.line_color)


def _placement(subject: Subject, options: DrawOptions) -> tuple[Placement, tuple[float, float]]:
    """Where the drawing lies, and the widths of outlines and creases in points."""
    style = options.style
    widest = max(style.outline.width if options.outline is None else options.outline, options.crease or 0.0)
    placement = place(options.page, subject.low, subject.high, widest / 2, LEGEND_WIDTH if options.legend else 0.0)
    outline = style.outline.at(placement.scale) if options.outline is None else options.outline
    crease = style.crease.at(placement.scale) if options.crease is None else options.crease
    return placement, (outline, crease)


def _picture(
    subject: Subject, options: DrawOptions, placement: Placement, widths: tuple[float, float], layers: list[Layer]
) -> Picture:
    half = max(*widths, 0.0 if options.color_by == "index" else SPREAD) / 2
    low, high = (placement.scale * corner + placement.shift for corner in (subject.low, subject.high))
    right = float(high[0] + half)
    if options.legend:
        x, middle = right + 16.0, float(low[1] + high[1]) / 2
        reach = min(float(high[1] - low[1]) / 2 - 12.0, 90.0)
        layers += legend(subject.values, CONTINUOUS[options.color_by], options.style, x, middle - reach, middle + reach)
        right = placement.width - 1.0
    box = (float(low[0] - half), float(low[1] - half), right, float(high[1] + half))
    return Picture(
        width=placement.width,
        height=placement.height,
        box=box,
        layers=layers,
        title=subject.molecule.name,
        background=options.background,
    )
