"""Geometry becomes a picture: what lines are comes in, what they look like is decided here."""

from dataclasses import dataclass

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.curves import Paths, PlaneArcs
from molviz.geometry.rows import lists_taken, offsets
from molviz.model.molecule import Molecule
from molviz.picture.chains import Chains, linked, merged
from molviz.picture.coloring import CONTINUOUS, atom_colors, order_of_appearance
from molviz.picture.furniture import Box, Furnished, Furniture, Ramp, furnish
from molviz.picture.marks import marks
from molviz.picture.page import Page
from molviz.picture.picture import SPREAD, Color, FillLayer, Layer, Picture, StackedLayer, StrokeLayer
from molviz.picture.style import Style
from molviz.visibility.half_edges import Loops, loop_areas
from molviz.visibility.map import BACKGROUND, VisibilityMap
from molviz.visibility.painter import Pieces

SLIVER = 0.004  # ångström: faces thinner than this are not drawn; displaced copies of one outline lie ten times closer


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


def picture_of_map(found: VisibilityMap, subject: Subject, options: DrawOptions) -> Picture:
    """Return the drawing of a visibility map: regions that do not overlap, and on top every visible edge once."""
    furnished, widths = _furnished(subject, options)
    placement = furnished.placement
    arcs = found.arcs.moved(placement.scale, placement.shift)
    sliver = slivers(found)
    layers: list[Layer] = []
    if options.fill != "none":
        layers.append(_regions(found, arcs, sliver, subject, options))
    roles = edge_roles(found, sliver)
    for name, width in (("crease", widths[1]), ("outline", widths[0]), ("silhouette", widths[0])):
        rows = np.flatnonzero(roles == name)
        if width > 0 and len(rows):
            chains = linked(found.origin, found.target, found.circle, rows)
            layers.append(StrokeLayer(name, _paths(arcs, found.circle, chains), width, options.style.line_color))
    return _picture(subject, options, furnished, widths, layers)


def edge_roles(found: VisibilityMap, sliver: Bools) -> "np.ndarray[tuple[int], np.dtype[np.str_]]":
    """Return what each arc is: ``crease``, ``outline`` (before another sphere), ``silhouette`` (before the background).

    Horizons of slivers have no role: the edge they nearly coincide with is drawn instead.
    """
    horizon = np.where(found.right == BACKGROUND, "silhouette", "outline")
    roles = np.where(found.is_crease(), "crease", horizon)
    loop_of = np.empty(2 * len(found.start), dtype=np.int64)
    loop_of[found.loops.half_edge] = np.repeat(np.arange(len(found.loops.face)), np.diff(found.loops.start))
    return np.where(~found.is_crease() & sliver[loop_of[::2]], "", roles)


def slivers(found: VisibilityMap) -> Bools:
    """Return which loops enclose less than ``SLIVER`` times their half length."""
    row = found.loops.half_edge >> 1
    chord = found.arcs.take(row)
    length = np.abs(chord.sweep) * np.sqrt((chord.u**2 + chord.v**2).sum(axis=1) / 2)
    half = np.add.reduceat(length, found.loops.start[:-1]) / 2 if len(row) else np.empty(0)
    return np.asarray(np.abs(loop_areas(found.arcs, found.loops)) < SLIVER * half)


def _regions(found: VisibilityMap, arcs: PlaneArcs, sliver: Bools, subject: Subject, options: DrawOptions) -> FillLayer:
    """One shape per visible atom, ordered by chain and residue so that these can be groups."""
    keep = np.flatnonzero((found.loops.face != BACKGROUND) & ~sliver)
    rank = _file_order(subject.molecule)[subject.atom]
    order = keep[np.argsort(rank[found.loops.face[keep]], kind="stable")]
    face = found.loops.face[order]
    shape = np.cumsum(np.append(False, np.diff(face) != 0)[: len(face)])
    paths = _paths(arcs, found.circle, _chains_of(found.loops, order), shape)
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


