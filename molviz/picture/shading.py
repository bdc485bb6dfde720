"""Contact shade and bands of light: exact regions in which copies of the spheres are seen."""

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.curves import Paths, PlaneArcs
from molviz.geometry.planar_map import loop_areas
from molviz.model.spheres import Spheres
from molviz.picture.oklab import mix
from molviz.picture.page import Placement
from molviz.picture.picture import Color, RadialGradient
from molviz.picture.regions import closed_chains, shapes_of, stacked
from molviz.picture.style import Light, Shade, ShadeStep, Style
from molviz.visibility.eye import projection_of
from molviz.visibility.horizon_runs import ATOM, HorizonRuns
from molviz.visibility.map import VisibilityMap
from molviz.visibility.overlay import (
    beads_on,
    drop_at_edge,
    on_ledges,
    seen_halves,
    seen_of_copies,
    seen_spheres,
    shaded_sides,
    skirts,
)
from molviz.visibility.view import View

LEDGE_FROM = 1.0  # ångström: wider skirts hang from ledges only, not from lone tips
LEDGE_WITHIN = 1.6  # ångström beyond the skirt's reach
BEAD_SAG = 0.02  # ångström: as deep below sticks lie the rows of beads on which shade falls, at most
MOST_HALVES = 3000  # of sticks for which contact shade is worth its time
SKIRT_SAG = 0.05  # of the skirt's reach, by which that of a row of balls may be narrower than that of their stick
SPECK = 0.1  # of the square of the usual radius: smaller bands of light look like dirt
RADIUS_STEP = 0.03  # of a radius: the eye tells no gradients apart that differ by less
FOCUS = 0.55  # of the radius, how far from the middle a ball is brightest, times the light's x and y
LEDGE_COUNT = 7  # spheres that make a ledge


def deepest_jumps(runs: HorizonRuns, count: int, straight: bool = False) -> Floats:
    """Return the deepest finite jump (count,) along the horizon of each sphere, 0 where there is none.

    Or along the ``straight`` lines of the sticks that end there.
    """
    deepest = np.zeros(count)
    rows = np.isfinite(runs.jump) & (runs.straight() == straight)[runs.owner()]
    np.maximum.at(deepest, runs.sphere[runs.owner()[rows]], runs.jump[rows])
    return deepest


def contact_steps(
    view_map: VisibilityMap, view: View, runs: HorizonRuns, shade: Shade, placement: Placement
) -> tuple[Paths, list[float]]:
    """Return the steps of the contact shade that cover anything, one shape each, and their opacities.

    Sticks that are ``shaded_with_sticks`` count as rows of balls; otherwise atoms alone count.
    """
    balls, halves, sticks = seen_spheres(view_map), seen_halves(view_map), view_map.sticks
    spheres = view_map.spheres.take(balls)
    of_ball, of_line = (deepest_jumps(runs, len(view_map.spheres.radius), straight) for straight in (False, True))
    if not shaded_with_sticks(view_map):
        halves, of_ball[view_map.spheres.radius < ATOM] = halves[:0], 0.0
    surfaces = _joined(spheres, beads_on(sticks, halves, 0.0, BEAD_SAG)[0])
    parts = []
    for step in shade.large_steps if len(balls) >= shade.large_from else shade.steps:
        beads, half = beads_on(sticks, halves, step.reach, SKIRT_SAG * step.reach)
        hanging, jumps = _joined(spheres, beads), np.append(of_ball[balls], of_line[sticks.ends.sphere[half]])
        if len(rows := _hung_from(hanging, jumps, len(balls), view, step)):
            copies = skirts(hanging, rows, step.reach, step.low, view)
            parts.append((_region(surfaces, copies, view, placement), step.opacity))
    return _stacked(parts)


def shaded_with_sticks(view_map: VisibilityMap) -> bool:
    """Whether contact shade falls on sticks and from them: where there are many, no eye sees it."""
    return len(seen_halves(view_map)) <= MOST_HALVES


