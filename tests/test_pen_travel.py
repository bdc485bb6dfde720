"""The order of strokes: complete, greedy, and shorter than the order given."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from molviz.write.pen_travel import drawing_order

point = st.tuples(st.integers(-50, 50), st.integers(-50, 50))


@given(st.lists(st.tuples(point, point), min_size=1, max_size=25))
def test_every_step_goes_to_a_nearest_end(strokes: list[tuple[tuple[int, int], tuple[int, int]]]) -> None:
    ends = np.array(strokes, dtype=float).reshape(-1, 2, 2)
    left, pen = set(range(len(strokes))), (0.0, 0.0)
    for stroke, reverse in drawing_order(ends[:, 0], ends[:, 1]):
        start, stop = (tuple(ends[stroke, side]) for side in ((1, 0) if reverse else (0, 1)))
        assert math.dist(pen, start) == min(math.dist(pen, tuple(end)) for k in left for end in ends[k])
        left.remove(stroke)
        pen = stop
    assert not left


def test_travel_is_short() -> None:
    """A greedy tour of n random points in a square of side 1 is about 0.9 √n long; a random one 0.52 n."""
    points = np.random.default_rng(1).random((2000, 2))
    order = [stroke for stroke, _ in drawing_order(points, points)]
    travel = np.hypot(*np.diff(points[order], axis=0).T).sum()
    assert travel == pytest.approx(0.92 * math.sqrt(2000), rel=0.1)


def test_no_strokes() -> None:
    assert list(drawing_order(np.empty((0, 2)), np.empty((0, 2)))) == []
