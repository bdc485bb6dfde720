"""The table of sticks between balls: cylinders that begin and end inside the two spheres of a bond."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints


class Sticks(NamedTuple):
    """k cylinders between spheres of one table; several with offsets of their own may join one pair.

    The axis runs from center[first] + offset to center[second] + offset; the offset is at right angles to the line
    of centres, and 0 where there is one stick for the bond. radius + |offset| is less than the radius of either sphere
    or, without an offset, at most equal to it, so that the end discs lie inside the spheres.
    """

    first: Ints  # (k,) rows of the spheres
    second: Ints  # (k,)
    radius: Floats  # (k,) ångström
    offset: Floats  # (k, 3) ångström, in the space of the centres

    def __repr__(self) -> str:
        return f"<Sticks: {len(self.radius)}>"

    def take(self, rows: Ints) -> "Sticks":
        """Return the given sticks, in that order."""
        return Sticks(self.first[rows], self.second[rows], self.radius[rows], self.offset[rows])

    def among(self, rows: Ints, count: int) -> "Sticks":
        """Return the sticks of which both spheres are among the given rows of ``count``, numbered in that order."""
        number = np.full(count, -1)
        number[rows] = np.arange(len(rows))
        kept = self.take(self.rows_among(rows, count))
        return kept._replace(first=number[kept.first], second=number[kept.second])

    def rows_among(self, rows: Ints, count: int) -> Ints:
        """Return the rows of those sticks."""
        known = np.zeros(count, dtype=bool)
        known[rows] = True
        return np.flatnonzero(known[self.first] & known[self.second])


NO_STICKS = Sticks(np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64), np.empty(0), np.empty((0, 3)))
