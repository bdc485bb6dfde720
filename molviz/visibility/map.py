"""The visibility map: the planar map of what the eye sees (Halperin & Overmars 1994, section 5.2).

Its arcs are the visible arcs of horizons and creases, its vertices are known by name, its faces are the visible regions
of the spheres. Horizons are split where other curves pass under them, so that each arc has one face on either side.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Ints
from molviz.curves import PlaneArcs
from molviz.geometry.boundary import Boundary
from molviz.geometry.grid import Neighbours
from molviz.geometry.planar_map import Loops, PlanarMap, loops, planar_map
from molviz.geometry.rows import expand
from molviz.model.spheres import Spheres
from molviz.visibility.curves import HORIZON, Curves
from molviz.visibility.junctions import CurveArcs, split_at_junctions
from molviz.visibility.named_arcs import Hidden, joined, visible_arcs
from molviz.visibility.occluders.sphere import SphereOccluders
from molviz.visibility.occlusion import creases_hidden, discs_of, horizons_hidden, overlaps
from molviz.visibility.own_occlusion import beyond_own_plane, creases_in_view, outside_free_arcs
from molviz.visibility.projection import Projection
from molviz.visibility.view import View

BACKGROUND = -1


class VisibilityMap(NamedTuple):
    """The map of one view: arcs of curves, and the planar map they form; lengths in ångström.

    Faces carry the number of the sphere seen there, BACKGROUND where there is none.
    """

    spheres: Spheres  # in eye coordinates
    curves: Curves  # creases, then one horizon for each sphere in turn; eye coordinates
    curve_arcs: CurveArcs  # (k,) the arcs on their curves
    arcs: PlaneArcs  # (k,) the same on the page
    edges: PlanarMap  # (2k,)
    loops: Loops  # of its faces, background included

    @property
    def left(self) -> Ints:
        """The face on the left of each arc (k,)."""
        return self.edges.face[::2]

    @property
    def right(self) -> Ints:
        """The face on the right of each arc (k,)."""
        return self.edges.face[1::2]

    def is_crease(self) -> Bools:
        """Return which arcs (k,) are creases; the others are horizons."""
        return self.curves.is_crease()[self.curve_arcs.curve]

    def horizons(self) -> Curves:
        """Return the horizons, in the order of the spheres."""
        return self.curves.of_kind(HORIZON)

    def __repr__(self) -> str:
        seen = len(np.unique(self.loops.face[self.loops.face != BACKGROUND]))
        arcs = len(self.curve_arcs.curve)
        return f"<VisibilityMap: {len(self.spheres.radius)} spheres, {seen} visible, {arcs} arcs>"


def map_in_view(
    boundary: Boundary,
    spheres: SphereOccluders,
    wanted: Ints,
    view: View,
    projection: Projection,
    label: Ints | None = None,
) -> VisibilityMap:
    """Return the map of what is seen of the ``wanted`` spheres (ascending), as if there were no others.

    ``spheres`` are the boundary's in eye coordinates; the map numbers spheres by their place in ``wanted``. Where a
    ``label`` (n,) from 0 of all spheres is given, faces carry labels, and only what separates different ones is
    computed. Raises ``Degenerate`` where the spheres are not in general position.
    """
    spheres, label = spheres.take(wanted), np.arange(len(wanted)) if label is None else label[wanted]
    creases, hidden = _creases_between(boundary, wanted, label, view)
    horizons = spheres.horizons()
    curves = creases.followed_by(horizons)
    discs = discs_of(horizons, projection)
    near = overlaps(discs)
    count = len(creases.first)
    nearness = spheres.nearness()
    nearer = np.where(nearness[creases.first] > nearness[creases.second], creases.first, creases.second)
    hidden = joined([
        hidden,
        beyond_own_plane(spheres, creases, np.arange(count), nearer),
        horizons_hidden(spheres, horizons, near, count),
        *creases_hidden(spheres, creases, projection, near, discs),
    ])  # fmt: skip
    named = visible_arcs(curves, np.arange(len(curves.first)), hidden)
    curve_arcs, entered = split_at_junctions(named, curves, horizons, spheres)
    sides = _sides(spheres, curves, curve_arcs, entered, near, projection)
    return _assembled(spheres, curves, curve_arcs, np.append(label, BACKGROUND)[sides], projection)


def _creases_between(boundary: Boundary, wanted: Ints, label: Ints, view: View) -> tuple[Curves, Hidden]:
    """One curve for each free arc of a crease between wanted spheres of different labels, and what balls hide of it."""
    number = np.full(len(boundary.spheres.radius) + 1, -1)  # row −1 stays −1
    number[wanted] = np.arange(len(wanted))
    circle = boundary.arcs.circle
    first, second = number[boundary.circles.first[circle]], number[boundary.circles.second[circle]]
    arc = np.flatnonzero((first >= 0) & (second >= 0) & (label[first] != label[second]))
    hidden = outside_free_arcs(boundary, arc)
    creases = creases_in_view(boundary.circles.take(circle[arc]), view)
    return (
        creases._replace(first=first[arc], second=second[arc]),
        hidden._replace(leaves=number[hidden.leaves], enters=number[hidden.enters]),
    )


def _sides(
    spheres: SphereOccluders,
    curves: Curves,
    curve_arcs: CurveArcs,
    entered: Ints,
    near: Neighbours,
    projection: Projection,
) -> Ints:
    """The spheres on the left and the right of each arc (2, k), BACKGROUND where there is none.

    ``second`` lies left and ``first`` right of a crease, on the right of a horizon what is behind it. Beside a horizon
    that is about to enter a ball that ball is seen, however short the arc: of neighbours at almost one height it is as
    short as the square of their difference, and its middle would be a matter of rounding.
    """
    left, right = curves.second[curve_arcs.curve], curves.first[curve_arcs.curve]
    rows = np.flatnonzero(~curves.is_crease()[curve_arcs.curve])
    arcs = projection.page_arcs(curves, curve_arcs.curve[rows], curve_arcs.start[rows], curve_arcs.sweep[rows])
    right[rows] = _behind(spheres, left[rows], arcs.at(arcs.middle()), near)
    for end, other in ((curve_arcs.origin, curve_arcs.target), (curve_arcs.target, curve_arcs.origin)):
        beside = rows[(entered[end[rows]] >= 0) & (entered[other[rows]] < 0)]
        right[beside] = entered[end[beside]]
    return np.stack([left, right])


def _assembled(
    spheres: SphereOccluders, curves: Curves, curve_arcs: CurveArcs, sides: Ints, projection: Projection
) -> VisibilityMap:
    """The map of the arcs whose sides (2, k) carry different labels."""
    rows = np.flatnonzero(sides[0] != sides[1])
    curve_arcs = curve_arcs.take(rows)
    arcs = projection.page_arcs(curves, curve_arcs.curve, curve_arcs.start, curve_arcs.sweep)
    edges = planar_map(curve_arcs.origin, curve_arcs.target, sides[0, rows], sides[1, rows])
    return VisibilityMap(spheres.spheres, curves, curve_arcs, arcs, edges, loops(edges))


def _behind(spheres: SphereOccluders, own: Ints, points: np.ndarray, near: Neighbours) -> Ints:
    """The sphere seen just outside each visible point of a horizon: the nearest other surface there, or BACKGROUND."""
    row, entry = expand(near.start[own], near.start[own + 1])
    sphere = near.item[entry]
    surface = spheres.surface(sphere, points[row])
    rows = np.flatnonzero(surface > -np.inf)
    rows = rows[np.lexsort((surface[rows], row[rows]))]
    behind = np.full(len(own), BACKGROUND)
    behind[row[rows]] = sphere[rows]  # ascending: the last one written is the nearest
    return behind
