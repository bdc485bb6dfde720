"""Many balls slab by slab: the same numbers as of all at once."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz.geometry import slabs as slabs_module
from molviz.geometry.components import components
from molviz.geometry.grid import intersecting_pairs, neighbours
from molviz.geometry.measure import measure_spheres
from molviz.geometry.slabs import slabs
from molviz.model.spheres import Spheres
from molviz.pipeline.info import closest_ratio, touching
from tests.test_measure import varied_spheres


@given(st.integers(0, 10**6), st.integers(0, 40), st.integers(1, 9))
@settings(max_examples=40)
def test_slabs_measure_the_same_to_the_last_bit(seed: int, doubled: int, slab: int) -> None:
    spheres = varied_spheres(seed)
    again = np.random.default_rng(seed).integers(0, len(spheres.radius), doubled)
    spheres = spheres.take(np.append(np.arange(len(spheres.radius)), again))
    whole = measure_spheres(spheres)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(slabs_module, "SLAB_BALLS", slab)
        parts = measure_spheres(spheres)
    for one, other in zip(whole, parts, strict=True):
        assert np.array_equal(one, other)


@given(st.integers(0, 10**6), st.integers(1, 60), st.integers(1, 9))
@settings(max_examples=60)
def test_slabs_tell_the_same_of_neighbours(seed: int, count: int, slab: int) -> None:
    rng = np.random.default_rng(seed)
    spheres = Spheres(rng.uniform(0, rng.uniform(2, 12), (count, 3)), rng.uniform(0.2, 1.5, count))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(slabs_module, "SLAB_BALLS", slab)
        many, parts = touching(spheres)
        ratio = closest_ratio(spheres)
        owned = np.concatenate([rows[own] for rows, own in slabs(spheres)])
    assert np.array_equal(np.sort(owned), np.arange(count))
    assert np.array_equal(many, np.diff(neighbours(spheres).start))
    assert parts == components(*intersecting_pairs(spheres), count)
    gap = np.linalg.norm(spheres.center[:, None] - spheres.center, axis=2) + np.diag(np.full(count, np.inf))
    expected = np.min(gap / np.maximum(spheres.radius[:, None], spheres.radius))
    assert ratio == (None if count == 1 else pytest.approx(expected, rel=1e-12))
