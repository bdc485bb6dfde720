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
    drop_at_edge,
    on_ledges,
    seen_of_copies,
    seen_spheres,
    shaded_sides,
    skirts,
)
from molviz.visibility.view import View

LEDGE_FROM = 1.0  # ångström: wider skirts hang from ledges only, not from lone tips
LEDGE_WITHIN = 1.6  # ångström beyond the skirt's reach
SPECK = 0.1  # of the square of the usual radius: smaller bands of light look like dirt
RADIUS_STEP = 0.03  # of a radius: the eye tells no gradients apart that differ by less
FOCUS = 0.55  # of the radius, how far from the middle a ball is brightest, times the light's x and y
LEDGE_COUNT = 7  # spheres that make a ledge


def deepest_jumps(runs: HorizonRuns, count: int) -> Floats:
    """Return the deepest finite jump (count,) along the horizon of each sphere, 0 where there is none."""
    deepest = np.zeros(count)
    rows = np.isfinite(runs.jump)
    np.maximum.at(deepest, runs.sphere[runs.owner()[rows]], runs.jump[rows])
    return deepest


def contact_steps(
    view_map: VisibilityMap, view: View, runs: HorizonRuns, shade: Shade, placement: Placement
) -> tuple[Paths, list[float]]:
    """Return the steps of the contact shade that cover anything, one shape each, and their opacities."""
    seen = seen_spheres(view_map)
    spheres, jumps = view_map.spheres.take(seen), deepest_jumps(runs, len(view_map.spheres.radius))[seen]
    if len(view_map.sticks.length):
        jumps = np.where(spheres.radius >= ATOM, jumps, 0.0)  # those of small balls would lie on their sticks
    steps = shade.large_steps if len(seen) >= shade.large_from else shade.steps
    parts = [
        (_region(spheres, skirts(spheres, rows, step.reach, step.low, view), view, placement), step.opacity)
        for step in steps
        if len(rows := _hung_from(spheres, jumps, view, step))
    ]
    return _stacked(parts)


def _hung_from(spheres: Spheres, jumps: Floats, view: View, step: ShadeStep) -> Ints:
    """The spheres whose skirts can be seen: those with something deeper than the drop behind their edges."""
    drop = drop_at_edge(spheres.radius, step.reach, step.low)
    rows = np.flatnonzero((drop > 0) & (jumps > drop))
    if step.reach <= LEDGE_FROM or not len(rows):
        return rows
    projection = projection_of(view)
    page, height = projection.page_points(spheres.center), projection.nearness(spheres.center)
    below = (height - drop / 2)[rows]
    return rows[on_ledges(page, height, rows, step.reach + LEDGE_WITHIN, below, LEDGE_COUNT + 1)]


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
