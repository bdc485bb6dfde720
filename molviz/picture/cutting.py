"""Shapes cut along straight lines, exactly: arcs are split where they cross, and the line closes what is left."""

import math
from typing import NamedTuple, TypeAlias

import numpy as np

from molviz.arrays import Floats
from molviz.curves import Paths, PlaneArcs, straight_pieces
from molviz.geometry.intervals import TURN

Piece: TypeAlias = tuple[int, float, float]  # arc, start, sweep
Loop: TypeAlias = list[Piece | list[float]]  # pieces of arcs, and straight parts [from, to] along the line


class _Chain(NamedTuple):
    """Pieces of arcs that follow each other on the kept side, and where on the line they begin and end."""

    pieces: list[Piece]
    begin: float | None  # None where the chain is a closed loop
    end: float | None


def kept_side(paths: Paths, point: Floats, normal: Floats) -> Paths:
    """Return what of each shape (s,) lies beyond its own line, on the side to which the normal (s, 2) points.

    Shapes have their interior on the left of their loops; a shape of which nothing is left has no loops.
    """
    arc_of_shape = paths.loop_start[paths.shape_start]
    owner = np.repeat(np.arange(len(point)), np.diff(arc_of_shape))
    along = np.column_stack([-normal[:, 1], normal[:, 0]])
    a, b, c = (
        np.sum(column * normal[owner], axis=1)
        for column in (paths.arcs.u, paths.arcs.v, paths.arcs.c - point[owner])
    )
    functions = list(zip(a.tolist(), b.tolist(), c.tolist(), strict=True))
    pieces: list[Piece] = []
    straight: list[tuple[Floats, Floats]] = []
    loop_start, shape_start = [0], [0]
    for shape in range(len(point)):
        chains = _chains(paths, shape, functions, along[shape], point[shape])
        for loop in _closed(chains):
            for element in loop:
                if isinstance(element, tuple):
                    pieces.append(element)
                else:
                    pieces.append((-len(straight) - 1, 0.0, 0.0))
                    ends = point[shape] + np.outer(element, along[shape])
                    straight.append((ends[0], ends[1]))
            loop_start.append(len(pieces))
        shape_start.append(len(loop_start) - 1)
    return Paths(_arcs(paths.arcs, pieces, straight), np.array(loop_start), np.array(shape_start))


def _arcs(
    arcs: PlaneArcs, pieces: list[Piece], straight: list[tuple[Floats, Floats]]
) -> PlaneArcs:
    """The pieces as arcs; negative numbers are those of straight ones."""
    number = np.array([piece[0] for piece in pieces], dtype=np.int64)
    ends = np.array(straight).reshape(-1, 2, 2)
    lines = straight_pieces(ends[:, 0], ends[:, 1])
    table = PlaneArcs(*(np.concatenate(columns) for columns in zip(arcs, lines, strict=True)))
    taken = table.take(np.where(number < 0, len(arcs.c) - number - 1, number))
    own = number >= 0
    start, sweep = (np.array([piece[k] for piece in pieces], dtype=float) for k in (1, 2))
    return taken._replace(start=np.where(own, start, taken.start), sweep=np.where(own, sweep, taken.sweep))


def _chains(
    paths: Paths, shape: int, functions: list[tuple[float, float, float]], along: Floats, point: Floats
) -> list[_Chain]:
    """The parts of a shape's loops beyond its line."""
    chains = []
    for loop in range(int(paths.shape_start[shape]), int(paths.shape_start[shape + 1])):
        pieces = []
        for arc in range(int(paths.loop_start[loop]), int(paths.loop_start[loop + 1])):
            pieces += _split(arc, float(paths.arcs.start[arc]), float(paths.arcs.sweep[arc]), functions[arc])
        kept = [_height(functions[arc], start + sweep / 2) > 0 for arc, start, sweep in pieces]
        if all(kept):
            chains.append(_Chain(pieces, None, None))
        elif any(kept):
            first = next(k for k in range(len(kept)) if kept[k] and not kept[k - 1])
            chains += _runs(paths.arcs, pieces[first:] + pieces[:first], kept[first:] + kept[:first], along, point)
    return chains


def _runs(
    arcs: PlaneArcs, pieces: list[Piece], kept: list[bool], along: Floats, point: Floats
) -> list[_Chain]:
    """Unbroken runs of kept pieces; the first is kept and the last is not."""

    def place(arc: int, t: float) -> float:
        at = arcs.c[arc] + arcs.u[arc] * math.cos(t) + arcs.v[arc] * math.sin(t) - point
        return float(at[0] * along[0] + at[1] * along[1])

    runs, begin = [], 0
    for k in range(1, len(pieces) + 1):
        if k == len(pieces) or kept[k] != kept[k - 1]:
            if kept[begin]:
                (arc, start, _), (last, at, sweep) = pieces[begin], pieces[k - 1]
                runs.append(_Chain(pieces[begin:k], place(arc, start), place(last, at + sweep)))
            begin = k
    return runs


def _height(function: tuple[float, float, float], t: float) -> float:
    a, b, c = function
    return a * math.cos(t) + b * math.sin(t) + c


def _split(arc: int, start: float, sweep: float, function: tuple[float, float, float]) -> list[Piece]:
    """The pieces between the points at which ``a cos t + b sin t + c`` vanishes."""
    a, b, c = function
    reach = math.hypot(a, b)
    if abs(c) >= reach:
        return [(arc, start, sweep)]
    middle, half = math.atan2(b, a), math.acos(-c / reach)
    sign = 1.0 if sweep > 0 else -1.0
    offsets = sorted((sign * (root - start)) % TURN for root in (middle - half, middle + half))
    marks = [0.0, *(offset for offset in offsets if 0.0 < offset < abs(sweep)), abs(sweep)]
    return [(arc, start + sign * low, sign * (high - low)) for low, high in zip(marks, marks[1:], strict=False)]


def _closed(chains: list[_Chain]) -> list[Loop]:
    """Loops of pieces and straight parts [from, to] along the line.

    Along it the ends and beginnings of chains bound the parts inside the shape: the first with the second, and so on.
    """
    loops: list[Loop] = [list(one.pieces) for one in chains if one.begin is None]
    open_chains = [one for one in chains if one.begin is not None]
    marks = sorted(
        [(one.begin, k, True) for k, one in enumerate(open_chains)]
        + [(one.end, k, False) for k, one in enumerate(open_chains)]
    )
    following = {}
    for one, other in zip(marks[::2], marks[1::2], strict=True):
        if one[2] == other[2]:
            return loops  # rounding: the shape touches the line
        end, begin = (other, one) if one[2] else (one, other)
        following[end[1]] = begin[1]
    while following:
        k, loop = next(iter(following)), Loop()
        while k in following:
            after = following.pop(k)
            loop += [*open_chains[k].pieces, [open_chains[k].end, open_chains[after].begin]]  # type: ignore[list-item]
            k = after
        loops.append(loop)
    return loops
