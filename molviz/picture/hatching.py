"""Hatching: parallel lines clipped exactly to regions that are bounded by arcs of ellipses."""

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.curves import Paths, PlaneArcs, straight_pieces
from molviz.geometry.rows import expand
from molviz.vectors import transformed

LEVELS = 6  # of tone, each with its own distance of lines
WHITE = 96.0  # L* from which on nothing is hatched
BLACK = 30.0  # L* of the densest hatching
OFFSET = 0.3819660112501051  # of the distance: lines so placed seldom meet what symmetry puts on round numbers


def tone_levels(lightness: Floats) -> Ints:
    """Return levels (n,) of L*: 0 for the darkest, LEVELS for what stays white."""
    share = (lightness - BLACK) / (WHITE - BLACK)
    levels = np.clip(np.floor(share * LEVELS), 0, LEVELS - 1).astype(np.int64)
    return np.where(lightness >= WHITE, LEVELS, levels)


def level_distance(level: int, nearest: float, farthest: float) -> float:
    """Return the distance of the lines of a level, from the nearest to the farthest in equal ratios."""
    return float(nearest * (farthest / nearest) ** (level / (LEVELS - 1)))


def hatched(paths: Paths, distance: float, degrees: float) -> Paths:
    """Return the parts of parallel lines inside closed loops (even-odd), one open loop each, all of one shape.

    In a frame turned with the lines, line k runs at height ``(k + OFFSET) distance``. It enters and leaves where it
    crosses pieces of arcs that rise or fall throughout, so that each piece is crossed once or not at all.
    """
    angle = np.radians(degrees)
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    c, u, v = (transformed(vectors, turn) for vectors in (paths.arcs.c, paths.arcs.u, paths.arcs.v))
    arcs = paths.arcs._replace(c=c, u=u, v=v)
    line, x = _crossings(_monotone(arcs), distance)
    order = np.lexsort((x, line))
    line, x = line[order], x[order]
    inside = _first_of_pairs(line)
    y = (line[inside] + OFFSET) * distance
    start, end = (transformed(np.column_stack([x[rows], y]), turn.T) for rows in (inside, inside + 1))
    pieces = straight_pieces(start, end)
    count = len(inside)
    return Paths(pieces, np.arange(count + 1), np.array([0, count]))


def _first_of_pairs(line: Ints) -> Ints:
    """The rows of crossings at which lines enter: every other one of each line; a last one without exit is left out."""
    begins = np.append(True, line[1:] != line[:-1])[: len(line)]
    first = np.flatnonzero(begins)
    place = np.arange(len(line)) - np.repeat(first, np.diff(np.append(first, len(line))))
    followed = np.append(line[1:] == line[:-1], False)[: len(line)]
    return np.flatnonzero((place % 2 == 0) & followed)


def _monotone(arcs: PlaneArcs) -> PlaneArcs:
    """The arcs cut where y turns, at ``tan t = v_y / u_y``."""
    low, high = np.minimum(arcs.start, arcs.stop()), np.maximum(arcs.start, arcs.stop())
    top = np.arctan2(arcs.v[:, 1], arcs.u[:, 1])
    first = np.ceil((low - top) / np.pi).astype(np.int64)
    last = np.floor((high - top) / np.pi).astype(np.int64)
    owner, turn = expand(first, last + 1)
    cut = top[owner] + np.pi * turn
    every = np.arange(len(low))
    arc, t = np.concatenate([every, every, owner]), np.concatenate([low, high, cut])
    order = np.lexsort((t, arc))
    arc, t = arc[order], t[order]
    piece = np.flatnonzero(arc[1:] == arc[:-1])
    return arcs.split(arc[piece], t[piece], t[piece + 1] - t[piece])


def _crossings(arcs: PlaneArcs, distance: float) -> tuple[Ints, Floats]:
    """The number of the line and x of every crossing with arcs on which y only rises or only falls."""
    begin, end = arcs.starts()[:, 1] / distance - OFFSET, arcs.ends()[:, 1] / distance - OFFSET
    arc, line = expand(
        np.ceil(np.minimum(begin, end)).astype(np.int64), np.ceil(np.maximum(begin, end)).astype(np.int64)
    )
    part = arcs.take(arc)
    height = (line + OFFSET) * distance - part.c[:, 1]
    reach = np.hypot(part.u[:, 1], part.v[:, 1])
    top = np.arctan2(part.v[:, 1], part.u[:, 1])
    half = np.arccos(np.clip(height / np.where(reach > 0, reach, 1.0), -1.0, 1.0))
    middle = part.middle()
    near = [solution + 2 * np.pi * np.round((middle - solution) / (2 * np.pi)) for solution in (top + half, top - half)]
    t = np.where(np.abs(near[0] - middle) < np.abs(near[1] - middle), near[0], near[1])
    return line, part.at(np.clip(t, part.start, part.stop()))[:, 0]
