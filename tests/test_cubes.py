"""Queries by cubes against all distances."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz.geometry.cubes import BLOCK_ROWS, BallIndex, cubes_of
from molviz.geometry.grid import Neighbours
from molviz.model.spheres import Spheres
from tests.oracle import random_spheres


def lists(met: Neighbours) -> list[list[int]]:
    return [met.item[first:last].tolist() for first, last in zip(met.start[:-1], met.start[1:], strict=True)]


def by_distance(spheres: Spheres, center: np.ndarray, radius: np.ndarray) -> list[list[int]]:
    gap = np.sum((center[:, None] - spheres.center) ** 2, axis=2)
    return [np.flatnonzero(row).tolist() for row in gap < (radius[:, None] + spheres.radius) ** 2]


@given(st.integers(0, 10_000), st.integers(1, 60), st.floats(0.1, 40), st.floats(1, 20), st.floats(0, 3))
def test_queries_equal_distances(seed: int, count: int, extent: float, spread: float, size: float) -> None:
    spheres = random_spheres(seed, count, extent, spread)
    random = np.random.default_rng(seed)
    center = random.uniform(-spread, extent + spread, (30, 3))
    radius = size * spheres.radius.max() * random.choice([0.0, 0.1, 1.0], 30)
    assert lists(BallIndex(spheres).balls_met(center, radius)) == by_distance(spheres, center, radius)


@settings(max_examples=50)
@given(st.lists(st.tuples(*[st.integers(-3, 3)] * 3, st.integers(1, 3)), min_size=1, max_size=12), st.integers(0, 4),
       st.sampled_from([1e-60, 1e-9, 1.0, 1e9, 2e59]), st.sampled_from([0.0, 1e6, 1e17]))  # fmt: skip
def test_what_only_touches_is_outside_at_any_scale(
    rows: list[tuple[int, ...]], size: int, scale: float, shift: float
) -> None:
    """Whole numbers, for which distances equal sums of radii; moved until several places share one number."""
    table = np.array(rows, dtype=float) * scale
    spheres = Spheres(table[:, :3] + shift * scale, table[:, 3])
    steps = np.arange(-4.0, 5.0) * scale + shift * scale
    center = np.stack(np.meshgrid(steps, steps[::3], steps[::2]), axis=-1).reshape(-1, 3)
    radius = np.full(len(center), size * scale)
    assert lists(BallIndex(spheres).balls_met(center, radius)) == by_distance(spheres, center, radius)


def test_no_queries_have_no_answers() -> None:
    met = BallIndex(random_spheres(0, 5)).balls_met(np.empty((0, 3)), np.empty(0))
    assert (met.start.tolist(), met.item.tolist()) == ([0], [])


def test_answers_of_several_blocks_are_in_order() -> None:
    spheres = random_spheres(1, 30, 4.0)
    center = np.tile(np.random.default_rng(1).uniform(0, 4, (1000, 3)), (BLOCK_ROWS // 1000 + 2, 1))
    radius = np.tile([0.0, 0.5], len(center) // 2)
    met = BallIndex(spheres).balls_met(center, radius)
    for begin in (0, len(center) - 1000):
        part = slice(begin, begin + 1000)
        assert lists(met)[part] == by_distance(spheres, center[part], radius[part])


def test_atoms_very_far_apart_cost_no_memory() -> None:
    center = np.array([[0, 0, 0], [1e8, 0, 0], [1e8, 1, 0], [-1e8, 1e8, 1e8]], dtype=float)
    met = BallIndex(Spheres(center, np.ones(4))).balls_met(center, np.zeros(4))
    assert lists(met) == [[0], [1], [2], [3]]
    assert len(cubes_of(Spheres(center, np.ones(4)), 0.0).ball) <= 4 * 8


@pytest.mark.parametrize(("count", "reach"), [(1000, 0.0), (1000, 1.0), (8000, 0.0)])
def test_a_ball_is_in_eight_cubes_at_most_and_enlarged_ones_in_27(count: int, reach: float) -> None:
    """Theorem 3.1: space linear in n."""
    cubes = cubes_of(random_spheres(2, count, count ** (1 / 3), 1.0), reach)
    assert np.bincount(cubes.ball).max() <= (27 if reach else 8)
    assert (np.diff(cubes.key) > 0).all() and (np.diff(cubes.start) > 0).all()


@pytest.mark.parametrize("edge", [8, 25])
def test_a_cube_holds_few_balls_however_many_there_are(edge: int) -> None:
    """Theorem 2.4 rests on it. Centres at least 0.8 Å apart, as on a shaken lattice of 1.4 Å, in a box of 6.4 Å."""
    grid = np.stack(np.meshgrid(*[np.arange(edge)] * 3), axis=-1).reshape(-1, 3) * 1.4
    center = grid + np.random.default_rng(3).uniform(-0.3, 0.3, grid.shape)
    cubes = cubes_of(Spheres(center, np.full(len(center), 1.6)), 0.0)
    assert np.diff(cubes.start).max() <= (int((6.4 + 0.6) / 1.4) + 1) ** 3
    assert len(cubes.key) <= ((edge * 1.4 + 3.2) / 3.2 + 2) ** 3
