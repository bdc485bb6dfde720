"""Caps on spheres, many spheres at a time: which creases can have a free part, and which balls can bound it.

A ball covers a cap of each sphere it meets, and a crease is the rim of a cap. Of the creases of a molecule with a
solvent probe nine in ten are covered entirely, and a free one is bounded by a handful of the balls that meet it. Both
is found here in single precision, with margins: what is rejected is certainly covered, and what is left is measured
in double precision by ``boundary``. The neighbours of some spheres are padded into arrays (spheres, caps, caps) that
stay in cache.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints, Masks, Singles
from molviz.geometry.circles import perpendicular
from molviz.geometry.tolerances import SINGLE

BINS = 64  # parts of a circle, one bit each
BIN_MARGIN = np.float32(0.01)  # of a bin: 1e-3 radians, far above the rounding of angles in single precision
ALL = np.uint64(2**BINS - 1)


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
    later = (caps.item[:, rims] > caps.sphere[:, None]) & ~_inside_larger(caps, rims)
    a, b, c = _in_plane(caps, rims, later)
    covered = np.bitwise_or.reduce(_bins_inside(a, b, c), axis=1)
    free = np.flatnonzero(covered != ALL)
    outside = _bins_inside(-a[free], -b[free], -c[free])
    crease, k = np.nonzero((outside | covered[free, None]) != ALL)
    sphere, p = (index[free] for index in np.nonzero(later))
    ball = caps.item[sphere[crease], k]
    return OpenCreases(caps.sphere[sphere], caps.item[:, rims][sphere, p], covered[free], crease, ball)


def _inside_larger(caps: Caps, rims: slice) -> Bools:
    """Whether each of the given rims lies in a larger cap of its sphere, (m, r).

    With ω the angles of the caps and δ that between their axes: ``δ < ω_k − ω_p``, or
    ``cos δ − cos ω_p cos ω_k − sin ω_p sin ω_k > 0``, one product of vectors of five.
    """
    sine = np.sqrt(np.maximum(1.0 - caps.cosine**2, 0.0))
    turn = np.stack([caps.cosine, sine], axis=2)
    one = np.concatenate([caps.axis[:, rims], -turn[:, rims]], axis=2, dtype=np.float32)
    other = np.concatenate([caps.axis, turn], axis=2, dtype=np.float32)
    depth: Singles = one @ other.transpose(0, 2, 1)
    depth *= np.tri(depth.shape[1], depth.shape[2], rims.start - 1, dtype=np.float32)
    return np.asarray(depth.max(axis=2) > SINGLE)


def _in_plane(caps: Caps, rims: slice, wanted: Bools) -> tuple[Singles, Singles, Singles]:
    """On the rim p, as circle ``p(θ)`` of the crease: ball k covers ``a cos θ + b sin θ > c``; three arrays (w, p).

    ``p(θ) = cos ω_p axis_p + sin ω_p (e cos θ + f sin θ)``, which enters cap k where ``p(θ) · axis_k > cos ω_k``.
    """
    axis, cosine = caps.axis[:, rims], caps.cosine[:, rims, None]
    sine = np.sqrt(np.maximum(1.0 - cosine**2, 0.0))
    e, f = (vector.reshape(axis.shape) * sine for vector in perpendicular(axis.reshape(-1, 3)))
    against = caps.axis.astype(np.float32).transpose(0, 2, 1)
    a, b, along = ((vector.astype(np.float32) @ against)[wanted] for vector in (e, f, axis * cosine))
    row, own = np.nonzero(wanted)
    c = caps.cosine.astype(np.float32)[row] - along
    c[np.arange(len(row)), own + rims.start] = 2.0  # a ball does not cover its own rim
    return a, b, c


def _bins_inside(a: Singles, b: Singles, c: Singles) -> Masks:
    """The bins on which ``a cos θ + b sin θ > c`` certainly holds throughout."""
    reach = np.sqrt(a * a + b * b) + np.float32(1e-30)
    level = (c + np.float32(SINGLE)) / reach + np.float32(SINGLE)
    half = np.arccos(np.clip(level, -1.0, 1.0)) * np.float32(BINS / (2 * np.pi)) - BIN_MARGIN
    half[level <= -1.0] = BINS
    middle = np.arctan2(b, a) * np.float32(BINS / (2 * np.pi))
    begin = np.ceil(middle - half).astype(np.int64)
    count = np.clip(np.floor(middle + half).astype(np.int64) - begin, 0, BINS).astype(np.uint64)
    return _run_of_bits(begin.astype(np.uint64) % np.uint64(BINS), count)


def _run_of_bits(begin: Masks, count: Masks) -> Masks:
    """Bits begin … begin + count − 1, cyclically; a shift by all 64 bits gives zero."""
    ones = (np.uint64(1) << count) - np.uint64(1)
    return (ones << begin) | (ones >> (np.uint64(BINS) - begin))
