"""Ink: how wide lines along horizons are, and where they are in which ink.

A line is the heavier the farther the surface behind it lies, and the heaviest before the background; where both sides
are nearly level it ends in a point. Widths never jump: where what lies behind changes at once, the heavier line fades
into the lighter one; no line is wider at its
end than another one that it meets there.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.rows import blocks
from molviz.threads import both, in_threads
from molviz.visibility.horizon_runs import HorizonRuns
from molviz.visibility.map import BACKGROUND

BLOCK_SAMPLES = 1 << 15  # at a time: their columns stay in cache
SIGMA = 0.2  # ångström, of the smoothing of widths along a line
LEVEL = 0.15  # ångström for which a line keeps its width where a lighter one takes over
FADE = 0.9  # ångström in which it would then fade to nothing
SIGMA_INK = 0.2  # ångström, of the smoothing of where the dark ink is used
INK_GAP = 2.0  # ångström: shorter stretches of a thing's own ink between dark ones are dark
INK_BEYOND = 0.4  # ångström by which the dark ink goes on beyond where it is due
THINNEST = 0.035  # ångström: a thinner line is not drawn
THINNEST_SHARE = 0.13  # of the widest inner line
CORNER = 0.8  # ångström before it enters a ball in which a line ends where another passes under it
SPUR = 1.1  # ångström: shorter lines are dropped if they are thin or meet no other
THINNER = 0.4  # of a line's width: it is not made so thin where another one ends with it
STUB = 0.5  # ångström: shorter lines are dropped unless they meet two others
SPUR_SHARE = 0.4  # of the widest inner line: such lines are thin
WIDEST_SHARE = 0.5  # ångström times the detail: no line is wider, nor than its stick is thick, lest it hide these
FARTHER_THINNER = 0.3  # by which lines of the farthest spheres are thinner


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
    """Along the samples of runs: width in ångström, 0 where nothing is drawn, and how much of it the dark ink takes."""

    width: Floats  # (s,)
    dark: Floats  # (s,) from 0 to 1
    ends: Ints  # (2, m) rows of the runs' vertices between which they have ink


def smooth_step(x: Floats) -> Floats:
    """Return ``x² (3 − 2 x)`` of x clipped to [0, 1]."""
    x = np.clip(x, 0.0, 1.0)
    return np.asarray(x * x * (3.0 - 2.0 * x))


def line_widths(
    runs: HorizonRuns, group: Ints, far: Floats, style: InkStyle, scale: float, crease: float = 0.0
) -> Widths:
    """Return the widths along runs; ``group`` (n,) tells which spheres belong together, ``far`` (n,) how far they are.

    ``far`` runs from 0 for the nearest sphere to 1 for the farthest. Lines before another group that end where a ball
    begins end as wide as the ``crease``, in ångström, that goes on there.
    """
    own = runs.sphere[runs.owner()]
    background = runs.behind == BACKGROUND
    foreign = ~background & (group[runs.behind] != group[own])
    silhouette, between, inside = (pen.at(scale) for pen in (style.silhouette, style.between, style.inside))
    ramp = smooth_step((runs.jump - style.faint) / (style.full - style.faint))
    width = np.where(background, silhouette, np.where(foreign, between * (0.5 + 0.5 * ramp), inside * ramp))
    widest = np.minimum(WIDEST_SHARE * runs.detail, runs.stick)
    width = np.minimum(width, widest[runs.owner()])
    width = _smoothed(_fading(width * (1.0 - FARTHER_THINNER * far[own]), runs), runs, SIGMA)
    thinnest = max(THINNEST, THINNEST_SHARE * inside)

    def ending() -> tuple[Floats, Ints]:
        width[width < thinnest] = 0.0
        width[_spurs(runs, width, SPUR_SHARE * np.minimum(inside, widest), foreign & (crease > 0))] = 0.0
        entering, ends = _entering(width, runs, np.where(foreign, crease, 0.0))
        entering[entering < thinnest] = 0.0
        return _joining(entering, runs, ends), ends

    dark, (joining, ends) = both(
        lambda: _dark_share(background | foreign, runs), ending, len(width) > BLOCK_SAMPLES
    )
    return Widths(joining, dark, ends)


def _by_blocks(runs: HorizonRuns, values_in: Callable[[slice], Floats]) -> Floats:
    """The values of all samples (s,), found in blocks of runs that stay in cache, shared by threads."""
    found = in_threads(values_in, blocks(np.diff(runs.start), BLOCK_SAMPLES))
    return np.concatenate([*found, np.empty(0)])


def _along(runs: HorizonRuns, block: slice, reach: float) -> Iterator[tuple[float, Ints]]:
    """Distances of up to ``reach`` ångström both ways, and the samples so far from each of those of a block of runs.

    Closed runs go all round; ends count as if they went on.
    """
    start, size = runs.start[block], np.diff(runs.start)[block]
    begin, count = np.repeat(start, size), np.repeat(size, size)
    closed, place = np.flatnonzero(np.repeat(runs.closed[block], size)), np.arange(len(begin)) + start[0] - begin
    last = count - 1
    steps = int(np.ceil(reach / runs.spacing))
    for step in range(-steps, steps + 1):
        other = np.minimum(np.maximum(place + step, 0), last)
        other[closed] = np.mod(place[closed] + step, last[closed])  # the last sample of a closed run is the first
        yield abs(step) * runs.spacing, begin + other


def _smoothed(values: Floats, runs: HorizonRuns, sigma: float) -> Floats:
    """Gaussian means along each run."""

    def means(block: slice) -> Floats:
        total, weights = np.zeros(runs.start[block.stop] - runs.start[block.start]), 0.0
        for distance, other in _along(runs, block, 3 * sigma):
            weight = np.exp(-0.5 * (distance / sigma) ** 2)
            total += weight * values[other]
            weights += weight
        return np.asarray(total / weights)

    return _by_blocks(runs, means)


def _fading(width: Floats, runs: HorizonRuns) -> Floats:
    """The widths, and beside heavier stretches what is left of these: ``max w (1 + (LEVEL − distance) / FADE)``."""

    def heaviest(block: slice) -> Floats:
        most = width[runs.start[block.start] : runs.start[block.stop]].copy()
        for distance, other in _along(runs, block, LEVEL + FADE):
            np.maximum(most, width[other] * min(1.0, 1.0 + (LEVEL - distance) / FADE), out=most)
        return most

    return _by_blocks(runs, heaviest)


def _largest(values: Floats, runs: HorizonRuns, reach: float) -> Floats:
    """The largest value within ``reach`` ångström along each run."""

    def largest(block: slice) -> Floats:
        most = values[runs.start[block.start] : runs.start[block.stop]].copy()
        for _, other in _along(runs, block, reach):
            np.maximum(most, values[other], out=most)
        return most

    return _by_blocks(runs, largest)


def _dark_share(due: Bools, runs: HorizonRuns) -> Floats:
    """How much of a line's width the dark ink takes: all of it where it is due and a little beyond, then less."""
    closed = -_largest(-_largest(due.astype(float), runs, INK_GAP / 2), runs, INK_GAP / 2 - INK_BEYOND)
    return _smoothed(closed, runs, SIGMA_INK)


