"""The grid index against all pairs."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from molviz.geometry.grid import intersecting_pairs, neighbours
from molviz.model.spheres import Spheres
from tests.oracle import all_pairs, random_spheres


@given(st.integers(0, 10_000), st.integers(1, 60), st.floats(0.1, 40), st.floats(1, 20))
def test_pairs_equal_all_pairs(seed: int, count: int, extent: float, spread: float) -> None:
    spheres = random_spheres(seed, count, extent, spread)
    first, second = intersecting_pairs(spheres)
    assert len(first) == len(all_pairs(spheres))
    assert set(zip(first.tolist(), second.tolist(), strict=True)) == all_pairs(spheres)


def test_atoms_very_far_apart_cost_no_memory() -> None:
    center = np.array([[0, 0, 0], [1e8, 0, 0], [1e8, 1, 0], [-1e8, 1e8, 1e8]], dtype=float)
    first, second = intersecting_pairs(Spheres(center, np.ones(4)))
    assert (first.tolist(), second.tolist()) == ([1], [2])


def test_neighbours_are_symmetric() -> None:
    near = neighbours(random_spheres(3, 50))
    owner = np.repeat(np.arange(50), np.diff(near.start))
    pairs = set(zip(owner.tolist(), near.item.tolist(), strict=True))
    assert pairs == {(j, i) for i, j in pairs}
