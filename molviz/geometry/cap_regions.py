"""What some caps leave free of a unit sphere, many spheres at a time: its arcs, its area and its flux."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.circles import CircleArcs, perpendicular
from molviz.geometry.intervals import Intervals, above, gaps
from molviz.geometry.rims import Rims, opposite_poles, sums, totals, twice_j1, unit_flux
from molviz.geometry.rows import blocks, expand
from molviz.vectors import dot

BLOCK_ROWS = 1 << 20  # pairs of caps at a time


class CapSets(NamedTuple):
    """c caps ``x · axis > cosine`` of m unit spheres, ordered by sphere."""

    sphere: Ints  # (c,) ascending
    start: Ints  # (m + 1,) rows of each sphere's caps
    axis: Floats  # (c, 3)
    cosine: Floats  # (c,)


def free_arcs(caps: CapSets) -> CircleArcs:
    """Return what no other cap of its sphere covers of each rim; circles, and what bounds them, are rows of caps.

    Angles are those of the frame ``perpendicular(axis)``.
    """
    e, f = perpendicular(caps.axis)
    parts = [Intervals(np.empty(0, dtype=np.int64), np.empty(0), np.empty(0))]
    covering = [np.empty(0, dtype=np.int64)]
    begin, end = caps.start[caps.sphere], caps.start[caps.sphere + 1]
    for block in blocks(end - begin, BLOCK_ROWS):
        rim, cap = expand(begin[block], end[block])
        rim += block.start
        sine = _sine(caps.cosine[rim])
        level = caps.cosine[cap] - caps.cosine[rim] * dot(caps.axis[rim], caps.axis[cap])
        middle, half = above(sine * dot(e[rim], caps.axis[cap]), sine * dot(f[rim], caps.axis[cap]), level)
        real = (half > 0) & (rim != cap)
        parts.append(Intervals(rim[real], (middle - half)[real], 2 * half[real]))
        covering.append(cap[real])
    name = np.append(np.concatenate(covering), -1)
    free = gaps(Intervals(*(np.concatenate(column) for column in zip(*parts, strict=True))), len(caps.cosine))
    return CircleArcs(free.circle, free.start, free.sweep, name[free.before], name[free.after])


def rims_of_caps(caps: CapSets, arcs: CircleArcs) -> Rims:
    """Return the arcs with what is left of the spheres on their left, ordered by sphere."""
    e, f = perpendicular(caps.axis[arcs.circle])
    angle = (arcs.start + arcs.sweep / 2)[:, None]
    cosine = caps.cosine[arcs.circle]
    middle = np.cos(angle) * e + np.sin(angle) * f
    return Rims(caps.sphere[arcs.circle], caps.axis[arcs.circle], cosine, _sine(cosine), middle, arcs.sweep / 2)


def area_and_flux(caps: CapSets, rims: Rims) -> tuple[Floats, Floats]:
    """Return area (m,) and ``∫ n dA`` (m, 3) of what is left of each sphere; of those without arcs nothing is left."""
    count = len(caps.start) - 1
    bounded, opposite = opposite_poles(rims)
    toward = np.zeros((count, 3))
    toward[bounded] = opposite
    area = sums(rims.sphere, twice_j1(rims, toward[rims.sphere]), count)
    area[bounded[_outside(caps, bounded, -opposite)]] += 4 * np.pi
    return area, totals(rims.sphere, unit_flux(rims), count)


def _outside(caps: CapSets, sphere: Ints, direction: Floats) -> Bools:
    """Whether the given points (q, 3) of the given spheres are in no cap."""
    query, cap = expand(caps.start[sphere], caps.start[sphere + 1])
    covered = dot(caps.axis[cap], direction[query]) > caps.cosine[cap]
    return np.asarray(np.bincount(query[covered], minlength=len(sphere)) == 0)


def _sine(cosine: Floats) -> Floats:
    return np.asarray(np.sqrt((1 - cosine) * (1 + cosine)))
