"""Geometry becomes a picture: what things are comes in, what they look like is decided here, layer by layer."""

from collections.abc import Sequence
from functools import cached_property, partial

import numpy as np

from molviz.arrays import Bools, Floats, Ints, distinct
from molviz.curves import Paths, PlaneArcs
from molviz.geometry.rows import offsets
from molviz.model.molecule import Molecule
from molviz.picture.captions import labels_of, legend_of
from molviz.picture.chains import Chains, linked, linked_apart, merged_arcs
from molviz.picture.coloring import order_of_appearance
from molviz.picture.furniture import Box, Furnished, Furniture, Label, Ramp, Swatches, furnish
from molviz.picture.hatching import LEVELS, hatched, level_distance, tone_levels
from molviz.picture.ink import SPUR, WIDEST_SHARE, Widths, at_places, line_widths
from molviz.picture.ink_ends import OUTSIDE
from molviz.picture.ink_pockets import inked_arcs, pockets
from molviz.picture.ink_shapes import NECK, in_colors, inked
from molviz.picture.looks import (
    NEARER_BY,
    Looks,
    borders,
    depths,
    distances,
    fogged,
    groups,
    nearness,
    tone_names,
)
from molviz.picture.marks import bond_marks, marks, region_mark
from molviz.picture.oklab import colors_of, lightness, mix
from molviz.picture.options import Alike, DrawOptions, Subject
from molviz.picture.page import Placement
from molviz.picture.picture import (
    SPREAD,
    Color,
    FillLayer,
    Layer,
    Picture,
    ShadeLayer,
    StackedLayer,
    StrokeLayer,
)
from molviz.picture.regions import (
    Regions,
    closed_chains,
    face_areas,
    merged_regions,
    point_on,
    shape_of,
    shapes_of,
    stacked,
)
from molviz.picture.shading import ball_gradients, contact_steps, light_bands, shaded_with_sticks
from molviz.picture.stick_light import StickLight
from molviz.picture.tints import entity_tints
from molviz.threads import both
from molviz.visibility.eye import projection_of
from molviz.visibility.horizon_runs import HorizonRuns, horizon_runs
from molviz.visibility.lines import CREASE, OUTLINE, ROLES, SILHOUETTE, line_roles, slivers
from molviz.visibility.map import BACKGROUND, VisibilityMap
from molviz.visibility.overlay import seen_spheres
from molviz.visibility.painter import Pieces
from molviz.visibility.projection import images_of
from molviz.visibility.view import View

NO_DISCS = np.empty((0, 3))
BY_PALETTE = ("entity", "chain")  # schemes whose colours are the palette's
DARK_PAGE = 50.0  # L*: on pages below, texts and bars are light
LIGHT_TEXT = (240, 240, 240)
WHITE = (255, 255, 255)
MANY = 5_000  # spheres, from which on layers made side by side are worth a thread
INK_CLASSES = 3  # of distance, in which ink takes on the haze
INK_FOG = 0.25  # of the fog's strength that the ink of the farthest class takes on


