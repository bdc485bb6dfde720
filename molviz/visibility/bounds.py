"""What solids keep within: a stripe with round ends on the page, and a range of nearness.

Most of what lies near a stick neither crosses its stripe nor lies on the right side of it, and needs no exact look.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.grid import Neighbours, meeting_pairs, pairs_by_owner
from molviz.geometry.rows import offsets
from molviz.model.spheres import Spheres
from molviz.threads import in_threads
from molviz.vectors import cross, dot
from molviz.visibility.occlusion import Discs

BLOCK_PAIRS = 1 << 15  # of stripes at a time: their columns stay in cache
ROOM = 1.0 + 1e-6  # of the radii of what just touches, for rounding


class Bounds(NamedTuple):
    """The m stripes: all points of the page within ``radius`` of the straight line from ``begin`` to ``end``."""

    begin: Floats  # (m, 2)
    end: Floats  # (m, 2)
    radius: Floats  # (m,)
    least: Floats  # (m,) nearness
    most: Floats  # (m,)

    def discs(self) -> Discs:
        """Return a disc around each stripe."""
        along = self.end - self.begin
        return Discs((self.begin + self.end) / 2, ROOM * (self.radius + np.sqrt(dot(along, along)) / 2))

    def meet_discs(self, rows: Ints, center: Floats, radius: Floats) -> Bools:
        """Return whether stripes (p,) meet discs (p, 2), (p,)."""
        begin, end = self.begin.take(rows, axis=0), self.end.take(rows, axis=0)
        reach = ROOM * (self.radius[rows] + radius)
        return np.asarray(_square_distances(center, begin, end) < reach**2)

    def meet(self, one: Ints, other: Ints) -> Bools:
        """Return whether stripes (p,) meet others.

        They do where their middle lines cross, or an end of one is near enough to the other.
        """
        reach = (ROOM * (self.radius[one] + self.radius[other])) ** 2
        ends = [(self.begin.take(row, axis=0), self.end.take(row, axis=0)) for row in (one, other)]
        met = _cross(*ends[0], *ends[1])
        for segment, points in ((0, 1), (1, 0)):
            for point in ends[points]:
                met |= _square_distances(point, *ends[segment]) < reach
        return met

    def neighbours(self) -> tuple[Neighbours, Neighbours]:
        """Return what may be in front of some of each solid, and what may be seen behind it."""
        discs = self.discs()
        flat = np.column_stack([discs.center, np.zeros(len(discs.radius))])
        one, other = meeting_pairs(Spheres(flat, discs.radius))
        parts = np.array_split(np.arange(len(one)), len(one) // BLOCK_PAIRS + 1)
        met = np.concatenate(in_threads(lambda part: self.meet(one[part], other[part]), parts))
        near = pairs_by_owner(one[met], other[met], len(self.radius))
        owner, item = np.repeat(np.arange(len(self.radius)), np.diff(near.start)), near.item
        in_front, behind = (self.most[a] > self.least[b] for a, b in ((item, owner), (owner, item)))
        return self._listed(owner, item, in_front), self._listed(owner, item, behind)

    def _listed(self, owner: Ints, item: Ints, which: Bools) -> Neighbours:
        return Neighbours(offsets(owner[which], len(self.radius)), item[which])


def _square_distances(point: Floats, begin: Floats, end: Floats) -> Floats:
    """The squares of the distances (p,) of points from straight lines between two points, all (p, 2)."""
    x, y = point[:, 0] - begin[:, 0], point[:, 1] - begin[:, 1]
    along_x, along_y = end[:, 0] - begin[:, 0], end[:, 1] - begin[:, 1]
    square = along_x**2 + along_y**2
    share = np.divide(x * along_x + y * along_y, square, out=np.zeros_like(square), where=square > 0)
    share = np.clip(share, 0.0, 1.0)
    return np.asarray((x - share * along_x) ** 2 + (y - share * along_y) ** 2)


def _cross(a: Floats, b: Floats, c: Floats, d: Floats) -> Bools:
    """Whether lines from a to b and from c to d cross, all (p, 2): the ends of each lie on both sides of the other."""
    sides = [cross(b - a, c - a), cross(b - a, d - a), cross(d - c, a - c), cross(d - c, b - c)]
    return np.asarray((sides[0] * sides[1] < 0) & (sides[2] * sides[3] < 0))
