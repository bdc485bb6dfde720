"""Painter's pieces: the free part of every hemisphere that faces the eye, back to front.

Halperin & Overmars 1994, section 5.1: the pieces of the union boundary on front hemispheres, drawn in the order of
the spheres' nearness, hide each other correctly (Theorem 5.1). Everything depends on touching neighbours only, so the
union boundary is computed once and serves every view.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Ints
from molviz.curves import PlaneArcs
from molviz.geometry.boundary import Boundary, inside_ball
from molviz.geometry.planar_map import UNUSED, Loops, PlanarMap, loops, planar_map
from molviz.geometry.rows import expand
from molviz.visibility.curves import Curves
from molviz.visibility.junctions import CurveArcs
from molviz.visibility.named_arcs import Hidden, NamedArcs, joined, vertex_numbers, visible_arcs
from molviz.visibility.names import BALL
from molviz.visibility.occluders.sphere import SphereOccluders
from molviz.visibility.own_occlusion import beyond_own_plane, creases_in_view, outside_free_arcs
from molviz.visibility.projection import Projection
from molviz.visibility.view import View


class Pieces(NamedTuple):
    """The painter's pieces of one view; page coordinates in ångström."""

    order: Ints  # (s,) spheres with a piece, back to front
    curves: Curves  # creases, then horizons; eye coordinates
    curve_arcs: CurveArcs  # (k,) the arcs on their curves
    arcs: PlaneArcs  # (k,) the same on the page
    edges: PlanarMap  # (2k,) its faces are the spheres
    loops: Loops  # by sphere

    def is_crease(self) -> Bools:
        """Return which arcs (k,) are creases; the others are horizons."""
        return self.curves.is_crease()[self.curve_arcs.curve]

    def __repr__(self) -> str:
        return f"<Pieces: {len(self.order)} spheres, {len(self.curve_arcs.curve)} arcs>"


def painter_pieces(
    boundary: Boundary, spheres: SphereOccluders, wanted: Ints, view: View, projection: Projection
) -> Pieces:
    """Return the pieces of the ``wanted`` spheres; ``spheres`` are the boundary's in eye coordinates.

    Raises ``Degenerate`` if the spheres are not in general position.
    """
    keep = np.zeros(len(boundary.spheres.radius), dtype=bool)
    keep[wanted] = True
    creases = creases_in_view(boundary.circles, view)
    curves = creases.followed_by(spheres.horizons())
    arc, own = _sides(boundary, keep)
    instance_curve = np.concatenate([boundary.arcs.circle[arc], len(creases.first) + wanted])
    hidden = joined([
        outside_free_arcs(boundary, arc),
        beyond_own_plane(spheres, curves, boundary.arcs.circle[arc], own),
        _horizons_in_balls(boundary, spheres, curves, wanted, len(creases.first), len(arc)),
    ])  # fmt: skip
    named = visible_arcs(curves, instance_curve, hidden)
    return _chained(spheres, curves, named, np.append(own, wanted), projection)


def _sides(boundary: Boundary, keep: Bools) -> tuple[Ints, Ints]:
    """Every free arc once for each of its two spheres that is wanted."""
    circle = boundary.arcs.circle
    own = np.concatenate([boundary.circles.first[circle], boundary.circles.second[circle]])
    rows = np.flatnonzero(keep[own])
    return rows % max(len(circle), 1), own[rows]


def _horizons_in_balls(
    boundary: Boundary, spheres: SphereOccluders, curves: Curves, wanted: Ints, offset: int, before: int
) -> Hidden:
    """What neighbouring balls hide of the wanted horizons; ``offset`` curves and ``before`` instances come first."""
    near = boundary.neighbours
    row, entry = expand(near.start[wanted], near.start[wanted + 1])
    ball = near.item[entry]
    middle, half = inside_ball(spheres.spheres, curves.circles(), offset + wanted[row], ball)
    rows = np.flatnonzero(half > 0)
    name, reason = ball[rows], np.full(len(rows), BALL)
    return Hidden(before + row[rows], (middle - half)[rows], 2 * half[rows], reason, name, name)


def _chained(
    spheres: SphereOccluders, curves: Curves, named: NamedArcs, owner: Ints, projection: Projection
) -> Pieces:
    """Chain the arcs of each sphere; the free part of ``second`` lies left of a crease, that of ``first`` right."""
    label = owner[named.instance]
    right = curves.is_crease()[named.curve] & (curves.first[named.curve] == label)
    curve_arcs = CurveArcs(named.curve, named.start, named.sweep, *vertex_numbers(named.origin, named.target))
    left_face, right_face = np.where(right, UNUSED, label), np.where(right, label, UNUSED)
    edges = planar_map(curve_arcs.origin, curve_arcs.target, left_face, right_face)
    arcs = projection.page_arcs(curves, curve_arcs.curve, curve_arcs.start, curve_arcs.sweep)
    seen = np.unique(label)
    order = seen[np.argsort(spheres.nearness()[seen], kind="stable")]
    return Pieces(order, curves, curve_arcs, arcs, edges, loops(edges))
