"""The visibility map: its invariants, and the same faces as looking at every point."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz.curves import PlaneArcs
from molviz.geometry.planar_map import Loops, loop_areas, oriented
from molviz.visibility.map import VisibilityMap
from molviz.visibility.painter import Pieces
from molviz.visibility.view import file_axes
from tests.oracle import random_spheres, seen_at, winding
from tests.scenes import map_of, pieces_of, shaken

RING = [(1.4 * np.cos(t), 1.4 * np.sin(t)) for t in np.arange(6) * np.pi / 3]
DEGENERATE = {
    "tangent": ([[0, 0, 0], [2, 0, 0]], [1, 1]),
    "identical": ([[0, 0, 0], [0, 0, 0], [1, 0, 0]], [1, 1, 1]),
    "concentric": ([[0, 0, 0], [0, 0, 0], [1, 0, 0]], [1, 1.5, 1]),
    "on the line of sight": ([[0, 0, z] for z in range(5)], [1] * 5),
    "two by two": ([[x, y, 0] for x in (0, 1) for y in (0, 1)], [0.7] * 4),
    "four through two points": ([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]], [1.2] * 4),
    "lattice": ([[x, y, z] for x in range(3) for y in range(3) for z in range(3)], [0.6] * 27),
    "lattice, touching": ([[x, y, z] for x in range(3) for y in range(3) for z in range(3)], [0.5] * 27),
    "cube through one point": ([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], [3**0.5] * 8),
    "ring face on": ([[x, y, 0] for x, y in RING], [1.7] * 6),
    "ring on edge": ([[x, 0, y] for x, y in RING], [1.7] * 6),
}


def sampled_face(arcs: PlaneArcs, found: Loops, face: int, points: np.ndarray) -> np.ndarray:
    """Winding number of a face's loops about points, arcs drawn with 60 chords each."""
    total = np.zeros(len(points), dtype=int)
    for loop in np.flatnonzero(found.face == face):
        rows = oriented(arcs, found.half_edge[found.start[loop] : found.start[loop + 1]])
        t = rows.start[:, None] + rows.sweep[:, None] * np.arange(60) / 60
        x, y = ((rows.c[:, [k]] + rows.u[:, [k]] * np.cos(t) + rows.v[:, [k]] * np.sin(t)).ravel() for k in (0, 1))
        total += winding(x, y, points)
    return total


def safe_points(seed: int, arcs: PlaneArcs, half: float) -> np.ndarray:
    """Random page points not too near any arc."""
    points = np.random.default_rng(seed).uniform(-half, half, (120, 2))
    t = arcs.start[:, None] + arcs.sweep[:, None] * np.linspace(0, 1, 400)
    x, y = ((arcs.c[:, [k]] + arcs.u[:, [k]] * np.cos(t) + arcs.v[:, [k]] * np.sin(t)).ravel() for k in (0, 1))
    gap = np.hypot(points[:, [0]] - x, points[:, [1]] - y).min(axis=1)
    return points[gap > 0.06]


def euler_defect(found: VisibilityMap) -> int:
    """V − E + L − 2 C, with L boundary loops and C components: nought for a planar map (Euler's formula)."""
    origin, target = found.curve_arcs.origin, found.curve_arcs.target
    parent = {int(vertex): int(vertex) for vertex in np.append(origin, target)}

    def root(vertex: int) -> int:
        while parent[vertex] != vertex:
            vertex = parent[vertex]
        return vertex

    for one, other in zip(origin.tolist(), target.tolist(), strict=True):
        parent[root(one)] = root(other)
    components = len({root(vertex) for vertex in parent})
    return len(parent) - len(origin) + len(found.loops.face) - 2 * components


@given(st.integers(0, 10**6), st.integers(1, 45), st.floats(0.1, 7), st.floats(1, 5))
@settings(max_examples=60)
def test_the_map_shows_what_is_seen(seed: int, count: int, extent: float, spread: float) -> None:
    view = file_axes(random_spheres(seed, count, extent, spread))
    found = map_of(random_spheres(seed, count, extent, spread), view)
    points = safe_points(seed, found.arcs, extent / 2 + spread)
    seen = seen_at(found.spheres, points)
    for face in set(seen.tolist()) - {-1}:
        assert np.array_equal(sampled_face(found.arcs, found.loops, face, points), seen == face)
    assert euler_defect(found) == 0


@pytest.mark.parametrize("name", DEGENERATE)
def test_degenerate_scenes_give_closed_maps(name: str) -> None:
    spheres = shaken(*DEGENERATE[name])
    found = map_of(spheres, file_axes(spheres))
    points = safe_points(1, found.arcs, 4.0)
    seen = seen_at(found.spheres, points)
    for face in set(seen.tolist()) - {-1}:
        assert np.array_equal(sampled_face(found.arcs, found.loops, face, points), seen == face)
    assert euler_defect(found) == 0
    area = loop_areas(found.arcs, found.loops)
    assert abs(area.sum()) < 1e-9 * np.abs(area).sum()


@given(st.integers(0, 10**6), st.integers(1, 40))
@settings(max_examples=25)
def test_a_central_map_is_planar_and_balanced(seed: int, count: int) -> None:
    spheres = random_spheres(seed, count, 5.0, 3.0)
    found = map_of(spheres, file_axes(spheres, distance=25.0))
    assert euler_defect(found) == 0
    area = loop_areas(found.arcs, found.loops)
    assert abs(area.sum()) < 1e-9 * np.abs(area).sum()


@given(st.integers(0, 10**6), st.integers(1, 40), st.floats(0.1, 7), st.floats(1, 5))
@settings(max_examples=40)
def test_painted_pieces_show_what_is_seen(seed: int, count: int, extent: float, spread: float) -> None:
    spheres = random_spheres(seed, count, extent, spread)
    view = file_axes(spheres)
    found: Pieces = pieces_of(spheres, view)
    points = safe_points(seed, found.arcs, extent / 2 + spread)
    painted = np.full(len(points), -1)
    for sphere in found.order.tolist():
        painted[sampled_face(found.arcs, found.loops, sphere, points) > 0] = sphere
    assert np.array_equal(painted, seen_at(view.of(spheres), points))


@pytest.mark.parametrize("distance", [20.0, 2e3, 2e4])
@pytest.mark.parametrize("name", DEGENERATE)
def test_a_far_eye_sees_degenerate_scenes_too(name: str, distance: float) -> None:
    """Found with C60 from 2000 Å: squares of the distance drowned what displacing had separated."""
    spheres = shaken(*DEGENERATE[name])
    assert euler_defect(map_of(spheres, file_axes(spheres, distance))) == 0
