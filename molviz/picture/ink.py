"""Ink: lines of varying width along horizons, as filled shapes bounded by arcs of circles.

A line is the heavier the farther the surface behind it lies, and the heaviest before the background; where both sides
are nearly level it ends in a point. Where a line passes under the horizon of a nearer sphere, or enters another's ball,
its two sides end on that sphere's horizon.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.curves import Paths, PlaneArcs, straight_pieces
from molviz.geometry.rows import expand, lists_taken, offsets
from molviz.vectors import cross, dot
from molviz.visibility.horizon_runs import HorizonRuns
from molviz.visibility.map import BACKGROUND

OUTSIDE = 0.6  # of the width lies outside the horizon
SIGMA = 0.35  # ångström, of the smoothing of widths along a line
SIGMA_INK = 0.5  # ångström, of the smoothing of where which ink is used
SHORTEST_INK = 1.0  # ångström: a line changes its ink for no less
THINNEST = 0.035  # ångström: a thinner line is not drawn
THINNEST_SHARE = 0.13  # of the widest inner line
ARC = 7.5  # samples along a line's side that one arc of a circle stands for: 1.5 Å unless giants are drawn
LONGEST_CUT = 1.2  # ångström by which a side may be cut
LONGEST_TIP = 4.0  # of its distance from the horizon, by which a side may be prolonged: longer tips are thorns
SPUR = 1.1  # ångström: shorter lines are dropped unless both ends are wide
SPUR_SHARE = 0.4  # of the widest inner line
FARTHER_THINNER = 0.3  # by which lines of the farthest spheres are thinner
NOTHING = 1e-9  # square ångström: a stroke of less ink is none
MITRE_STEPS = 6  # of Newton's method, from a guess within a width of the end


@dataclass(frozen=True)
class Pen:
    """The widest line of one kind: ångström, but not more than points of the page."""

    angstrom: float
    points: float

    def at(self, scale: float) -> float:
        """Return the width in ångström in a drawing of ``scale`` points per ångström."""
        return min(self.angstrom, self.points / scale)

    def times(self, factor: float) -> "Pen":
        """Return a pen that is so many times as wide."""
        return Pen(self.angstrom * factor, self.points * factor)


@dataclass(frozen=True)
class InkStyle:
    """Pens before the background, before another chain and inside a chain.

    ``faint`` and ``full`` are the jumps in ångström at which inner lines begin and at which they are full.
    """

    silhouette: Pen
    between: Pen
    inside: Pen
    faint: float
    full: float

    def scaled_to(self, points: float | None, scale: float) -> "InkStyle":
        """Return the style with silhouettes of so many points and all other pens in proportion; itself for None."""
        usual = self.silhouette.at(scale) * scale
        if points is None or not usual:
            return self
        factor = points / usual
        silhouette, between, inside = (pen.times(factor) for pen in (self.silhouette, self.between, self.inside))
        return InkStyle(silhouette, between, inside, self.faint, self.full)


class Widths(NamedTuple):
    """Along the samples of runs: width in ångström, 0 where nothing is drawn, and whether the dark ink is used."""

    width: Floats  # (s,)
    dark: Bools  # (s,)


def smooth_step(x: Floats) -> Floats:
    """Return ``x² (3 − 2 x)`` of x clipped to [0, 1]."""
    x = np.clip(x, 0.0, 1.0)
    return np.asarray(x * x * (3.0 - 2.0 * x))


def line_widths(runs: HorizonRuns, group: Ints, far: Floats, style: InkStyle, scale: float) -> Widths:
    """Return the widths along runs; ``group`` (n,) tells which spheres belong together, ``far`` (n,) how far they are.

    ``far`` runs from 0 for the nearest sphere to 1 for the farthest.
    """
    owner = runs.owner()
    own = runs.sphere[owner]
    background = runs.behind == BACKGROUND
    foreign = ~background & (group[runs.behind] != group[own])
    silhouette, between, inside = (pen.at(scale) for pen in (style.silhouette, style.between, style.inside))
    ramp = smooth_step((runs.jump - style.faint) / (style.full - style.faint))
    width = np.where(background, silhouette, np.where(foreign, between * (0.5 + 0.5 * ramp), inside * ramp))
    width = _smoothed(width * (1.0 - FARTHER_THINNER * far[own]), runs, SIGMA)
    dark = _without_short(_smoothed((background | foreign).astype(float), runs, SIGMA_INK) > 0.5, runs)
    width[width < max(THINNEST, THINNEST_SHARE * inside)] = 0.0
    width[_spurs(runs, width, SPUR_SHARE * inside)[owner]] = 0.0
    return Widths(width, dark)


def _without_short(dark: Bools, runs: HorizonRuns) -> Bools:
    """The inks along runs; stretches of one ink below SHORTEST_INK, and below those beside them, take on their ink."""
    owner = runs.owner()
    begins = np.append(True, (owner[1:] != owner[:-1]) | (dark[1:] != dark[:-1]))[: len(dark)]
    first = np.flatnonzero(begins)
    run, length = owner[first], np.diff(np.append(first, len(dark))) * runs.spacing
    after = np.append(np.where(run[1:] == run[:-1], length[1:], np.nan), np.nan)[: len(first)]
    before = np.append(np.nan, np.where(run[1:] == run[:-1], length[:-1], np.nan))[: len(first)]
    longer = ~(before <= length) & ~(after <= length) & ~(np.isnan(before) & np.isnan(after))
    return np.asarray(dark ^ ((length < SHORTEST_INK) & longer)[np.cumsum(begins) - 1])


def _smoothed(values: Floats, runs: HorizonRuns, sigma: float) -> Floats:
    """Gaussian means along each run, closed ones all round; ends count as if they went on."""
    owner = runs.owner()
    place = np.arange(len(values)) - runs.start[owner]
    count = np.diff(runs.start)[owner]
    reach = int(np.ceil(3 * sigma / runs.spacing))
    total, weights = np.zeros(len(values)), 0.0
    for step in range(-reach, reach + 1):
        weight = np.exp(-0.5 * (step * runs.spacing / sigma) ** 2)
        wrapped = np.mod(place + step, np.maximum(count - 1, 1))  # the last sample of a closed run is the first
        other = np.where(runs.closed[owner], wrapped, np.clip(place + step, 0, count - 1))
        total += weight * values[runs.start[owner] + other]
        weights += weight
    return np.asarray(total / weights)


def _spurs(runs: HorizonRuns, width: Floats, thin: float) -> Bools:
    """Which open runs are short and thin at one end."""
    ends = np.minimum(width[runs.start[:-1]], width[runs.start[1:] - 1])
    return ~runs.closed & (runs.length() < SPUR) & (ends < thin)


class Strokes(NamedTuple):
    """Stretches of runs that are drawn in one ink, from parameter ``first`` to ``last``."""

    run: Ints  # (k,)
    first: Floats  # (k,) samples, fractional counts from the run's start
    last: Floats  # (k,)
    dark: Bools  # (k,)
    at_start: Bools  # (k,) begins where the run begins
    at_end: Bools  # (k,)
    whole: Bools  # (k,) a closed run altogether

    def take(self, rows: Ints) -> "Strokes":
        """Return the given rows, in that order."""
        ends = self.at_start[rows], self.at_end[rows]
        return Strokes(self.run[rows], self.first[rows], self.last[rows], self.dark[rows], *ends, self.whole[rows])


def strokes_of(runs: HorizonRuns, widths: Widths) -> Strokes:
    """Return the stretches of positive width and one ink; they end in a point where the width vanishes."""
    owner = runs.owner()
    drawn = widths.width > 0
    state = np.where(drawn, 1 + widths.dark, 0)
    joined = np.append(False, (owner[1:] == owner[:-1]) & (state[1:] == state[:-1]))
    first = np.flatnonzero(~joined & drawn)
    last = np.flatnonzero(~np.append(joined[1:], False) & drawn)
    run = owner[first]
    begin, end = runs.start[run], runs.start[run + 1] - 1
    at_start, at_end = first == begin, last == end
    # one sample farther: the point in which the line ends, or the place where the other ink takes over
    beyond = np.minimum(last + 1, len(drawn) - 1)
    low = (first - begin).astype(float) - np.where(at_start, 0.0, np.where(drawn[first - 1], 0.5, 1.0))
    high = (last - begin).astype(float) + np.where(at_end, 0.0, np.where(drawn[beyond], 0.5, 1.0))
    closed = runs.closed[run]
    whole = closed & at_start & at_end
    return Strokes(run, low, high, widths.dark[first], at_start & ~closed, at_end & ~closed, whole)


def outlined(runs: HorizonRuns, widths: Widths, strokes: Strokes) -> tuple[Strokes, Paths]:
    """Return one shape of one loop per stroke, the ink inside: arcs through three points of either side each.

    Strokes of which the cuts at their two ends leave nothing are left out.
    """
    pieces = np.maximum(np.ceil((strokes.last - strokes.first) / ARC).astype(np.int64), 1)
    owner, place = expand(np.zeros_like(pieces), 2 * pieces + 1)
    share = place / (2 * pieces[owner])
    sample = strokes.first[owner] + share * (strokes.last - strokes.first)[owner]
    run = strokes.run[owner]
    width = _interpolated(widths.width, runs.start[run], sample, runs.start[run + 1] - 1)
    last_sample = np.diff(runs.start) - 1
    t = runs.arcs.start[run] + runs.arcs.sweep[run] * sample / last_sample[run]
    sides = [
        _mitred(runs, strokes, owner, place, pieces, t, offset)
        for offset in (OUTSIDE * width, (OUTSIDE - 1.0) * width)
    ]
    return _with_ink(strokes, _loops(strokes, runs, pieces, owner, place, sides[0], sides[1]))


def _with_ink(strokes: Strokes, paths: Paths) -> tuple[Strokes, Paths]:
    """The strokes and shapes with ink inside: where a cut reaches across the other end, a shape is inside out."""
    area = np.add.reduceat(paths.arcs.signed_area(), paths.loop_start[:-1])[paths.shape_start[:-1]]
    kept = np.flatnonzero(area > NOTHING)
    return strokes.take(kept), _shapes_taken(paths, kept)


def _shapes_taken(paths: Paths, shapes: Ints) -> Paths:
    loop, shape_start = lists_taken(paths.shape_start, shapes)
    arc, loop_start = lists_taken(paths.loop_start, loop)
    return Paths(paths.arcs.take(arc), loop_start, shape_start)


def _interpolated(values: Floats, begin: Ints, sample: Floats, end: Ints) -> Floats:
    low = np.floor(sample).astype(np.int64)
    share = sample - low
    return np.asarray(values[begin + low] * (1 - share) + values[np.minimum(begin + low + 1, end)] * share)


def _beside(arcs: PlaneArcs, t: Floats, offset: Floats) -> Floats:
    """Points beside curves, ``offset`` outwards: on the right of the way."""
    tangent = arcs.tangent(t)
    normal = np.column_stack([tangent[:, 1], -tangent[:, 0]]) / np.hypot(*tangent.T)[:, None]
    return np.asarray(arcs.at(t) + offset[:, None] * normal)


def _mitred(
    runs: HorizonRuns, strokes: Strokes, owner: Ints, place: Ints, pieces: Ints, t: Floats, offset: Floats
) -> Floats:
    """The points of one side of all strokes; at ends of runs the last points lie on the horizon of the sphere there."""
    run = strokes.run[owner]
    arcs = runs.arcs.take(run)
    shift = np.zeros(len(t))
    for at_end, host, end_place, onward in (
        (strokes.at_start, runs.before, np.zeros_like(pieces), -1.0),
        (strokes.at_end, runs.after, 2 * pieces, 1.0),
    ):
        last = np.flatnonzero((place == end_place[owner]) & at_end[owner] & (host[run] >= 0))
        moved = _to_horizon(runs, arcs.take(last), host[run[last]], t[last], offset[last], onward)
        # the points of the last arc follow: half of the way for the one in the middle
        shift[last] += moved
        shift[last + np.where(end_place[owner[last]] == 0, 1, -1)] += moved / 2
    return _beside(arcs, _forwards(t, shift, owner, pieces), offset)


def _forwards(t: Floats, shift: Floats, owner: Ints, pieces: Ints) -> Floats:
    """The shifted parameters; where the cuts at the two ends of a short side pass each other it is one point."""
    last = np.cumsum(2 * pieces + 1) - 1
    first = last - 2 * pieces
    begin, end = (t + shift)[first], (t + shift)[last]
    point = np.where(shift[last] == 0, end, np.where(shift[first] == 0, begin, (begin + end) / 2))
    return np.asarray(np.where((end < begin)[owner], point[owner], t + shift))


def _to_horizon(
    runs: HorizonRuns, arcs: PlaneArcs, host: Ints, t: Floats, offset: Floats, onward: float
) -> Floats:
    """By how much each end must move along its curve to lie on the image of the host's horizon; 0 if that is far.

    ``onward`` is the direction, 1 or −1, in which lines go on beyond these ends.
    """
    ellipse = runs.horizons.take(host)
    size, step = arcs.major(), np.zeros(len(t))
    cut, tip = -onward * LONGEST_CUT / size, onward * LONGEST_TIP * np.abs(offset) / size
    low, high = np.minimum(cut, tip), np.maximum(cut, tip)
    for _ in range(MITRE_STEPS):
        value, slope = _inside(ellipse, arcs, t + step, offset)
        step = step - np.where(np.abs(slope) > 1e-9, value / np.where(slope == 0, 1.0, slope), 0.0)
        step = np.clip(step, low, high)
    value, _ = _inside(ellipse, arcs, t + step, offset)
    return np.asarray(np.where(np.abs(value) < 1e-6, step, 0.0))


def _inside(ellipse: PlaneArcs, arcs: PlaneArcs, t: Floats, offset: Floats) -> tuple[Floats, Floats]:
    """``(p×v / u×v)² + (u×p / u×v)² − 1`` at the offset points relative to the ellipses, and its slope along t."""
    tangent = arcs.tangent(t)
    size = np.hypot(*tangent.T)
    p = _beside(arcs, t, offset) - ellipse.c
    direction = tangent * (1 + offset / size)[:, None]
    area = cross(ellipse.u, ellipse.v)
    x, y = cross(p, ellipse.v) / area, cross(ellipse.u, p) / area
    dx, dy = cross(direction, ellipse.v) / area, cross(ellipse.u, direction) / area
    return x * x + y * y - 1.0, 2 * (x * dx + y * dy)


def _loops(
    strokes: Strokes, runs: HorizonRuns, pieces: Ints, owner: Ints, place: Ints, outer: Floats, inner: Floats
) -> Paths:
    """Outer side forwards, cap, inner side backwards, cap; two loops where the stroke is a ring."""
    first = np.cumsum(2 * pieces + 1) - (2 * pieces + 1)
    arc_owner, arc_place = expand(np.zeros_like(pieces), pieces)
    row = first[arc_owner] + 2 * arc_place
    forwards = arcs_through(outer[row], outer[row + 1], outer[row + 2])
    backwards = arcs_through(inner[row + 2], inner[row + 1], inner[row])
    last = first + 2 * pieces
    end_cap, start_cap = straight_pieces(outer[last], inner[last]), straight_pieces(inner[first], outer[first])
    loop = np.concatenate([arc_owner, np.arange(len(pieces)), arc_owner, np.arange(len(pieces))])
    part = np.repeat([0, 1, 2, 3], [len(arc_owner), len(pieces), len(arc_owner), len(pieces)])
    along = np.concatenate([arc_place, np.zeros(len(pieces)), -arc_place, np.zeros(len(pieces))])
    everything = PlaneArcs(*map(np.concatenate, zip(forwards, end_cap, backwards, start_cap, strict=True)))
    ring = strokes.whole[loop]
    keep = ~(ring & (part % 2 == 1))
    number = 2 * loop + (ring & (part == 2))
    order = np.lexsort((along, part, number))
    order = order[keep[order]]
    _, loop_first = np.unique(number[order], return_index=True)
    loop_start = np.append(loop_first, len(order))
    shape_start = offsets(loop[order][loop_first], len(pieces))
    return Paths(everything.take(order), loop_start, shape_start)


def arcs_through(start: Floats, middle: Floats, end: Floats) -> PlaneArcs:
    """Return the arcs of circles through three points each, straight where these are nearly in a line."""
    a, b = middle - start, end - start
    area, size = 2 * cross(a, b), dot(b, b)
    flat = np.abs(area) <= 1e-6 * np.maximum(size, dot(a, a))
    aa, divisor = dot(a, a), np.where(flat, 1.0, area)
    center = np.column_stack([b[:, 1] * aa - a[:, 1] * size, a[:, 0] * size - b[:, 0] * aa]) / divisor[:, None]
    u = -center
    v = np.column_stack([-u[:, 1], u[:, 0]])
    to_end = b - center
    angle = np.mod(np.arctan2(dot(v, to_end), dot(u, to_end)), 2 * np.pi)
    sweep = np.where(area > 0, angle, angle - 2 * np.pi)
    line = straight_pieces(start, end)
    pick = flat[:, None]
    return PlaneArcs(
        np.where(pick, line.c, start + center), np.where(pick, line.u, u), np.where(pick, line.v, v),
        np.where(flat, line.start, 0.0), np.where(flat, line.sweep, sweep),
    )  # fmt: skip


def in_colors(paths: Paths, color: Ints) -> tuple[Paths, Ints]:
    """Return shapes of equal rows of ``color`` (k, c) as one shape each, and the distinct rows, ascending."""
    distinct, number = np.unique(color, axis=0, return_inverse=True)
    taken = _shapes_taken(paths, np.argsort(number.ravel(), kind="stable"))
    last = np.cumsum(np.bincount(number.ravel(), minlength=len(distinct)))
    return taken._replace(shape_start=taken.shape_start[np.append(0, last)]), distinct
