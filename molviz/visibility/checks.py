"""Invariants of a visibility map, for whoever wants proof of a picture (``draw --check``)."""

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.curves import PlaneArcs
from molviz.errors import InternalError
from molviz.geometry.intervals import Intervals, above, gaps
from molviz.geometry.planar_map import euler_defect, loop_areas
from molviz.geometry.rows import expand
from molviz.vectors import dot, length
from molviz.visibility.eye import occluders_of, projection_of
from molviz.visibility.map import BACKGROUND, VisibilityMap
from molviz.visibility.occlusion import discs_of, overlaps
from molviz.visibility.projection import Projection
from molviz.visibility.solids import Solids
from molviz.visibility.view import View

AREA_TOLERANCE = 1e-9  # of the drawing's area, by which two ways of computing it may differ
# Of an arc's size: how far beside its middle the faces are looked up. Slivers between lines that nearly coincide, as
# those of a crystal seen along its planes do, may be thinner than the first.
SIDE_STEPS = (1e-7, 1e-8, 1e-9)
LEAST_STEP = 1e-10  # of the largest sphere: shorter steps drown in rounding
CLEAR = 1e-3  # of the step, by which one surface must be nearer than the others to be called the nearest


def check_map(view_map: VisibilityMap, view: View) -> None:
    """Raise InternalError if the map breaks an invariant; that every vertex balances was seen to when it was made."""
    if euler_defect(view_map.edges, view_map.loops):
        raise InternalError("the visibility map breaks Euler's formula")
    difference = area_difference(view_map, projection_of(view))
    if difference > AREA_TOLERANCE:
        raise InternalError(f"the faces' areas differ from the area of the union of discs by {difference:.1e} of it")
    wrong = arcs_beside_wrong_faces(view_map, view)
    if len(wrong):
        raise InternalError(f"{len(wrong)} faces of the visibility map are not what is seen beside their arcs")


def area_difference(view_map: VisibilityMap, projection: Projection) -> float:
    """Return by how much, relatively, the faces' total area misses that of the union of the discs (parallel views).

    The second comes from the discs' own free arcs alone; a central view, whose outlines are ellipses, and one with
    sticks compare the faces with the outer loops instead.
    """
    areas = loop_areas(view_map.arcs, view_map.loops)
    inside = float(areas[view_map.loops.face != BACKGROUND].sum())
    outer = -float(areas[view_map.loops.face == BACKGROUND].sum())
    of_discs = projection.keeps_circles and not len(view_map.sticks.length)
    whole = _union_of_discs(view_map, projection) if of_discs else outer
    return abs(inside - whole) / max(whole, np.finfo(float).tiny)


def _union_of_discs(view_map: VisibilityMap, projection: Projection) -> float:
    discs = discs_of(view_map.horizons(), projection)
    near = overlaps(discs)
    own, entry = expand(near.start[:-1], near.start[1:])
    toward = discs.center[near.item[entry]] - discs.center[own]
    flat = np.sum(toward**2, axis=1) + discs.radius[own] ** 2 - discs.radius[near.item[entry]] ** 2
    middle, half = above(toward[:, 0], toward[:, 1], flat / (2 * discs.radius[own]))
    rows = half > 0
    free = gaps(Intervals(own[rows], (middle - half)[rows], 2 * half[rows]), len(discs.radius))
    u = np.column_stack([discs.radius, np.zeros(len(discs.radius))])[free.circle]
    v = u[:, ::-1]
    return float(PlaneArcs(discs.center[free.circle], u, v, free.start, free.sweep).signed_area().sum())


def arcs_beside_wrong_faces(view_map: VisibilityMap, view: View) -> Ints:
    """Return the arcs beside whose middle the nearest surface is not the face that the map names.

    Arcs that are too short to step beside are left out, points at which two surfaces are closer than the step, and rims
    of joints and of sticks beside the line of centres.
    """
    rows = np.flatnonzero(~_near_rims(view_map)[view_map.curve_arcs.curve])
    for step in SIDE_STEPS:
        if len(rows):
            rows = rows[_wrong_beside(view_map, view, rows, step)]
    return rows


def _wrong_beside(view_map: VisibilityMap, view: View, rows: Ints, step: float) -> Bools:
    """Which of the given arcs have another face than the map says, a step of their size beside their middles."""
    arcs = view_map.arcs.take(rows)
    middle = arcs.middle()
    along = arcs.tangent(middle)
    size = length(along)
    apart = step * size * np.minimum(np.abs(arcs.sweep), 1.0)
    left = np.column_stack([-along[:, 1], along[:, 0]]) / size[:, None] * apart[:, None]
    own = view_map.curves.first[view_map.curve_arcs.curve[rows]]
    wrong = np.zeros(len(rows), dtype=bool)
    for side, face in ((1.0, view_map.left), (-1.0, view_map.right)):
        margin, nearest = _nearest_surface(view_map, own, arcs.at(middle) + side * left, view)
        wrong |= _differ(view_map, nearest, face[rows]) & (margin > CLEAR * apart)
    return np.asarray(wrong & (apart > LEAST_STEP * view_map.spheres.radius.max()))


def _near_rims(view_map: VisibilityMap) -> Bools:
    """Which curves are rims beside which a strip far thinner than the step may be all that shows of a solid."""
    count, ends = len(view_map.spheres.radius), view_map.sticks.ends
    close = np.append(ends.joint | (dot(ends.offset, ends.offset) > 0), False)
    first, second = view_map.curves.first, view_map.curves.second
    return np.asarray((first < count) & (second >= count) & close[np.maximum(second - count, -1)])


def _differ(view_map: VisibilityMap, one: Ints, other: Ints) -> Bools:
    """Whether solids are not the same, nor a ball and its own sticks of which a strip thinner than the step may show.

    A joint goes over into its sticks with a common tangent; a stick beside the line of centres leaves its ball through
    a plane, a little off their true curve.
    """
    ends = view_map.sticks.ends
    close = ends.joint | (dot(ends.offset, ends.offset) > 0)
    ball = np.append(np.full(len(view_map.spheres.radius), -2), np.where(close, ends.sphere, -2))
    ball[ends.sphere[close]] = ends.sphere[close]
    seen = (one >= 0) & (other >= 0)
    return np.asarray((one != other) & ~(seen & (ball[one] >= 0) & (ball[one] == ball[other])))


def _nearest_surface(view_map: VisibilityMap, own: Ints, points: Floats, view: View) -> tuple[Floats, Ints]:
    """The solid seen at each page point, on or beside the image of solid ``own``, and by how much it is nearer."""
    solids, projection = Solids(occluders_of(view_map.spheres, view), view_map.sticks), projection_of(view)
    near, own = solids.overlaps(projection, view), solids.rows(own)
    row, entry = expand(near.start[own], near.start[own + 1])
    row, entry = np.append(row, np.arange(len(own))), np.append(near.item[entry], own)
    surface, solid = solids.surfaces(entry, points[row], projection)
    order = np.lexsort((surface, row))
    best, nearest, second = (np.full(len(own), fill) for fill in (-np.inf, BACKGROUND, -np.inf))
    best[row[order]], nearest[row[order]] = surface[order], solid[order]  # ascending: the last one is the nearest
    behind = order[np.append(row[order][1:] == row[order][:-1], False)]
    second[row[behind]] = surface[behind]
    nearest = np.where(best > -np.inf, nearest, BACKGROUND)
    with np.errstate(invalid="ignore"):
        return np.where(second > -np.inf, best - second, np.inf), nearest.astype(np.int64)
