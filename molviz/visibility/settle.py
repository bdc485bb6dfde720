"""Ends of arcs that are decided once, where two ways to find them may differ.

An elbow of sticks k and l ends where one of them turns away from the eye, say k. There the line of k enters l, and that
of l, which would enter k a little farther, is behind k already. Seen along the plane of the elbow (as all bonds of a
flat ring are, seen on edge) the two points differ by the square of the displacement only, which is rounding: then the
elbow decides.

A stick beside the line of centres leaves its ball through a plane that misses their true curve by some 5e-4 Å. Where
the rim turns away from the eye before it sinks below the ball's horizon, the stick's line begins there and the horizon
passes under it; where it sinks first, the horizon enters the stick and the line comes out from under it. The rim
decides.
"""

from typing import TypeAlias

import numpy as np

from molviz.arrays import Bools, Ints
from molviz.vectors import dot
from molviz.visibility.curves import HORIZON, LINE, SEAM, Curves
from molviz.visibility.named_arcs import NamedArcs
from molviz.visibility.names import EDGE, ELBOW, ENTRY, TEE
from molviz.visibility.occluders.stick import StickOccluders

Place: TypeAlias = tuple[Ints, int]  # a table of names and a row of it
HorizonEnds: TypeAlias = dict[tuple[int, int, int], list[Place]]


def settle_ends(arcs: NamedArcs, curves: Curves, sticks: StickOccluders, count: int) -> None:
    """Rename ends of arcs that contradict an elbow or the rim of a stick beside the line of centres."""
    if not len(sticks.length):
        return
    _Ends(arcs, curves, sticks, count).settle()


class _Ends:
    def __init__(self, arcs: NamedArcs, curves: Curves, sticks: StickOccluders, count: int) -> None:
        self.arcs, self.curves, self.sticks, self.count = arcs, curves, sticks, count
        self.contour = np.flatnonzero(curves.is_contour())

    def settle(self) -> None:
        self._elbows()
        aside = dot(self.sticks.ends.offset, self.sticks.ends.offset) > 0
        if aside.any():
            self._rims(aside)

    def _elbows(self) -> None:
        kind = self.curves.kind[self.arcs.curve]
        ends = [(name, row) for name in self._names() for row in np.flatnonzero(name[:, 0] >> 1 == ELBOW).tolist()]
        of_lines = {tuple(name[row].tolist()): (name, row) for name, row in ends if kind[row] == LINE}
        of_elbows = {tuple(name[row].tolist()) for name, row in ends if kind[row] == SEAM}
        for key in of_lines.keys() - of_elbows:
            half, other = key[1], key[2]
            side = self._same_side(half, other, key[0] & 1)
            if (ELBOW * 2 + side, other, half, -1) in of_elbows:
                self._end_behind(of_lines[key], self._line(other, side))
        for key in of_elbows - of_lines.keys():
            place = self._at_end(key[1], key[0] & 1)
            if place and self._is_behind(place, [self._line(key[2], side) for side in (0, 1)]):
                place[0][place[1]] = key

    def _rims(self, aside: Bools) -> None:
        """At each visible end of a rim, let the line and the horizon there end as it says."""
        second = self.curves.second[self.arcs.curve]
        rows = np.flatnonzero((self.curves.first[self.arcs.curve] < self.count) & (second >= self.count))
        rows = rows[aside[second[rows] - self.count]]
        horizon_ends = self._ends_of_horizons(np.unique(self.curves.first[self.arcs.curve[rows]]))
        for row in rows.tolist():
            sphere, half = int(self.curves.first[self.arcs.curve[row]]), int(second[row])
            for name in self._names():
                if name[row, 0] >> 1 == EDGE:
                    self._line_begins(name[row], sphere, half, horizon_ends)
                elif name[row, 0] >> 1 == ENTRY:
                    self._stick_is_entered(name[row], sphere, half, horizon_ends)

    def _line_begins(self, edge: Ints, sphere: int, half: int, horizon_ends: HorizonEnds) -> None:
        """The stick's line begins at the end of the rim, and the ball's horizon passes under it."""
        side = int(edge[0] & 1)
        line = self._at_end(half, side)
        if line and self._is_behind(line, [sphere]):
            line[0][line[1]] = edge
        for place in horizon_ends.get((ENTRY * 2 + side, sphere, half), []):
            self._end_behind(place, self._line(half, side))

    def _stick_is_entered(self, entry: Ints, sphere: int, half: int, horizon_ends: HorizonEnds) -> None:
        """The ball's horizon enters the stick at the end of the rim, and the stick's line comes out from under it."""
        side = int(entry[0] & 1)
        line = self._at_end(half, side)
        if line and line[0][line[1], 0] >> 1 == EDGE:
            self._end_behind(line, sphere)
        if (ENTRY * 2 + side, sphere, half) not in horizon_ends:
            for place in horizon_ends.get((TEE * 2, sphere, self._line(half, side)), [])[:1]:
                place[0][place[1]] = entry

    def _names(self) -> tuple[Ints, Ints]:
        return self.arcs.origin, self.arcs.target

    def _ends_of_horizons(self, spheres: Ints) -> HorizonEnds:
        """Where the horizons of the given spheres enter sticks, by name, and where they pass under lines."""
        own = self.curves.first[self.arcs.curve]
        rows = np.flatnonzero((self.curves.kind[self.arcs.curve] == HORIZON) & np.isin(own, spheres))
        ends: HorizonEnds = {}
        for name in self._names():
            for row in rows[np.isin(name[rows, 0] >> 1, (ENTRY, TEE))].tolist():
                is_tee = name[row, 0] >> 1 == TEE
                key = (TEE * 2, int(own[row]), int(name[row, 2])) if is_tee else tuple(name[row, :3].tolist())
                ends.setdefault(key, []).append((name, row))
        return ends

    def _same_side(self, half: int, other: int, side: int) -> int:
        """On which side of another stick of its joint, seen outwards from there, a side of a stick lies on the page."""
        ends = half - self.count, other - self.count
        one, two = (self.sticks.normals[[end >> 1], 1] * (1 - 2 * (end & 1)) for end in ends)
        return side if float(dot(one, two)[0]) > 0 else 1 - side

    def _line(self, half: int, side: int) -> int:
        """The number of the line on a side of a half stick, seen outwards from its end."""
        end = half - self.count
        return self.count + 2 * (end >> 1) + (side ^ (end & 1))

    def _at_end(self, half: int, side: int) -> Place | None:
        """The end, nearest its ball, of the visible part of the line on a side of a half stick."""
        curve = self.contour[self._line(half, side)]
        begin, end = np.searchsorted(self.arcs.curve, [curve, curve + 1])
        if begin == end:
            return None
        return (self.arcs.origin, int(begin)) if self.curves.first[curve] == half else (self.arcs.target, int(end - 1))

    def _is_behind(self, place: Place, contours: list[int]) -> bool:
        name = place[0][place[1]]
        return bool(name[0] >> 1 == TEE and name[2] in contours)

    def _end_behind(self, place: Place, contour: int) -> None:
        name, row = place
        name[row] = [TEE * 2 + (name is self.arcs.origin), row, contour, -1]
