"""Where the regions of a map are, and how large."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from molviz.model.spheres import Spheres
from molviz.picture.regions import face_areas, point_on
from molviz.visibility.overlay import seen_spheres
from molviz.visibility.view import file_axes
from tests.oracle import random_spheres
from tests.scenes import map_of


@given(st.integers(0, 10**6), st.integers(1, 40))
def test_a_sphere_is_seen_at_its_point(seed: int, count: int) -> None:
    scene = random_spheres(seed, count, 7.0)
    view_map = map_of(scene, file_axes(scene, None))
    spheres = view_map.spheres
    area = face_areas(view_map)
    for sphere in seen_spheres(view_map).tolist():
        if area[sphere] < 1e-6:
            assert np.isfinite(point_on(view_map, sphere)).all()
            continue
        beside = spheres.center[:, :2] - point_on(view_map, sphere)
        square = spheres.radius**2 - np.sum(beside**2, axis=1)
        height = np.where(square > 0, spheres.center[:, 2] + np.sqrt(np.maximum(square, 0)), -np.inf)
        assert height[sphere] >= height.max() - 1e-6


def test_a_whole_ball_is_seen_near_its_middle_with_its_whole_disc() -> None:
    scene = Spheres(np.array([[3.0, 1.0, 0.0]]), np.array([2.0]))
    view_map = map_of(scene, file_axes(scene, None))
    assert np.hypot(*(point_on(view_map, 0) - view_map.spheres.center[0, :2])) < 0.5
    assert face_areas(view_map) == pytest.approx([4 * np.pi])
