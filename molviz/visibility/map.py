"""The visibility map: the planar map of what the eye sees (Halperin & Overmars 1994, section 5.2).

Its arcs are the visible arcs of horizons and creases, its vertices are known by name, its faces are the visible regions
of the spheres. Horizons are split where other curves pass under them, so that each arc has one face on either side.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.curves import PlaneArcs
from molviz.geometry.boundary import Boundary
from molviz.geometry.circles import Circles
from molviz.geometry.grid import Neighbours
from molviz.geometry.rows import expand
from molviz.model.spheres import Spheres
from molviz.visibility.curves_in_view import beyond_own_plane, merged, outside_free_arcs, rotated_circles
from molviz.visibility.half_edges import Loops, chained, directed, loops
from molviz.visibility.junctions import Edges, split_at_junctions
from molviz.visibility.named_arcs import Hidden, joined, visible_arcs
from molviz.visibility.projection import Projection
from molviz.visibility.shadows import discs_of, overlaps, shadows_on_creases, shadows_on_horizons
from molviz.visibility.view import View

BACKGROUND = -1


class VisibilityMap(NamedTuple):
    """The map of one view: arcs, the faces on either side, and the faces' loops; lengths in ångström.

    Spheres are numbered as in the boundary the map was made from; ``left`` and ``right`` are −1 for the background.
    """

    spheres: Spheres  # in eye coordinates
    circles: Circles  # creases, then horizons; eye coordinates
    circle: Ints  # (k,) of each arc
    start: Floats  # (k,) radians on the circle
    sweep: Floats  # (k,)
    arcs: PlaneArcs  # (k,) on the page
    left: Ints  # (k,)
    right: Ints  # (k,)
    origin: Ints  # (k,) vertex numbers
    target: Ints  # (k,)
    loops: Loops  # by face, background included

    def is_crease(self) -> Bools:
        """Return which arcs are creases; the others are horizons."""
        return np.asarray(self.circles.second[self.circle] >= 0)

    def horizons(self) -> Circles:
        """Return the horizons, in the order of the spheres."""
        return self.circles.take(np.flatnonzero(self.circles.second < 0))


def visibility_map(
    boundary: Boundary, seen: Spheres, wanted: Ints, view: View, projection: Projection
) -> VisibilityMap:
    """Return the map of what is seen of the ``wanted`` spheres (ascending), as if there were no others.

    ``seen`` are the boundary's spheres in eye coordinates; the map numbers spheres by their place in ``wanted``. Raises
    ``Degenerate`` where the spheres are not in general position.
    """
    spheres = seen.take(wanted)
    creases, hidden = _creases_between(boundary, wanted, view)
    horizons = projection.horizons(spheres)
    circles = merged(creases, horizons)
    discs = discs_of(horizons, projection)
    near = overlaps(discs)
    everything = np.arange(len(circles.first))
    crease = everything[: len(creases.first)]
    nearness = projection.nearness(spheres)
    nearer = np.where(nearness[creases.first] > nearness[creases.second], creases.first, creases.second)
    hidden = joined([
        hidden,
        beyond_own_plane(spheres, circles, projection, crease, nearer),
        shadows_on_horizons(spheres, horizons, projection, near, len(crease)),
        *shadows_on_creases(spheres, circles, projection, near, discs, crease),
    ])  # fmt: skip
    named = visible_arcs(circles, everything, hidden)
    edges = split_at_junctions(named, circles, horizons, spheres, projection)
    return _assembled(spheres, circles, edges, near, projection)


def _creases_between(boundary: Boundary, wanted: Ints, view: View) -> tuple[Circles, Hidden]:
    """One circle for each free arc of a crease between wanted spheres, and what balls hide of it."""
    number = np.full(len(boundary.spheres.radius) + 1, -1)  # row −1 stays −1
    number[wanted] = np.arange(len(wanted))
    circle = boundary.arcs.circle
    first, second = number[boundary.circles.first[circle]], number[boundary.circles.second[circle]]
    arc = np.flatnonzero((first >= 0) & (second >= 0))
    hidden = outside_free_arcs(boundary, arc)
    turned = rotated_circles(boundary.circles.take(circle[arc]), view)
    return (
        turned._replace(first=first[arc], second=second[arc]),
        hidden._replace(leaves=number[hidden.leaves], enters=number[hidden.enters]),
    )


def _assembled(
    spheres: Spheres, circles: Circles, edges: Edges, near: Neighbours, projection: Projection
) -> VisibilityMap:
    plane = projection.page_arcs(circles, edges.circle, edges.start, edges.sweep)
    is_crease = circles.second[edges.circle] >= 0
    left = np.where(is_crease, circles.second[edges.circle], circles.first[edges.circle])
    right = circles.first[edges.circle].copy()
    rim = np.flatnonzero(~is_crease)
    points = plane.take(rim).at(plane.start[rim] + plane.sweep[rim] / 2)
    right[rim] = _behind(spheres, left[rim], points, near, projection)
    face = directed(left, right)
    following = chained(face, directed(edges.origin, edges.target), directed(edges.target, edges.origin))
    found = loops(face, following)
    return VisibilityMap(
        spheres, circles, edges.circle, edges.start, edges.sweep, plane, left, right, edges.origin, edges.target, found
    )


def _behind(spheres: Spheres, own: Ints, points: Floats, near: Neighbours, projection: Projection) -> Ints:
    """The sphere seen just outside each visible point of a horizon: the nearest other surface there, or BACKGROUND."""
    row, entry = expand(near.start[own], near.start[own + 1])
    sphere = near.item[entry]
    surface = projection.surface(spheres, sphere, points[row])
    rows = np.flatnonzero(surface > -np.inf)
    rows = rows[np.lexsort((surface[rows], row[rows]))]
    behind = np.full(len(own), BACKGROUND)
    behind[row[rows]] = sphere[rows]  # ascending: the last one written is the nearest
    return behind