class MapComposer:
    """Makes the layers of the drawing of one visibility map."""

    def __init__(self, view_map: VisibilityMap, view: View, subject: Subject, options: DrawOptions) -> None:
        self.map, self.view, self.subject, self.options = view_map.by_sphere(), view, subject, options
        self.solids = view_map
        self.style = options.chosen_style()
        self.fill = options.fill or self.style.fill
        self.sliver = slivers(view_map)
        self.furnished = furnished(subject, options, self.legend() if options.legend else None, *self.labels())
        self.placement = self.furnished.placement
        self.scale, self.widths = self.placement.scale, widths_of(options, self.placement.scale)
        self.arcs: PlaneArcs = view_map.arcs.moved(self.placement.scale, self.placement.shift)

    def legend(self) -> Ramp | Swatches:
        """Return what explains the colours."""
        return legend_of(self.subject, self.options, self.subject.colors(self.options, self.shown_tints).fill)

    def labels(self) -> tuple[list[Label], Floats]:
        """Return the labels, and the discs x, y, r that they stay off."""
        if not self.subject.labelled:
            return [], np.empty((0, 3))
        images = images_of(self.map.horizons().take(self.seen), projection_of(self.view))
        labels = labels_of(self.subject, self.seen, face_areas(self.map), partial(point_on, self.map))
        return labels, np.column_stack([images.c, images.major()])

    @property
    def no_tints(self) -> Ints:
        """The tints of chains that do not touch."""
        return np.zeros(len(self.subject.entities.chain), dtype=np.int64)

    @property
    def shown_tints(self) -> Ints:
        """The tints that the scheme of colours has."""
        return self.tints if self.options.color_by == "entity" else self.no_tints

    def layers(self) -> list[Layer]:
        """Return all layers in painting order: regions, shade, light, lines."""
        layers: list[Layer] = []
        if self.fill != "none":
            many = len(self.looks.fill) > MANY  # both ask for the looks, which are known now
            regions, _ = both(lambda: [self.regions(), *self.sticks()], lambda: self.inking, many)
            layers += [*regions, *self.shade(), *self.light()]
        return [*layers, *self.hatching(), *self.edges(), *self.ink()]

    @cached_property
    def seen(self) -> Ints:
        """The spheres that are seen."""
        return seen_spheres(self.map)

    @cached_property
    def runs(self) -> HorizonRuns:
        """The visible horizons."""
        return horizon_runs(self.solids, self.view)

    @property
    def dark_ink(self) -> Color:
        """The ink around things: the palette's where it gives the colours, else the style's."""
        by_palette = self.options.color_by in BY_PALETTE and self.style.colors.scheme in BY_PALETTE
        return self.options.palette.ink if by_palette else self.style.lines.color

    @cached_property
    def haze(self) -> Color:
        """What far things fade to."""
        return self.options.background or self.options.palette.haze

    @cached_property
    def looks(self) -> Looks:
        """The colours of each sphere."""
        colors = self.subject.seen_colors(self.options, self.shown_tints)
        group = groups(self.subject.seen_molecule, self.subject.entities.take(self.subject.atom))
        if self.options.is_mask:
            return Looks(*colors, group, np.zeros(len(group)))
        surfaces, centers = self.subject.alike.depth or depths(self.map, self.view, self.seen)
        far = distances(self.map, self.view, surfaces, NEARER_BY)
        fill = fogged(colors.fill, far, self.style.fog, self.haze)
        return Looks(fill, colors.ink, colors.shade, group, distances(self.map, self.view, centers))

    @cached_property
    def tints(self) -> Ints:
        """The tints of polymer chains: copies of an entity that touch on the page differ, or else the set's."""
        entities, kept = self.subject.entities, self.subject.alike.tint
        if kept is not None:
            return np.array([kept.get(chain, 0) for chain in entities.chain.tolist()], dtype=np.int64)
        polymer = entities.polymer[self.subject.atom]
        near, known = nearness(self.map, self.view), polymer >= 0
        count = len(entities.chain)
        mean = np.bincount(polymer[known], near[known], count) / np.maximum(np.bincount(polymer[known], None, count), 1)
        one, other, length = borders(self.map, polymer)
        return entity_tints(entities.chain_entity, self.options.palette, one, other, length, mean)

    def regions(self) -> FillLayer:
        """Return the fills."""
        if self.by_atom:
            return self.atoms()
        regions, first = self.color_regions
        colors = colors_of(self.looks.fill[first])
        names = tone_names(str(self.options.color_by), self.subject.seen_molecule)
        chain = self.subject.seen_molecule.chain
        named = [region_mark(str(chain[k]), str(names[k])) for k in first.tolist()]
        return FillLayer("regions", regions.paths, colors, named, SPREAD)

    @property
    def by_atom(self) -> bool:
        """Whether each atom has a region of its own, and each bond, rather than each chain and colour."""
        return self.options.is_mask or self.fill == "ball" or (self.options.parts or self.style.parts) == "atoms"

    @cached_property
    def color_regions(self) -> tuple[Regions, Ints]:
        """The regions of one chain and one colour, and a sphere of each."""
        chain = np.unique(self.subject.seen_molecule.chain, return_inverse=True)[1]
        keys = np.column_stack([chain, self.looks.fill])
        _, first, label = np.unique(keys, axis=0, return_index=True, return_inverse=True)
        regions = merged_regions(self.map, self.arcs, label.ravel())
        return regions, first[regions.label]

    def atoms(self) -> FillLayer:
        """Return one shape per visible atom, ordered by chain and residue so that these can be groups."""
        seen = self.map.merged() if self.options.is_mask else self.solids.of_spheres()
        face = seen.loops.face
        keep = np.flatnonzero((face != BACKGROUND) & ~slivers(seen))
        rank = _file_order(self.subject.seen_molecule, self.subject.chain_number[self.subject.atom])
        order = keep[np.argsort(rank[face[keep]], kind="stable")]
        shape = np.cumsum(np.append(False, np.diff(face[order]) != 0)[: len(order)])
        paths = shapes_of(self.arcs, self.map.curve_arcs.curve, closed_chains(seen.loops, order), shape)
        sphere = face[order][np.searchsorted(shape, np.arange(len(paths.shape_start) - 1))]
        named = marks(self.subject.seen_molecule.take(sphere), True)
        if self.options.is_mask:
            return FillLayer("atoms", paths, colors_of(self.looks.fill[sphere]), named)
        if self.fill != "ball":
            return FillLayer("atoms", paths, colors_of(self.looks.fill[sphere]), named, SPREAD)
        images = images_of(self.map.horizons().take(sphere), projection_of(self.view))
        images = images.moved(self.placement.scale, self.placement.shift)
        balls = ball_gradients(self.looks.fill[sphere], images.major(), self.style)
        return FillLayer("atoms", paths, balls, named, SPREAD, images.c)

    def sticks(self) -> list[Layer]:
        """Return bonds with names, where atoms have them, and what the light makes of sticks: bands or gradients."""
        light = self.style.light
        if self.options.is_mask or not len(self.solids.sticks.length):
            return []
        fill = self.looks.fill[self.solids.sticks.ends.sphere]
        lit = StickLight(self.solids, projection_of(self.view), self.placement, light)
        if not self.by_atom:
            return [*lit.bands(fill)]
        ends = self.solids.sticks.ends.sphere.reshape(-1, 2)[lit.stick]
        named = bond_marks(self.subject.seen_molecule, ends)
        if self.fill != "ball":
            return [FillLayer("bonds", lit.paths, colors_of(fill[lit.half]), named, SPREAD), *lit.bands(fill)]
        paints, origin = lit.gradients(fill, self.style)
        return [FillLayer("bonds", lit.paths, paints, named, SPREAD, origin)]

    def shade(self) -> list[Layer]:
        """Return the contact shade, in the deep colour of whatever it falls on."""
        if not self.style.shade.steps or self.options.is_mask:
            return []
        steps, opacity = contact_steps(self.solids, self.view, self.runs, self.style.shade, self.placement)
        distinct, label = np.unique(self.looks.shade, axis=0, return_inverse=True)
        on = self.map if shaded_with_sticks(self.solids) else self.solids.of_spheres()
        return self.shade_layer("contact shade", on, steps, opacity, label.ravel(), colors_of(distinct))

    def light(self) -> list[Layer]:
        """Return the bands of light."""
        light = self.style.light
        if not (light.terminators or light.highlights) or self.options.is_mask:
            return []
        dark, bright = light_bands(self.map, self.view, light, self.placement)
        everything = np.zeros(len(self.map.spheres.radius), dtype=np.int64)
        balls = self.solids.of_spheres()
        return [
            *self.shade_layer("terminators", balls, *dark, everything, [light.dark]),
            *self.shade_layer("highlights", balls, *bright, everything, [light.bright]),
        ]

    def shade_layer(
        self, name: str, on: VisibilityMap, steps: Paths, opacity: list[float], label: Ints, colors: list[Color]
    ) -> list[Layer]:
        """Return steps clipped to the map's regions of each label (s,), in its colour; none without steps."""
        if not opacity:
            return []
        clip = merged_regions(on, self.arcs, label)
        keys = np.column_stack([label, self.looks.fill])
        _, first, tone_label = np.unique(keys, axis=0, return_index=True, return_inverse=True)
        tone = merged_regions(on, self.arcs, tone_label.ravel())
        sphere = first[tone.label]
        place = np.searchsorted(clip.label, label[sphere])
        return [
            ShadeLayer(
                name, steps, opacity, clip.paths, [colors[k] for k in clip.label.tolist()],
                tone.paths, colors_of(self.looks.fill[sphere]), place.tolist(),
            )
        ]  # fmt: skip

    def hatching(self) -> list[Layer]:
        """Return parallel lines, the denser the darker a region; across them in the bands that light does not reach."""
        hatch, light = self.style.hatch, self.style.light
        if not hatch.nearest or self.options.is_mask:
            return []
        level = tone_levels(lightness(self.looks.fill))
        regions = merged_regions(self.map, self.arcs, level)
        lines = [
            hatched(shape_of(regions.paths, row), level_distance(number, hatch.nearest, hatch.farthest), hatch.angle)
            for row, number in enumerate(regions.label.tolist())
            if number < LEVELS
        ]
        (dark, opacity), _ = light_bands(self.map, self.view, light, self.placement)
        across = [
            hatched(shape_of(dark, row), hatch.nearest * (2 + row), hatch.angle + 90.0) for row in range(len(opacity))
        ]
        return [StrokeLayer(name, stacked(parts), hatch.width, self.style.lines.color)
                for name, parts in (("hatching", lines), ("hatching across", across)) if parts]  # fmt: skip

    def edges(self) -> list[Layer]:
        """Return even strokes along creases, outlines and silhouettes, those of one role in one layer."""
        roles, color = line_roles(self.map, self.sliver), self.style.lines.color
        layers: list[Layer] = []
        for role, width in ((CREASE, self.widths[1]), (OUTLINE, self.widths[0]), (SILHOUETTE, self.widths[0])):
            rows = np.flatnonzero(roles == role)
            if role == CREASE:
                rows = self.without_crumbs(np.flatnonzero(self.wanted_creases & np.isin(roles, (CREASE, OUTLINE))))
            if width > 0 and len(rows):
                opacity = self.style.lines.crease_opacity if role == CREASE else 1.0
                paths, below = self.lines_by_ground(rows) if opacity < 1 else (self.lines(rows), [])
                layers.append(StrokeLayer(ROLES[role], paths, width, color, opacity=opacity, below=below))
        return layers

    def lines(self, rows: Ints) -> Paths:
        """Return arcs joined to lines as long as they can be."""
        return shapes_of(self.arcs, self.map.curve_arcs.curve, self.chains(rows))

    def chains(self, rows: Ints) -> Chains:
        """Return arcs joined to chains as long as they can be."""
        on_curves = self.map.curve_arcs
        return linked(on_curves.origin, on_curves.target, on_curves.curve, rows)

    def without_crumbs(self, rows: Ints) -> Ints:
        """Return the creases that are no crumbs."""
        chains = self.chains(rows)
        return distinct(chains.take(np.flatnonzero(~self.crumbs(chains))).half_edge >> 1)

    def lines_by_ground(self, rows: Ints) -> tuple[Paths, list[Color]]:
        """Return the same as one shape for each colour below, and these: means of the fills on both sides."""
        paper = self.options.background or WHITE
        fill = np.vstack([self.looks.fill, paper])  # BACKGROUND is −1, the last
        both = (fill[self.map.left[rows]] + fill[self.map.right[rows]]) // 2
        distinct, number = np.unique(both, axis=0, return_inverse=True)
        on_curves = self.map.curve_arcs
        chains, shape = linked_apart(on_curves.origin, on_curves.target, on_curves.curve, rows, number.ravel())
        return shapes_of(self.arcs, on_curves.curve, chains, shape), colors_of(distinct)

    @cached_property
    def wanted_creases(self) -> Bools:
        """Which arcs lie where the style wants creases: where it wants all, also inner horizons with thinner ink."""
        creases = self.map.is_crease()
        if self.style.lines.crease_where == "all":
            if self.inking is None:
                return creases
            thinner = inked_arcs(*self.inking[:2]).min(axis=0) < self.widths[1] / self.scale
            return np.asarray(creases | thinner)
        group = np.append(self.looks.group, -1)
        rims = self.map.curves.second[self.map.curve_arcs.curve] >= len(self.map.spheres.radius)
        return np.asarray(creases & (rims | (group[self.map.left] != group[self.map.right])))

    def crumbs(self, chains: Chains) -> Bools:
        """Return which chains (c,) of creases are short and meet neither ink nor another crease at either end."""
        if self.inking is None:
            return np.zeros(len(chains.closed), dtype=bool)
        runs, widths, _ = self.inking
        origin, at = self.map.edges.origin, runs.vertices
        length = np.add.reduceat(self.map.arcs.lengths()[chains.half_edge >> 1], chains.start[:-1])
        ends = origin[np.stack([chains.half_edge[chains.start[:-1]], chains.half_edge[chains.start[1:] - 1] ^ 1])]
        known, count = np.unique(origin[np.append(chains.half_edge, chains.half_edge ^ 1)], return_counts=True)
        inked = at.vertex[at_places(widths.width, runs, at.run, at.place) > 0]
        meets = (np.isin(ends, inked) | np.isin(ends, known[count > 1])).any(axis=0)
        return np.asarray(~chains.closed & ~meets & (length < SPUR))

    @cached_property
    def inking(self) -> tuple[HorizonRuns, Widths, float] | None:
        """The lines of varying width, and the gap between two of them that ink fills; None where there are none."""
        style = self.style.ink.scaled_to(self.options.outline, self.scale)
        if not style.silhouette.at(self.scale) or self.options.is_mask:
            return None
        crease = self.widths[1] / self.scale if self.style.lines.crease_where == "between" else 0.0
        widths = line_widths(self.runs, self.looks.group, self.looks.far, style, self.scale, crease)
        if self.style.colors.scheme not in BY_PALETTE:  # things are not told apart by their inks
            widths = widths._replace(dark=np.ones_like(widths.dark))
        widest = min(style.silhouette.at(self.scale), WIDEST_SHARE * float(np.mean(self.runs.detail)))
        return self.runs, widths, NECK * widest

    def ink(self) -> list[Layer]:
        """Return lines of varying width: dark ones around things, the things' own within them; far ones first."""
        if self.inking is None:
            return []
        inking = self.inking
        (strokes, paths, dark), filled = both(
            lambda: inked(*inking), lambda: pockets(self.map, *inking), len(self.looks.fill) > MANY
        )
        paths, dark = stacked([filled.paths, paths]), np.append(filled.dark, dark)
        sphere, looks = self.runs.sphere[np.append(filled.run, strokes.run)], self.looks
        if not len(sphere):
            return []
        far_class = np.minimum((looks.far[sphere] * INK_CLASSES).astype(np.int64), INK_CLASSES - 1)
        share = INK_FOG * self.style.fog.strength * (far_class + 0.5) / INK_CLASSES
        color = mix(np.where(dark[:, None], self.dark_ink, looks.ink[sphere]), self.haze, share)
        paths, distinct = in_colors(paths, np.column_stack([-far_class, dark, color]))
        paths = paths._replace(arcs=paths.arcs.moved(self.placement.scale, self.placement.shift))
        return [FillLayer("ink", paths, colors_of(distinct[:, 2:]), [region_mark("", "ink")] * len(distinct))]


