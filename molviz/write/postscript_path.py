"""Paths as PostScript: true arcs, one line of text per arc."""

import numpy as np

from molviz.arrays import Bools, Floats, Texts
from molviz.curves import Paths, PlaneArcs
from molviz.write.ellipse import THIN, closed_loops, on_axes, with_straight_pieces
from molviz.write.text import numbers


def shape_texts(paths: Paths, filled: bool) -> list[list[str]]:
    """Return the commands of the loops of each shape."""
    loops, bounds = loop_texts(paths, filled), paths.shape_start.tolist()
    return [list(filter(None, loops[first:stop])) for first, stop in zip(bounds, bounds[1:], strict=False)]


def loop_texts(paths: Paths, filled: bool) -> list[str]:
    """Return the commands of each loop.

    An arc starts a path by itself, but would be joined to the loop before it; a straight piece always needs a start.
    """
    paths, straight = with_straight_pieces(paths)
    words, first, stop = arc_texts(paths.arcs, straight).tolist(), paths.loop_start[:-1], paths.loop_start[1:]
    held, closed = stop > first, closed_loops(paths)
    move = np.full(len(first), "", dtype=object)
    moved = held.copy()
    moved[held] &= filled | straight[first[held]]
    rows = paths.arcs.take(first[moved])
    move[moved] = phrase(rows.at(rows.start)) + " m\n"
    bounds = zip(first.tolist(), stop.tolist(), strict=True)
    bodies = ["\n".join(words[a:b]) for a, b in bounds]
    ends = np.where(closed, " h", "").tolist()
    return [start + text + end if text else "" for start, text, end in zip(move.tolist(), bodies, ends, strict=True)]


def phrase(values: Floats) -> Texts:
    """Return the rows (k, m) of numbers as texts (k,), separated by spaces."""
    words = numbers(values)
    words[:, 1:] = " " + words[:, 1:]
    return np.asarray(words.sum(axis=1), dtype=object)


def arc_texts(arcs: PlaneArcs, straight: Bools) -> Texts:
    """Return the command (k,) of each arc: circles by centre, radius and angles, ellipses under their own matrix."""
    axes = on_axes(arcs)
    rotation, sweep = np.degrees(axes.rotation), np.degrees(axes.sweep)
    circle = axes.major - axes.minor < THIN
    start = np.mod(np.degrees(axes.start) + np.where(circle, rotation, 0.0), 360.0)
    angles, forward = np.column_stack([start, start + sweep]), axes.sweep >= 0
    as_circle = phrase(np.column_stack([arcs.c, axes.major, angles])) + np.where(forward, " A", " N").astype(object)
    shape = np.column_stack([angles, axes.major, axes.minor, rotation, arcs.c])
    as_ellipse = phrase(shape) + np.where(forward, " E", " F").astype(object)
    as_line = phrase(arcs.at(arcs.start + arcs.sweep)) + " l"
    return np.asarray(np.where(straight, as_line, np.where(circle, as_circle, as_ellipse)), dtype=object)
