"""Straight up from points to the first face of a union boundary: the vertical order in the decomposition of ``cubes``.

Where the way up meets the boundary on an arc, or so near to one that rounding puts the place in no face, another way is
taken beside it; the first are nearer to it than anything but rounding.
"""

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.errors import InternalError
from molviz.geometry.boundary_graph import BoundaryGraph
from molviz.geometry.cubes import BLOCK_ROWS, BallIndex, Cubes, cubes_above, slab_above
from molviz.geometry.rows import blocks, expand
from molviz.geometry.spherical_faces import face_at

NOTHING, ON_ARC = -1, -2  # in place of a face
ASIDE = tuple(10.0**power for power in range(-12, -3))  # in radii of the ball that is met: how far beside, in turn
TURN = 2.4  # radians from one way beside to the next: the golden angle, so that no two are alike


class FacesAbove:
    """The faces of a union boundary, ready to be met from below; ``rows`` are the balls that lie in no other."""

    def __init__(self, graph: BoundaryGraph) -> None:
        self.graph = graph
        self.rows = np.flatnonzero(~graph.boundary.inside)
        self.index = BallIndex(graph.boundary.spheres.take(self.rows))

    def __call__(self, point: Floats) -> Ints:
        """Return the face (m,) that is met first straight up from points (m, 3) outside of all balls, −1 for none.

        Raises InternalError if (never seen) an arc is met, and no way beside it meets a face.
        """
        face, ball = self._met(point)
        for turn, share in enumerate(ASIDE):
            lost = np.flatnonzero(face == ON_ARC)
            if not len(lost):
                return face
            shift = np.outer(self.index.spheres.radius[ball[lost]], (np.cos(turn * TURN), np.sin(turn * TURN), 0.0))
            beside = point[lost] + share * shift
            outside = np.diff(self.index.balls_met(beside, np.zeros(len(lost))).start) == 0
            face[lost[outside]] = self._met(beside[outside])[0]
        if (face == ON_ARC).any():
            raise InternalError("a point lies below an arc of the boundary, and so do those beside it")
        return face

    def _met(self, point: Floats) -> tuple[Ints, Ints]:
        """The face (m,), and the ball that it is on."""
        ball, height = first_above(self.index, point)
        face, met = np.full(len(point), NOTHING), np.flatnonzero(ball >= 0)
        place = np.column_stack([point[met, :2], height[met]]) - self.index.spheres.center[ball[met]]
        direction = place / self.index.spheres.radius[ball[met], None]
        at = face_at(self.graph.faces, self.rows[ball[met]], direction)
        face[met] = np.where(at >= 0, at, ON_ARC)
        return face, ball


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
    owner, entry = expand(cubes.start[row[0]], cubes.start[row[1]])
    met = cubes.ball[entry]
    deep = index.spheres.radius.take(met) ** 2 - index.gap(point[query], owner, met, axes=2)
    below = np.flatnonzero(deep > 0)
    met, asked = met[below], query[owner[below]]
    bottom = index.spheres.center[met, 2] - np.sqrt(deep[below])
    ahead = np.flatnonzero((bottom >= point[asked, 2]) & (bottom < height[asked]))
    ahead = ahead[np.lexsort((bottom[ahead], asked[ahead]))]
    ahead = ahead[np.diff(asked[ahead], prepend=-1) > 0]
    ball[asked[ahead]], height[asked[ahead]] = met[ahead], bottom[ahead]
