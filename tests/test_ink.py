"""Ink: widths by their formula and without jumps; shapes that are closed, that join, and that leave no thorns."""

import io
import math

import numpy as np
import pytest
import resvg_py
from hypothesis import example, given, settings
from hypothesis import strategies as st
from PIL import Image

from molviz.curves import Paths, PlaneArcs
from molviz.model.spheres import Spheres
from molviz.picture.ink import (
    CORNER,
    FADE,
    FARTHER_THINNER,
    INK_BEYOND,
    INK_GAP,
    LEVEL,
    SIGMA,
    SIGMA_INK,
    SPUR,
    THINNEST,
    THINNEST_SHARE,
    InkStyle,
    Pen,
    Widths,
    at_places,
    distances_from_ends,
    line_widths,
    widest_other,
)
from molviz.picture.ink_ends import INSIDE, LONGEST_MITRE, OUTSIDE, ends_of
from molviz.picture.ink_pockets import inked_arcs, pockets
from molviz.picture.ink_shapes import NECK, arcs_through, in_colors, inked, outlined
from molviz.picture.ink_strokes import Strokes, strokes_of
from molviz.picture.style import load_style
from molviz.visibility.horizon_runs import SPACING, STRAIGHT, HorizonRuns, horizon_runs
from molviz.visibility.map import BACKGROUND, VisibilityMap
from molviz.visibility.scene import Scene
from molviz.visibility.view import View, file_axes
from molviz.write.svg_path import path_data
from tests.oracle import random_spheres
from tests.scenes import map_of, shaken
from tests.stick_scenes import licorice, parallel_bonds
from tests.test_map import DEGENERATE

STYLE = load_style("goodsell").ink
SCALE = 9.0  # points per ångström: the caps rule
DISTANCES = [None, 40.0]


def drawn(
    spheres: Spheres, view: View, style: InkStyle = STYLE, scale: float = SCALE, groups: int = 1
) -> tuple[VisibilityMap, HorizonRuns, Widths, Strokes, Paths]:
    view_map = map_of(spheres, view)
    runs = horizon_runs(view_map, view)
    count = len(view_map.spheres.radius)
    widths = line_widths(runs, np.arange(count) % groups, np.arange(count) / count, style, scale)
    strokes, paths, _ = inked(runs, widths, NECK * style.silhouette.at(scale))
    return view_map, runs, widths, strokes, paths


def loops(paths: Paths) -> list[PlaneArcs]:
    ends = zip(paths.loop_start[:-1].tolist(), paths.loop_start[1:].tolist(), strict=True)
    return [paths.arcs.take(np.arange(begin, end)) for begin, end in ends]


def polygon(loop: PlaneArcs, steps: int = 8) -> np.ndarray:
    """Points along a loop, none twice."""
    t = loop.start[:, None] + loop.sweep[:, None] * np.arange(steps) / steps
    x, y = ((loop.c[:, [k]] + loop.u[:, [k]] * np.cos(t) + loop.v[:, [k]] * np.sin(t)).ravel() for k in (0, 1))
    points = np.column_stack([x, y])
    return points[np.hypot(*(points - np.roll(points, 1, axis=0)).T) > 1e-9]


def crossings(points: np.ndarray) -> int:
    """How many pairs of sides of a closed polygon that are no neighbours cross each other by more than a trifle."""
    a, b = points, np.roll(points, -1, axis=0)
    d = b - a

    def side(p: np.ndarray) -> np.ndarray:
        """Signed distance of points (m, 2) from the line of each side (n, m)."""
        away = p[None] - a[:, None]
        return (d[:, None, 0] * away[..., 1] - d[:, None, 1] * away[..., 0]) / np.hypot(*d.T)[:, None]

    start, end = side(a), side(b)
    apart = (start * end < 0) & (np.minimum(np.abs(start), np.abs(end)) > 1e-3)
    meets = np.triu(apart & apart.T, 2)
    meets[0, -1] = False
    return int(meets.sum())


# ---- widths


def along(runs: HorizonRuns, run: int, place: int, reach: float) -> list[tuple[float, int]]:
    """The samples within reach of one of a run, with their distances; ends count as if they went on."""
    count, steps = int(np.diff(runs.start)[run]), math.ceil(reach / SPACING)
    return [
        (abs(k) * SPACING, (place + k) % (count - 1) if runs.closed[run] else min(max(place + k, 0), count - 1))
        for k in range(-steps, steps + 1)
    ]


