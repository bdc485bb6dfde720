"""Names of the ends of arcs of sticks, by the same rule as those of spheres.

On a circle or ellipse about an axis, what is hidden beyond a plane of normal g ends towards (a × b) × g. With e
towards the eye, ``e × u`` is the side of an end whose stick leaves its ball along u: rims end there where they sink
behind their stick or below their ball, horizons where they come out of the stick. ``u × w`` is that of two sticks of a
joint.
"""

import numpy as np

from molviz.arrays import Bools, Ints
from molviz.visibility.curves import BORDER, HORIZON, LINE, SEAM, Curves
from molviz.visibility.names import BALL, CUT, EDGE, ELBOW, ENTRY, HALF, OWN, TRIPLE, named


def name_stick_ends(
    name: Ints, curves: Curves, curve: Ints, why: Ints, other: Ints, is_end: int, count: int
) -> None:
    """Write the names of those rows (k, 4) that end at a stick; ``is_end`` tells ends of hidden intervals from starts.

    Halves of sticks are numbered from ``count``.
    """
    kind, first, second = (column[curve] for column in (curves.kind, curves.first, curves.second))
    line, horizon, border = kind == LINE, kind == HORIZON, kind == BORDER
    rim = ~line & ~border & (first < count) & (second >= count)
    elbow = ~line & ~border & (first >= count)
    own, ball = why == OWN, why == BALL
    side = np.full(len(curve), is_end)
    near = first if is_end else second  # the half of a line that lies at the joint where its visible part ends
    left = (first - count) & 1  # of a line, as it runs against the axis then
    _write(name, rim & own & (other == second), EDGE, side, second)
    _write(name, rim & own & (other == first) & (kind == SEAM), EDGE, side, second)
    _write(name, rim & own & (other == first) & (kind != SEAM), ENTRY, side, first, second)
    _write(name, rim & ball, TRIPLE, side ^ (second > other).astype(int), first, *_sorted(second, other))
    _write(name, elbow & own & (other == second), ELBOW, side, second, first)
    _write(name, elbow & own & (other == first), ELBOW, 1 - side, first, second)
    turned = (second < first).astype(int)
    _write(name, elbow & ball & (other < count), TRIPLE, side ^ turned, other, *_sorted(first, second))
    _write(name, elbow & ball & (other >= count), TRIPLE, 0 * side, *_sorted(first, second, other))
    _write(name, border & own, HALF, side, first)
    _write(name, horizon & own, EDGE, side, other)
    _write(name, horizon & ball & (other >= count), ENTRY, side, first, other)
    _write(name, line & own, EDGE, left ^ ((other - count) & 1), other)
    _write(name, line & (why == CUT), HALF, left, other)
    _write(name, line & ball, ELBOW, left ^ ((near - count) & 1), near, other)


def _sorted(*columns: Ints) -> list[Ints]:
    return list(np.sort(np.stack(columns), axis=0))


def _write(name: Ints, where: Bools, kind: int, side: Ints, *numbers: Ints) -> None:
    rows = np.flatnonzero(where)
    none = np.full(len(rows), -1)
    filled = [*(column[rows] for column in numbers), *[none] * (3 - len(numbers))]
    name[rows] = named(np.full(len(rows), kind), side[rows], *filled)
