"""The creases of a union boundary in eye coordinates, and what their own two spheres and all balls hide of them."""

import numpy as np

from molviz.arrays import Ints
from molviz.geometry.boundary import Boundary
from molviz.geometry.circles import Circles
from molviz.geometry.intervals import TURN, above
from molviz.model.spheres import Spheres
from molviz.visibility.named_arcs import BALL, HORIZON, Hidden
from molviz.visibility.projection import Projection
from molviz.visibility.view import View


def rotated_circles(circles: Circles, view: View) -> Circles:
    """Return circles of the molecule's space in eye coordinates."""
    eye = [0.0, 0.0, view.distance or 0.0]
    turn = view.rotation.T
    return circles._replace(
        center=(circles.center - view.center) @ turn - eye, a=circles.a @ turn, b=circles.b @ turn
    )


def merged(one: Circles, other: Circles) -> Circles:
    """Return two tables of circles as one."""
    first, second = (np.concatenate([getattr(one, name), getattr(other, name)]) for name in ("first", "second"))
    center, a, b = (np.concatenate([getattr(one, name), getattr(other, name)]) for name in ("center", "a", "b"))
    return Circles(first, second, center, a, b)


def outside_free_arcs(boundary: Boundary, arc: Ints) -> Hidden:
    """Return what balls hide of the circles of the given free arcs, curve c being ``arc[c]``: everything else."""
    arcs = boundary.arcs
    cut = np.flatnonzero(arcs.before[arc] >= 0)
    rows = arc[cut]
    start, sweep = arcs.start[rows] + arcs.sweep[rows], TURN - arcs.sweep[rows]
    return Hidden(cut, start, sweep, np.full(len(cut), BALL), arcs.before[rows], arcs.after[rows])


def beyond_own_plane(
    spheres: Spheres, circles: Circles, projection: Projection, circle: Ints, sphere: Ints
) -> Hidden:
    """Return the interval of each curve (on the given circle) beyond the horizon of the given own sphere."""
    margin = projection.plane_margin(spheres, circles, circle, sphere)
    middle, half = above(margin.a, margin.b, -margin.c)
    rows = np.flatnonzero(half > 0)
    name = sphere[rows]
    return Hidden(rows, (middle - half)[rows], 2 * half[rows], np.full(len(rows), HORIZON), name, name)