def _chains_of(found: Loops, rows: Ints) -> Chains:
    """The given loops as closed chains."""
    place, start = lists_taken(found.start, rows)
    return Chains(found.half_edge[place], start, np.ones(len(rows), dtype=bool))


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


def picture_of_pieces(found: Pieces, subject: Subject, options: DrawOptions) -> Picture:
    """Return the drawing of painter's pieces, back to front, each with the strokes of its own edges."""
    furnished, widths = _furnished(subject, options)
    placement = furnished.placement
    arcs = found.arcs.moved(placement.scale, placement.shift)
    rank = np.full(len(subject.atom), -1)
    rank[found.order] = np.arange(len(found.order))
    order = np.argsort(rank[found.loops.face], kind="stable")
    chains = _chains_of(found.loops, order)
    shape = rank[found.loops.face[order]]
    fills = _fills("fills", _paths(arcs, found.circle, chains, shape), subject, found.order, options, False)
    edge_shape = np.repeat(shape, np.diff(chains.start))
    edge = chains.half_edge >> 1
    strokes = [
        _strokes_of_pieces(name, found, arcs, edge[wanted[edge]], edge_shape[wanted[edge]], width, options)
        for name, wanted, width in (("crease", found.is_crease, widths[1]), ("outline", ~found.is_crease, widths[0]))
        if width > 0
    ]
    return _picture(subject, options, furnished, widths, [StackedLayer("atoms", fills, strokes)])


def _strokes_of_pieces(
    name: str, found: Pieces, arcs: PlaneArcs, edge: Ints, shape: Ints, width: float, options: DrawOptions
) -> StrokeLayer:
    """The edges of one kind, one shape per piece, each chained within its piece only."""
    vertex = found.origin * len(found.order), found.target * len(found.order)
    owner = np.zeros(len(found.origin), dtype=np.int64)
    owner[edge] = shape
    chains = linked(vertex[0] + owner, vertex[1] + owner, found.circle, edge)
    of_chain = owner[chains.half_edge[chains.start[:-1]] >> 1]
    order = np.argsort(of_chain, kind="stable")
    loops = Loops(chains.half_edge, chains.start, of_chain)
    ordered = _chains_of(loops, order)._replace(closed=chains.closed[order])
    rows, start = merged(arcs, found.circle, ordered)
    return StrokeLayer(name, Paths(rows, start, offsets(of_chain, len(found.order))), width, options.style.line_color)


def _furnished(subject: Subject, options: DrawOptions) -> tuple[Furnished, tuple[float, float]]:
    """Where the drawing and its legend lie, and the widths of outlines and creases in points."""
    style = options.style
    widest = max(style.outline.width if options.outline is None else options.outline, options.crease or 0.0)
    furniture = Furniture(legend=_ramp(subject, options) if options.legend else None, color=style.line_color)
    furnished = furnish(options.page, subject.low, subject.high, widest / 2, furniture)
    outline = style.outline.at(furnished.placement.scale) if options.outline is None else options.outline
    crease = style.crease.at(furnished.placement.scale) if options.crease is None else options.crease
    return furnished, (outline, crease)


def _ramp(subject: Subject, options: DrawOptions) -> Ramp:
    """The legend of a scheme of numbers."""
    known = subject.values[np.isfinite(subject.values)]
    least, greatest = (float(known.min()), float(known.max())) if len(known) else (0.0, 0.0)
    return Ramp(CONTINUOUS[options.color_by], least, greatest, options.style.ramp)


def _picture(
    subject: Subject, options: DrawOptions, furnished: Furnished, widths: tuple[float, float], layers: list[Layer]
) -> Picture:
    half, placement = max(*widths, 0.0 if options.color_by == "index" else SPREAD) / 2, furnished.placement
    low, high = (placement.scale * corner + placement.shift for corner in (subject.low, subject.high))
    box = Box(float(low[0] - half), float(low[1] - half), float(high[0] + half), float(high[1] + half))
    return Picture(
        width=placement.width,
        height=placement.height,
        box=box.around(furnished.box) if furnished.box else box,
        layers=[*layers, *furnished.layers],
        title=subject.molecule.name,
        background=options.background,
    )