def slow_width(runs: HorizonRuns, run: int, group: np.ndarray, far: np.ndarray, scale: float) -> list[float]:
    """The widths along a run by the definition, sample by sample, before its ends count and anything is dropped."""
    begin, count, own = int(runs.start[run]), int(np.diff(runs.start)[run]), int(runs.sphere[run])
    pens = [min(pen.angstrom, pen.points / scale) for pen in (STYLE.silhouette, STYLE.between, STYLE.inside)]

    def raw(k: int) -> float:
        behind, x = int(runs.behind[begin + k]), float(runs.jump[begin + k]) - STYLE.faint
        x = min(max(x / (STYLE.full - STYLE.faint), 0.0), 1.0)
        ramp = x * x * (3 - 2 * x)
        if behind == BACKGROUND:
            width = pens[0]
        else:
            width = pens[2] * ramp if group[behind] == group[own] else pens[1] * (0.5 + 0.5 * ramp)
        return width * (1 - FARTHER_THINNER * far[own])

    fading = [
        max(raw(j) * max(min(1.0, 1 - (away - LEVEL) / FADE), 0.0) for away, j in along(runs, run, k, LEVEL + FADE))
        for k in range(count)
    ]
    weights = [(math.exp(-0.5 * (away / SIGMA) ** 2)) for away, _ in along(runs, run, 0, 3 * SIGMA)]
    near = [along(runs, run, k, 3 * SIGMA) for k in range(count)]
    return [sum(w * fading[j] for w, (_, j) in zip(weights, row, strict=True)) / sum(weights) for row in near]


def slow_dark(due: list[float], runs: HorizonRuns, run: int) -> list[float]:
    """How dark a run is by the definition: gaps closed, dark stretches longer, and means of that."""
    count = len(due)
    longer = [max(due[j] for _, j in along(runs, run, k, INK_GAP / 2)) for k in range(count)]
    closed = [min(longer[j] for _, j in along(runs, run, k, INK_GAP / 2 - INK_BEYOND)) for k in range(count)]
    near = [along(runs, run, k, 3 * SIGMA_INK) for k in range(count)]
    weights = [math.exp(-0.5 * (away / SIGMA_INK) ** 2) for away, _ in near[0]]
    return [sum(w * closed[j] for w, (_, j) in zip(weights, row, strict=True)) / sum(weights) for row in near]


@pytest.mark.parametrize("distance", DISTANCES)
@pytest.mark.parametrize("scale", [3.0, SCALE])
def test_widths_follow_the_formula_where_no_end_is_near(distance: float | None, scale: float) -> None:
    scene = random_spheres(5, 40, 8.0)
    view = file_axes(scene, distance)
    runs = horizon_runs(map_of(scene, view), view)
    group, far = np.arange(40) % 3, np.arange(40) / 40
    found = line_widths(runs, group, far, STYLE, scale)
    thinnest = max(THINNEST, THINNEST_SHARE * STYLE.inside.at(scale))
    from_end = np.minimum(*distances_from_ends(runs))
    owner, compared = runs.owner(), 0
    due = (runs.behind == BACKGROUND) | (group[runs.behind] != group[runs.sphere[owner]])
    for run in range(len(runs.sphere)):
        samples = np.arange(runs.start[run], runs.start[run + 1])
        assert found.dark[samples] == pytest.approx(slow_dark(due[samples].astype(float).tolist(), runs, run), abs=1e-9)
        rows = samples[(from_end[samples] > FADE + CORNER) | runs.closed[run]]
        rows = rows[found.width[rows] > 0]
        slow = np.array(slow_width(runs, run, group, far, scale))[rows - samples[0]]
        assert found.width[rows] == pytest.approx(slow, abs=1e-9) and np.all(slow >= thinnest)
        compared += len(rows)
    assert compared > 100


@given(st.integers(0, 10**6), st.integers(1, 40), st.sampled_from(DISTANCES), st.integers(1, 3))
@settings(max_examples=25)
def test_widths_do_not_jump_and_agree_where_lines_meet(
    seed: int, count: int, distance: float | None, groups: int
) -> None:
    """A line fades within FADE, and ends in a point where there is no other line."""
    scene = random_spheres(seed, count, 8.0)
    _, runs, widths, _, _ = drawn(scene, file_axes(scene, distance), groups=groups)
    owner, width = runs.owner(), widths.width
    inner = (owner[1:] == owner[:-1]) & (width[1:] > 0) & (width[:-1] > 0)
    pen, step = STYLE.silhouette.at(SCALE), runs.spacing / FADE
    assert np.all(np.abs(np.diff(width))[inner] <= 3 * step * pen)
    for rows in widths.ends:
        other = runs.vertices.partner[rows]
        known = np.flatnonzero(~runs.closed & (other >= 0))
        here, there = (
            at_places(width, runs, runs.vertices.run[row[known]], runs.vertices.place[row[known]])
            for row in (rows, other)
        )
        assert np.all((here < 0.01) | (np.maximum(there, widest_other(width, runs, rows)[known]) > 0))


