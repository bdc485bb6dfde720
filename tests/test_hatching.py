"""Hatching: parallel lines inside regions, all of them, cut exactly at the boundary."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz.curves import Paths, PlaneArcs
from molviz.picture.hatching import LEVELS, OFFSET, WHITE, hatched, level_distance, tone_levels
from molviz.picture.regions import merged_regions, shape_of
from molviz.picture.style import load_style
from molviz.visibility.view import file_axes
from tests.oracle import random_spheres, winding
from tests.scenes import map_of
from tests.shaded_pictures import circle, paths, rectangle, side

SQUARE = paths([[rectangle(-5, -3, 5, 3)]])


def region(seed: int, count: int, scale: float = 1.0) -> Paths:
    """One of three labels' regions of a random scene: many loops, holes, arcs of circles and of ellipses."""
    spheres = random_spheres(seed, count, 6.0)
    view_map = map_of(spheres, file_axes(spheres))
    arcs = view_map.arcs.moved(scale, np.array([3.0, -2.0]))
    return shape_of(merged_regions(view_map, arcs, np.random.default_rng(seed).integers(0, 3, count)).paths, 0)


def area(shape: Paths) -> float:
    return float(shape.arcs.signed_area().sum())


def outline(arcs: PlaneArcs, steps: int = 400) -> list[np.ndarray]:
    """Points of each arc."""
    t = arcs.start[:, None] + arcs.sweep[:, None] * np.linspace(0, 1, steps)
    return [np.column_stack([
        arcs.c[k, axis] + arcs.u[k, axis] * np.cos(t[k]) + arcs.v[k, axis] * np.sin(t[k]) for axis in (0, 1)
    ]) for k in range(len(t))]  # fmt: skip


def is_inside(shape: Paths, points: np.ndarray) -> np.ndarray:
    """Even-odd, by the polygon of its loops."""
    total = np.zeros(len(points), dtype=int)
    for begin, end in zip(shape.loop_start[:-1].tolist(), shape.loop_start[1:].tolist(), strict=True):
        x, y = np.concatenate([one[:-1] for one in outline(shape.arcs.take(np.arange(begin, end)))]).T
        total += winding(x, y, points)
    return total % 2 == 1


def on_boundary(arcs: PlaneArcs, points: np.ndarray) -> np.ndarray:
    """The least distance of points from arcs by Newton's method on the curves themselves, from many guesses."""
    least = np.full(len(points), np.inf)
    for k in range(len(arcs.c)):
        one = arcs.take(np.full(len(points), k))
        t = np.linspace(0, 1, 64)[:, None] * arcs.sweep[k] + arcs.start[k]
        curve = arcs.c[k] + np.cos(t) * arcs.u[k] + np.sin(t) * arcs.v[k]
        guess = t[np.hypot(*(curve[:, None] - points).transpose(2, 0, 1)).argmin(axis=0), 0]
        for _ in range(8):
            away, slope = one.at(guess) - points, one.tangent(guess)
            step = (away * slope).sum(axis=1) / np.maximum((slope**2).sum(axis=1), 1e-12)
            low, high = sorted((arcs.start[k], arcs.start[k] + arcs.sweep[k]))
            whole = high - low > 2 * np.pi - 1e-9  # no ends to stop at
            guess = guess - step if whole else np.clip(guess - step, low, high)
        least = np.minimum(least, np.hypot(*(one.at(guess) - points).T))
    return least


@given(st.integers(0, 10**6), st.floats(-180, 180), st.floats(0.15, 0.6))
@settings(max_examples=15)
def test_lines_lie_inside_and_end_on_the_boundary(seed: int, angle: float, distance: float) -> None:
    shape = region(seed, 12)
    lines = hatched(shape, distance, angle).arcs
    start, end = lines.starts(), lines.ends()
    assert np.max(on_boundary(shape.arcs, np.concatenate([start, end])), initial=0) < 1e-7
    long = np.hypot(*(end - start).T) > 0.01
    for share in (0.02, 0.3, 0.5, 0.77, 0.98):
        assert np.all(is_inside(shape, (start + share * (end - start))[long]))


