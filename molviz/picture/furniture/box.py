"""Boxes on the page, and the straight pieces that furniture is drawn with."""

from typing import NamedTuple, TypeAlias

import numpy as np

from molviz.arrays import Floats
from molviz.curves import Paths, straight_pieces
from molviz.picture.picture import FillLayer, StrokeLayer, TextLayer

Piece: TypeAlias = FillLayer | StrokeLayer | TextLayer


class Box(NamedTuple):
    """A rectangle in points, y up."""

    x0: float
    y0: float
    x1: float
    y1: float

    def around(self, other: "Box") -> "Box":
        """Return the smallest box that holds both."""
        return Box(*map(min, self[:2], other[:2]), *map(max, self[2:], other[2:]))


def rectangles(boxes: Floats) -> Paths:
    """Return one shape for each box (k, 4), running anticlockwise."""
    x0, y0, x1, y1 = np.asarray(boxes, dtype=float).reshape(-1, 4).T
    return polygons(np.stack([np.stack([x0, x1, x1, x0], axis=1), np.stack([y0, y0, y1, y1], axis=1)], axis=2))


def polygons(corners: Floats) -> Paths:
    """Return one closed shape for each list of corners (k, m, 2)."""
    count, sides = corners.shape[:2]
    arcs = straight_pieces(corners.reshape(-1, 2), np.roll(corners, -1, axis=1).reshape(-1, 2))
    return Paths(arcs, np.arange(count + 1) * sides, np.arange(count + 1))


def segments(start: Floats, end: Floats) -> Paths:
    """Return all pieces from start to end (k, 2) as one shape of open loops."""
    return Paths(straight_pieces(start, end), np.arange(len(start) + 1), np.array([0, len(start)]))
