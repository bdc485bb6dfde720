"""Contact shade and bands of light: exact regions in which copies of the spheres are seen."""

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.curves import Paths, PlaneArcs
from molviz.model.spheres import Spheres
from molviz.picture.page import Placement
from molviz.picture.regions import closed_chains, shapes_of
from molviz.picture.style import Light, Shade, ShadeStep
from molviz.visibility.eye import projection_of
from molviz.visibility.horizon_runs import HorizonRuns
from molviz.visibility.map import VisibilityMap
from molviz.visibility.overlay import (
    drop_at_rim,
    on_ledges,
    seen_of_copies,
    seen_spheres,
    shaded_sides,
    skirts,
)
from molviz.visibility.view import View

LEDGE_FROM = 1.0  # ångström: wider skirts hang from ledges only, not from lone tips
LEDGE_WITHIN = 1.6  # ångström beyond the skirt's reach
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
    steps = shade.large_steps if len(seen) >= shade.large_from else shade.steps
    parts = [
        (_region(spheres, skirts(spheres, rows, step.reach, step.low, view), view, placement), step.opacity)
        for step in steps
        if len(rows := _hung_from(spheres, jumps, view, step))
    ]
    return _stacked(parts)


def _hung_from(spheres: Spheres, jumps: Floats, view: View, step: ShadeStep) -> Ints:
    """The spheres whose skirts can be seen: those with something deeper than the drop behind their edges."""
    drop = drop_at_rim(spheres.radius, step.reach, step.low)
    rows = np.flatnonzero((drop > 0) & (jumps > drop))
    if step.reach <= LEDGE_FROM:
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
    toward = np.array(light.direction)
    dark = [
        (_region(spheres, shaded_sides(spheres, toward, cosine), view, placement), opacity)
        for cosine, opacity in light.terminators
    ]
    bright = [
        (_region(spheres, shaded_sides(spheres, -toward, -cosine), view, placement), opacity)
        for cosine, opacity in light.highlights
    ]
    return _stacked(dark), _stacked(bright)


def _region(spheres: Spheres, copies: Spheres, view: View, placement: Placement) -> Paths:
    """The region in which copies are seen, as one shape on the page."""
    view_map, boundary = seen_of_copies(spheres, copies, view)
    chains = closed_chains(boundary, np.flatnonzero(boundary.face == 1))
    arcs: PlaneArcs = view_map.arcs.moved(placement.scale, placement.shift)
    return shapes_of(arcs, view_map.curve_arcs.curve, chains)


def _stacked(parts: list[tuple[Paths, float]]) -> tuple[Paths, list[float]]:
    """Shapes of several tables as one table, without those that are empty."""
    parts = [(paths, opacity) for paths, opacity in parts if len(paths.arcs.c)]
    if not parts:
        nothing = PlaneArcs(np.empty((0, 2)), np.empty((0, 2)), np.empty((0, 2)), np.empty(0), np.empty(0))
        return Paths(nothing, np.zeros(1, dtype=np.int64), np.zeros(1, dtype=np.int64)), []
    tables = [paths for paths, _ in parts]
    arcs = PlaneArcs(*map(np.concatenate, zip(*(one.arcs for one in tables), strict=True)))
    loop_start = _joined([one.loop_start for one in tables])
    return Paths(arcs, loop_start, _joined([one.shape_start for one in tables])), [opacity for _, opacity in parts]


def _joined(starts: list[Ints]) -> Ints:
    """CSR offsets of tables that follow each other."""
    counts = np.concatenate([np.diff(start) for start in starts])
    return np.concatenate([[0], np.cumsum(counts)])
