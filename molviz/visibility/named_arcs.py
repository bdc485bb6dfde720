"""Arcs whose ends have names.

Where an arc ends is known by *why* it ends, never by comparing coordinates. Three reasons, three kinds of vertex:

* ``TRIPLE (i, j, k)``: the crease of two spheres enters a third ball; the creases of all three pairs end there.
* ``ENTRY (i, j)``: the horizon of i enters ball j; the crease of i and j, which sinks below it there, ends too.
* ``TEE (a, k)``: arc a passes under the horizon of a nearer sphere k, and nothing else ends there.

Three spheres, or a horizon and a sphere, meet in two points, mirror images of each other; ``side`` tells which. An
interval ``φ ± h`` of a circle with axis a × b inside a half-space with normal g ends on the side where ``(a × b) × g``
is positive and starts on the other. So the side of an end follows from which end of which interval it is.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.geometry.intervals import Intervals, gaps
from molviz.visibility.curves import Curves

TRIPLE, ENTRY, TEE, WHOLE = range(4)
BALL, OWN, FRONT = range(3)  # why an interval is hidden: inside a ball, behind the curve's own sphere, or one in front


class Hidden(NamedTuple):
    """Hidden intervals of numbered curves, and what hides them.

    ``leaves`` and ``enters`` are the spheres concerned at the interval's end (where the curve comes out) and at its
    start (where it goes in); they differ only where several intervals have been merged into one.
    """

    curve: Ints  # (m,)
    start: Floats  # (m,) radians
    sweep: Floats  # (m,) radians
    reason: Ints  # (m,) BALL, OWN or FRONT
    leaves: Ints  # (m,)
    enters: Ints  # (m,)


class NamedArcs(NamedTuple):
    """k arcs of curves with the names of the vertices they run between: kind × 2 + side, and three numbers."""

    curve: Ints  # (k,)
    start: Floats  # (k,) radians
    sweep: Floats  # (k,) radians, (0, 2π]
    instance: Ints  # (k,) the curve as numbered in the hidden intervals, which may name one curve several times
    origin: Ints  # (k, 4)
    target: Ints  # (k, 4)


def joined(parts: list[Hidden]) -> Hidden:
    """Return the rows of several tables as one."""
    return Hidden(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def visible_arcs(curves: Curves, instance_curve: Ints, hidden: Hidden) -> NamedArcs:
    """Return what the hidden intervals leave of each curve; their number c means the curve ``instance_curve[c]``."""
    free = gaps(Intervals(hidden.curve, hidden.start, hidden.sweep), len(instance_curve))
    curve = instance_curve[free.circle]
    number = np.arange(len(curve))
    origin = _names(curves, curve, number, hidden.reason, hidden.leaves, free.before, 1)
    target = _names(curves, curve, number, hidden.reason, hidden.enters, free.after, 0)
    return NamedArcs(curve, free.start, free.sweep, free.circle, origin, target)


def _names(curves: Curves, curve: Ints, number: Ints, reason: Ints, sphere: Ints, row: Ints, side: int) -> Ints:
    """Names (k, 4) of the ends of arcs at ends (side 1) or starts (side 0) of the given hidden intervals."""
    first, second = curves.first[curve], curves.second[curve]
    why, other = np.append(reason, -1)[row], np.append(sphere, -1)[row]
    is_crease, whole = curves.is_crease()[curve], row < 0
    name = _named(np.full(len(curve), TEE), side, number, other, -1)
    name[whole] = _named(np.full(len(curve), WHOLE), 0, number, -1, -1)[whole]
    triple = ~whole & is_crease & (why == BALL)
    name[triple] = _triple(first[triple], second[triple], other[triple], side)
    sinks = ~whole & is_crease & (why == OWN)
    name[sinks] = _entry(other[sinks], (first + second - other)[sinks], side ^ (other == second)[sinks])
    enters = ~whole & ~is_crease & (why == BALL)
    name[enters] = _entry(first[enters], other[enters], np.full(int(enters.sum()), side))
    return name


def _named(kind: Ints, side: Ints | int, *numbers: Ints | int) -> Ints:
    columns = [kind * 2 + side, *numbers]
    return np.stack([np.broadcast_to(column, kind.shape) for column in columns], axis=1).astype(np.int64)


def _triple(i: Ints, j: Ints, k: Ints, side: int) -> Ints:
    """i < j; sorting (i, j, k) is an odd permutation exactly if k belongs between them, and mirrors the sides."""
    low, high = np.minimum(i, k), np.maximum(j, k)
    odd = (i < k) & (k < j)
    return _named(np.full(len(i), TRIPLE), side ^ odd, low, i + j + k - low - high, high)


def _entry(sphere: Ints, other: Ints, side: Ints) -> Ints:
    return _named(np.full(len(sphere), ENTRY), side, sphere, other, -1)


def vertex_numbers(*names: Ints) -> list[Ints]:
    """Return for tables of names (k, 4) the numbers of the vertices, equal exactly where the names are."""
    table = np.concatenate(names)
    order = np.lexsort(table.T[::-1])
    new = np.any(table[order[1:]] != table[order[:-1]], axis=1)
    number = np.empty(len(table), dtype=np.int64)
    number[order] = np.concatenate([[0], np.cumsum(new)])[: len(table)]
    return np.split(number, np.cumsum([len(part) for part in names])[:-1])
