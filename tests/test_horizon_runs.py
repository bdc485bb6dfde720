"""Visible horizons as runs: what lies behind them, how deep, and under what they come out, by looking at points."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz.model.spheres import Spheres
from molviz.visibility.curves import HORIZON
from molviz.visibility.eye import occluders_of, projection_of
from molviz.visibility.horizon_runs import SPACING, HorizonRuns, horizon_runs
from molviz.visibility.map import BACKGROUND, VisibilityMap
from molviz.visibility.view import View, file_axes
from tests.oracle import random_spheres
from tests.scenes import map_of

DISTANCES = [None, 40.0]


def runs_of(seed: int, count: int, distance: float | None) -> tuple[VisibilityMap, View, HorizonRuns]:
    scene = random_spheres(seed, count, 8.0)
    view = file_axes(scene, distance)
    view_map = map_of(scene, view)
    return view_map, view, horizon_runs(view_map, view)


def surfaces(view_map: VisibilityMap, view: View, page: np.ndarray) -> np.ndarray:
    """How near each sphere's surface is at each page point (points, spheres)."""
    seen, count = occluders_of(view_map.spheres, view), len(view_map.spheres.radius)
    return np.stack([seen.surface(np.full(len(page), k), page) for k in range(count)], axis=1)


@given(st.integers(0, 10**6), st.integers(1, 30), st.sampled_from(DISTANCES))
@settings(max_examples=25)
def test_runs_are_all_of_the_visible_horizons(seed: int, count: int, distance: float | None) -> None:
    view_map, _, runs = runs_of(seed, count, distance)
    row = np.flatnonzero(view_map.curves.kind[view_map.curve_arcs.curve] == HORIZON)
    assert runs.arcs.sweep.sum() == pytest.approx(view_map.arcs.sweep[row].sum())
    assert np.all(runs.arcs.sweep > 0) and np.array_equal(runs.closed, np.isclose(runs.arcs.sweep, 2 * np.pi))
    owner, count = runs.owner(), np.diff(runs.start)
    assert np.allclose(runs.t[runs.start[:-1]], runs.arcs.start) and np.allclose(
        runs.t[runs.start[1:] - 1], runs.arcs.stop()
    )
    step = np.diff(runs.t)[owner[1:] == owner[:-1]]
    assert np.allclose(step, np.repeat(runs.arcs.sweep / (count - 1), count - 1))
    assert np.all(runs.length() / (count - 1) <= SPACING + 1e-9)


@given(st.integers(0, 10**6), st.sampled_from(DISTANCES))
@settings(max_examples=20)
def test_what_is_behind_is_what_is_seen_just_outside(seed: int, distance: float | None) -> None:
    view_map, view, runs = runs_of(seed, 25, distance)
    owner = runs.owner()
    ends = np.isin(np.arange(len(owner)), np.append(runs.start[:-1], runs.start[1:] - 1))
    arcs = runs.arcs.take(owner)
    tangent = arcs.tangent(runs.t)
    outwards = np.column_stack([tangent[:, 1], -tangent[:, 0]]) / np.hypot(*tangent.T)[:, None]
    page = arcs.at(runs.t)
    near, far = (surfaces(view_map, view, page + gap * outwards) for gap in (1e-5, 1e-3))
    sure = (
        ~ends
        & (near.argmax(axis=1) == far.argmax(axis=1))
        & ((near.max(axis=1) > -np.inf) == (far.max(axis=1) > -np.inf))
    )
    seen = np.where(near.max(axis=1) > -np.inf, near.argmax(axis=1), BACKGROUND)
    assert sure.mean() > 0.8 or len(owner) < 50
    assert np.array_equal(runs.behind[sure], seen[sure])
    rim = occluders_of(view_map.spheres, view).nearness()[runs.sphere[owner]]
    depth = np.where(
        runs.behind == BACKGROUND, np.inf, rim - surfaces(view_map, view, page)[np.arange(len(page)), runs.behind]
    )
    assert np.allclose(runs.jump[sure], depth[sure], atol=1e-9) and np.all(runs.jump >= 0)
    assert not np.isnan(runs.jump).any()


@given(st.integers(0, 10**6), st.sampled_from(DISTANCES))
@settings(max_examples=20)
def test_runs_come_out_under_the_horizon_of_a_nearer_sphere(seed: int, distance: float | None) -> None:
    view_map, view, runs = runs_of(seed, 30, distance)
    projection = projection_of(view)
    for host, point in ((runs.before, runs.arcs.starts()), (runs.after, runs.arcs.ends())):
        rows = np.flatnonzero((host >= 0) & ~runs.closed)
        assert np.all(host[rows] != runs.sphere[rows])
        near = occluders_of(view_map.spheres, view).nearness()
        rows = rows[near[host[rows]] > near[runs.sphere[rows]]]  # the others enter the ball of a farther one
        images = view_map.horizons().take(host[rows])
        for row, image in zip(rows.tolist(), range(len(rows)), strict=True):
            t = np.linspace(0, 2 * np.pi, 4001)
            circle = images.take(np.full(len(t), image)).at(np.arange(len(t)), t)
            gap = np.hypot(*(projection.page_points(circle) - point[row]).T).min()
            assert gap < 2e-3


def test_a_ball_before_a_floor() -> None:
    spheres = Spheres(np.array([[0.0, 0.0, 0.0], [0.0, 0.0, -1003.0]]), np.array([1.0, 1000.0]))
    view = View(np.eye(3), np.zeros(3))
    runs = horizon_runs(map_of(spheres, view), view)
    own = runs.owner() == np.flatnonzero(runs.sphere == 0)[0]
    assert runs.closed.all() and np.all(runs.behind[own] == 1) and np.all(runs.behind[~own] == BACKGROUND)
    assert np.allclose(runs.jump[own], 3.0 + 1000 - np.sqrt(1000.0**2 - 1)) and np.all(np.isinf(runs.jump[~own]))
