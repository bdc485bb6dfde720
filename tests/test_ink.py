"""Ink: widths by their formula, shapes that are closed, simple and end where they should."""

import math
from itertools import groupby

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from molviz.curves import Paths, PlaneArcs
from molviz.model.spheres import Spheres
from molviz.picture.ink import (
    ARC,
    FARTHER_THINNER,
    SHORTEST_INK,
    SIGMA,
    SIGMA_INK,
    SPUR,
    THINNEST,
    THINNEST_SHARE,
    InkStyle,
    Pen,
    Strokes,
    Widths,
    in_colors,
    line_widths,
    outlined,
    strokes_of,
)
from molviz.picture.style import load_style
from molviz.visibility.horizon_runs import SPACING, HorizonRuns, horizon_runs
from molviz.visibility.map import BACKGROUND, VisibilityMap
from molviz.visibility.view import View, file_axes
from tests.oracle import random_spheres
from tests.scenes import map_of, shaken
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
    return view_map, runs, widths, *outlined(runs, widths, strokes_of(runs, widths))


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


def slow_width(
    runs: HorizonRuns, run: int, place: int, group: np.ndarray, far: np.ndarray, style: InkStyle, scale: float
) -> tuple[float, float]:
    """Width and darkness at one sample of a run by the definition, sample by sample, before anything is dropped."""
    begin, count, own = int(runs.start[run]), int(np.diff(runs.start)[run]), int(runs.sphere[run])

    def raw(k: int) -> tuple[float, bool]:
        behind, x = (
            int(runs.behind[begin + k]),
            (float(runs.jump[begin + k]) - style.faint) / (style.full - style.faint),
        )
        ramp = 0.0 if x <= 0 else 1.0 if x >= 1 else x * x * (3 - 2 * x)
        if behind == BACKGROUND:
            width, dark = min(style.silhouette.angstrom, style.silhouette.points / scale), True
        elif group[behind] != group[own]:
            width, dark = min(style.between.angstrom, style.between.points / scale) * (0.5 + 0.5 * ramp), True
        else:
            width, dark = min(style.inside.angstrom, style.inside.points / scale) * ramp, False
        return width * (1 - FARTHER_THINNER * far[own]), dark

    def mean(sigma: float, column: int) -> float:
        reach = math.ceil(3 * sigma / SPACING)
        weight = [math.exp(-0.5 * (k * SPACING / sigma) ** 2) for k in range(-reach, reach + 1)]
        at = [(place + k) % (count - 1) if runs.closed[run] else min(max(place + k, 0), count - 1)
              for k in range(-reach, reach + 1)]  # fmt: skip
        return sum(w * raw(k)[column] for w, k in zip(weight, at, strict=True)) / sum(weight)

    return mean(SIGMA, 0), mean(SIGMA_INK, 1)


def slow_ink(dark: list[bool]) -> list[bool]:
    """The inks of one run without stretches that are short, and shorter than what is beside them."""
    parts = [(ink, len(list(same))) for ink, same in groupby(dark)]
    inks: list[bool] = []
    for k, (ink, length) in enumerate(parts):
        beside = [parts[j][1] for j in (k - 1, k + 1) if 0 <= j < len(parts)]
        short = length * SPACING < SHORTEST_INK and beside and all(length < other for other in beside)
        inks += [ink ^ bool(short)] * length
    return inks


@pytest.mark.parametrize("distance", DISTANCES)
@pytest.mark.parametrize("scale", [3.0, SCALE])
def test_widths_follow_the_formula(distance: float | None, scale: float) -> None:
    scene = random_spheres(5, 40, 8.0)
    view = file_axes(scene, distance)
    runs = horizon_runs(map_of(scene, view), view)
    group, far = np.arange(40) % 3, np.arange(40) / 40
    found = line_widths(runs, group, far, STYLE, scale)
    thinnest = max(THINNEST, THINNEST_SHARE * STYLE.inside.at(scale))
    seen = set()
    for run in range(len(runs.sphere)):
        samples = range(int(runs.start[run]), int(runs.start[run + 1]))
        slow = [slow_width(runs, run, k - samples[0], group, far, STYLE, scale) for k in samples]
        width = [w if w >= thinnest else 0.0 for w, _ in slow]
        thin = min(width[0], width[-1]) < 0.4 * STYLE.inside.at(scale)
        spur = not runs.closed[run] and runs.length()[run] < SPUR and thin
        seen.add(spur)
        assert found.width[samples] == pytest.approx([0.0] * len(samples) if spur else width, abs=1e-9)
        if all(abs(d - 0.5) > 1e-9 for _, d in slow):
            assert found.dark[samples].tolist() == slow_ink([d > 0.5 for _, d in slow])
    assert seen == {True, False}


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
            assert np.allclose(widths.width[rows], widest[0])
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
        assert np.all(widths.dark[own]) == (low > 0)
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
    """Of 95,000 shapes of random scenes 69 did, nearly all shorter than 0.3 Å: of these at most 3 in 1,000."""
    crossed, shapes = 0, 0
    for seed in range(16):
        scene = random_spheres(seed, 35, 8.0)
        _, _, _, _, paths = drawn(scene, file_axes(scene, distance))
        crossed += sum(crossings(polygon(loop)) > 0 for loop in loops(paths))
        shapes += len(paths.loop_start) - 1
    assert shapes > 400 and crossed <= 0.003 * shapes


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