@given(st.integers(0, 10**6), st.floats(-180, 180))
@settings(max_examples=15)
def test_no_line_is_missing(seed: int, angle: float) -> None:
    """Total length times distance is the area, and points on lines are covered exactly if they are inside."""
    shape, distance = region(seed, 12), 0.02
    lines = hatched(shape, distance, angle).arcs
    length = np.hypot(*(lines.ends() - lines.starts()).T)
    assert length.sum() * distance == pytest.approx(area(shape), rel=0.02, abs=0.05)


@pytest.mark.parametrize("angle", [0.0, 30.0, 90.0, -45.0, 360.0])
def test_lines_are_parallel_and_a_distance_apart(angle: float) -> None:
    lines = hatched(SQUARE, 0.5, angle).arcs
    turn = np.radians(angle)
    way = (lines.ends() - lines.starts()) / np.hypot(*(lines.ends() - lines.starts()).T)[:, None]
    assert np.allclose(way, [np.cos(turn), np.sin(turn)], atol=1e-9)
    height = lines.starts() @ [-np.sin(turn), np.cos(turn)] / 0.5 - OFFSET
    assert np.allclose(height, np.round(height)) and np.all(np.diff(np.round(height)) == 1)


def test_a_turned_region_has_the_turned_lines() -> None:
    turn = np.radians(37.0)
    matrix = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    shape = region(7, 15)
    turned = shape._replace(arcs=shape.arcs._replace(
        c=shape.arcs.c @ matrix, u=shape.arcs.u @ matrix, v=shape.arcs.v @ matrix))  # fmt: skip
    one, other = hatched(shape, 0.3, 10.0).arcs, hatched(turned, 0.3, 47.0).arcs
    assert np.allclose(one.starts() @ matrix, other.starts()) and np.allclose(one.ends() @ matrix, other.ends())


def test_lines_through_corners_and_along_tangents_neither_leak_nor_vanish() -> None:
    """A diamond, a disc and a box with corners, tops and sides exactly at the height of a line."""
    distance = 1.0
    y = (3 + OFFSET) * distance
    diamond = [side((-4, y), (0, y - 3)), side((0, y - 3), (4, y)), side((4, y), (0, y + 3)), side((0, y + 3), (-4, y))]
    disc = circle(20.0, y - 2.0, 2.0)  # touches the line from below
    box = rectangle(40.0, y, 46.0, y + 1.5)  # lies along it
    both = paths([[diamond, disc, box]])
    lines = hatched(both, distance, 0.0).arcs
    start, end = lines.starts(), lines.ends()
    assert np.all(start[:, 0] <= end[:, 0])
    for left, right in ((-4.0, 4.0), (18.0, 22.0), (40.0, 46.0)):
        inside = (start[:, 0] >= left - 1e-9) & (end[:, 0] <= right + 1e-9)
        assert inside.any()
    owner = np.digitize(start[:, 0], [10.0, 30.0])
    assert np.array_equal(owner, np.digitize(end[:, 0], [10.0, 30.0]))
    across = (owner == 0) & np.isclose(start[:, 1], y)
    assert np.allclose(end[across] - start[across], [[8.0, 0.0]], atol=1e-6)


def test_nothing_is_hatched_in_nothing() -> None:
    empty = paths([[circle(0.0, 0.0, 0.01)]])
    assert len(hatched(empty, 5.0, 0.0).arcs.c) == 0


def test_darker_tones_are_denser_and_white_has_no_lines() -> None:
    hatch = load_style("hatch").hatch
    levels = tone_levels(np.linspace(0, 100, 401))
    assert np.all(np.diff(levels) >= 0) and set(levels.tolist()) == set(range(LEVELS + 1))
    assert np.array_equal(levels == LEVELS, np.linspace(0, 100, 401) >= WHITE)
    distances = [level_distance(level, hatch.nearest, hatch.farthest) for level in range(LEVELS)]
    assert distances[0] == pytest.approx(hatch.nearest) and distances[-1] == pytest.approx(hatch.farthest)
    ratio = np.array(distances[1:]) / np.array(distances[:-1])
    assert np.allclose(ratio, ratio[0]) and ratio[0] > 1