@given(st.integers(0, 10**6), st.sampled_from(DISTANCES))
@settings(max_examples=15)
def test_silhouettes_are_the_heaviest_and_level_lines_are_none(seed: int, distance: float | None) -> None:
    scene = random_spheres(seed, 25, 8.0)
    _, runs, _, _, _ = drawn(scene, file_axes(scene, distance))
    near = np.zeros(25)
    widths = line_widths(runs, np.zeros(25, dtype=int), near, STYLE, SCALE)
    widest = [pen.at(SCALE) for pen in (STYLE.silhouette, STYLE.between, STYLE.inside)]
    assert widest == sorted(widest, reverse=True) and widths.width.max() <= widest[0] + 1e-12
    owner = runs.owner()
    for run in range(len(runs.sphere)):
        rows = owner == run
        if np.all(runs.behind[rows] == BACKGROUND) and np.any(widths.width[rows]):
            middle = rows & (np.minimum(*distances_from_ends(runs)) > FADE)
            assert np.allclose(widths.width[middle], widest[0]) and np.allclose(widths.dark[rows], 1.0)
        if np.all(runs.behind[rows] != BACKGROUND):
            assert widths.width[rows].max() <= widest[2] + 1e-12 and not np.any(widths.dark[rows])
            if runs.jump[rows].max() <= STYLE.faint:
                assert not np.any(widths.width[rows])


def test_between_groups_a_line_is_never_thinner_than_half() -> None:
    near = Spheres(np.array([[0.0, 0.0, 0.0], [0.3, 0.0, -3.8]]), np.array([1.0, 3.0]))
    view = View(np.eye(3), np.zeros(3))
    runs = horizon_runs(map_of(near, view), view)
    own = runs.owner() == np.flatnonzero(runs.sphere == 0)[0]
    pen = STYLE.between.at(SCALE)
    for group, low in ((np.array([0, 1]), 0.5 * pen), (np.array([0, 0]), 0.0)):
        widths = line_widths(runs, group, np.zeros(2), STYLE, SCALE)
        assert np.all(widths.dark[own] == (low > 0))
        assert low <= widths.width[own].min() and widths.width[own].max() <= pen


# ---- shapes


@given(st.integers(0, 10**6), st.integers(1, 40), st.sampled_from(DISTANCES), st.integers(1, 3))
@example(642, 11, None, 1)
@example(50683, 32, None, 2)
@example(798097, 37, None, 2)
@example(483, 13, 40.0, 3)
@settings(max_examples=25)
def test_shapes_are_closed_and_their_ink_is_inside(seed: int, count: int, distance: float | None, groups: int) -> None:
    scene = random_spheres(seed, count, 7.0)
    _, runs, _, strokes, paths = drawn(scene, file_axes(scene, distance), groups=groups)
    assert all(np.isfinite(column).all() for column in paths.arcs)
    assert len(paths.shape_start) == len(strokes.run) + 1
    found = loops(paths)
    area = np.array([float(loop.signed_area().sum()) for loop in found])
    for loop in found:
        assert np.allclose(loop.ends(), np.roll(loop.starts(), -1, axis=0), atol=1e-9)
    rings = np.diff(paths.shape_start) == 2
    assert np.array_equal(rings, strokes.whole) and np.all(np.diff(paths.shape_start) <= 2)
    assert np.all(area[paths.shape_start[:-1]] > 0)  # a line of which its two cuts leave nothing is left out
    for first, ring in zip(paths.shape_start[:-1].tolist(), rings.tolist(), strict=True):
        if ring:
            assert area[first + 1] < 0 and area[first] + area[first + 1] > 0


@pytest.mark.parametrize("distance", DISTANCES)
def test_hardly_a_shape_crosses_itself(distance: float | None) -> None:
    """Few shapes, nearly all short ones under two lines that nearly meet: at most 5 in 1,000 of random scenes."""
    crossed, shapes = 0, 0
    for seed in range(16):
        scene = random_spheres(seed, 35, 8.0)
        _, _, _, _, paths = drawn(scene, file_axes(scene, distance))
        crossed += sum(crossings(polygon(loop)) > 0 for loop in loops(paths))
        shapes += len(paths.loop_start) - 1
    assert shapes > 400 and crossed <= 0.005 * shapes