def distances_from_ends(runs: HorizonRuns) -> tuple[Floats, Floats]:
    """Return how far along its run each sample (s,) is from the start and from the end, in ångström."""
    owner = runs.owner()
    place, last = np.arange(len(owner)) - runs.start[owner], (np.diff(runs.start) - 1)[owner]
    step = runs.length()[owner] / last
    return place * step, (last - place) * step


def _edges(runs: HorizonRuns) -> tuple[Ints, Ints]:
    """The first and the last sample of each run."""
    return runs.start[:-1], runs.start[1:] - 1


def _entering(width: Floats, runs: HorizonRuns, least: Floats) -> tuple[Floats, Ints]:
    """The widths, fading to ``least`` (s,) where horizons enter balls, and the vertices' rows (2, m) where lines end.

    A line that enters a ball just after another has passed under it makes a corner with that one: it ends there, as
    wide as it is, unless it goes on beyond as a line and then as a crease.
    """
    owner, ends, width = runs.owner(), runs.ends.copy(), width.copy()
    wide = np.flatnonzero(least > 0)
    for end, distance in enumerate(distances_from_ends(runs)):
        row, away = _last_vertices(width, runs, end)
        met = np.where(away < np.inf, widest_other(width, runs, row) > 0, True)
        enters = ~runs.closed & (runs.vertices.partner[runs.ends[end]] < 0)
        goes_on = np.zeros(len(away), dtype=bool)
        goes_on[owner[wide[distance[wide] < away[owner[wide]]]]] = True
        corner = enters & met & (away < CORNER) & ~goes_on
        ends[end] = np.where(corner, row, ends[end])
        reach = np.where(met, np.minimum(away, FADE), FADE)
        fades = np.flatnonzero((enters & ~corner)[owner])
        fades = fades[(distance[fades] < reach[owner[fades]]) & (width[fades] > least[fades])]
        share = distance[fades] / reach[owner[fades]]
        width[fades] = least[fades] + (width[fades] - least[fades]) * share
    return width, ends


def _last_vertices(width: Floats, runs: HorizonRuns, end: int) -> tuple[Ints, Floats]:
    """The row of the last vertex before the start (``end`` 0) or end (1) of each run, and ångström from there.

    Within reach of a corner those count first in which a drawn line ends. Infinite, and the end itself, where there is
    none.
    """
    vertices, last = runs.vertices, runs.last()
    is_end: Bools = np.zeros(len(vertices.run), dtype=bool)
    is_end[runs.ends] = True
    inner = np.flatnonzero(~is_end)
    run, place = vertices.run[inner], vertices.place[inner]
    distance = np.abs(end * last[run] - place) * (runs.length() / last)[run]
    partner = vertices.partner[inner]
    meets = (partner >= 0) & (at_places(width, runs, vertices.run[partner], vertices.place[partner]) > 0)
    first = meets & (distance < CORNER)
    nearest, away = np.full((2, len(last)), np.inf)
    np.minimum.at(nearest, run[first], distance[first])
    np.minimum.at(away, run, distance)
    away = np.where(nearest < np.inf, nearest, away)
    found = (distance == away[run]) & (first | (nearest == np.inf)[run])
    row = runs.ends[end].copy()
    row[run[found]] = inner[found]
    return row, away


