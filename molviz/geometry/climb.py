"""Straight up from points to the first ball, cube by cube: the vertical order in the decomposition of ``cubes``."""

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.geometry.cubes import BLOCK_ROWS, BallIndex, Cubes, cubes_above, slab_above
from molviz.geometry.rows import blocks, expand


def first_above(index: BallIndex, point: Floats) -> tuple[Ints, Floats]:
    """Return the ball (m,) that the way straight up from each point (m, 3) enters first, and the height of that place.

    The ball is −1, the height ∞, where there is none; balls that a point is in are not entered. Twice as many cubes are
    passed at each turn, so that turns are few however many cubes there are. A ball is entered in a cube that has it in
    its list; so the lowest entry in the cubes passed is the first as soon as it lies in one of them.
    """
    cubes = index.cubes()
    ball, height = np.full(len(point), -1), np.full(len(point), np.inf)
    begin, end = cubes_above(cubes, point)
    climbing, step = np.flatnonzero(begin < end), 1
    while len(climbing):
        first, last = begin[climbing], np.minimum(begin[climbing] + step, end[climbing])
        for block in blocks(cubes.start[last] - cubes.start[first], BLOCK_ROWS):
            _enter(index, cubes, point, climbing[block], (first[block], last[block]), ball, height)
        begin[climbing] = last
        met = np.floor(height[climbing] / cubes.side) <= slab_above(cubes, last - 1)
        climbing, step = climbing[~met & (last < end[climbing])], 2 * step
    return ball, height


def _enter(
    index: BallIndex, cubes: Cubes, point: Floats, query: Ints, row: tuple[Ints, Ints], ball: Ints, height: Floats
) -> None:
    """Lower each query's height to the lowest at which it enters a ball of the given rows of cubes."""
    spheres = index.spheres
    owner, entry = expand(cubes.start[row[0]], cubes.start[row[1]])
    met, asked = cubes.ball[entry], query[owner]
    aside = np.sum((point[asked, :2] - spheres.center[met, :2]) ** 2, axis=1)
    deep = spheres.radius[met] ** 2 - aside
    bottom = spheres.center[met, 2] - np.sqrt(np.maximum(deep, 0.0))
    ahead = np.flatnonzero((deep > 0) & (bottom >= point[asked, 2]) & (bottom < height[asked]))
    ahead = ahead[np.lexsort((bottom[ahead], asked[ahead]))]
    ahead = ahead[np.diff(asked[ahead], prepend=-1) > 0]
    ball[asked[ahead]], height[asked[ahead]] = met[ahead], bottom[ahead]