def test_no_arc_goes_the_long_way_round() -> None:
    """Found as a black disc on sticks of 1AON: where a line crosses its own end, the middle of three points nearly in a
    line lies beyond both others, and the circle through them may be as large as the page."""
    start, end = np.zeros((3, 2)), np.array([[1.0, 0.0], [1.0, 0.0], [1.0, 0.0]])
    middle = np.array([[0.5, 0.5], [1.1, 1e-3], [-0.2, 1e-6]])
    arcs = arcs_through(start, middle, end)
    assert np.allclose(np.abs(arcs.sweep), np.pi) and np.allclose(np.hypot(*arcs.u.T), 0.5)
    assert np.allclose(arcs.at(arcs.middle()), [[0.5, 0.5], [0.5, 0.0], [0.5, 0.0]])
    assert np.allclose(arcs.starts(), start) and np.allclose(arcs.ends(), end)


def test_a_sphere_alone_has_a_ring_of_even_width() -> None:
    _, _, widths, strokes, paths = drawn(Spheres(np.zeros((1, 3)), np.array([1.5])), View(np.eye(3), np.zeros(3)))
    pen = STYLE.silhouette.at(SCALE)
    assert strokes.whole.tolist() == [True] and np.allclose(widths.width, pen)
    outer, inner = (np.hypot(*polygon(loop).T) for loop in loops(paths))
    assert np.allclose(outer, 1.5 + 0.6 * pen) and np.allclose(inner, 1.5 - 0.4 * pen)


@pytest.mark.parametrize("distance", DISTANCES)
@pytest.mark.parametrize("name", DEGENERATE)
def test_no_arrangement_breaks_it(name: str, distance: float | None) -> None:
    scene = shaken(*DEGENERATE[name])
    view = file_axes(scene, distance)
    _, _, _, _, paths = drawn(scene, view)
    assert len(paths.arcs.c) and all(np.isfinite(column).all() for column in paths.arcs)
    assert np.all([loop.signed_area().sum() != 0 for loop in loops(paths)])


def test_a_nested_sphere_has_no_ink() -> None:
    inner = Spheres(np.array([[0.0, 0, 0], [0.1, 0, 0.05]]), np.array([2.0, 0.5]))
    _, runs, _, _, _ = drawn(inner, View(np.eye(3), np.zeros(3)))
    assert runs.sphere.tolist() == [0]


def test_short_lines_that_are_thin_are_dropped_and_wide_ones_are_not() -> None:
    scene = random_spheres(11, 60, 8.0)
    _, runs, widths, strokes, _ = drawn(scene, file_axes(scene))
    short = np.flatnonzero(~runs.closed & (runs.length() < SPUR))
    kept = np.intersect1d(short, strokes.run)
    size = np.maximum.reduceat(widths.width, runs.start[:-1])
    assert 0 < len(kept) < len(short)
    assert np.all(size[kept] >= 0.3 * STYLE.inside.at(SCALE))


# ---- ends


def horizon_gap(runs: HorizonRuns, host: int, points: np.ndarray) -> np.ndarray:
    """Distances of points from the image of the circle of a run, by points of the whole of it; negative inside."""
    t = np.linspace(0, 2 * np.pi, 20_001)
    arc = runs.arcs.take(np.array([host]))
    ellipse = arc.c + np.cos(t)[:, None] * arc.u + np.sin(t)[:, None] * arc.v
    gap = np.array([np.hypot(*(ellipse - point).T).min() for point in points])
    return np.where(np.hypot(*(points - arc.c).T) < np.sqrt((arc.u**2 + arc.v**2).sum() / 2), -gap, gap)


@pytest.mark.parametrize("distance", DISTANCES)
@pytest.mark.parametrize("seed", range(3))
def test_lines_that_pass_under_a_line_end_under_its_ink(seed: int, distance: float | None) -> None:
    """No shape comes out on the inner side of a line under which it ends, nor lies on a ball whose line is thinner.

    Of the shape's points in the host's disc the deepest is no deeper than the host's ink is wide there.
    """
    scene = random_spheres(seed, 40, 9.0)
    _, runs, widths, strokes, paths = drawn(scene, file_axes(scene, distance))
    found, seen = loops(paths), 0
    for row in np.flatnonzero(~strokes.whole).tolist():
        points = polygon(found[int(paths.shape_start[row])])
        for at in strokes.ends[:, row].tolist():
            other = int(runs.vertices.partner[np.array([at])][0]) if at >= 0 else -1
            if other < 0 or at not in runs.ends or other in widths.ends:
                continue  # in the open, or a corner
            host, place = runs.vertices.run[[other]], runs.vertices.place[[other]]
            corner = runs.arcs.take(host).at(runs.t[runs.start[host] + np.round(place).astype(int)])
            wide = float(at_places(widths.width, runs, host, place)[0])
            own = float(at_places(widths.width, runs, runs.vertices.run[[at]], runs.vertices.place[[at]])[0])
            if own == 0 or widest_other(widths.width, runs, np.array([at]))[0] > wide:
                continue
            close = points[np.hypot(*(points - corner).T) < 2 * max(wide, own)]
            seen += 1
            assert horizon_gap(runs, int(host[0]), close).min(initial=0.0) > INSIDE * wide - 0.02
    assert seen > 10


