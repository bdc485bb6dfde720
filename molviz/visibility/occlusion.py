"""What spheres in front hide of horizons and creases: intervals of the curves inside their balls and occlusions."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.grid import Neighbours, neighbours
from molviz.geometry.intervals import TURN, above
from molviz.geometry.rows import blocks, expand
from molviz.model.spheres import Spheres
from molviz.threads import in_threads
from molviz.vectors import dot
from molviz.visibility.conics import Harmonics, harmonics, roots
from molviz.visibility.curves import Curves
from molviz.visibility.forms import Linear
from molviz.visibility.named_arcs import Hidden
from molviz.visibility.names import BALL, FRONT
from molviz.visibility.occluders.sphere import SphereOccluders
from molviz.visibility.projection import Projection, images_of

BLOCK_ROWS = 1 << 14  # (curve, sphere) rows at a time, some forty columns each: they stay in cache


class Discs(NamedTuple):
    """Circles about the images of curves or spheres on the page."""

    center: Floats  # (m, 2)
    radius: Floats  # (m,)


def discs_of(curves: Curves, projection: Projection) -> Discs:
    """Return a disc around the image of each curve, as small as its ellipse's major axis allows."""
    image = images_of(curves, projection)
    return Discs(image.c, image.major())


def overlaps(discs: Discs) -> Neighbours:
    """Return which discs overlap each disc."""
    flat = np.column_stack([discs.center, np.zeros(len(discs.radius))])
    return neighbours(Spheres(flat, discs.radius))


def horizons_hidden(
    spheres: SphereOccluders, horizons: Curves, which: Ints, near: Neighbours, first_curve: int
) -> Hidden:
    """Return what all spheres hide of some horizons ``which`` (o,), which are curves ``first_curve`` onwards.

    ``near`` are the spheres that overlap each of them. A horizon leaves the interval under a nearer sphere (a
    T-junction) or inside a farther ball (an entry).
    """
    curve = np.repeat(np.arange(len(which)), np.diff(near.start))
    own, other = which[curve], near.item
    margin = spheres.horizon_margin(horizons, own, other)
    middle, half = above(margin.a, margin.b, -margin.c)
    nearness = spheres.nearness()
    rows = np.flatnonzero(half > 0)
    own, other, middle, half = own[rows], other[rows], middle[rows], half[rows]
    reason = np.where(nearness[other] > nearness[own], FRONT, BALL)
    return Hidden(first_curve + curve[rows], middle - half, 2 * half, reason, other, other)


def creases_hidden(
    spheres: SphereOccluders, creases: Curves, projection: Projection, near: Neighbours, lists: Ints, discs: Discs
) -> list[Hidden]:
    """Return what nearer spheres hide of the creases, which are curves 0 onwards, in blocks.

    ``near.item[near.start[lists]]`` onwards overlap the first spheres of the creases, ``discs`` are around spheres.
    Only a sphere nearer than both spheres of a crease can hide what these leave of it: in a parallel view what they
    leave lies above both centres, and an occlusion lies below its sphere's.
    """
    image = discs_of(creases, projection)
    nearness = spheres.nearness()
    nearest = np.maximum(nearness[creases.first], nearness[creases.second])
    begin, end = near.start[lists], near.start[lists + 1]

    def hidden_in(block: slice) -> list[Hidden]:
        row, entry = expand(begin[block], end[block])
        curve, sphere = row + block.start, near.item[entry]
        rows = np.flatnonzero(nearness[sphere] > nearest[curve])
        curve, sphere = curve[rows], sphere[rows]
        apart = image.center.take(curve, axis=0) - discs.center.take(sphere, axis=0)
        reach = image.radius[curve] + discs.radius[sphere]
        rows = np.flatnonzero(dot(apart, apart) < reach**2)
        return [
            occlusion(spheres, creases, curve[part], sphere[part])
            for part in np.array_split(rows, len(rows) // BLOCK_ROWS + 1)
        ]

    found = in_threads(hidden_in, blocks(end - begin, 8 * BLOCK_ROWS))
    return [part for block in found for part in block]


def occlusion(spheres: SphereOccluders, curves: Curves, curve: Ints, sphere: Ints) -> Hidden:
    """Return the intervals of each curve inside the sphere's cone and beyond its plane, by their end points.

    End points are the roots of the cone's function beyond the plane, and those of the plane's inside the cone; between
    consecutive ones a curve is hidden or not as a whole, as its middle is.
    """
    cone = harmonics(spheres.cone(curves, curve, sphere))
    plane = spheres.plane_margin(curves, curve, sphere)
    ends = _ends(cone, plane)
    ends.sort(axis=1)
    sweep = np.roll(ends, -1, axis=1) - ends
    last = np.arange(ends.shape[1]) == np.sum(~np.isnan(ends), axis=1)[:, None] - 1
    sweep = np.where(last, ends[:, :1] + TURN - ends, sweep)
    start, sweep = _without_ends(ends, sweep)
    row, column = np.nonzero(~np.isnan(sweep))
    middle = start[row, column] + sweep[row, column] / 2
    hidden = (cone.take(row).at(middle) < 0) & (plane.take(row).at(middle) > 0)
    row, column = row[hidden], column[hidden]
    name = sphere[row]
    reason = np.full(len(row), FRONT)
    return Hidden(curve[row], start[row, column], sweep[row, column], reason, name, name)


def _ends(cone: Harmonics, plane: Linear) -> Floats:
    """The end points (m, 6) in [0, 2π), NaN where there are fewer."""
    crossing, exists = roots(cone)
    middle, half = above(plane.a, plane.b, -plane.c)
    sinking = np.stack([middle - half, middle + half], axis=1)
    cuts = (half > 0) & (half < np.pi)
    real = np.concatenate([exists & (plane.at(crossing) > 0), cuts[:, None] & (cone.at(sinking) < 0)], axis=1)
    angle = np.mod(np.concatenate([crossing, sinking], axis=1), TURN)
    return np.where(real, angle, np.nan)


def _without_ends(start: Floats, sweep: Floats) -> tuple[Floats, Floats]:
    """A curve without end points is one interval, all round."""
    alone: Bools = np.isnan(start[:, 0])
    start[alone, 0] = 0.0
    sweep[alone, 0] = TURN
    return start, sweep
