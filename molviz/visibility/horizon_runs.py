"""Visible horizons as unbroken runs, sampled along their way: how far behind each point the next surface lies."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.curves import PlaneArcs
from molviz.geometry.rows import expand, offsets
from molviz.visibility.curves import HORIZON
from molviz.visibility.eye import occluders_of, projection_of
from molviz.visibility.map import BACKGROUND, VisibilityMap
from molviz.visibility.projection import images_of
from molviz.visibility.view import View

SPACING = 0.2  # ångström between samples
MOST = 5000  # samples across a drawing: in those of giants they lie farther apart


class HorizonRuns(NamedTuple):
    """m runs of consecutive arcs of one horizon each, counter-clockwise about the sphere; ångström on the page."""

    sphere: Ints  # (m,) whose horizon it is
    arcs: PlaneArcs  # (m,) the whole runs
    closed: Bools  # (m,) whole turns
    before: Ints  # (m,) the sphere under whose horizon, or out of whose ball, the run comes at its start; −1 if closed
    after: Ints  # (m,) that under or into which it goes at its end
    horizons: PlaneArcs  # (n,) the images of the horizons of all spheres
    start: Ints  # (m + 1,) CSR offsets of the samples
    t: Floats  # (s,) parameters of the samples, equally spaced, both ends included
    behind: Ints  # (s,) the sphere seen just outside each sample, or BACKGROUND
    spacing: float  # ångström between samples, roughly
    jump: Floats  # (s,) ångström from the horizon to the surface there, infinite before the background

    def owner(self) -> Ints:
        """Return the run of each sample (s,)."""
        return np.repeat(np.arange(len(self.sphere)), np.diff(self.start))

    def length(self) -> Floats:
        """Return the lengths (m,) in ångström, those of the circles about the images."""
        return self.arcs.sweep * self.arcs.major()


def horizon_runs(view_map: VisibilityMap, view: View) -> HorizonRuns:
    """Return the visible horizons of a map, each as long as nothing hides it, and what lies behind them."""
    curve_arcs = view_map.curve_arcs
    row = np.flatnonzero(view_map.curves.kind[curve_arcs.curve] == HORIZON)
    curve, origin, target = (column[row] for column in (curve_arcs.curve, curve_arcs.origin, curve_arcs.target))
    begins = np.append(True, (curve[1:] != curve[:-1]) | (origin[1:] != target[:-1]))[: len(row)]
    first = np.flatnonzero(begins)
    last = np.append(first[1:], len(row))[: len(first)] - 1
    arcs = view_map.arcs.take(row[first])
    arcs = arcs._replace(sweep=np.add.reduceat(view_map.arcs.sweep[row], first) if len(first) else arcs.sweep)
    sphere = view_map.curves.first[curve]
    closed = origin[first] == target[last]
    before = np.where(closed, -1, _met_at(view_map, row, target, origin[first], sphere[first]))
    after = np.where(closed, -1, _met_at(view_map, row, origin, target[last], sphere[first]))
    horizons = images_of(view_map.horizons(), projection_of(view))
    spacing = max(SPACING, _width(arcs) / MOST)
    count = np.maximum(np.ceil(arcs.sweep * arcs.major() / spacing).astype(np.int64), 2) + 1
    start = offsets(np.repeat(np.arange(len(first)), count), len(first))
    owner, place = expand(np.zeros_like(count), count)
    offset = arcs.sweep[owner] * place / (count[owner] - 1)
    # an end stands for the half sample beside it: where balls touch, the very last arc of a horizon is often too short
    # to be seen, and has the neighbour behind it while all others have the background
    beside = arcs.sweep[owner] * np.clip(place, 0.5, count[owner] - 1.5) / (count[owner] - 1)
    behind = _behind_at(view_map, row, first, last, owner, beside)
    t = arcs.start[owner] + offset
    page = arcs.take(owner).at(t)
    jump = _jumps(view_map, view, sphere[first][owner], behind, page)
    return HorizonRuns(sphere[first], arcs, closed, before, after, horizons, start, t, behind, spacing, jump)


def _width(arcs: PlaneArcs) -> float:
    """The larger side of the box around whole ellipses."""
    half = arcs.half_extent()
    return float(np.max(np.max(arcs.c + half, axis=0, initial=0.0) - np.min(arcs.c - half, axis=0, initial=0.0)))


def _met_at(view_map: VisibilityMap, row: Ints, end: Ints, vertex: Ints, own: Ints) -> Ints:
    """The sphere at which a run of ``own`` ends at each vertex (m,): that of a horizon that runs on, or of a crease."""
    curves, curve_arcs = view_map.curves, view_map.curve_arcs
    above = _other_at(end, curves.first[curve_arcs.curve[row]], vertex, own)
    crease = np.flatnonzero(view_map.is_crease())
    ends = np.concatenate([curve_arcs.origin[crease], curve_arcs.target[crease]])
    pair = [np.tile(column[curve_arcs.curve[crease]], 2) for column in (curves.first, curves.second)]
    entered = [_other_at(ends, sphere, vertex, own) for sphere in pair]
    return np.where(above >= 0, above, np.maximum(*entered))


def _other_at(end: Ints, sphere: Ints, vertex: Ints, own: Ints) -> Ints:
    """The sphere other than ``own`` a horizon arc of which has the given vertex at its ``end``, −1 where none has."""
    order = np.argsort(end, kind="stable")
    begin = np.searchsorted(end[order], vertex)
    stop = np.searchsorted(end[order], vertex, side="right")
    row, entry = expand(begin, stop)
    there = sphere[order[entry]]
    other = np.full(len(vertex), -1)
    rows = np.flatnonzero(there != own[row])
    other[row[rows]] = there[rows]
    return other


def _behind_at(view_map: VisibilityMap, row: Ints, first: Ints, last: Ints, owner: Ints, offset: Floats) -> Ints:
    """The face on the right of the arc of its run on which each sample lies."""
    reached = np.cumsum(view_map.arcs.sweep[row])
    begin = reached[first] - view_map.arcs.sweep[row[first]]
    place = np.searchsorted(reached, begin[owner] + offset)
    return view_map.right[row[np.clip(place, first[owner], last[owner])]]


def _jumps(view_map: VisibilityMap, view: View, own: Ints, behind: Ints, page: Floats) -> Floats:
    occluders = occluders_of(view_map.spheres, view)
    surface = occluders.surface(np.maximum(behind, 0), page)
    jump = np.maximum(occluders.nearness()[own] - surface, 0.0)  # rounding beside a silhouette of the surface: −∞
    own_radius = view_map.spheres.radius[own]
    return np.where(behind == BACKGROUND, np.inf, np.where(np.isfinite(jump), jump, own_radius))