@pytest.mark.parametrize("distance", DISTANCES)
def test_dark_lines_stop_at_the_ink_of_lines_across_them(distance: float | None) -> None:
    """Dark ink is drawn on the things' own: where a line ends under one of these, it stops at its edge.

    Short strokes, and the few that curve so that they never meet that edge, end as they may.
    """
    gaps = []
    for seed in range(40):
        scene = random_spheres(seed, 60, 9.0)
        _, runs, widths, _, _ = drawn(scene, file_axes(scene, distance), groups=2)
        dark = np.where(widths.width * widths.dark >= THINNEST, widths.width * widths.dark, 0.0)
        strokes = strokes_of(runs, dark > 0, widths.ends)
        ends = ends_of(runs, strokes, dark, widths)
        drawn_ones, paths = outlined(runs, strokes, dark, widths, NECK * STYLE.silhouette.at(SCALE))
        begins = zip(drawn_ones.run.tolist(), drawn_ones.first.tolist(), strict=True)
        shapes = {begin: row for row, begin in enumerate(begins)}
        for row in np.flatnonzero(ends.bars() > 0).tolist():
            shape = shapes[strokes.run[ends.stroke[row]], strokes.first[ends.stroke[row]]]
            points = polygon(loops(paths)[int(paths.shape_start[shape])])
            close = points[np.hypot(*(points - ends.frame.point[row]).T) < 0.7 * ends.width[row]]
            if ends.most[row] * ends.frame.step[row] > 2 * ends.width[row]:
                gaps.append(horizon_gap(runs, int(ends.host[row]), close).min(initial=1.0) / ends.barred[row])
    assert len(gaps) > 8 and np.mean(np.array(gaps) > 0.8) > 0.8


@pytest.mark.parametrize(("radius", "half"), [(1.7, 1.5), (1.7, 1.0), (1.7, 0.4), (3.0, 2.9)])
def test_two_lines_that_end_together_are_mitred(radius: float, half: float) -> None:
    """Sides of equal balls at (± a, 0) meet at x = 0, where ``y² = (r + share w)² − a²``; spikes are limited.

    Where the wedge between both outer sides is narrow, ink fills it somewhat farther.
    """
    scene = Spheres(np.array([[-half, 0, 0], [half, 0, -1e-3]]), np.full(2, radius))
    view = file_axes(scene)
    runs = horizon_runs(map_of(scene, view), view)
    widths = line_widths(runs, np.zeros(2), np.zeros(2), STYLE, SCALE)
    _, paths, _ = inked(runs, widths, NECK * STYLE.silhouette.at(SCALE))
    width = STYLE.silhouette.at(SCALE)
    points = np.vstack([polygon(loop, 40) for loop in loops(paths)])
    above = points[points[:, 1] > 0]
    end = float(np.sqrt(radius**2 - half**2))
    outer, inner = (float(np.sqrt(max((radius + share * width) ** 2 - half**2, 0.0))) for share in (OUTSIDE, INSIDE))
    tip = max(inner, end - LONGEST_MITRE * width)
    assert above[np.abs(above[:, 0]) < 0.02, 1].min() == pytest.approx(tip, abs=0.02)
    a, b = points, np.roll(points, -1, axis=0)
    crosses = (a[:, 0] * b[:, 0] < 0) & (np.minimum(a[:, 1], b[:, 1]) > 0) & (np.hypot(*(b - a).T) < 0.5)
    highest = (a[crosses, 1] - a[crosses, 0] * (b - a)[crosses, 1] / (b - a)[crosses, 0]).max()
    assert outer - 0.02 < highest < outer + (0.02 if half < end else 0.15)
    off = np.abs(above[:, 0]) > (0.02 if tip == inner else 0.1)
    assert np.hypot(np.abs(above[off, 0]) - half, above[off, 1]).min() > radius + INSIDE * width - 0.02


