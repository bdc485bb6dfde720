"""Invariants of a visibility map, for whoever wants proof of a picture (``draw --check``)."""

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.curves import PlaneArcs
from molviz.errors import InternalError
from molviz.geometry.components import components
from molviz.geometry.intervals import Intervals, above, gaps
from molviz.geometry.rows import expand
from molviz.visibility.half_edges import loop_areas, signed_areas
from molviz.visibility.map import BACKGROUND, VisibilityMap
from molviz.visibility.projection import projection_of
from molviz.visibility.shadows import discs_of, overlaps
from molviz.visibility.view import View

AREA_TOLERANCE = 1e-9  # of the drawing's area, by which two ways of computing it may differ
SIDE_STEP = 1e-7  # of an arc's size: how far beside its middle the faces are looked up, less than slivers are wide
LEAST_STEP = 1e-10  # of the largest sphere: shorter steps drown in rounding
CLEAR = 1e-3  # of the step, by which one surface must be nearer than the others to be called the nearest


def check_map(found: VisibilityMap, view: View) -> None:
    """Raise InternalError if the map breaks an invariant; that every vertex balances was seen to when it was made."""
    if euler_defect(found):
        raise InternalError("the visibility map breaks Euler's formula")
    difference = area_difference(found, view)
    if difference > AREA_TOLERANCE:
        raise InternalError(f"the faces' areas differ from the area of the union of discs by {difference:.1e} of it")
    wrong = faces_not_seen(found, view)
    if len(wrong):
        raise InternalError(f"{len(wrong)} faces of the visibility map are not what is seen beside their arcs")


def euler_defect(found: VisibilityMap) -> int:
    """Return V − E + L − 2 C for V vertices, E arcs, L boundary loops and C components, nought for a planar map.

    Euler's V − E + F = 1 + C in other words: a face with h holes has 1 + h loops.
    """
    vertices, number = np.unique(np.append(found.origin, found.target), return_inverse=True)
    one, other = number[: len(found.origin)], number[len(found.origin) :]
    return int(len(vertices) - len(found.start) + len(found.loops.face) - 2 * components(one, other, len(vertices)))


def area_difference(found: VisibilityMap, view: View) -> float:
    """Return by how much, relatively, the faces' total area misses that of the union of the discs (parallel views).

    The second comes from the discs' own free arcs alone; a central view, whose outlines are ellipses, compares the
    faces with the outer loops instead.
    """
    areas = loop_areas(found.arcs, found.loops)
    inside = float(areas[found.loops.face != BACKGROUND].sum())
    outer = -float(areas[found.loops.face == BACKGROUND].sum())
    whole = _union_of_discs(found) if view.distance is None else outer
    return abs(inside - whole) / max(whole, np.finfo(float).tiny)


def _union_of_discs(found: VisibilityMap) -> float:
    center, radius = found.spheres.center[:, :2], found.spheres.radius
    near = overlaps(discs_of(found.horizons(), projection_of(View(np.eye(3), np.zeros(3)))))
    own, entry = expand(near.start[:-1], near.start[1:])
    toward = center[near.item[entry]] - center[own]
    flat = np.sum(toward**2, axis=1) + radius[own] ** 2 - radius[near.item[entry]] ** 2
    middle, half = above(toward[:, 0], toward[:, 1], flat / (2 * radius[own]))
    rows = half > 0
    free = gaps(Intervals(own[rows], (middle - half)[rows], 2 * half[rows]), len(radius))
    u = np.column_stack([radius, np.zeros(len(radius))])[free.circle]
    v = np.column_stack([np.zeros(len(radius)), radius])[free.circle]
    return float(signed_areas(PlaneArcs(center[free.circle], u, v, free.start, free.sweep)).sum())


def faces_not_seen(found: VisibilityMap, view: View) -> Ints:
    """Return the arcs beside whose middle the nearest surface is not the face that the map names.

    Arcs that are too short to step beside are left out, and points at which two surfaces are closer than the step.
    """
    arcs = found.arcs
    middle = arcs.start + arcs.sweep / 2
    along = arcs.v * np.cos(middle)[:, None] - arcs.u * np.sin(middle)[:, None]
    size = np.linalg.norm(along, axis=1)
    step = SIDE_STEP * size * np.minimum(np.abs(arcs.sweep), 1.0)
    rows = np.flatnonzero(step > LEAST_STEP * found.spheres.radius.max())
    left = np.column_stack([-along[rows, 1], along[rows, 0]]) / size[rows, None] * step[rows, None]
    own = found.circles.first[found.circle[rows]]
    wrong = np.zeros(len(rows), dtype=bool)
    for side, face in ((1.0, found.left), (-1.0, found.right)):
        points = arcs.take(rows).at(middle[rows]) + side * left
        margin, nearest = _nearest_surface(found, own, points, view)
        wrong |= (nearest != face[rows]) & (margin > CLEAR * step[rows])
    return rows[wrong]


def _nearest_surface(found: VisibilityMap, own: Ints, points: Floats, view: View) -> tuple[Floats, Ints]:
    """The sphere seen at each page point, on or beside the image of sphere ``own``, and by how much it is nearer."""
    projection = projection_of(view)
    near = overlaps(discs_of(found.horizons(), projection))
    row, entry = expand(near.start[own], near.start[own + 1])
    row, sphere = np.append(row, np.arange(len(own))), np.append(near.item[entry], own)
    surface = projection.surface(found.spheres, sphere, points[row])
    order = np.lexsort((surface, row))
    best, nearest, second = (np.full(len(own), fill) for fill in (-np.inf, BACKGROUND, -np.inf))
    best[row[order]], nearest[row[order]] = surface[order], sphere[order]  # ascending: the last one is the nearest
    behind = order[np.append(row[order][1:] == row[order][:-1], False)]
    second[row[behind]] = surface[behind]
    nearest = np.where(best > -np.inf, nearest, BACKGROUND)
    with np.errstate(invalid="ignore"):
        return np.where(second > -np.inf, best - second, np.inf), nearest.astype(np.int64)
