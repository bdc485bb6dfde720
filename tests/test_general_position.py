"""Perturbed copies: without duplicates, and reproducible sphere by sphere."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from molviz.model.spheres import Spheres
from tests.scenes import general_position

SMALL = st.tuples(*[st.integers(-1, 1)] * 3, st.integers(1, 2))


@given(st.lists(SMALL, max_size=40))
def test_the_first_of_equal_spheres_stays(rows: list[tuple[int, ...]]) -> None:
    table = np.array(rows, dtype=float).reshape(-1, 4)
    _, found = general_position(Spheres(table[:, :3], table[:, 3]))
    assert found.tolist() == [k for k, row in enumerate(rows) if row not in rows[:k]]


@given(st.lists(SMALL, min_size=1, max_size=20))
def test_a_sphere_is_displaced_alike_whatever_comes_after_it(rows: list[tuple[int, ...]]) -> None:
    table = np.array(rows, dtype=float)
    whole, first = general_position(Spheres(table[:, :3], table[:, 3]))
    part, same = general_position(Spheres(table[:-1, :3], table[:-1, 3]))
    assert first[: len(same)].tolist() == same.tolist()
    assert np.array_equal(whole.center[: len(same)], part.center)
