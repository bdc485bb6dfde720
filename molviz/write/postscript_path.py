"""Paths as PostScript: true arcs, one line of text per arc."""

from collections.abc import Iterator
from functools import partial

import numpy as np

from molviz.arrays import Bools, Words
from molviz.curves import Paths, PlaneArcs
from molviz.write.columns import Formatted, in_loops, spaced_rows, texts_of_shapes, word, words
from molviz.write.ellipse import (
    THIN,
    bezier_handles,
    bezier_pieces,
    closed_loops,
    in_equal_pieces,
    on_axes,
    with_straight_pieces,
)

PLACES = 2
LARGEST = 500.0  # points, half-axis of arcs written as such: half a hundredth of a degree is 0.04 points there


def shape_texts(paths: Paths, filled: bool) -> Iterator[str]:
    """Yield the lines of each shape, without the last one's end; every loop is stroked unless it is ``filled``."""
    write = partial(loop_texts, filled=filled)
    return (text.removesuffix("\n") for text in texts_of_shapes(paths, write))


def loop_texts(paths: Paths, filled: bool) -> Formatted:
    """Return the lines of each loop.

    An arc starts a path by itself, but would be joined to the loop before it; a straight piece, or a cubic for a very
    large arc, always needs a start.
    """
    paths, straight = with_straight_pieces(paths)
    major = on_axes(paths.arcs).major
    large = ~straight & (major > LARGEST)
    count = np.where(large, bezier_pieces(major, paths.arcs.sweep), 1)
    paths, straight, large = in_equal_pieces(paths, count), np.repeat(straight, count), np.repeat(large, count)
    start = paths.loop_start
    held = start[1:] > start[:-1]
    moved = held.copy()
    moved[held] &= filled | (straight | large)[start[:-1][held]]
    first = paths.arcs.take(start[:-1][moved])
    move = spaced_rows([(moved, first.starts(), word(" m\n"))], PLACES)
    end = np.full((len(straight), 2), words("", "\n"))
    last = start[1:][held] - 1
    end[last, 0] = np.where(closed_loops(paths)[held], word(" h"), 0)
    end[last, 1] = word("\n" if filled else " s\n")
    return in_loops(start, move, np.column_stack([arc_words(paths.arcs, straight, large), end]))


def arc_words(arcs: PlaneArcs, straight: Bools, large: Bools) -> Words:
    """Return the command of each arc (k, w): circles by centre, radius and angles, ellipses under their own matrix."""
    axes = on_axes(arcs)
    rotation, sweep = np.degrees(axes.rotation), np.degrees(axes.sweep)
    round_ = axes.major - axes.minor < THIN
    start = np.mod(np.degrees(axes.start) + np.where(round_, rotation, 0.0), 360.0)
    angles, backward = np.column_stack([start, start + sweep]), (axes.sweep < 0).astype(int)
    circle = np.column_stack([arcs.c, axes.major, angles])
    ellipse = np.column_stack([angles, axes.major, axes.minor, rotation, arcs.c])
    is_circle, is_ellipse = (kind & ~straight & ~large for kind in (round_, ~round_))
    cubic = np.column_stack([*bezier_handles(arcs), arcs.ends()])
    kinds = [
        (straight, arcs.ends()[straight], word(" l")),
        (large, cubic[large], word(" q")),
        (is_circle, circle[is_circle], words(" A", " N")[backward[is_circle]]),
        (is_ellipse, ellipse[is_ellipse], words(" E", " F")[backward[is_ellipse]]),
    ]
    return spaced_rows(kinds, PLACES)