def test_the_dark_ink_ends_in_points_on_the_things_own() -> None:
    """Where the ink changes along a line the own ink goes on below the dark one, which narrows to a point."""
    scene = random_spheres(5, 40, 8.0)
    view_map = map_of(scene, file_axes(scene))
    runs = horizon_runs(view_map, file_axes(scene))
    widths = line_widths(runs, np.arange(40) % 2, np.zeros(40), STYLE, SCALE)
    strokes, paths, dark = inked(runs, widths, NECK * STYLE.silhouette.at(SCALE))
    assert not np.any(np.diff(dark.astype(int)) < 0)  # in painting order the own ink comes first
    changes = np.flatnonzero(dark & (strokes.ends == -1).any(axis=0) & ~strokes.whole)
    tips = 0
    for row in changes.tolist():
        run, found = int(strokes.run[row]), loops(paths)[int(paths.shape_start[row])]
        for place, at in ((strokes.first[row], strokes.ends[0, row]), (strokes.last[row], strokes.ends[1, row])):
            if at < 0:
                point = runs.arcs.take(np.array([run])).at(runs.arcs.start[[run]] + runs.arcs.sweep[run] * place
                                                           / runs.last()[run])  # fmt: skip
                tips += bool(np.hypot(*(found.starts() - point).T).min() < 1e-9)
    assert tips > 3


def test_lines_that_fade_out_end_in_points() -> None:
    scene = random_spheres(8, 40, 8.0)
    _, runs, widths, strokes, paths = drawn(scene, file_axes(scene))
    fades = (strokes.ends[1] < 0) & ~strokes.whole & (widths.dark[runs.start[strokes.run]] == 0)
    ended = 0
    for row in np.flatnonzero(fades).tolist():
        place = int(runs.start[strokes.run[row]]) + int(strokes.last[row])
        if widths.width[place] == 0:
            point = runs.arcs.take(strokes.run[[row]]).at(runs.t[[place]])
            ended += 1
            assert np.hypot(*(polygon(loops(paths)[int(paths.shape_start[row])]) - point).T).min() < 1e-9
    assert ended > 0


# ---- as seen


def pixels(paths: Paths, low: np.ndarray, side: float, size: int) -> np.ndarray:
    """Whether each pixel of a square is inked: (size, size)."""
    data = path_data(paths._replace(arcs=paths.arcs.moved(100.0, -100.0 * low)), 100.0 * side)
    body = "".join(f'<path d="{d}"/>' for d in data if d)
    box = f'viewBox="0 0 {100 * side} {100 * side}" width="{size}" height="{size}"'
    png = resvg_py.svg_to_bytes(svg_string=f'<svg xmlns="http://www.w3.org/2000/svg" {box}>{body}</svg>')
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGBA"))[..., 3] > 127


def grown(image: np.ndarray, radius: int) -> np.ndarray:
    """The pixels within a radius of set ones."""
    size, reach = len(image), np.arange(-radius, radius + 1)
    disc = np.zeros_like(image, dtype=float)
    disc[np.ix_(reach % size, reach % size)] = reach[:, None] ** 2 + reach**2 <= radius**2
    both = np.fft.irfft2(np.fft.rfft2(image.astype(float)) * np.fft.rfft2(disc), image.shape)
    return np.asarray(both > 0.5)


def patches(image: np.ndarray) -> list[np.ndarray]:
    """The connected patches of set pixels as lists of their places (m, 2)."""
    todo, found = {(int(y), int(x)) for y, x in zip(*np.nonzero(image), strict=True)}, []
    while todo:
        edge = [todo.pop()]
        patch = list(edge)
        while edge:
            y, x = edge.pop()
            near = {(y + dy, x + dx) for dy in (-1, 0, 1) for dx in (-1, 0, 1)} & todo
            todo -= near
            edge += near
            patch += near
        found.append(np.array(patch))
    return found


def test_thorns_and_notches_are_few() -> None:
    """By opening and closing with discs, at 100 pixels an ångström, in three random scenes.

    What opening with a disc of 0.04 Å takes away and is neither long nor tiny is a thorn, the tip of a line that fades,
    or a sharp mitre, which most of them are; what closing with a disc of 0.05 Å fills and is not tiny is a notch. When
    lines ended on the very horizon above them and each was as wide as it liked, there were 19 and 16.
    """
    thorns, notches = 0, 0
    for seed in range(3):
        _, _, _, _, paths = drawn(scene := random_spheres(seed, 40, 8.0), file_axes(scene))
        image = pixels(paths, np.array([-6.0, -6.0]), 12.0, 1200)
        opened, closed = grown(~grown(~image, 4), 4), ~grown(~grown(image, 5), 5)
        thorns += sum(len(p) > 12 and np.ptp(p, axis=0).max() < 15 for p in patches(image & ~opened))
        notches += sum(len(p) > 40 for p in patches(closed & ~image))
        assert 0.02 < image.mean() < 0.5
    assert thorns <= 15 and notches <= 9


