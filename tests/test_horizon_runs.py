"""Visible horizons as runs: what lies behind them, how deep, and under what they come out, by looking at points."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz.model.spheres import Spheres
from molviz.visibility.curves import HORIZON
from molviz.visibility.eye import occluders_of
from molviz.visibility.horizon_runs import NODE, SPACING, HorizonRuns, horizon_runs
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
    along = 1e-3 * tangent / np.hypot(*tangent.T)[:, None]
    seen, *others = (
        np.where(near.max(axis=1) > -np.inf, near.argmax(axis=1), BACKGROUND)
        for near in (
            surfaces(view_map, view, page + 1e-5 * outwards + shift) for shift in (0, along, -along, 1e-3 * outwards)
        )
    )
    sure = ~ends & np.all(np.stack(others) == seen, axis=0)
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
    """Or out of a ball, where no other horizon is."""
    view_map, view, runs = runs_of(seed, 30, distance)
    near, vertices = occluders_of(view_map.spheres, view).nearness(), runs.vertices
    for ends, point in zip(runs.ends, (runs.arcs.starts(), runs.arcs.ends()), strict=True):
        above = vertices.partner[ends]
        rows = np.flatnonzero((above >= 0) & ~runs.closed)
        run, place = vertices.run[above[rows]], vertices.place[above[rows]]
        host = runs.arcs.take(run)
        there = host.at(host.start + host.sweep * place / runs.last()[run])
        assert np.allclose(there, point[rows], atol=1e-6)
        assert np.all(near[runs.sphere[run]] > near[runs.sphere[rows]])


@given(st.integers(0, 10**6), st.sampled_from(DISTANCES))
@settings(max_examples=20)
def test_vertices_lie_on_their_runs_and_near_ones_are_one_node(seed: int, distance: float | None) -> None:
    view_map, _, runs = runs_of(seed, 30, distance)
    row = np.flatnonzero(runs.run_of_arc >= 0)
    assert np.array_equal(row, np.flatnonzero(~view_map.is_crease()))
    run = runs.run_of_arc[row]
    arcs = runs.arcs.take(run)
    for place, points in zip(runs.place_of_arc[:, row], (view_map.arcs.starts(), view_map.arcs.ends()), strict=True):
        assert np.allclose(arcs.at(arcs.start + arcs.sweep * place / runs.last()[run]), points[row], atol=1e-6)
    vertices = runs.vertices
    assert np.all(np.diff(vertices.vertex) >= 0) and np.all(vertices.run[runs.ends] == np.arange(len(runs.sphere)))
    order = np.lexsort((vertices.place, vertices.run))
    one, other = order[:-1], order[1:]
    step = (runs.length() / runs.last())[vertices.run[one]]
    close = (vertices.run[one] == vertices.run[other]) & ((vertices.place[other] - vertices.place[one]) * step < NODE)
    assert np.all(vertices.node[one[close]] == vertices.node[other[close]])
    same = np.diff(vertices.vertex) == 0
    assert np.all(np.diff(vertices.node)[same] == 0)


def test_a_ball_before_a_floor() -> None:
    spheres = Spheres(np.array([[0.0, 0.0, 0.0], [0.0, 0.0, -1003.0]]), np.array([1.0, 1000.0]))
    view = View(np.eye(3), np.zeros(3))
    runs = horizon_runs(map_of(spheres, view), view)
    own = runs.owner() == np.flatnonzero(runs.sphere == 0)[0]
    assert runs.closed.all() and np.all(runs.behind[own] == 1) and np.all(runs.behind[~own] == BACKGROUND)
    assert np.allclose(runs.jump[own], 3.0 + 1000 - np.sqrt(1000.0**2 - 1)) and np.all(np.isinf(runs.jump[~own]))
