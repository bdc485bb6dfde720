"""What balls, and their own two spheres, hide of the creases of a union boundary."""

import numpy as np

from molviz.arrays import Ints
from molviz.geometry.boundary import Boundary
from molviz.geometry.circles import Circles
from molviz.geometry.intervals import TURN, above
from molviz.vectors import transformed
from molviz.visibility.curves import Curves, creases_of
from molviz.visibility.eye import eye_of
from molviz.visibility.named_arcs import Hidden
from molviz.visibility.names import BALL, OWN
from molviz.visibility.occluders.sphere import SphereOccluders
from molviz.visibility.view import View


def creases_in_view(circles: Circles, view: View) -> Curves:
    """Return creases of the molecule's space in eye coordinates."""
    center = transformed(circles.center - view.center, view.rotation) - eye_of(view)
    a, b = (transformed(vectors, view.rotation) for vectors in (circles.a, circles.b))
    return creases_of(circles._replace(center=center, a=a, b=b))


def outside_free_arcs(boundary: Boundary, arc: Ints) -> Hidden:
    """Return what balls hide of the circles of the given free arcs, curve c being ``arc[c]``: everything else."""
    arcs = boundary.arcs
    cut = np.flatnonzero(arcs.before[arc] >= 0)
    rows = arc[cut]
    start, sweep = arcs.start[rows] + arcs.sweep[rows], TURN - arcs.sweep[rows]
    return Hidden(cut, start, sweep, np.full(len(cut), BALL), arcs.before[rows], arcs.after[rows])


def beyond_own_plane(spheres: SphereOccluders, curves: Curves, curve: Ints, sphere: Ints) -> Hidden:
    """Return the interval of each of the given curves beyond the horizon of the given one of its own spheres."""
    margin = spheres.plane_margin(curves, curve, sphere)
    middle, half = above(margin.a, margin.b, -margin.c)
    rows = np.flatnonzero(half > 0)
    name = sphere[rows]
    return Hidden(rows, (middle - half)[rows], 2 * half[rows], np.full(len(rows), OWN), name, name)
