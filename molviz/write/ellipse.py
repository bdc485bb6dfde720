"""Numerics that the writers share: axes of ellipses, straight pieces, cubic Béziers."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.curves import Paths, PlaneArcs
from molviz.vectors import cross, dot

THIN = 0.005  # points: an ellipse with a smaller half-axis cannot be told from a straight piece on any page
FLAT = 0.01  # points: an arc that leaves its chord by less is the chord, as rounding moves its ends as far
BEZIER_ERROR = 1e-3  # points: how far a cubic may stray from its arc


class AxisArcs(NamedTuple):
    """k arcs on the axes of their ellipses: ``center + R(rotation) (major cos t, minor sin t)``.

    t is right-handed (from the first coordinate axis towards the second) and runs from ``start`` through ``sweep``.
    """

    center: Floats  # (k, 2)
    major: Floats  # (k,)
    minor: Floats  # (k,)
    rotation: Floats  # (k,) radians in [−π/2, π/2]
    start: Floats  # (k,) radians
    sweep: Floats  # (k,) radians in [−2π, 2π]


def major_vertex(arcs: PlaneArcs) -> Floats:
    """Return the parameter (k,) of a vertex on the major axis.

    ``|u cos t + v sin t|²`` is largest at ``tan 2t = 2 u·v / (u² − v²)`` (Rytz's problem in closed form).
    """
    uv, uu, vv = (dot(*pair) for pair in ((arcs.u, arcs.v), (arcs.u, arcs.u), (arcs.v, arcs.v)))
    return np.asarray(0.5 * np.arctan2(2 * uv, uu - vv))


def on_axes(arcs: PlaneArcs) -> AxisArcs:
    """Return the same arcs on the axes of their ellipses."""
    vertex = major_vertex(arcs)
    cos, sin = np.cos(vertex)[:, None], np.sin(vertex)[:, None]
    p, q = arcs.u * cos + arcs.v * sin, arcs.v * cos - arcs.u * sin
    hand = np.where(cross(p, q) < 0, -1.0, 1.0)
    turned = np.where(p[:, 0] < 0, -1.0, 1.0)  # the other vertex, half a turn on, keeps the rotation short
    rotation = np.arctan2(turned * p[:, 1], turned * p[:, 0])
    start = hand * (arcs.start - vertex) + np.where(turned < 0, np.pi, 0.0)
    return AxisArcs(arcs.c, np.hypot(*p.T), np.hypot(*q.T), rotation, start, hand * arcs.sweep)


def with_pieces(paths: Paths, owner: Ints, start: Floats, sweep: Floats) -> Paths:
    """Return the paths whose arcs are pieces of the old ones; ``owner`` (ascending) is the old row of each piece."""
    arcs = paths.arcs.split(owner, start, sweep)
    return paths._replace(arcs=arcs, loop_start=np.searchsorted(owner, paths.loop_start))


def in_equal_pieces(paths: Paths, count: Ints) -> Paths:
    """Return the paths with arc k cut in ``count[k]`` pieces of equal sweep."""
    owner = np.repeat(np.arange(len(count)), count)
    sweep = (paths.arcs.sweep / count)[owner]
    position = np.arange(len(owner)) - (np.cumsum(count) - count)[owner]
    return with_pieces(paths, owner, paths.arcs.start[owner] + position * sweep, sweep)


def flat(arcs: PlaneArcs) -> Bools:
    """Return which arcs (k,) run along their chords, never backwards, and hardly leave them."""
    (start, first), (end, last) = (arcs.at_with_tangent(t) for t in (arcs.start, arcs.stop()))
    middle, chord = arcs.at(arcs.middle()), end - start
    length = np.hypot(*chord.T)
    with np.errstate(divide="ignore", invalid="ignore"):
        beside = np.abs(cross(chord, middle - start)) / length
    onward = np.ones(len(length), dtype=bool)
    for tangent in (first, last):
        onward &= dot(tangent * np.sign(arcs.sweep)[:, None], chord) > 0
    return np.asarray((beside < FLAT) & onward & (np.abs(arcs.sweep) < np.pi))


def with_straight_pieces(paths: Paths) -> tuple[Paths, Bools]:
    """Return the paths with every thin arc cut where it turns, and which arcs (k,) are straight: those and flat ones.

    A thin ellipse turns at the two ends of its major axis, half a turn apart.
    """
    arcs, axes = paths.arcs, on_axes(paths.arcs)
    thin, length = axes.minor < THIN, np.abs(arcs.sweep)
    if not thin.any():
        return paths, flat(arcs)
    first = np.mod(np.sign(arcs.sweep) * (major_vertex(arcs) - arcs.start), np.pi)
    inner = np.where(thin[:, None], np.stack([first, first + np.pi], axis=1), np.inf)
    stop = np.minimum(np.column_stack([np.zeros(len(thin)), inner, length]), length[:, None])
    piece = np.diff(stop, axis=1)
    owner, column = np.nonzero(piece > 1e-12)  # a turn at the very end cuts nothing off
    direction = np.sign(arcs.sweep)[owner]
    cut = with_pieces(
        paths, owner, arcs.start[owner] + direction * stop[owner, column], direction * piece[owner, column]
    )
    return cut, thin[owner] | flat(cut.arcs)


def closed_loops(paths: Paths) -> Bools:
    """Return which loops (loops,) end where they start; loops without arcs do not."""
    held, arcs = np.diff(paths.loop_start) > 0, paths.arcs
    first, last = arcs.take(paths.loop_start[:-1][held]), arcs.take(paths.loop_start[1:][held] - 1)
    closed = np.zeros(len(held), dtype=bool)
    closed[held] = np.hypot(*(last.ends() - first.starts()).T) < THIN
    return closed


def starts_and_ends(paths: Paths) -> tuple[Floats, Floats]:
    """Return where arcs start and end (k, 2), an end inside a loop or of a closed one being exactly the next start."""
    arcs, closed = paths.arcs, closed_loops(paths)
    start, end = arcs.starts(), arcs.ends()
    following = np.arange(1, len(start) + 1)
    held = np.diff(paths.loop_start) > 0
    last = paths.loop_start[1:][held] - 1
    following[last] = np.where(closed[held], paths.loop_start[:-1][held], -1)
    return start, np.where((following >= 0)[:, None], start[following], end)


def bezier_pieces(major: Floats, sweep: Floats) -> Ints:
    """Return in how many cubics (k,) an arc must be cut to stay within BEZIER_ERROR.

    The usual cubic with handles ``4/3 tan(φ/4)`` over an angle φ of the unit circle leaves it by at most
    ``4/27 sin⁶(φ/4) / cos²(φ/4)``, and φ ≤ π/2 bounds the cosine; the affine image
    stretches that by the major half-axis.
    """
    allowed = 27 / 4 * np.cos(np.pi / 8) ** 2 * BEZIER_ERROR / np.maximum(major, BEZIER_ERROR)
    widest = np.minimum(4 * np.arcsin(np.minimum(allowed, 1.0) ** (1 / 6)), np.pi / 2)
    return np.asarray(np.maximum(np.ceil(np.abs(sweep) / widest - 1e-9), 1), dtype=np.int64)


def bezier_handles(arcs: PlaneArcs) -> tuple[Floats, Floats]:
    """Return the two inner control points (k, 2) of the cubic for each arc: ends ± ``4/3 tan(φ/4)`` times tangent."""
    reach = (4 / 3 * np.tan(arcs.sweep / 4))[:, None]
    (start, first), (end, last) = (arcs.at_with_tangent(t) for t in (arcs.start, arcs.stop()))
    return start + reach * first, end - reach * last