def test_short_lines_with_a_thin_end_are_dropped_and_wide_ones_are_not() -> None:
    scene = random_spheres(11, 60, 8.0)
    _, runs, widths, strokes, _ = drawn(scene, file_axes(scene))
    short = np.flatnonzero(~runs.closed & (runs.length() < SPUR))
    drawn_short = np.intersect1d(short, strokes.run)
    ends = np.minimum(widths.width[runs.start[:-1]], widths.width[runs.start[1:] - 1])
    assert 0 < len(drawn_short) < len(short)
    assert np.all(ends[drawn_short] >= 0.4 * STYLE.inside.at(SCALE))


# ---- ends


def horizon_gap(runs: HorizonRuns, host: int, points: np.ndarray) -> np.ndarray:
    """Distances of points from the image of a sphere's horizon, by the points of its whole ellipse."""
    t, whole = np.linspace(0, 2 * np.pi, 20_001), runs.horizons
    ellipse = whole.c[host] + np.cos(t)[:, None] * whole.u[host] + np.sin(t)[:, None] * whole.v[host]
    return np.array([np.hypot(*(ellipse - point).T).min() for point in points])


def corners(strokes: Strokes, paths: Paths, row: int) -> tuple[np.ndarray, np.ndarray]:
    """The outer and the inner point at the start of a stroke, and at its end."""
    loop = loops(paths)[int(paths.shape_start[row])]
    pieces = max(math.ceil((strokes.last[row] - strokes.first[row]) / ARC), 1)
    points = loop.starts()
    return points[[0, 2 * pieces + 1]], points[[pieces, pieces + 1]]


@pytest.mark.parametrize("distance", DISTANCES)
@pytest.mark.parametrize("seed", range(3))
def test_lines_that_pass_under_a_horizon_end_on_it(seed: int, distance: float | None) -> None:
    """Both corners of the end lie on the nearer horizon; few lines end straight across, where that is too far."""
    scene = random_spheres(seed, 40, 9.0)
    _, runs, _, strokes, paths = drawn(scene, file_axes(scene, distance))
    mitred, straight = 0, 0
    for row in np.flatnonzero(~strokes.whole).tolist():
        run, (start, end) = int(strokes.run[row]), corners(strokes, paths, row)
        for is_end, host, pair in (
            (strokes.at_start[row], int(runs.before[run]), start),
            (strokes.at_end[row], int(runs.after[run]), end),
        ):
            if is_end and host >= 0:
                on = horizon_gap(runs, host, pair) < 1e-3
                mitred, straight = mitred + int(on.sum()), straight + int((~on).sum())
    assert mitred > 20 and straight < 0.15 * mitred


def test_pieces_in_two_inks_meet() -> None:
    """Where the ink changes along a run, one piece ends exactly where and as wide as the other begins."""
    scene = random_spheres(5, 40, 8.0)
    _, _, _, strokes, paths = drawn(scene, file_axes(scene), groups=2)
    met = 0
    for one in range(len(strokes.run) - 1):
        if strokes.run[one] == strokes.run[one + 1] and strokes.last[one] == strokes.first[one + 1]:
            assert strokes.dark[one] != strokes.dark[one + 1]
            assert np.allclose(corners(strokes, paths, one)[1], corners(strokes, paths, one + 1)[0], atol=1e-9)
            met += 1
    assert met > 3


def test_lines_that_fade_out_end_in_points() -> None:
    scene = random_spheres(8, 40, 8.0)
    _, runs, widths, strokes, paths = drawn(scene, file_axes(scene))
    count = np.diff(runs.start)[strokes.run]
    fades = (strokes.last != count - 1) & ~strokes.whole & (strokes.last % 1 == 0)
    assert fades.any()
    for row in np.flatnonzero(fades).tolist():
        place = int(runs.start[strokes.run[row]]) + int(strokes.last[row])
        assert widths.width[place] == 0
        point = runs.arcs.take(strokes.run[[row]]).at(runs.t[[place]])
        assert np.hypot(*(polygon(loops(paths)[int(paths.shape_start[row])]) - point).T).min() < 1e-9


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
