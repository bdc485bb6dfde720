"""Ragged tables against the obvious."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from molviz.geometry.rows import ordered


@given(st.integers(0, 10_000), st.integers(0, 200), st.sampled_from([1.0, 1e-12, 0.0]))
def test_ordered_is_lexsort_down_to_ties(seed: int, count: int, spread: float) -> None:
    random = np.random.default_rng(seed)
    owner = random.integers(0, 20, count)
    value = random.choice([-1.0, 3.0], count) + spread * random.normal(size=count)
    assert ordered(owner, value).tolist() == np.lexsort((value, owner)).tolist()
