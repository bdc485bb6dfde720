"""Intervals of angle on circles: the one primitive, and the gaps that a family of intervals leaves.

Every curve that molviz draws is a circle with a parameter θ, and nearly everything that hides part of it hides
an interval of θ. What stays visible is what no interval covers.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.rows import ordered
from molviz.threads import in_threads

TURN = 2.0 * np.pi
BLOCK_ROWS = 1 << 16  # intervals at a time: their columns stay in cache
PARTS = 1 << 16  # that sixteen bits can number


class Intervals(NamedTuple):
    """Intervals ``start ≤ θ ≤ start + sweep`` on numbered circles; rows in any order."""

    circle: Ints  # (m,)
    start: Floats  # (m,) radians, any turn
    sweep: Floats  # (m,) radians, in (0, 2π]


class Gaps(NamedTuple):
    """What a family of intervals leaves free of each circle, ordered by circle and start.

    ``before`` and ``after`` are the rows of the intervals at whose end a gap begins and at whose start it ends;
    −1 where the whole circle is free.
    """

    circle: Ints  # (k,)
    start: Floats  # (k,) radians in [0, 2π)
    sweep: Floats  # (k,) radians in (0, 2π]
    before: Ints  # (k,)
    after: Ints  # (k,)


def above(a: Floats, b: Floats, c: Floats) -> tuple[Floats, Floats]:
    """Solve ``a cos θ + b sin θ > c`` for θ.

    Returns the middle φ and the half-width h of the one interval φ ± h that solves it: h = arccos(c / R) with
    R = hypot(a, b) and φ = atan2(b, a); h is 0 where nothing solves it (c ≥ R) and π where everything does (c < −R).
    """
    reach = np.hypot(a, b)
    with np.errstate(divide="ignore", invalid="ignore"):
        half = np.arccos(np.clip(c / reach, -1.0, 1.0))
    half = np.where(c >= reach, 0.0, np.where(c < -reach, np.pi, half))
    return np.arctan2(b, a), half


def gaps(hidden: Intervals, count: int) -> Gaps:
    """Return the parts of circles 0 … count − 1 that no interval covers (closed intervals, so gaps are open).

    Many circles are taken in parts, so that sorting stays in cache.
    """
    parts = min(len(hidden.circle) // BLOCK_ROWS + 1, PARTS)
    if parts == 1:
        return _gaps(hidden, count)
    many = -(-count // parts)  # circles a part
    part = (hidden.circle // many).astype(np.uint16)
    order = np.argsort(part, kind="stable")  # of sixteen bits: in one pass
    begin = np.searchsorted(part[order], np.arange(parts + 1))

    def of_part(number: int) -> Gaps:
        rows, first = order[begin[number] : begin[number + 1]], number * many
        some = Intervals(hidden.circle[rows] - first, hidden.start[rows], hidden.sweep[rows])
        free = _gaps(some, max(min(many, count - first), 0))
        rows = np.append(rows, -1)  # row −1 stays −1
        return free._replace(circle=free.circle + first, before=rows[free.before], after=rows[free.after])

    found = in_threads(of_part, range(parts))
    return Gaps(*(np.concatenate(column) for column in zip(*found, strict=True)))


def _gaps(hidden: Intervals, count: int) -> Gaps:
    """The gaps of some circles: one sort by start and a running maximum of ends.

    Intervals that wrap through θ = 0 enter twice, the second time a turn earlier; the maximum runs over ranks, not
    angles, so that circles need no offset and no precision is lost.
    """
    start = np.mod(hidden.start, TURN)
    start[(start >= TURN) | (hidden.sweep >= TURN)] = 0.0  # mod rounds a tiny negative angle up; and no seam in a whole
    end = start + hidden.sweep
    wraps = np.flatnonzero(end > TURN)
    row = np.concatenate([np.arange(len(start)), wraps])
    circle = hidden.circle[row]
    start = np.concatenate([start, start[wraps] - TURN])
    end = np.concatenate([end, end[wraps] - TURN])

    by_end = ordered(circle, end)
    rank = np.empty(len(row), dtype=np.int64)
    rank[by_end] = np.arange(len(row))
    by_start = ordered(circle, start)
    circle, start, row_sorted = circle[by_start], start[by_start], row[by_start]
    farthest = by_end[np.maximum.accumulate(rank[by_start])]  # of this circle: ranks of earlier circles are smaller

    return _ordered(
        _gaps_between(circle, start, end[farthest], row_sorted, row[farthest]),
        _gap_across_zero(circle, start, end[farthest], row_sorted, row[farthest]),
        _whole(circle, count),
    )


def _gaps_between(circle: Ints, start: Floats, reached: Floats, row: Ints, reached_row: Ints) -> Gaps:
    """Gaps between consecutive rows of one circle; ``reached`` is the farthest end so far."""
    free = np.flatnonzero((circle[1:] == circle[:-1]) & (start[1:] > reached[:-1]))
    return Gaps(circle[free], reached[free], start[free + 1] - reached[free], reached_row[free], row[free + 1])


def _gap_across_zero(circle: Ints, start: Floats, reached: Floats, row: Ints, reached_row: Ints) -> Gaps:
    """The gap between the last end and the first start of circles on which no interval wraps through zero."""
    last = np.flatnonzero(np.append(circle[1:] != circle[:-1], True)[: len(circle)])
    first = np.append(0, last[:-1] + 1)[: len(last)]
    sweep = start[first] + TURN - reached[last]
    free = (start[first] >= 0) & (sweep > 0)
    first, last, sweep = first[free], last[free], sweep[free]
    return Gaps(circle[last], np.mod(reached[last], TURN), sweep, reached_row[last], row[first])


def _whole(circle: Ints, count: int) -> Gaps:
    """Circles without any interval, free all round."""
    untouched: Bools = np.ones(count, dtype=bool)
    untouched[circle] = False
    free = np.flatnonzero(untouched)
    none = np.full(len(free), -1)
    return Gaps(free, np.zeros(len(free)), np.full(len(free), TURN), none, none)


def _ordered(*parts: Gaps) -> Gaps:
    columns = [np.concatenate(column) for column in zip(*parts, strict=True)]
    order = ordered(columns[0], columns[1])
    return Gaps(*(column[order] for column in columns))
