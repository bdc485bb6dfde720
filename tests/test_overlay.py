"""Copies laid over a map: seen exactly where the definition says, told by looking at points."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from molviz.curves import PlaneArcs
from molviz.geometry.planar_map import Loops, loops, merged_faces, oriented
from molviz.model.spheres import Spheres
from molviz.visibility.eye import eye_coordinates, occluders_of
from molviz.visibility.overlay import drop_at_edge, on_ledges, seen_of_copies, shaded_sides, skirts
from molviz.visibility.view import View, file_axes
from tests.oracle import random_spheres
from tests.scenes import map_of
from tests.test_map import sampled_face

CLEAR = 0.02  # ångström from every arc: points nearer are not asked


def points_off(arcs: PlaneArcs, spheres: Spheres, seed: int, count: int = 300) -> np.ndarray:
    """Random page points not too near any arc."""
    low, high = (corner[:2] for corner in spheres.box())
    points = np.random.default_rng(seed).uniform(low, high, (count, 2))
    t = arcs.start[:, None] + arcs.sweep[:, None] * np.linspace(0, 1, 1000)  # at most CLEAR apart
    x, y = ((arcs.c[:, [k]] + arcs.u[:, [k]] * np.cos(t) + arcs.v[:, [k]] * np.sin(t)).ravel() for k in (0, 1))
    gap = np.min(np.hypot(points[:, [0]] - x, points[:, [1]] - y), axis=1)
    return points[gap > CLEAR]


def nearest_surfaces(spheres: Spheres, view: View, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The nearest surface at each point and whose it is, by looking at all of them."""
    occluders = occluders_of(spheres, view)
    count = len(spheres.radius)
    surface = np.stack([occluders.surface(np.full(len(points), k), points) for k in range(count)], axis=1)
    return surface.max(axis=1), surface.argmax(axis=1)


def inside(arcs: PlaneArcs, boundary: Loops, points: np.ndarray) -> np.ndarray:
    return sampled_face(arcs, boundary, 1, points) > 0


@given(st.integers(0, 10**6), st.floats(0.3, 3.0), st.floats(0.2, 3.0), st.sampled_from([None, 30.0]))
@example(834, 1.0, 0.25, None)  # a point between two samples of an arc, 0.001 from it
@settings(max_examples=25)
def test_a_skirt_is_seen_where_the_surface_lies_below_it(
    seed: int, reach: float, deeper: float, distance: float | None
) -> None:
    scene = random_spheres(seed, 25, 7.0)
    view = file_axes(scene, distance)
    spheres = eye_coordinates(scene, view)
    low = float(np.sqrt(2 * 2.0 * reach + reach**2)) + deeper
    copies = skirts(spheres, np.arange(0, 25, 2), reach, low, view)
    view_map = seen_of_copies(spheres, copies, view)
    points = points_off(view_map.arcs, spheres, seed)
    own, _ = nearest_surfaces(spheres, view, points)
    skirt, _ = nearest_surfaces(copies, view, points)
    assert np.array_equal(inside(view_map.arcs, view_map.loops, points), skirt > own)


@given(st.integers(0, 10**6), st.floats(-0.9, 0.9))
@settings(max_examples=25)
def test_a_shaded_side_is_where_light_falls_less(seed: int, cosine: float) -> None:
    scene = random_spheres(seed, 15, 6.0)
    view = file_axes(scene)
    spheres = eye_coordinates(scene, view)
    light = np.array([-0.45, 0.6, 0.66]) / np.linalg.norm([-0.45, 0.6, 0.66])
    view_map = seen_of_copies(spheres, shaded_sides(spheres, light, cosine), view)
    points = points_off(view_map.arcs, spheres, seed)
    height, own = nearest_surfaces(spheres, view, points)
    seen = height > -np.inf
    points, height, own = points[seen], height[seen], own[seen]
    normal = (np.column_stack([points, height]) - spheres.center[own]) / spheres.radius[own][:, None]
    assert np.array_equal(inside(view_map.arcs, view_map.loops, points), normal @ light < cosine)


def test_the_rim_of_a_skirt_lies_a_drop_below_the_horizon() -> None:
    """A ball of 1 above a floor: the skirt shows on the floor exactly if it lies deeper than the drop at the rim."""
    for depth, shows in ((2.9, False), (3.1, True)):
        low = 3.0 + np.sqrt(2 * 1.0 * 0.5 + 0.25)
        assert np.isclose(drop_at_edge(np.array([1.0]), 0.5, low), 3.0)
        floor = Spheres(np.array([[0.0, 0.0, -1000.0 - depth]]), np.array([1000.0]))
        spheres = Spheres(np.concatenate([[[0.0, 0.0, 0.0]], floor.center]), np.array([1.0, 1000.0]))
        view = View(np.eye(3), np.zeros(3))
        view_map = seen_of_copies(spheres, skirts(spheres, np.array([0]), 0.5, low, view), view)
        assert inside(view_map.arcs, view_map.loops, np.array([[1.01, 0.0]]))[0] == shows


def test_a_lone_tip_is_no_ledge() -> None:
    page = np.array([[0.0, 0.0], *[(10 + 0.3 * k, 0.0) for k in range(9)]])
    wanted = np.array([0, 5])
    assert on_ledges(page, np.zeros(10), wanted, 2.0, np.full(2, -1.0), 4).tolist() == [False, True]
    assert on_ledges(page, np.zeros(10), wanted, 2.0, np.full(2, 1.0), 4).tolist() == [False, False]


@given(st.integers(0, 10**6), st.integers(2, 40), st.integers(1, 5))
@settings(max_examples=40)
def test_merged_faces_are_the_unions_of_their_parts(seed: int, count: int, labels: int) -> None:
    spheres = random_spheres(seed, count, 5.0)
    view_map = map_of(spheres, file_axes(spheres))
    label = np.append(np.random.default_rng(seed).integers(0, labels, count), -1)
    merged = loops(merged_faces(view_map.edges, label[view_map.edges.face]))
    areas = dict.fromkeys(range(-1, labels), 0.0)
    for boundary, of in ((view_map.loops, label), (merged, np.append(np.arange(labels), -1))):
        area = np.add.reduceat(
            oriented(view_map.arcs, boundary.half_edge).signed_area(), boundary.start[:-1]
        )
        for face, value in zip(of[boundary.face].tolist(), area.tolist(), strict=True):
            areas[face] += value if boundary is merged else -value
    assert np.allclose(list(areas.values()), 0.0, atol=1e-9)
    both = merged_faces(view_map.edges, label[view_map.edges.face])
    drawn = np.flatnonzero(both.next >= 0)
    assert np.array_equal(both.origin[both.next[drawn]], both.origin[drawn ^ 1])
    assert np.all(both.face[drawn] != both.face[drawn ^ 1])


def test_all_of_one_label_leaves_the_outer_loops_alone() -> None:
    spheres = random_spheres(3, 30, 4.0)
    view_map = map_of(spheres, file_axes(spheres))
    merged = loops(merged_faces(view_map.edges, np.where(view_map.edges.face < 0, -1, 0)))
    outer = view_map.loops.face == -1
    assert np.sum(merged.face == -1) == outer.sum()


@pytest.mark.parametrize("distance", [None, 40.0])
def test_nothing_is_seen_of_copies_behind(distance: float | None) -> None:
    scene = random_spheres(5, 20, 4.0)
    view = file_axes(scene, distance)
    spheres = eye_coordinates(scene, view)
    view_map = seen_of_copies(spheres, skirts(spheres, np.arange(20), -0.1, 5.0, view), view)
    assert not np.any(view_map.loops.face == 1)
