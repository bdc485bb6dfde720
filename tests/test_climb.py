"""The first ball straight above a point against all balls."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz.geometry.climb import first_above
from molviz.geometry.cubes import BallIndex
from molviz.model.spheres import Spheres
from tests.oracle import random_spheres


def by_all(spheres: Spheres, point: np.ndarray) -> np.ndarray:
    """The least height (m,) of all entries at or above each point, ∞ for none."""
    deep = spheres.radius**2 - np.sum((point[:, None, :2] - spheres.center[:, :2]) ** 2, axis=2)
    entry = spheres.center[:, 2] - np.sqrt(np.maximum(deep, 0))
    return np.where((deep > 0) & (entry >= point[:, 2:]), entry, np.inf).min(axis=1)


@given(st.integers(0, 10_000), st.integers(1, 60), st.floats(0.1, 60), st.floats(1, 20))
def test_the_first_ball_is_the_lowest_of_all(seed: int, count: int, extent: float, spread: float) -> None:
    spheres = random_spheres(seed, count, extent, spread)
    point = np.random.default_rng(seed).uniform(-spread, extent + spread, (60, 3))
    point[::3, 2] -= 3 * extent
    ball, height = first_above(BallIndex(spheres), point)
    assert np.array_equal(height, by_all(spheres, point)) and np.array_equal(ball >= 0, height < np.inf)
    met = ball >= 0
    aside = np.sum((point[met, :2] - spheres.center[ball[met], :2]) ** 2, axis=1)
    assert np.allclose(aside + (height[met] - spheres.center[ball[met], 2]) ** 2, spheres.radius[ball[met]] ** 2)


@settings(max_examples=50)
@given(st.lists(st.tuples(*[st.integers(-3, 3)] * 2, st.integers(-90, 90), st.integers(1, 3)), min_size=1, max_size=9),
       st.sampled_from([1e-60, 1.0, 2e58]), st.sampled_from([0.0, 1e6, 1e17]))  # fmt: skip
def test_points_on_spheres_and_on_the_faces_of_cubes(
    rows: list[tuple[int, ...]], scale: float, shift: float
) -> None:
    table = np.array(rows, dtype=float) * scale
    spheres = Spheres(table[:, :3] + shift * scale, table[:, 3])
    steps = np.arange(-4.0, 5.0)
    point = np.stack(np.meshgrid(steps, steps, [-100, -7, -1, 0, 2, 50, 100]), axis=-1).reshape(-1, 3)
    point = (point + shift) * scale
    assert np.array_equal(first_above(BallIndex(spheres), point)[1], by_all(spheres, point))


@pytest.mark.parametrize("gap", [3.0, 1e9])
def test_a_tall_column_is_climbed_in_few_turns(gap: float) -> None:
    """Half a million balls above each other that leave the axis free, and one at the top that does not."""
    height = gap * np.arange(100_000)
    around = [(np.cos(turn) * 1.5, np.sin(turn) * 1.5) for turn in range(5)]
    center = np.concatenate([np.column_stack([np.full_like(height, x), np.full_like(height, y), height])
                             for x, y in around] + [[[0, 0, height[-1] + gap]]])  # fmt: skip
    ball, top = first_above(BallIndex(Spheres(center, np.ones(len(center)))), np.array([[0.0, 0, -5], [0, 0, 1e15]]))
    assert ball.tolist() == [len(center) - 1, -1] and top.tolist() == [height[-1] + gap - 1, np.inf]