def at_places(values: Floats, runs: HorizonRuns, run: Ints, place: Floats) -> Floats:
    """Return the values of samples (s,) between samples: at places (q,), fractional counts from the runs' starts.

    Places beyond the end of a closed run lie in its next turn.
    """
    last = (np.diff(runs.start) - 1)[run]
    place = np.where(runs.closed[run], np.mod(place, last), np.clip(place, 0, last))
    low = np.minimum(place.astype(np.int64), last - 1)
    share, begin = place - low, runs.start[run]
    return np.asarray(values[begin + low] * (1 - share) + values[begin + low + 1] * share)


def widest_other(width: Floats, runs: HorizonRuns, row: Ints) -> Floats:
    """Return the width of the widest line at the nodes of the given vertices' rows (…), their own runs left out."""
    vertices = runs.vertices
    here = at_places(width, runs, vertices.run, vertices.place)
    best, second, widest = np.full(len(here), -1), np.zeros(len(here)), np.zeros(len(here))
    np.maximum.at(widest, vertices.node, here)
    rows = np.flatnonzero(here == widest[vertices.node])
    best[vertices.node[rows]] = vertices.run[rows]  # by node; the last one written, where two are the widest
    other = np.flatnonzero(vertices.run != best[vertices.node])
    np.maximum.at(second, vertices.node[other], here[other])
    node = vertices.node[row]
    return np.where(best[node] == vertices.run[row], second[node], widest[node])


def _joining(width: Floats, runs: HorizonRuns, ends: Ints) -> Floats:
    """The widths, less towards ``ends`` where the other line there is thinner; points where there is none.

    Where that line is much thinner, and for silhouettes, which go on across nodes, the widest one of the node counts.
    """
    owner, eased = runs.owner(), width.copy()
    from_start, _ = distances_from_ends(runs)
    for row, edge, widest in zip(ends, _edges(runs), widest_other(width, runs, ends), strict=True):
        there = runs.vertices.place[row] * runs.length() / runs.last()
        distance = np.abs(from_start - there[owner])
        own = at_places(width, runs, runs.vertices.run[row], runs.vertices.place[row])
        partner = runs.vertices.partner[row]
        other = at_places(width, runs, runs.vertices.run[partner], runs.vertices.place[partner])
        silhouette = runs.behind[edge] == BACKGROUND
        other = np.where((other > THINNER * own) & ~silhouette, other, widest)
        share = np.minimum(other / np.where(own > 0, own, 1.0), 1.0)
        joins = ~runs.closed & (own > 0) & (partner >= 0)
        close = np.where(joins[owner], 1.0 - smooth_step(distance / FADE), 0.0)
        eased *= 1.0 - (1.0 - share[owner]) * close
    return eased


def _spurs(runs: HorizonRuns, width: Floats, thin: Floats, goes_on: Bools) -> Bools:
    """Which samples belong to stretches of line that are short, and thin or without another line at either end.

    Thinner than ``thin`` (m,) is thin. None is a spur of which a part (s,) ``goes_on`` as a crease where its run ends.
    """
    owner, drawn = runs.owner(), width > 0
    first = np.flatnonzero(drawn & ~np.append(False, drawn[:-1] & (owner[1:] == owner[:-1]))[: len(drawn)])
    last = np.flatnonzero(drawn & ~np.append(drawn[1:] & (owner[1:] == owner[:-1]), False)[: len(drawn)])
    run = owner[first]
    length = runs.length()[run] * (last - first) / (np.diff(runs.start)[run] - 1)
    joins = widest_other(width, runs, runs.ends[:, run]) > 0
    joins &= np.stack([first, last]) == np.stack(_edges(runs))[:, run]
    meets = joins[0].astype(int) + joins[1] + _met_by_others(runs, width, first, last)
    size = np.maximum.reduceat(width, first) if len(first) else np.empty(0)
    spur = (length < SPUR) & ~runs.closed[run] & ((size < thin[run]) | (meets == 0) | ((length < STUB) & (meets < 2)))
    if len(first):
        spur &= ~np.logical_or.reduceat(goes_on, first)
    of_stretch = np.cumsum(np.bincount(first, minlength=len(drawn))) - 1
    return np.asarray(drawn & (spur[of_stretch] if len(spur) else False))


def _met_by_others(runs: HorizonRuns, width: Floats, first: Ints, last: Ints) -> Bools:
    """Under which stretches, samples ``first`` to ``last``, drawn lines end."""
    under = []
    for ends, edge in zip(runs.ends, _edges(runs), strict=True):
        row = runs.vertices.partner[ends[(width[edge] > 0) & ~runs.closed]]
        under.append((runs.start[runs.vertices.run[row]] + runs.vertices.place[row])[row >= 0])
    at = np.sort(np.concatenate(under))
    return np.asarray(np.searchsorted(at, last, side="right") > np.searchsorted(at, first))
