"""The visibility map: the planar map of what the eye sees (Halperin & Overmars 1994, section 5.2).

Its arcs are the visible arcs of horizons and creases, its vertices are known by name, its faces are the visible regions
of the spheres. Horizons are split where other curves pass under them, so that each arc has one face on either side.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Ints, distinct
from molviz.curves import PlaneArcs
from molviz.geometry.boundary import Boundary
from molviz.geometry.general_position import Degenerate
from molviz.geometry.grid import Neighbours
from molviz.geometry.planar_map import Loops, PlanarMap, loops, merged_faces, planar_map
from molviz.model.spheres import Spheres
from molviz.visibility.bounds import Bounds
from molviz.visibility.curves import HORIZON, LINE, Curves
from molviz.visibility.junctions import CurveArcs, split_at_junctions
from molviz.visibility.named_arcs import Hidden, joined, sticks_at, visible_arcs
from molviz.visibility.occluders.stick import StickOccluders
from molviz.visibility.occlusion import discs_of, overlaps
from molviz.visibility.own_occlusion import creases_in_view, outside_free_arcs
from molviz.visibility.projection import Projection, arcs_on_page
from molviz.visibility.settle import settle_ends
from molviz.visibility.solids import BACKGROUND as BACKGROUND
from molviz.visibility.solids import Solids
from molviz.visibility.stick_curves import caps_on_horizons, halving, hidden_of_own, stick_curves
from molviz.visibility.stick_occlusion import hidden_by_sticks, hidden_of_stick_curves
from molviz.visibility.tiles import Each, Tile, hidden_by_balls, visible_arcs_of, whole_scene
from molviz.visibility.view import View


class VisibilityMap(NamedTuple):
    """The map of one view: arcs of curves, and the planar map they form; lengths in ångström.

    Faces carry the number of the sphere or half stick seen there, BACKGROUND where there is none. Of k sticks between n
    spheres, the half at the first ball of stick j is number n + 2 j, the other n + 2 j + 1.
    """

    spheres: Spheres  # in eye coordinates
    sticks: StickOccluders  # in eye coordinates, those that have a silhouette
    curves: Curves  # creases, curves of sticks, one horizon for each sphere in turn, lines; eye coordinates
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

    def owner(self) -> Ints:
        """Return the sphere (n + 2k,) of each solid: itself, or that at the end of a half stick."""
        return np.append(np.arange(len(self.spheres.radius)), self.sticks.ends.sphere)

    def by_sphere(self) -> "VisibilityMap":
        """Return the map with the halves of sticks counted as parts of their balls' faces; arcs stay as they are."""
        return self._with_faces(self.owner())

    def merged(self) -> "VisibilityMap":
        """Return the map with neighbouring faces of one label as one face; arcs between them bound nothing."""
        edges = merged_faces(self.edges, self.edges.face)
        return self._replace(edges=edges, loops=loops(edges))

    def of_spheres(self) -> "VisibilityMap":
        """Return the map with the halves of sticks counted as background."""
        count = len(self.spheres.radius)
        return self._with_faces(np.append(np.arange(count), np.full(len(self.sticks.ends.sphere), BACKGROUND)))

    def _with_faces(self, label: Ints) -> "VisibilityMap":
        """The map with labels (n + 2k,) for faces."""
        label = np.append(label, BACKGROUND)
        edges = self.edges._replace(face=label[self.edges.face])
        return self._replace(edges=edges, loops=self.loops._replace(face=label[self.loops.face]))

    def horizons(self) -> Curves:
        """Return the horizons, in the order of the spheres."""
        return self.curves.of_kind(HORIZON)

    def __repr__(self) -> str:
        seen = len(distinct(self.loops.face[self.loops.face != BACKGROUND]))
        arcs = len(self.curve_arcs.curve)
        return f"<VisibilityMap: {len(self.spheres.radius)} spheres, {seen} visible, {arcs} arcs>"


def map_in_view(
    boundary: Boundary,
    solids: Solids,
    wanted: Ints,
    view: View,
    projection: Projection,
    label: Ints | None = None,
    each: Each = map,
) -> VisibilityMap:
    """Return the map of what is seen of the ``wanted`` spheres (ascending) and their sticks, as if there were no more.

    The spheres of ``solids`` are the wanted ones of the boundary, in eye coordinates; the map numbers them by their
    place in ``wanted``. Where a ``label`` (n,) from 0 of all the boundary's spheres is given (and no sticks), faces
    carry labels, and only what separates different ones is computed. ``each`` does the tiles of a large map of balls,
    as ``map`` does. Raises ``Degenerate``, of the sticks concerned, where the solids are not in general position.
    """
    number = np.arange(solids.balls + len(solids.sticks.ends.sphere))
    label = solids.seen_halves(number) if label is None else label[wanted]
    creases, hidden = _creases_between(boundary, wanted, label, view, solids.sticks)
    horizons = solids.spheres.horizons()
    near = overlaps(discs_of(horizons, projection))
    scene = whole_scene(solids.spheres, near, creases, hidden, projection)
    bounds = solids.bounds(projection, view)
    if len(solids.sticks.length):
        in_front, near = bounds.neighbours()
        curves, parts = _with_sticks(solids, scene, horizons, in_front, bounds)
        named = visible_arcs(curves, np.arange(len(curves.first)), joined(parts), solids.balls)
        settle_ends(named, curves, solids.sticks, solids.balls)
    else:
        curves = creases.followed_by(horizons)
        named = visible_arcs_of(scene, each)
    try:
        curve_arcs, entered = split_at_junctions(named, curves, solids, view.distance is not None)
        sides = _sides(solids, curves, curve_arcs, entered, near, projection, bounds)
        return _assembled(solids, curves, curve_arcs, np.append(label, BACKGROUND)[sides], projection)
    except Degenerate as special:
        concerned = sticks_at(named, curves, special.rows, solids.balls, solids.sticks.ends.sphere)
        raise Degenerate(solids.sticks.row[concerned]) from None


