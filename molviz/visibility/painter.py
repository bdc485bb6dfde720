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
from molviz.geometry.circles import Circles
from molviz.geometry.rows import expand
from molviz.model.spheres import Spheres
from molviz.visibility.curves_in_view import beyond_own_plane, merged, outside_free_arcs, rotated_circles
from molviz.visibility.half_edges import UNUSED, Loops, chained, directed, loops
from molviz.visibility.named_arcs import BALL, Hidden, NamedArcs, joined, vertex_numbers, visible_arcs
from molviz.visibility.projection import Projection
from molviz.visibility.view import View


class Pieces(NamedTuple):
    """The painter's pieces of one view; page coordinates in ångström."""

    order: Ints  # (s,) spheres with a piece, back to front
    arcs: PlaneArcs  # (k,)
    circle: Ints  # (k,) the circle each arc belongs to, numbered anyhow
    origin: Ints  # (k,) vertex numbers
    target: Ints  # (k,)
    is_crease: Bools  # (k,)
    loops: Loops  # by sphere; face is the sphere


def painter_pieces(boundary: Boundary, seen: Spheres, wanted: Ints, view: View, projection: Projection) -> Pieces:
    """Return the pieces of the ``wanted`` spheres; ``seen`` are the boundary's spheres in eye coordinates.

    Raises ``Degenerate`` if the spheres are not in general position.
    """
    count = len(seen.radius)
    keep = np.zeros(count, dtype=bool)
    keep[wanted] = True
    creases = rotated_circles(boundary.circles, view)
    circles = merged(creases, projection.horizons(seen))
    arc, own = _sides(boundary, keep)
    curve_circle = np.concatenate([boundary.arcs.circle[arc], len(creases.first) + wanted])
    hidden = joined([
        outside_free_arcs(boundary, arc),
        beyond_own_plane(seen, circles, projection, boundary.arcs.circle[arc], own),
        _horizons_in_balls(boundary, seen, circles, wanted, len(creases.first), len(arc)),
    ])  # fmt: skip
    return _pieces(seen, circles, visible_arcs(circles, curve_circle, hidden), np.append(own, wanted), projection)


def _sides(boundary: Boundary, keep: Bools) -> tuple[Ints, Ints]:
    """Every free arc once for each of its two spheres that is wanted."""
    circle = boundary.arcs.circle
    own = np.concatenate([boundary.circles.first[circle], boundary.circles.second[circle]])
    rows = np.flatnonzero(keep[own])
    return rows % max(len(circle), 1), own[rows]


def _horizons_in_balls(
    boundary: Boundary, seen: Spheres, circles: Circles, wanted: Ints, offset: int, curves: int
) -> Hidden:
    near = boundary.neighbours
    row, entry = expand(near.start[wanted], near.start[wanted + 1])
    ball = near.item[entry]
    middle, half = inside_ball(seen, circles, offset + wanted[row], ball)
    rows = np.flatnonzero(half > 0)
    name, reason = ball[rows], np.full(len(rows), BALL)
    return Hidden(curves + row[rows], (middle - half)[rows], 2 * half[rows], reason, name, name)


def _pieces(seen: Spheres, circles: Circles, arcs: NamedArcs, owner: Ints, projection: Projection) -> Pieces:
    """Chain the arcs of each sphere; the free part of ``second`` lies left of a crease, that of ``first`` right."""
    label = owner[arcs.curve]
    left = circles.first[arcs.circle] != label
    is_crease = circles.second[arcs.circle] >= 0
    forward = np.where(is_crease & ~left, UNUSED, label)
    backward = np.where(is_crease & ~left, label, UNUSED)
    face = directed(forward, backward)
    origin, target = vertex_numbers(arcs.origin, arcs.target)
    following = chained(face, directed(origin, target), directed(target, origin))
    plane = projection.page_arcs(circles, arcs.circle, arcs.start, arcs.sweep)
    spheres = np.unique(label)
    order = spheres[np.argsort(projection.nearness(seen)[spheres], kind="stable")]
    return Pieces(order, plane, arcs.circle, origin, target, is_crease, loops(face, following))
