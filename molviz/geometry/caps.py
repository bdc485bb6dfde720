"""Caps on spheres, many spheres at a time: which creases can have a free part, and which balls can bound it.

A ball covers a cap of each sphere it meets, and a crease is the rim of a cap. Of the creases of a molecule with a
solvent probe nine in ten are covered entirely, and a free one is bounded by a handful of the balls that meet it. Both
are found here in single precision, with margins: what is rejected is certainly covered, and what is left is measured
in double precision by ``boundary``. The caps of some spheres are padded into arrays (spheres, caps) that stay in cache,
the largest first, as these alone cover most rims.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints, Masks, Singles
from molviz.geometry.circles import perpendicular
from molviz.geometry.tolerances import SINGLE

BINS = 64  # parts of a circle, one bit each
BIN_MARGIN = np.float32(0.01)  # of a bin: 1e-3 radians, far above the rounding of angles in single precision
ALL = np.uint64(2**BINS - 1)
LARGEST = 16  # caps of a sphere that are tried first: they cover four rims in five


def _runs_of_bits() -> Masks:
    """The masks of c bits from bit b on, cyclically, at c · 64 + b; a shift by all 64 bits gives zero."""
    count, begin = np.divmod(np.arange((BINS + 1) * BINS, dtype=np.uint64), np.uint64(BINS))
    ones = (np.uint64(1) << count) - np.uint64(1)
    return (ones << begin) | (ones >> (np.uint64(BINS) - begin))


RUNS = _runs_of_bits()


class Caps(NamedTuple):
    """The p caps of each of m spheres, the largest first: ball k covers ``x · axis > cosine`` of the unit sphere."""

    sphere: Ints  # (m,)
    item: Ints  # (m, p) the ball, −1 for padding
    axis: Floats  # (m, p, 3)
    cosine: Floats  # (m, p) of the cap's angle, ascending; 2 for padding


class OpenCreases(NamedTuple):
    """Creases that may have a free part, and the balls that may bound it."""

    first: Ints  # (c,)
    second: Ints  # (c,)
    covered: Masks  # (c,) bit b: the crease is covered from angle 2πb/64 to 2π(b + 1)/64
    crease: Ints  # (k,) rows of the above
    ball: Ints  # (k,)


def open_creases(caps: Caps, rims: slice) -> OpenCreases:
    """Return what may be free of the given rims of ``caps``, of those that belong to balls of a higher row."""
    sphere, rim = np.nonzero(caps.item[:, rims] > caps.sphere[:, None])
    rim += rims.start
    width = caps.item.shape[1]
    for number in sorted({min(LARGEST, width), width}):
        a, b, c = _in_plane(caps, sphere, rim, number)
        covered = np.bitwise_or.reduce(_bins_inside(a, b, c), axis=0)
        free = np.flatnonzero(covered != ALL)
        sphere, rim = sphere[free], rim[free]
    outside = _bins_inside(-a[:, free], -b[:, free], -c[:, free])
    crease, k = np.nonzero(((outside | covered[free]) != ALL).T)
    return OpenCreases(caps.sphere[sphere], caps.item[sphere, rim], covered[free], crease, caps.item[sphere[crease], k])


def _in_plane(caps: Caps, sphere: Ints, rim: Ints, number: int) -> tuple[Singles, Singles, Singles]:
    """On w rims, as circles ``p(θ)`` of the creases: cap k covers ``a cos θ + b sin θ > c``; three arrays (number, w).

    ``p(θ) = cos ω_p axis_p + sin ω_p (e cos θ + f sin θ)``, which enters cap k where ``p(θ) · axis_k > cos ω_k``.
    """
    axis, cosine = caps.axis[sphere, rim], caps.cosine[sphere, rim][:, None]
    sine = np.sqrt(np.maximum(1.0 - cosine**2, 0.0))
    e, f = perpendicular(axis)
    against = _singles(caps.axis[:, :number])[:, :, sphere]
    a, b, along = (_products(against, _singles(vector)) for vector in (e * sine, f * sine, axis * cosine))
    c = _singles(caps.cosine[:, :number])[:, sphere] - along
    own = np.flatnonzero(rim < number)
    c[rim[own], own] = 2.0  # a ball does not cover its own rim
    return a, b, c


def _singles(columns: Floats) -> Singles:
    """The transposed array in single precision: the longest axis last, along which numpy is fast."""
    return np.ascontiguousarray(columns.T, dtype=np.float32)


def _products(one: Singles, other: Singles) -> Singles:
    """The scalar products (number, w) of vectors (3, number, w) with vectors (3, w)."""
    total: Singles = one[0] * other[0]
    total += one[1] * other[1]
    total += one[2] * other[2]
    return total


def _bins_inside(a: Singles, b: Singles, c: Singles) -> Masks:
    """The bins on which ``a cos θ + b sin θ > c`` certainly holds throughout."""
    reach = np.sqrt(a * a + b * b) + np.float32(1e-30)
    level = (c + np.float32(SINGLE)) / reach + np.float32(SINGLE)
    half = np.arccos(np.clip(level, -1.0, 1.0)) * np.float32(BINS / (2 * np.pi)) - BIN_MARGIN
    half[level <= -1.0] = BINS
    middle = np.arctan2(b, a) * np.float32(BINS / (2 * np.pi))
    begin = np.ceil(middle - half).astype(np.int32)
    count = np.clip(np.floor(middle + half).astype(np.int32) - begin, 0, BINS)
    return np.asarray(RUNS.take(count * BINS + (begin & (BINS - 1))))