# ---- pockets


def three_around(gap: float) -> Spheres:
    """Three balls around a hole to the background, ``gap`` ångström from its middle."""
    angle = np.radians([90.0, 210.0, 330.0])
    center = np.column_stack([np.cos(angle), np.sin(angle), [0.0, 0.1, 0.2]]) * [4.0 + gap, 4.0 + gap, 1.0]
    return Spheres(center, np.full(3, 4.0))


@pytest.mark.parametrize(("gap", "count"), [(0.2, 1), (0.45, 0)])
def test_holes_that_ink_nearly_fills_are_filled(gap: float, count: int) -> None:
    """The ink of silhouettes reaches 0.6 × 0.356 Å into the hole from each side."""
    scene = three_around(gap)
    view = View(np.eye(3), np.zeros(3))
    view_map, runs, widths, _, _ = drawn(scene, view)
    found = pockets(view_map, runs, widths, NECK * STYLE.silhouette.at(SCALE))
    assert len(found.run) == count and np.all(found.dark)
    if count:
        assert found.paths.arcs.signed_area().sum() == pytest.approx(hole_area(gap))


def test_a_line_between_two_sides_of_a_part_leaves_room_on_either() -> None:
    """A ball in a hole, joined to what is around it by a line without ink, was filled with ink all over."""
    hole = three_around(0.45)
    balls = Spheres(np.array([[0.01, 0.25, -1.0], [0.0, -0.25, -1.1]]), np.full(2, 0.35))
    scene = Spheres(np.vstack([hole.center, balls.center]), np.append(hole.radius, balls.radius))
    view_map, runs, widths, _, _ = drawn(scene, View(np.eye(3), np.zeros(3)))
    without = np.isin(runs.owner(), np.flatnonzero(runs.sphere == 4))
    widths = widths._replace(width=np.where(without, 0.0, widths.width))
    assert len(pockets(view_map, runs, widths, 0.41).run) == 0  # the upper ball has room for a disc 0.42 Å wide
    (run,) = pockets(view_map, runs, widths, 0.6).run.tolist()
    assert runs.sphere[run] < 3


def hole_area(gap: float) -> float:
    """The area between three discs of radius 4 that overlap pairwise, with centres 4 + gap from the middle.

    Of the triangle of the centres three sectors of 60° are taken away, and twice half of each lens.
    """
    half = (4 + gap) * math.sqrt(3) / 2
    lens = 2 * (16 * math.acos(half / 4) - half * math.sqrt(16 - half**2))
    return math.sqrt(3) * half**2 - 8 * math.pi + 3 * lens / 2


def test_ink_along_the_arcs_of_the_map_is_that_of_their_runs() -> None:
    scene = random_spheres(4, 40, 8.0)
    view_map, runs, widths, _, _ = drawn(scene, file_axes(scene))
    found = inked_arcs(runs, widths)
    assert not found[:, view_map.is_crease()].any() and found.max() <= widths.width.max()
    for run in np.flatnonzero(runs.closed).tolist():
        rows = runs.run_of_arc == run
        assert found[:, rows].max() == pytest.approx(widths.width[runs.owner() == run].max(), rel=0.1)


# ---- scale and colours


def test_pens_grow_with_the_page_until_their_caps_hold() -> None:
    pen = Pen(0.42, 3.2)
    assert pen.at(1.0) == 0.42 and pen.at(9.0) == pytest.approx(3.2 / 9)
    for scale in (10.0, 20.0, 40.0):
        assert pen.at(scale) * scale == pytest.approx(3.2)


def test_a_scene_twice_as_large_at_half_the_scale_has_the_same_ink_where_caps_rule() -> None:
    """In points; what a lone ball's line is made of depends on nothing else in ångström."""
    for size, scale in ((1.5, 20.0), (3.0, 10.0)):
        ball = Spheres(np.zeros((1, 3)), np.array([size]))
        *_, paths = drawn(ball, View(np.eye(3), np.zeros(3)), scale=scale)
        outer, inner = (np.hypot(*polygon(loop).T) * scale for loop in loops(paths))
        assert np.allclose(outer, 30 + 0.6 * 3.2) and np.allclose(inner, 30 - 0.4 * 3.2)