def picture_of_map(view_map: VisibilityMap, view: View, subject: Subject, options: DrawOptions) -> Picture:
    """Return the drawing of a visibility map: regions that do not overlap, and on top every visible edge once."""
    composer = MapComposer(view_map, view, subject, options)
    return _picture(subject, options, composer.furnished, composer.layers())


def alike_with(seen: VisibilityMap | Pieces, view: View, subject: Subject, options: DrawOptions) -> Alike:
    """Return what a picture would share with others of its set, if they were all like it."""
    if isinstance(seen, Pieces):
        return Alike(_around_pieces(subject, options).free, values=subject.bounds)
    composer = MapComposer(seen, view, subject, options)
    tint = dict(zip(subject.entities.chain.tolist(), composer.shown_tints.tolist(), strict=True))
    return Alike(composer.furnished.free, depths(seen, view, composer.seen), tint, subject.bounds)


def placed_and_colored(
    seen: VisibilityMap | Pieces, view: View, subject: Subject, options: DrawOptions
) -> tuple[Placement, Ints]:
    """Return where a drawing lies on its page, and what each atom (n, 3) is filled with before fog."""
    if isinstance(seen, Pieces):
        return _around_pieces(subject, options).placement, _plain_fill(subject, options)
    composer = MapComposer(seen, view, subject, options)
    tint = composer.tints if options.color_by == "entity" else composer.no_tints
    return composer.placement, subject.colors(options, tint).fill