def _with_sticks(
    solids: Solids, scene: Tile, horizons: Curves, near: Neighbours, bounds: Bounds
) -> tuple[Curves, list[Hidden]]:
    """All curves, those of sticks after the others, and what is hidden of them; ``scene`` is that of the balls.

    ``near`` are the spheres and sticks that may be in front of some of each, ``bounds`` what they keep within.
    """
    spheres, sticks, count = solids.spheres, solids.sticks, solids.balls
    of = stick_curves(sticks, halving(sticks, count), count)
    plain = scene.creases.followed_by(horizons)
    start = len(plain.first)
    curves = plain.followed_by(of.curves)
    own = caps_on_horizons(sticks, spheres, horizons, of, count)
    by_spheres, by_sticks = hidden_of_stick_curves(solids, of, near, bounds, scene.projection, start)
    return curves, [
        scene.inside,
        *hidden_by_balls(scene, horizons),
        own._replace(curve=own.curve + len(scene.creases.first)),
        *hidden_of_own(sticks, spheres, of, start),
        *by_spheres,
        *hidden_by_sticks(sticks, plain, near, count),
        *by_sticks,
    ]


def _creases_between(
    boundary: Boundary, wanted: Ints, label: Ints, view: View, sticks: StickOccluders
) -> tuple[Curves, Hidden]:
    """One curve for each free arc of a crease between wanted spheres of different labels, and what balls hide of it.

    Creases of balls with a stick between them lie inside it.
    """
    number = np.full(len(boundary.spheres.radius) + 1, -1)  # row −1 stays −1
    number[wanted] = np.arange(len(wanted))
    circle = boundary.arcs.circle
    first, second = number[boundary.circles.first[circle]], number[boundary.circles.second[circle]]
    arc = np.flatnonzero((first >= 0) & (second >= 0) & (label[first] != label[second]))
    arc = arc[~sticks.joins(first[arc], second[arc], len(wanted))]
    hidden = outside_free_arcs(boundary, arc)
    creases = creases_in_view(boundary.circles.take(circle[arc]), view)
    return (
        creases._replace(first=first[arc], second=second[arc]),
        hidden._replace(leaves=number[hidden.leaves], enters=number[hidden.enters]),
    )


def _sides(
    solids: Solids,
    curves: Curves,
    curve_arcs: CurveArcs,
    entered: Ints,
    near: Neighbours,
    projection: Projection,
    bounds: Bounds,
) -> Ints:
    """The solids on the left and the right of each arc (2, k), BACKGROUND where there is none.

    ``second`` lies left and ``first`` right of a crease, on the right of a contour what is behind it, on the left of a
    line the half of the stick. Beside a contour that is about to enter a solid that solid is seen, however short the
    arc: of neighbours at almost one height it is as short as the square of their difference, and its middle would be a
    matter of rounding.
    """
    left, right = curves.second[curve_arcs.curve], curves.first[curve_arcs.curve]
    rows = np.flatnonzero(curves.is_contour()[curve_arcs.curve])
    line = rows[curves.kind[curve_arcs.curve[rows]] == LINE]
    at_first = line[curve_arcs.start[line] + curve_arcs.sweep[line] / 2 < np.pi / 2]
    left[at_first] = right[at_first]
    own = solids.rows(left[rows])
    arc = curve_arcs.take(rows)
    arcs = arcs_on_page(curves, arc.curve, arc.start, arc.sweep, projection)
    right[rows] = solids.nearest(near, own, arcs.at(arcs.middle()), projection, bounds)
    for end, other in ((curve_arcs.origin, curve_arcs.target), (curve_arcs.target, curve_arcs.origin)):
        beside = rows[(entered[end[rows]] >= 0) & (entered[other[rows]] < 0)]
        right[beside] = entered[end[beside]]
    return np.stack([left, right])


def _assembled(
    solids: Solids, curves: Curves, curve_arcs: CurveArcs, sides: Ints, projection: Projection
) -> VisibilityMap:
    """The map of the arcs whose sides (2, k) carry different labels."""
    rows = np.flatnonzero(sides[0] != sides[1])
    curve_arcs = curve_arcs.take(rows)
    arcs = arcs_on_page(curves, curve_arcs.curve, curve_arcs.start, curve_arcs.sweep, projection)
    edges = planar_map(curve_arcs.origin, curve_arcs.target, sides[0, rows], sides[1, rows])
    return VisibilityMap(solids.spheres.spheres, solids.sticks, curves, curve_arcs, arcs, edges, loops(edges))