def _hung_from(spheres: Spheres, jumps: Floats, atoms: int, view: View, step: ShadeStep) -> Ints:
    """The spheres whose skirts can be seen: those with something deeper than the drop behind their edges.

    The first ``atoms`` of them make ledges.
    """
    drop = drop_at_edge(spheres.radius, step.reach, step.low)
    rows = np.flatnonzero((drop > 0) & (jumps > drop))
    if step.reach <= LEDGE_FROM or not len(rows):
        return rows
    projection = projection_of(view)
    page, height = projection.page_points(spheres.center), projection.nearness(spheres.center)
    below = (height - drop / 2)[rows]
    of_atoms = np.where(np.arange(len(height)) < atoms, height, -np.inf)
    return rows[on_ledges(page, of_atoms, rows, step.reach + LEDGE_WITHIN, below, LEDGE_COUNT + 1)]


def _joined(one: Spheres, other: Spheres) -> Spheres:
    return Spheres(*(np.concatenate(columns) for columns in zip(one, other, strict=True)))


def light_bands(
    view_map: VisibilityMap, view: View, light: Light, placement: Placement
) -> tuple[tuple[Paths, list[float]], tuple[Paths, list[float]]]:
    """Return the dark and the bright bands: steps, one shape each, and their opacities."""
    spheres = view_map.spheres.take(seen_spheres(view_map))
    toward, speck = np.array(light.direction), SPECK * float(np.mean(spheres.radius)) ** 2
    dark = [
        (_region(spheres, shaded_sides(spheres, toward, cosine), view, placement, speck), opacity)
        for cosine, opacity in light.terminators
    ]
    bright = [
        (_region(spheres, shaded_sides(spheres, -toward, -cosine), view, placement, speck), opacity)
        for cosine, opacity in light.highlights
    ]
    return _stacked(dark), _stacked(bright)


def _region(spheres: Spheres, copies: Spheres, view: View, placement: Placement, least: float = 0.0) -> Paths:
    """The region in which copies are seen, as one shape on the page, without loops of less than ``least`` Å²."""
    view_map = seen_of_copies(spheres, copies, view)
    large = np.abs(loop_areas(view_map.arcs, view_map.loops)) >= least
    chains = closed_chains(view_map.loops, np.flatnonzero((view_map.loops.face == 1) & large))
    arcs: PlaneArcs = view_map.arcs.moved(placement.scale, placement.shift)
    return shapes_of(arcs, view_map.curve_arcs.curve, chains)


def _stacked(parts: list[tuple[Paths, float]]) -> tuple[Paths, list[float]]:
    """The shapes that are not empty as one table, and their opacities."""
    parts = [(paths, opacity) for paths, opacity in parts if len(paths.arcs.c)]
    return stacked([paths for paths, _ in parts]), [opacity for _, opacity in parts]


def ball_gradients(color: Ints, radius: Floats, style: Style) -> list[RadialGradient]:
    """Return the shading of balls of the given colours (k, 3) and radii (k,) on the page, equal ones being equal.

    Radii are rounded to a few per cent, so that a central view, in which each ball has its own, needs few gradients.
    """
    x, y, _ = style.light.direction
    steps = np.exp(np.round(np.log(radius) / RADIUS_STEP) * RADIUS_STEP)
    bright = mix(color, style.light.bright, style.ball.bright)
    dark = mix(color, style.light.dark, style.ball.dark)
    deep = mix(color, style.light.dark, style.ball.dark / 4)
    rows = zip(*(rows.tolist() for rows in (np.round(steps, 2), bright, color, deep, dark)), strict=True)
    return [
        RadialGradient(
            size, (FOCUS * x * size, FOCUS * y * size),
            ((0.0, color_of(light)), (0.3, color_of(own)), (0.75, color_of(deeper)), (1.0, color_of(edge))),
        )
        for size, light, own, deeper, edge in rows
    ]  # fmt: skip


def color_of(row: list[int]) -> Color:
    """Return a row of three numbers as a colour."""
    red, green, blue = row
    return red, green, blue
