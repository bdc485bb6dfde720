"""Visible horizons as unbroken runs, sampled along their way: how far behind each point the next surface lies."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.curves import PlaneArcs
from molviz.geometry.components import component_labels
from molviz.geometry.rows import blocks, expand, offsets, ordered
from molviz.threads import both, in_threads
from molviz.vectors import dot
from molviz.visibility.curves import LINE
from molviz.visibility.eye import occluders_of, projection_of
from molviz.visibility.map import BACKGROUND, VisibilityMap
from molviz.visibility.occlusion import BLOCK_ROWS
from molviz.visibility.solids import Solids
from molviz.visibility.view import View

SPACING = 0.2  # ångström between samples
NODE = 0.2  # ångström between vertices of one node
ATOM = 1.0  # ångström: the radius below which balls are smaller than atoms, and lines change in less room
FINEST = 0.25  # of what they need on atoms
STRAIGHT = 1e4  # ångström: the radius of arcs that stand for straight lines; over 2 Å they bend by 5e-5 Å
MOST = 5000  # samples across a drawing: in those of giants they lie farther apart


class Vertices(NamedTuple):
    """Where on the runs the vertices of the map lie: both where runs end and where other curves end under them."""

    vertex: Ints  # (p,) ascending
    run: Ints  # (p,)
    place: Floats  # (p,) samples, a fractional count from the run's start
    node: Ints  # (p,) the same for all that are closer to each other along runs than NODE
    partner: Ints  # (p,) the row of the same vertex on another run, −1 where there is none


class HorizonRuns(NamedTuple):
    """m runs of consecutive arcs of one horizon each, counter-clockwise about the sphere; ångström on the page."""

    sphere: Ints  # (m,) whose horizon it is, or at the end of whose stick it is a line
    stick: Floats  # (m,) the radius of the stick of which it is a line, infinite for horizons of balls
    arcs: PlaneArcs  # (m,) the whole runs
    detail: Floats  # (m,) 1 for atoms, less for small balls and their sticks: of the ångström by which lines change
    closed: Bools  # (m,) whole turns
    vertices: Vertices
    ends: Ints  # (2, m) rows of ``vertices``: where they start and end
    run_of_arc: Ints  # (k,) the run on which each arc of the map lies, −1 for creases
    place_of_arc: Floats  # (2, k) the places there where it starts and ends
    start: Ints  # (m + 1,) CSR offsets of the samples
    t: Floats  # (s,) parameters of the samples, equally spaced, both ends included
    behind: Ints  # (s,) the sphere seen just outside each sample, or BACKGROUND
    spacing: float  # ångström between samples, roughly
    jump: Floats  # (s,) ångström from the horizon to the surface there, infinite before the background

    def straight(self) -> Bools:
        """Return which runs (m,) are lines of sticks."""
        return np.isfinite(self.stick)

    def owner(self) -> Ints:
        """Return the run of each sample (s,)."""
        return np.repeat(np.arange(len(self.sphere)), np.diff(self.start))

    def length(self) -> Floats:
        """Return the lengths (m,) of the circles about the images, in ångström divided by the detail."""
        return np.asarray(self.arcs.sweep * self.arcs.major() / self.detail)

    def last(self) -> Ints:
        """Return the places (m,) of the last samples."""
        return np.diff(self.start) - 1


def horizon_runs(view_map: VisibilityMap, view: View) -> HorizonRuns:
    """Return the visible contours of a map, each as long as nothing hides it, and what lies behind them.

    Those of sticks are told by the spheres at their ends, as arcs of circles so large that nobody sees them bend.
    """
    curve_arcs, owner_of = view_map.curve_arcs, np.append(view_map.owner(), BACKGROUND)
    row = np.flatnonzero(view_map.curves.is_contour()[curve_arcs.curve])
    curve, origin, target = (column[row] for column in (curve_arcs.curve, curve_arcs.origin, curve_arcs.target))
    begins = np.append(True, (curve[1:] != curve[:-1]) | (origin[1:] != target[:-1]))[: len(row)]
    first = np.flatnonzero(begins)
    last = np.append(first[1:], len(row))[: len(first)] - 1
    line = view_map.curves.kind[curve] == LINE
    sweep = _sweeps(view_map.arcs.take(row), line)
    arcs = view_map.arcs.take(row[first])
    spacing = max(SPACING, _width(arcs) / MOST)
    arcs = _whole_runs(arcs, view_map.arcs.take(row[last]), sweep, first, line[first])
    solid = view_map.curves.first[curve][first]
    detail = np.clip(view_map.spheres.radius / ATOM, FINEST, 1.0)[owner_of[solid]]
    length = arcs.sweep * arcs.major() / detail
    count = np.maximum(np.ceil(length / spacing).astype(np.int64), 2) + 1
    start = offsets(np.repeat(np.arange(len(first)), count), len(first))
    run = np.repeat(np.arange(len(first)), last - first + 1)
    places = _places(sweep, run, first, (count - 1) / arcs.sweep)
    run_of_arc, place_of_arc = np.full(len(curve_arcs.curve), -1), np.zeros((2, len(curve_arcs.curve)))
    run_of_arc[row], place_of_arc[:, row] = run, places
    owner, place = expand(np.zeros_like(count), count)
    offset = arcs.sweep[owner] * place / (count[owner] - 1)
    # an end stands for the half sample beside it: where balls touch, the very last arc of a horizon is often too short
    # to be seen, and has the neighbour behind it while all others have the background
    beside = arcs.sweep[owner] * np.clip(place, 0.5, count[owner] - 1.5) / (count[owner] - 1)
    behind = _behind_at(view_map.right[row], sweep, first, last, owner, beside)
    t = arcs.start[owner] + offset
    near = _nearness(view_map, view, row[first], row[last], line[first], owner, place / (count[owner] - 1))
    vertices, surface = both(
        lambda: _vertices(np.append(origin, target), np.tile(run, 2), places.ravel(), length, count - 1),
        lambda: _surfaces(view_map, view, behind, arcs, owner, t), len(owner) > BLOCK_ROWS,
    )  # fmt: skip
    jump = _jumps(view_map, near, owner_of[solid[owner]], behind, surface)
    closed = origin[first] == target[last]
    stick = np.append(np.full(len(view_map.spheres.radius), np.inf), np.repeat(view_map.sticks.radius, 2))[solid]
    return HorizonRuns(
        owner_of[solid], stick, arcs, detail, closed, *vertices, run_of_arc, place_of_arc, start, t, owner_of[behind],
        spacing, jump,
    )  # fmt: skip


def _sweeps(arcs: PlaneArcs, line: Bools) -> Floats:
    """The angles (a,) of arcs about the centres of their ellipses or, of lines, of their large circles."""
    return np.where(line, np.hypot(*(arcs.ends() - arcs.starts()).T) / STRAIGHT, arcs.sweep)


def _whole_runs(arcs: PlaneArcs, last: PlaneArcs, sweep: Floats, first: Ints, line: Bools) -> PlaneArcs:
    """Runs from the first of their arcs (m,) to the last, counter-clockwise with their solids on the left."""
    if not len(first):
        return arcs
    arcs = arcs._replace(sweep=np.add.reduceat(sweep, first))
    begin, end = arcs.starts()[line], last.ends()[line]
    half = (end - begin) / 2
    left = np.column_stack([-half[:, 1], half[:, 0]]) / np.maximum(np.hypot(*half.T), np.finfo(float).tiny)[:, None]
    arcs.c[line] = begin + half + left * np.sqrt(STRAIGHT**2 - dot(half, half))[:, None]
    arcs.u[line] = begin - arcs.c[line]
    arcs.v[line] = np.column_stack([-arcs.u[line][:, 1], arcs.u[line][:, 0]])
    arcs.start[line] = 0.0
    return arcs


def _nearness(
    view_map: VisibilityMap, view: View, first: Ints, last: Ints, line: Bools, owner: Ints, share: Floats
) -> Floats:
    """How near the samples are: all alike on a horizon, between both ends on a line."""
    arcs, projection = view_map.curve_arcs, projection_of(view)
    begin = projection.nearness(view_map.curves.at(arcs.curve[first], arcs.start[first]))
    end = projection.nearness(view_map.curves.at(arcs.curve[last], (arcs.start + arcs.sweep)[last]))
    sphere = np.where(line, 0, view_map.curves.first[arcs.curve[first]])
    whole = occluders_of(view_map.spheres, view).nearness()[sphere]
    return np.where(line[owner], begin[owner] + share * (end - begin)[owner], whole[owner])


def _places(sweep: Floats, run: Ints, first: Ints, samples: Floats) -> Floats:
    """The places (2, a) of the starts and ends of arcs that follow each other along their runs."""
    reached = np.cumsum(sweep)
    before = (reached - sweep)[first][run]
    return np.maximum(np.stack([reached - sweep - before, reached - before]), 0.0) * samples[run]


def _vertices(vertex: Ints, run: Ints, place: Floats, length: Floats, last: Ints) -> tuple[Vertices, Ints]:
    """The table of the starts of all arcs, followed by their ends, and the rows of the runs' own starts and ends."""
    place = np.minimum(place, last[run])
    along = ordered(run, place)
    near = np.diff(place[along]) * (length / last)[run[along][1:]] < NODE
    near &= run[along][1:] == run[along][:-1]
    same = np.argsort(vertex, kind="stable")
    again = vertex[same][1:] == vertex[same][:-1]
    one = np.append(along[1:][near], same[1:][again])
    other = np.append(along[:-1][near], same[:-1][again])
    node = component_labels(one, other, len(vertex))
    row_of = np.empty(len(vertex), dtype=np.int64)
    row_of[same] = np.arange(len(vertex))
    count = len(vertex) // 2
    numbers = np.arange(len(last))
    first, final = np.searchsorted(run[:count], numbers), np.searchsorted(run[:count], numbers, side="right") - 1
    place[count + final] = last  # exactly
    vertex, run = vertex[same], run[same]
    table = Vertices(vertex, run, place[same], node[same], _partners(vertex, run))
    return table, row_of[np.stack([first, count + final])]


