"""Paths as PDF: arcs as cubic Béziers within a thousandth of a point."""

import numpy as np

from molviz.arrays import Bools, Texts
from molviz.curves import Paths
from molviz.write.ellipse import (
    bezier_handles,
    bezier_pieces,
    closed_loops,
    in_equal_pieces,
    on_axes,
    starts_and_ends,
    with_straight_pieces,
)
from molviz.write.text import numbers

PLACES = 3


def shape_texts(paths: Paths) -> list[str]:
    """Return the operators of the loops of each shape."""
    loops, bounds = loop_texts(paths), paths.shape_start.tolist()
    return ["\n".join(filter(None, loops[first:stop])) for first, stop in zip(bounds, bounds[1:], strict=False)]


def loop_texts(paths: Paths) -> list[str]:
    """Return the operators of each loop, empty where it has no arc."""
    paths, straight = as_cubics(paths)
    words, first, stop = arc_texts(paths, straight).tolist(), paths.loop_start[:-1], paths.loop_start[1:]
    held = stop > first
    rows = paths.arcs.take(first[held])
    move = np.full(len(first), "", dtype=object)
    move[held] = joined(numbers(rows.at(rows.start), PLACES)) + " m\n"
    bodies = ["\n".join(words[a:b]) for a, b in zip(first.tolist(), stop.tolist(), strict=True)]
    ends = np.where(closed_loops(paths), " h", "").tolist()
    return [start + text + end if text else "" for start, text, end in zip(move.tolist(), bodies, ends, strict=True)]


def as_cubics(paths: Paths) -> tuple[Paths, Bools]:
    """Return the paths cut so that one cubic or one straight piece stands for each arc, and which are straight."""
    paths, straight = with_straight_pieces(paths)
    count = np.where(straight, 1, bezier_pieces(on_axes(paths.arcs).major, paths.arcs.sweep))
    return in_equal_pieces(paths, count), np.repeat(straight, count)


def arc_texts(paths: Paths, straight: Bools) -> Texts:
    """Return the operator (k,) of each arc."""
    end = starts_and_ends(paths)[1]
    points = numbers(np.column_stack([*bezier_handles(paths.arcs), end]), PLACES)
    return np.asarray(np.where(straight, joined(points[:, 4:]) + " l", joined(points) + " c"), dtype=object)


def joined(words: Texts) -> Texts:
    """Return the rows of words (k, m) as one text (k,) each."""
    spaced = words.copy()
    spaced[:, 1:] = " " + spaced[:, 1:]
    return np.asarray(spaced.sum(axis=1), dtype=object)
