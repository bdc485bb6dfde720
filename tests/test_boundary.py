"""The union boundary against sampling and counting."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz.geometry.boundary import Boundary, union_boundary
from molviz.geometry.intervals import TURN
from molviz.model.spheres import Spheres
from tests.oracle import random_spheres


def points_on(boundary: Boundary, fraction: float) -> np.ndarray:
    arcs = boundary.arcs
    return boundary.circles.at(arcs.circle, arcs.start + fraction * arcs.sweep)


def depth(boundary: Boundary, points: np.ndarray) -> np.ndarray:
    """Distance of each point outside each ball (negative inside)."""
    spheres = boundary.spheres
    return np.linalg.norm(points[:, None] - spheres.center, axis=2) - spheres.radius


@given(st.integers(0, 10_000), st.integers(2, 40), st.floats(0.5, 6), st.floats(1, 8))
@settings(max_examples=60)
def test_free_arcs_lie_on_two_spheres_outside_all_balls(seed: int, count: int, extent: float, spread: float) -> None:
    boundary = union_boundary(random_spheres(seed, count, extent, spread))
    for fraction in (0.0, 0.3, 1.0):
        outside = depth(boundary, points_on(boundary, fraction))
        assert outside.size == 0 or outside.min() > -1e-7
        rows = np.arange(len(outside))
        for sphere in (boundary.circles.first, boundary.circles.second):
            assert np.allclose(outside[rows, sphere[boundary.arcs.circle]], 0, atol=1e-9)


@given(st.integers(0, 10_000), st.integers(2, 25))
@settings(max_examples=40)
def test_free_length_equals_sampling(seed: int, count: int) -> None:
    spheres = random_spheres(seed, count, 3.0)
    boundary = union_boundary(spheres)
    circles, arcs = boundary.circles, boundary.arcs
    theta = (np.arange(2000) + 0.5) * TURN / 2000
    for circle in range(min(len(circles.first), 5)):
        points = circles.at(np.full(2000, circle), theta)
        others = np.setdiff1d(np.arange(count), [circles.first[circle], circles.second[circle]])
        gap = np.linalg.norm(points[:, None] - spheres.center[others], axis=2) - spheres.radius[others]
        free = np.mean(np.all(gap >= 0, axis=1)) * TURN
        assert abs(free - arcs.sweep[arcs.circle == circle].sum()) < 0.02


@given(st.integers(0, 10_000), st.integers(3, 40))
@settings(max_examples=40)
def test_three_arcs_end_in_every_triple_point(seed: int, count: int) -> None:
    """In general position each vertex of the union is the end of exactly three arcs."""
    boundary = union_boundary(random_spheres(seed, count, 5.0))
    arcs, circles = boundary.arcs, boundary.circles
    cut = arcs.before >= 0
    ends = np.concatenate([points_on(boundary, 0.0)[cut], points_on(boundary, 1.0)[cut]])
    names = np.concatenate([
        np.stack([circles.first[arcs.circle], circles.second[arcs.circle], ball], axis=1)[cut]
        for ball in (arcs.before, arcs.after)
    ])  # fmt: skip
    keys = np.column_stack([np.sort(names, axis=1), np.round(ends, 5)])
    _, times = np.unique(keys, axis=0, return_counts=True)
    assert np.all(times == 3)


@pytest.mark.parametrize(
    ("center", "radius"),
    [([[0, 0, 0], [0.2, 0, 0]], [2, 1]), ([[0, 0, 0], [0, 0, 0]], [1, 1]), ([[0, 0, 0], [2, 0, 0]], [1, 1])],
    ids=["nested", "identical", "tangent"],
)
def test_spheres_without_a_common_circle_have_no_arcs(center: list[list[float]], radius: list[float]) -> None:
    boundary = union_boundary(Spheres(np.array(center, dtype=float), np.array(radius, dtype=float)))
    assert len(boundary.arcs.circle) == 0


def test_a_single_sphere_has_no_arcs() -> None:
    assert len(union_boundary(Spheres(np.zeros((1, 3)), np.ones(1))).circles.first) == 0
