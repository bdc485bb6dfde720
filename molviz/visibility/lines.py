"""What the lines of a visibility map are: creases, outlines before another sphere, silhouettes; their depth jumps."""

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.planar_map import loop_areas
from molviz.visibility.curves import BORDER, SEAM
from molviz.visibility.eye import occluders_of, projection_of
from molviz.visibility.map import BACKGROUND, VisibilityMap
from molviz.visibility.solids import Solids
from molviz.visibility.view import View

SLIVER = 0.004  # ångström: thinner faces are not drawn; displaced copies of one outline lie ten times closer
SMALL = 0.1  # ångström: the radius of balls that are smaller than any atom, whose slivers are thinner in proportion
CREASE, OUTLINE, SILHOUETTE, UNDRAWN = range(4)
ROLES = ("crease", "outline", "silhouette")  # the names of those that are drawn


def line_roles(view_map: VisibilityMap, sliver: Bools) -> Ints:
    """Return what each arc (k,) is: CREASE, OUTLINE (before another sphere) or SILHOUETTE (before the background).

    Contours of slivers are UNDRAWN: the edge they nearly coincide with is drawn instead. So are seams and borders,
    across which nothing but a colour changes.
    """
    kind = view_map.curves.kind[view_map.curve_arcs.curve]
    horizon = np.where(is_silhouette(view_map), SILHOUETTE, OUTLINE)
    loop_of = np.empty(len(view_map.edges.face), dtype=np.int64)
    loop_of[view_map.loops.half_edge] = np.repeat(np.arange(len(sliver)), np.diff(view_map.loops.start))
    contour = np.where(sliver[loop_of[::2]], UNDRAWN, horizon)
    return np.where(np.isin(kind, (SEAM, BORDER)), UNDRAWN, np.where(view_map.is_crease(), CREASE, contour))


def is_silhouette(view_map: VisibilityMap) -> Bools:
    """Return which arcs (k,) lie before the background."""
    return np.asarray(view_map.right == BACKGROUND)


def slivers(view_map: VisibilityMap) -> Bools:
    """Return which loops enclose less than ``SLIVER`` times their half length; less in scenes below ``SMALL``."""
    thinnest = SLIVER * min(1.0, float(view_map.spheres.radius.max(initial=0.0)) / SMALL)
    row = view_map.loops.half_edge >> 1
    half = np.add.reduceat(view_map.arcs.lengths()[row], view_map.loops.start[:-1]) / 2 if len(row) else np.empty(0)
    return np.asarray(np.abs(loop_areas(view_map.arcs, view_map.loops)) < thinnest * half)


def depth_jump(view_map: VisibilityMap, view: View) -> Floats:
    """Return how much farther than each arc (k,) the surface behind it lies at its middle, in ångström.

    Measured along the line of sight; 0 where two surfaces meet, infinite at a silhouette.
    """
    projection, arcs = projection_of(view), view_map.curve_arcs
    solids = Solids(occluders_of(view_map.spheres, view), view_map.sticks)
    points = view_map.curves.at(arcs.curve, arcs.start + arcs.sweep / 2)
    right = solids.rows(np.maximum(view_map.right, 0))
    behind, _ = solids.surfaces(right, projection.page_points(points), projection)
    jump = np.where(is_silhouette(view_map), np.inf, projection.nearness(points) - behind)
    return np.where(view_map.curves.is_contour()[arcs.curve], jump, 0.0)