def _file_order(molecule: Molecule, chain: Ints) -> Ints:
    """The rank of each atom when chains, by their numbers (n,), and in them residues stay together.

    The residues of a chain are in order of appearance.
    """
    place = np.char.add(np.char.add(molecule.residue_name, " "), molecule.residue)
    residue = order_of_appearance(np.char.add(np.char.add(molecule.chain, "/"), place))
    rank = np.empty(len(molecule), dtype=np.int64)
    rank[np.lexsort((residue, chain))] = np.arange(len(molecule))
    return rank


def picture_of_pieces(pieces: Pieces, subject: Subject, options: DrawOptions) -> Picture:
    """Return the drawing of painter's pieces, back to front, each with the strokes of its own edges; fills are flat."""
    fill, around = _plain_fill(subject, options), _around_pieces(subject, options)
    placement, widths = around.placement, widths_of(options, around.placement.scale)
    arcs, drawn = (arcs.moved(placement.scale, placement.shift) for arcs in (pieces.arcs, pieces.strokes))
    rank = np.full(len(pieces.owner), -1)
    rank[pieces.order] = np.arange(len(pieces.order))
    order = np.argsort(rank[pieces.loops.face], kind="stable")
    chains = closed_chains(pieces.loops, order)
    shape = rank[pieces.loops.face[order]]
    paths = shapes_of(arcs, pieces.curve_arcs.curve, chains, shape)
    sphere = pieces.owner[pieces.order]
    fills = _fills_of_pieces(paths, fill[subject.atom[sphere]], sphere, subject, options)
    edge_shape = np.repeat(shape, np.diff(chains.start))
    edge = chains.half_edge >> 1
    lines = (("crease", pieces.is_crease(), widths[1]), ("outline", pieces.is_contour(), widths[0]))
    strokes = [
        _strokes_of_pieces(name, pieces, drawn, edge[wanted[edge]], edge_shape[wanted[edge]], width, options)
        for name, wanted, width in lines
        if width > 0
    ]
    return _picture(subject, options, around, [StackedLayer("atoms", fills, strokes)])


