"""Strokes: the stretches of horizons that are drawn in one ink, and the frames of points along them."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.vectors import cross, dot
from molviz.visibility.horizon_runs import HorizonRuns


class Strokes(NamedTuple):
    """Stretches of runs that are drawn in one ink; they may reach into the next turn of closed runs."""

    run: Ints  # (k,)
    first: Floats  # (k,) samples, fractional counts from the run's start
    last: Floats  # (k,)
    ends: Ints  # (2, k) rows of the runs' vertices in which they begin and end, −1 where in none
    whole: Bools  # (k,) a closed run altogether

    def take(self, rows: Ints) -> "Strokes":
        """Return the given rows, in that order."""
        return Strokes(self.run[rows], self.first[rows], self.last[rows], self.ends[:, rows], self.whole[rows])


def strokes_of(runs: HorizonRuns, drawn: Bools, ends: Ints) -> Strokes:
    """Return the stretches of ``drawn`` samples (s,), as far as the sample beyond, where their width may be nought.

    Runs have ink between ``ends`` (2, m), rows of their vertices.
    """
    owner = runs.owner()
    joined = np.append(False, drawn[1:] & drawn[:-1] & (owner[1:] == owner[:-1]))[: len(drawn)]
    first = np.flatnonzero(drawn & ~joined)
    last = np.flatnonzero(drawn & ~np.append(joined[1:], False)[: len(drawn)])
    run = owner[first]
    count = np.diff(runs.start)[run]
    low, high = first - runs.start[run], last - runs.start[run]
    from_start, to_end = low == 0, high == count - 1
    whole = runs.closed[run] & from_start & to_end
    # of a closed run that is drawn across its seam the part after it continues the one before
    split = runs.closed[run] & ~whole
    after, before = np.flatnonzero(split & from_start), np.flatnonzero(split & to_end)
    after, before = after[np.isin(run[after], run[before])], before[np.isin(run[before], run[after])]
    high[before] += high[after]
    opened = np.stack([from_start & ~runs.closed[run], to_end & ~runs.closed[run]])
    begin = np.where(opened[0], runs.vertices.place[ends[0, run]], low - 1.0 * ~whole)
    end = np.where(opened[1], runs.vertices.place[ends[1, run]], high + 1.0 * ~whole)
    rows = np.where(opened, ends[:, run], -1)
    found = Strokes(run, begin, np.maximum(begin, end), rows, whole)
    return found.take(np.setdiff1d(np.arange(len(run)), after))


class Frames(NamedTuple):
    """Points of horizons with their unit normals outwards, radii of curvature and ångström per sample."""

    point: Floats  # (q, 2)
    normal: Floats  # (q, 2)
    radius: Floats  # (q,)
    step: Floats  # (q,)

    def take(self, rows: Ints) -> "Frames":
        """Return the given rows, in that order."""
        return Frames(*(column.take(rows, axis=0) for column in self))

    def outwards(self, offset: Floats) -> Floats:
        """Return the points (q, 2) so many ångström (q,) outside."""
        return np.asarray(self.point + offset[:, None] * self.normal)

    def center(self) -> Floats:
        """Return the centres of curvature (q, 2)."""
        return self.outwards(-self.radius)

    def samples_to(self, point: Floats) -> Floats:
        """Return how many samples (q,) along its horizon each point (q, 2) is, as seen from the centre of curvature."""
        spoke, to_point = self.radius[:, None] * self.normal, point - self.center()
        return np.asarray(np.arctan2(cross(spoke, to_point), dot(spoke, to_point)) * self.radius / self.step)


def frames_at(runs: HorizonRuns, run: Ints, place: Floats) -> Frames:
    """Return the frames at places (q,) of runs."""
    arcs, samples = runs.arcs.take(run), (np.diff(runs.start) - 1)[run]
    t = arcs.start + arcs.sweep * place / samples
    point, tangent = arcs.at_with_tangent(t)
    speed = np.hypot(*tangent.T)
    normal = np.column_stack([tangent[:, 1], -tangent[:, 0]]) / speed[:, None]
    return Frames(point, normal, speed**3 / np.abs(cross(arcs.u, arcs.v)), speed * arcs.sweep / samples)