@pytest.mark.parametrize("points", [0.0, 1.0, 6.4])
def test_an_outline_scales_all_pens(points: float) -> None:
    scaled = STYLE.scaled_to(points, SCALE)
    for old, new in zip((STYLE.silhouette, STYLE.between, STYLE.inside),
                        (scaled.silhouette, scaled.between, scaled.inside), strict=True):  # fmt: skip
        assert new.at(SCALE) == pytest.approx(old.at(SCALE) * points / 3.2)
    assert STYLE.scaled_to(None, SCALE) is STYLE


def test_shapes_of_one_colour_become_one_and_keep_all_loops() -> None:
    scene = random_spheres(5, 20, 8.0)
    _, _, _, strokes, paths = drawn(scene, file_axes(scene))
    color = (np.arange(len(strokes.run)) % 3)[:, None]
    joined, distinct = in_colors(paths, color)
    assert distinct[:, 0].tolist() == [0, 1, 2] and len(joined.loop_start) == len(paths.loop_start)
    for number in range(3):
        rows = [
            loop
            for shape in np.flatnonzero(color[:, 0] == number)
            for loop in loops(paths)[paths.shape_start[shape] : paths.shape_start[shape + 1]]
        ]
        mine = loops(joined)[joined.shape_start[number] : joined.shape_start[number + 1]]
        assert [loop.c.tolist() for loop in rows] == [loop.c.tolist() for loop in mine]


@pytest.mark.parametrize("seed", range(4))
def test_ink_along_sticks_is_no_wider_than_it_should_be(seed: int) -> None:
    """Lines that fade only near their ends are straight along the rest; short horizons of joints are no spurs."""
    spheres, sticks = licorice(seed, 24)
    view = file_axes(spheres)
    view_map = Scene(spheres, view, sticks).map(view)[0]
    runs = horizon_runs(view_map, view)
    widths = line_widths(runs, np.zeros(24), np.zeros(24), STYLE, SCALE)
    strokes, paths, _ = inked(runs, widths, 0.0)
    for row in np.flatnonzero(runs.straight()[strokes.run]).tolist():
        arc = runs.arcs.take(strokes.run[[row]])
        points = polygon(loops(paths)[int(paths.shape_start[row])])
        beside = np.hypot(*(points - arc.c[0]).T) - STRAIGHT
        most = float(widths.width[runs.start[strokes.run[row]] : runs.start[strokes.run[row] + 1]].max())
        assert INSIDE * most - 0.02 < beside.min() and beside.max() < OUTSIDE * most + 0.02
    background = np.flatnonzero(~runs.closed & (np.maximum.reduceat(runs.behind, runs.start[:-1]) == BACKGROUND))
    assert len(background) > 10 and (np.maximum.reduceat(widths.width, runs.start[:-1])[background] > 0).all()


@pytest.mark.parametrize("seed", range(3))
def test_lines_of_sticks_are_no_wider_than_these_are_thick(seed: int) -> None:
    """Else the gap between the sticks of a double bond would be full of ink."""
    spheres, sticks = parallel_bonds(seed, 20)
    view = file_axes(spheres)
    runs = horizon_runs(Scene(spheres, view, sticks).map(view)[0], view)
    widths = line_widths(runs, np.zeros(20), np.zeros(20), STYLE, 30.0)
    assert (widths.width <= runs.stick[runs.owner()] + 1e-12).all()
    assert (widths.width[runs.straight()[runs.owner()]] > 0.05).any() and (widths.width > 0.06).any()


@pytest.mark.parametrize("distance", DISTANCES)
def test_a_line_between_groups_that_goes_on_as_a_crease_has_no_gap(distance: float | None) -> None:
    """Its short parts are no spurs, and it does not end in corners; all arcs longer than 0.1 Å have ink."""
    seen = 0
    for seed in range(4):
        scene = random_spheres(seed, 60, 8.0)
        view = file_axes(scene, distance)
        view_map = map_of(scene, view)
        runs = horizon_runs(view_map, view)
        group = np.arange(60) % 2
        widths = line_widths(runs, group, np.zeros(60), STYLE, SCALE, crease=0.1)
        middle = inked_arcs(runs, widths)[2]
        between = np.append(group, -1)[view_map.left] != np.append(group, -1)[view_map.right]
        arcs = np.flatnonzero((runs.run_of_arc >= 0) & between & (view_map.right != BACKGROUND))
        arcs = arcs[view_map.arcs.lengths()[arcs] > 0.1]
        assert (middle[arcs] > 0).all()
        seen += len(arcs)
    assert seen > 100
