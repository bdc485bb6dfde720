"""How far spheres are, for fog and ink."""

import numpy as np
import pytest

from molviz.model.spheres import Spheres
from molviz.picture.looks import SHALLOWEST, depths, distances
from molviz.visibility.view import View
from tests.scenes import map_of


@pytest.mark.parametrize(("deep", "farthest"), [(1e-4, 1e-4 / SHALLOWEST), (SHALLOWEST / 2, 0.5), (40.0, 1.0)])
def test_the_farthest_of_a_flat_scene_is_not_far(deep: float, farthest: float) -> None:
    scene = Spheres(np.array([[0.0, 0.0, 0.0], [5.0, 0.0, -deep], [10.0, 0.0, -deep / 2]]), np.ones(3))
    view = View(np.eye(3), np.zeros(3))
    view_map = map_of(scene, view)
    for nearer_by, depth in zip((0.7, 0.0), depths(view_map, view, np.arange(3)), strict=True):
        assert np.allclose(distances(view_map, view, depth, nearer_by), [0.0, farthest, farthest / 2], atol=1e-12)