def _plain_fill(subject: Subject, options: DrawOptions) -> Ints:
    return subject.colors(options, np.zeros(len(subject.entities.chain), dtype=np.int64)).fill


def _around_pieces(subject: Subject, options: DrawOptions) -> Furnished:
    legend = legend_of(subject, options, _plain_fill(subject, options)) if options.legend else None
    return furnished(subject, options, legend)


def _fills_of_pieces(paths: Paths, fill: Ints, sphere: Ints, subject: Subject, options: DrawOptions) -> FillLayer:
    colors = colors_of(fill)
    if (options.fill or options.chosen_style().fill) == "none":
        colors = [options.background or WHITE] * len(colors)
    spread = 0.0 if options.is_mask else SPREAD
    return FillLayer("fills", paths, colors, marks(subject.molecule.take(subject.atom[sphere]), False), spread)


def _strokes_of_pieces(
    name: str, pieces: Pieces, arcs: PlaneArcs, edge: Ints, shape: Ints, width: float, options: DrawOptions
) -> StrokeLayer:
    """The edges of one kind, one shape per piece, each chained within its piece only."""
    on_curves = pieces.curve_arcs
    chains, of_chain = linked_apart(on_curves.origin, on_curves.target, on_curves.curve, edge, shape)
    rows, start = merged_arcs(arcs, on_curves.curve, chains)
    paths = Paths(rows, start, offsets(of_chain, len(pieces.order)))
    return StrokeLayer(name, paths, width, options.chosen_style().lines.color)


