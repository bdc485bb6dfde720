"""Paths as PDF: arcs as cubic Béziers within a thousandth of a point."""

from collections.abc import Iterator

import numpy as np

from molviz.arrays import Bools, Words
from molviz.curves import Paths
from molviz.write.columns import Formatted, in_loops, spaced_rows, texts_of_shapes, word
from molviz.write.ellipse import (
    bezier_handles,
    bezier_pieces,
    closed_loops,
    in_equal_pieces,
    on_axes,
    starts_and_ends,
    with_straight_pieces,
)

PLACES = 3


def shape_texts(paths: Paths) -> Iterator[str]:
    """Yield the operators of each shape, without the end of the last line."""
    return (text.removesuffix("\n") for text in texts_of_shapes(paths, loop_texts))


def loop_texts(paths: Paths) -> Formatted:
    """Return the operators of each loop, empty where it has no arc."""
    paths, straight = as_cubics(paths)
    start = paths.loop_start
    held = start[1:] > start[:-1]
    rows = paths.arcs.take(start[:-1][held])
    move = spaced_rows([(held, rows.starts(), word(" m\n"))], PLACES)
    end = np.full(len(straight), word("\n"))
    end[start[1:][held & closed_loops(paths)] - 1] = word(" h\n")
    return in_loops(start, move, np.column_stack([arc_words(paths, straight), end]))


def as_cubics(paths: Paths) -> tuple[Paths, Bools]:
    """Return the paths cut so that one cubic or one straight piece stands for each arc, and which are straight."""
    paths, straight = with_straight_pieces(paths)
    count = np.where(straight, 1, bezier_pieces(on_axes(paths.arcs).major, paths.arcs.sweep))
    return in_equal_pieces(paths, count), np.repeat(straight, count)


def arc_words(paths: Paths, straight: Bools) -> Words:
    """Return the operator of each arc (k, w)."""
    end = starts_and_ends(paths)[1]
    points = np.column_stack([*bezier_handles(paths.arcs), end])
    kinds = [(straight, points[straight, 4:], word(" l")), (~straight, points[~straight], word(" c"))]
    return spaced_rows(kinds, PLACES)
