"""The grid index against all pairs."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from molviz.geometry.grid import balls_met, grid_index, intersecting_pairs, neighbours
from molviz.model.spheres import Spheres
from tests.oracle import all_pairs, random_spheres


@given(st.integers(0, 10_000), st.integers(1, 60), st.floats(0.1, 40), st.floats(1, 20))
def test_pairs_equal_all_pairs(seed: int, count: int, extent: float, spread: float) -> None:
    spheres = random_spheres(seed, count, extent, spread)
    first, second = intersecting_pairs(spheres)
    assert len(first) == len(all_pairs(spheres))
    assert set(zip(first.tolist(), second.tolist(), strict=True)) == all_pairs(spheres)


@given(st.integers(0, 10_000), st.floats(0, 1))
def test_queries_equal_distances(seed: int, size: float) -> None:
    spheres = random_spheres(seed, 40, 8.0)
    random = np.random.default_rng(seed)
    center, radius = random.uniform(-3, 11, (25, 3)), np.full(25, size * spheres.radius.max())
    met = balls_met(grid_index(spheres), center, radius)
    gap = np.linalg.norm(center[:, None] - spheres.center, axis=2)
    for query in range(25):
        expected = np.flatnonzero(gap[query] < radius[query] + spheres.radius)
        assert met.item[met.start[query] : met.start[query + 1]].tolist() == expected.tolist()


def test_atoms_very_far_apart_cost_no_memory() -> None:
    center = np.array([[0, 0, 0], [1e8, 0, 0], [1e8, 1, 0], [-1e8, 1e8, 1e8]], dtype=float)
    first, second = intersecting_pairs(Spheres(center, np.ones(4)))
    assert (first.tolist(), second.tolist()) == ([1], [2])


def test_a_query_larger_than_the_spheres_is_refused() -> None:
    with pytest.raises(ValueError, match="larger"):
        balls_met(grid_index(Spheres(np.zeros((1, 3)), np.ones(1))), np.zeros((1, 3)), np.full(1, 1.5))


def test_neighbours_are_symmetric() -> None:
    near = neighbours(random_spheres(3, 50))
    owner = np.repeat(np.arange(50), np.diff(near.start))
    pairs = set(zip(owner.tolist(), near.item.tolist(), strict=True))
    assert pairs == {(j, i) for i, j in pairs}
