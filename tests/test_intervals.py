"""Gaps of intervals on circles, against sampling."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from molviz.geometry import intervals
from molviz.geometry.intervals import TURN, Intervals, above, gaps

interval = st.tuples(st.integers(0, 3), st.floats(-20, 20), st.floats(1e-3, TURN))


def covered(theta: np.ndarray, start: np.ndarray, sweep: np.ndarray) -> np.ndarray:
    return np.mod(theta[:, None] - start, TURN) <= sweep


@given(st.lists(interval, max_size=8))
def test_gaps_are_what_no_interval_covers(rows: list[tuple[int, float, float]]) -> None:
    circle = np.array([row[0] for row in rows], dtype=np.int64)
    start = np.array([row[1] for row in rows], dtype=float)
    sweep = np.array([row[2] for row in rows], dtype=float)
    free = gaps(Intervals(circle, start, sweep), 5)
    theta = np.linspace(0, TURN, 997, endpoint=False) + 1e-4
    for number in range(5):
        hidden = covered(theta, start[circle == number], sweep[circle == number]).any(axis=1)
        seen = covered(theta, free.start[free.circle == number], free.sweep[free.circle == number]).any(axis=1)
        # a sample that lies on an end belongs to both
        ends = np.concatenate([free.start, free.start + free.sweep])[:, None]
        clear = np.abs(np.mod(theta - ends + np.pi, TURN) - np.pi).min(axis=0, initial=1.0) > 1e-9
        assert np.array_equal(seen[clear], ~hidden[clear])


def test_a_gap_through_zero_is_one_gap_and_names_its_neighbours() -> None:
    free = gaps(Intervals(np.array([0, 0]), np.array([1.0, 2.0]), np.array([1.5, 1.0])), 1)
    assert free.start.tolist() == [3.0] and np.isclose(free.sweep[0], TURN - 2.0)
    assert (free.before[0], free.after[0]) == (1, 0)


def test_no_interval_leaves_the_circle_whole() -> None:
    free = gaps(Intervals(np.empty(0, dtype=np.int64), np.empty(0), np.empty(0)), 2)
    assert free.sweep.tolist() == [TURN, TURN] and free.before.tolist() == [-1, -1]


def test_above_solves_the_inequality() -> None:
    a, b, c = np.array([1.0, 0.0, 1.0, 1.0]), np.array([0.0, 2.0, 0.0, 0.0]), np.array([0.0, 1.0, 1.0, -1.5])
    middle, half = above(a, b, c)
    assert np.allclose(half, [np.pi / 2, np.pi / 3, 0.0, np.pi])
    assert np.allclose(middle[:2], [0.0, np.pi / 2])


@given(st.floats(-20, 20))
def test_a_whole_turn_leaves_no_seam(start: float) -> None:
    assert len(gaps(Intervals(np.array([0]), np.array([start]), np.array([TURN])), 1).circle) == 0


def test_circles_in_parts_have_the_same_gaps(monkeypatch: pytest.MonkeyPatch) -> None:
    random = np.random.default_rng(4)
    hidden = Intervals(random.integers(0, 23, 400), random.uniform(-9, 9, 400), random.uniform(0.01, 0.6, 400))
    expected = gaps(hidden, 29)
    monkeypatch.setattr(intervals, "BLOCK_ROWS", 60)
    for one, other in zip(expected, gaps(hidden, 29), strict=True):
        assert np.array_equal(one, other)
