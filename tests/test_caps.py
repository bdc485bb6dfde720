"""What the pre-tests in single precision let through: all free arcs, whatever is packed how densely."""

from collections import defaultdict

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz.geometry import boundary as boundary_module
from molviz.geometry.boundary import union_boundary
from tests.measure_oracle import all_free_arcs
from tests.oracle import random_spheres


@given(st.integers(0, 10_000), st.integers(2, 30), st.floats(1.0, 5.0), st.floats(1, 4))
@settings(max_examples=40)
def test_free_arcs_are_those_of_testing_every_piece(seed: int, count: int, extent: float, spread: float) -> None:
    spheres = random_spheres(seed, count, extent, spread)
    boundary = union_boundary(spheres)
    expected: dict[tuple[int, int], float] = defaultdict(float)
    for arc in all_free_arcs(spheres):
        if arc.sphere < arc.ball:
            expected[arc.sphere, arc.ball] += arc.sweep
    sweep = np.bincount(boundary.arcs.circle, boundary.arcs.sweep, len(boundary.circles.first))
    pairs = zip(boundary.circles.first.tolist(), boundary.circles.second.tolist(), strict=True)
    found = dict(zip(pairs, sweep.tolist(), strict=True))
    for pair in {*expected, *found}:
        assert abs(expected[pair] - found.get(pair, 0.0)) < 1e-9


def test_rims_taken_in_turns_give_the_same_arcs(monkeypatch: pytest.MonkeyPatch) -> None:
    spheres = random_spheres(8, 60, 5.0, 3.0)
    expected = union_boundary(spheres)
    monkeypatch.setattr(boundary_module, "BLOCK_ENTRIES", 100)
    found = union_boundary(spheres)
    for one, other in zip(expected.arcs + expected.circles, found.arcs + found.circles, strict=True):
        assert np.array_equal(one, other)
