"""Arcs whose ends have names.

Where an arc ends is known by *why* it ends, never by comparing coordinates. Three reasons, three kinds of vertex:

* ``TRIPLE (i, j, k)``: the crease of two spheres enters a third ball; the creases of all three pairs end there.
* ``ENTRY (i, j)``: the horizon of i enters ball j; the crease of i and j, which sinks below it there, ends too.
* ``TEE (a, k)``: arc a passes under the contour k of a nearer solid, and nothing else ends there. Contours are
  numbered: the horizons of the spheres, then the silhouette lines of the sticks, two of each.
* ``EDGE (h)``: the silhouette line of stick half h ends in its ball, and its rim turns away from the eye. At a joint
  the horizon of the ball ends there too.
* ``ELBOW (h, l)``: the silhouette line of h enters stick half l of the same joint, and their elbow turns away.
* ``HALF (h)``: the border of h and its stick's other half meets a silhouette line. So does each border of the parts
  that a painter cuts a stick into; of a part's lines the rest is cut off there.

Three spheres, or a horizon and a sphere, meet in two points, mirror images of each other; ``side`` tells which. An
interval ``φ ± h`` of a circle with axis a × b inside a half-space with normal g ends on the side where ``(a × b) × g``
is positive and starts on the other. So the side of an end follows from which end of which interval it is.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints, distinct
from molviz.geometry.intervals import Intervals, gaps
from molviz.threads import both
from molviz.visibility.curves import Curves
from molviz.visibility.names import BALL, ENTRY, OWN, TEE, TRIPLE, WHOLE, named
from molviz.visibility.stick_names import name_stick_ends

MANY = 20_000  # arcs, from which on both of their ends are worth a thread


class Hidden(NamedTuple):
    """Hidden intervals of numbered curves, and what hides them.

    ``leaves`` and ``enters`` are the solids concerned at the interval's end (where the curve comes out) and at its
    start (where it goes in), contours where the reason is FRONT, borders where it is CUT; they may differ where
    several intervals were merged, or where one is what lies beyond both ends of a line.
    """

    curve: Ints  # (m,)
    start: Floats  # (m,) radians
    sweep: Floats  # (m,) radians
    reason: Ints  # (m,) BALL, OWN, FRONT or CUT
    leaves: Ints  # (m,)
    enters: Ints  # (m,)

    def take(self, rows: Ints) -> "Hidden":
        """Return the given intervals, in that order."""
        angles, names = (self.start[rows], self.sweep[rows]), (self.leaves[rows], self.enters[rows])
        return Hidden(self.curve[rows], *angles, self.reason[rows], *names)


class NamedArcs(NamedTuple):
    """k arcs of curves with the names of the vertices they run between: kind × 2 + side, and three numbers."""

    curve: Ints  # (k,)
    start: Floats  # (k,) radians
    sweep: Floats  # (k,) radians, (0, 2π]
    instance: Ints  # (k,) the curve as numbered in the hidden intervals, which may name one curve several times
    origin: Ints  # (k, 4)
    target: Ints  # (k, 4)

    def take(self, rows: Ints) -> "NamedArcs":
        """Return the given arcs, in that order; names keep the numbers of arcs that they had."""
        ends = (name.take(rows, axis=0) for name in (self.origin, self.target))
        return NamedArcs(self.curve[rows], self.start[rows], self.sweep[rows], self.instance[rows], *ends)


def joined(parts: list[Hidden]) -> Hidden:
    """Return the rows of several tables as one."""
    return Hidden(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def visible_arcs(curves: Curves, instance_curve: Ints, hidden: Hidden, spheres: int | None = None) -> NamedArcs:
    """Return what the hidden intervals leave of each curve; their number c means the curve ``instance_curve[c]``.

    Halves of sticks, if there are any, are numbered from ``spheres``.
    """
    free = gaps(Intervals(hidden.curve, hidden.start, hidden.sweep), len(instance_curve))
    curve = instance_curve[free.circle]
    number = np.arange(len(curve))
    origin, target = both(
        lambda: _names(curves, curve, number, hidden.reason, hidden.leaves, free.before, 1, spheres),
        lambda: _names(curves, curve, number, hidden.reason, hidden.enters, free.after, 0, spheres),
        len(curve) > MANY,
    )
    return NamedArcs(curve, free.start, free.sweep, free.circle, origin, target)


def _names(
    curves: Curves, curve: Ints, number: Ints, reason: Ints, sphere: Ints, row: Ints, side: int, spheres: int | None
) -> Ints:
    """Names (k, 4) of the ends of arcs at ends (side 1) or starts (side 0) of the given hidden intervals."""
    first, second = curves.first[curve], curves.second[curve]
    why, other = np.append(reason, -1)[row], np.append(sphere, -1)[row]
    is_crease, whole = curves.is_crease()[curve], row < 0
    name = named(np.full(len(curve), TEE), side, number, other, -1)
    name[whole] = named(np.full(int(whole.sum()), WHOLE), 0, number[whole], -1, -1)
    triple = ~whole & is_crease & (why == BALL)
    name[triple] = _triple(first[triple], second[triple], other[triple], side)
    sinks = ~whole & is_crease & (why == OWN)
    name[sinks] = _entry(other[sinks], (first + second - other)[sinks], side ^ (other == second)[sinks])
    enters = ~whole & ~is_crease & (why == BALL)
    name[enters] = _entry(first[enters], other[enters], np.full(int(enters.sum()), side))
    if spheres is not None:
        name_stick_ends(name, curves, curve, np.where(whole, -1, why), other, side, spheres)
    return name


def _triple(i: Ints, j: Ints, k: Ints, side: int) -> Ints:
    """i < j; sorting (i, j, k) is an odd permutation exactly if k belongs between them, and mirrors the sides."""
    low, high = np.minimum(i, k), np.maximum(j, k)
    odd = (i < k) & (k < j)
    return named(np.full(len(i), TRIPLE), side ^ odd, low, i + j + k - low - high, high)


def _entry(sphere: Ints, other: Ints, side: Ints) -> Ints:
    return named(np.full(len(sphere), ENTRY), side, sphere, other, -1)


def sticks_at(arcs: NamedArcs, curves: Curves, vertices: Ints, balls: int, end: Ints) -> Ints:
    """Return the sticks, ascending, of what ends in the given vertices and is told of in their names, and of its balls.

    ``end`` (2k,) is the ball of each half of a stick. Halves and lines of sticks, two of either for each stick, are
    numbered from ``balls``.
    """
    numbers = []
    for name, vertex in zip((arcs.origin, arcs.target), vertex_numbers(arcs.origin, arcs.target), strict=True):
        rows = np.flatnonzero(np.isin(vertex, vertices))
        of_arc = np.isin(name[rows, 0] >> 1, (TEE, WHOLE))  # the first number is that of the arc
        numbers += [np.where(of_arc, -1, name[rows, 1]), *name[rows, 2:].T]
        numbers += [curves.first[arcs.curve[rows]], curves.second[arcs.curve[rows]]]
    number = np.concatenate(numbers)
    beside = np.flatnonzero(np.isin(end, number[number < balls]))
    return distinct(np.append(number[number >= balls] - balls, beside) >> 1)


def vertex_numbers(*names: Ints) -> list[Ints]:
    """Return for tables of names (k, 4) the numbers of the vertices, equal exactly where the names are."""
    table = np.concatenate(names)
    order = np.lexsort(table.T[::-1])
    new = np.any(table[order[1:]] != table[order[:-1]], axis=1)
    number = np.empty(len(table), dtype=np.int64)
    number[order] = np.concatenate([[0], np.cumsum(new)])[: len(table)]
    return np.split(number, np.cumsum([len(part) for part in names])[:-1])