def _partners(vertex: Ints, run: Ints) -> Ints:
    """The last row of the same vertex on another run for each row (p,), −1 where there is none."""
    begins = np.flatnonzero(np.diff(vertex, prepend=-1))
    size = np.diff(begins, append=len(vertex))
    last = np.repeat(begins + size - 1, size)
    elsewhere = run != run[last]
    other = np.where(elsewhere, np.arange(len(run)), -1)
    return np.where(elsewhere, last, np.repeat(np.maximum.reduceat(other, begins), size) if len(begins) else other)


def _width(arcs: PlaneArcs) -> float:
    """The larger side of the box around whole ellipses."""
    half = arcs.half_extent()
    return float(np.max(np.max(arcs.c + half, axis=0, initial=0.0) - np.min(arcs.c - half, axis=0, initial=0.0)))


def _behind_at(right: Ints, sweep: Floats, first: Ints, last: Ints, owner: Ints, offset: Floats) -> Ints:
    """The face on the right of the arc of its run on which each sample lies."""
    reached = np.cumsum(sweep)
    begin = (reached - sweep)[first]
    place = np.searchsorted(reached, begin[owner] + offset)
    return right[np.clip(place, first[owner], last[owner])]


def _surfaces(view_map: VisibilityMap, view: View, behind: Ints, arcs: PlaneArcs, owner: Ints, t: Floats) -> Floats:
    """How near the solids behind samples (s,) are there, in blocks, shared by threads; of BACKGROUND any number."""
    solids, projection = Solids(occluders_of(view_map.spheres, view), view_map.sticks), projection_of(view)
    row = solids.rows(np.maximum(behind, 0))

    def surfaces_in(block: slice) -> Floats:
        return solids.surfaces(row[block], arcs.take(owner[block]).at(t[block]), projection)[0]

    return np.concatenate([*in_threads(surfaces_in, blocks(np.ones_like(row), BLOCK_ROWS)), np.empty(0)])


def _jumps(view_map: VisibilityMap, near: Floats, own: Ints, behind: Ints, surface: Floats) -> Floats:
    jump = np.maximum(near - surface, 0.0)  # rounding beside a silhouette of the surface: −∞
    own_radius = view_map.spheres.radius[own]
    return np.where(behind == BACKGROUND, np.inf, np.where(np.isfinite(jump), jump, own_radius))