def furnished(
    subject: Subject,
    options: DrawOptions,
    legend: Ramp | Swatches | None = None,
    labels: Sequence[Label] = (),
    discs: Floats = NO_DISCS,
) -> Furnished:
    """Return where the drawing and all that stands beside it lie."""
    style = options.chosen_style()
    line = max(style.ink.silhouette.points, style.lines.outline.width)
    line = max(line if options.outline is None else options.outline, options.crease or 0.0)
    paper = options.background or WHITE
    color = style.lines.color if lightness(paper) > DARK_PAGE else LIGHT_TEXT
    furniture = Furniture(options.title, options.scale_bar, options.unit, legend, labels, discs, color, paper)
    return furnish(options.page, subject.low, subject.high, line / 2, furniture, subject.alike.free)


def widths_of(options: DrawOptions, scale: float) -> tuple[float, float]:
    """Return the widths of even outlines and creases in points, 0 for none."""
    style = options.chosen_style()
    outline, crease = style.lines.outline.at(scale), style.lines.crease.at(scale)
    if options.outline is not None and not style.ink.silhouette.points:
        outline = options.outline
    return outline, crease if options.crease is None else options.crease


def _picture(subject: Subject, options: DrawOptions, around: Furnished, layers: list[Layer]) -> Picture:
    placement = around.placement
    widest = max(*widths_of(options, placement.scale), 2 * OUTSIDE * _ink_width(options, placement.scale))
    half = max(widest, 0.0 if options.is_mask else SPREAD) / 2
    low, high = (placement.scale * corner + placement.shift for corner in (subject.low, subject.high))
    box = Box(float(low[0] - half), float(low[1] - half), float(high[0] + half), float(high[1] + half))
    return Picture(
        width=placement.width,
        height=placement.height,
        box=box if around.box is None else box.around(around.box),
        layers=[*layers, *around.layers],
        title=options.title or subject.molecule.name,
        background=options.background,
        description=subject.description,
    )


def _ink_width(options: DrawOptions, scale: float) -> float:
    """The widest line of ink in points."""
    return options.chosen_style().ink.scaled_to(options.outline, scale).silhouette.at(scale) * scale
