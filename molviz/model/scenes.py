"""Scenes of spheres that no file describes: Franklin's random gas, and words spelt in spheres (Franklin 1980).

They lie in the unit square of x and y, and larger z is farther, as in the paper. A sphere is only a disc to the
hidden-line algorithm: its z orders it and nothing else.
"""

import math

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.errors import InputError
from molviz.model.glyphs import dots
from molviz.model.spheres import Spheres

PERIOD = 32003  # of his generator: the modulus, a prime
X_PRIMES = (5281, 13513, 22343, 16823)
Y_PRIMES = (13513, 22343, 16823, 5281)
Z_PRIMES = (22343, 16823, 5281, 13513)
DEFAULT_DEPTH = 10.0
LAYERS = 10
LAYER_SHIFT = 3 / 16  # of the spacing, to the right and up with every layer farther back
DOTS_APART = 2  # spheres along the side of one dot of a letter


def random_scene(
    count: int,
    *,
    depth: float | None = None,
    radius: float | None = None,
    seed: int | None = None,
    shrink: bool = False,
) -> Spheres:
    """Return ``count`` random spheres whose discs lie within the unit square.

    ``depth`` is the average number of discs over a point, D = π Σ r²; ``radius`` that of the foremost sphere.
    Without ``seed`` the centres are those of Franklin's cubic generator, which repeats itself after 32003 spheres:
    a larger scene is drawn from NumPy's generator with seed 0. ``shrink`` is his perspective (section 6):
    Rᵢ = R₁ log 11 / log(i + 10) for the i-th sphere from the front.

    Raises ``InputError`` if both depth and radius are given, or discs would not fit into the square.
    """
    if depth is not None and radius is not None:
        raise InputError("depth and radius were both given, expected one of them")
    unit = _cubic_points(count) if seed is None and count <= PERIOD else _uniform_points(count, seed or 0)
    share = _perspective(unit[:, 2]) if shrink else np.ones(count)
    if radius is None:
        wanted = DEFAULT_DEPTH if depth is None else depth
        radius = math.sqrt(wanted / (math.pi * float(np.sum(share**2))))
    share *= radius
    return Spheres(_within_square(unit, share), share)


def text_scene(text: str, *, shrink: bool = False) -> Spheres:
    """Return layers of touching spheres that spell ``text`` (his Fig. 5: "CSE" in 10 layers, about 1500 spheres).

    Layers lie behind each other, each a little to the right and above the one before it; all spheres of a layer
    have the same z. ``shrink`` makes farther layers smaller, after the same law as the random scene.

    Raises ``InputError`` for a character that the dot-matrix font does not have.
    """
    column, row = _sub_dots(*dots(text))
    front = np.stack([column, row], axis=1).astype(np.float64)
    layer = np.repeat(np.arange(LAYERS), len(front))
    flat = np.tile(front, (LAYERS, 1)) + LAYER_SHIFT * layer[:, None]
    radius = np.full(len(flat), 0.5)
    if shrink:
        size = math.log(11.0) / np.log(layer + 11.0)
        middle = flat[layer == 0].mean(axis=0)
        flat, radius = middle + (flat - middle) * size[:, None], radius * size
    return _into_square(Spheres(np.column_stack([flat, layer.astype(np.float64)]), radius))


def _cubic_points(count: int) -> Floats:
    """Points (n, 3) of the paper's generator, (a + b I + c I² + d I³) mod 32003 / 32003 for I = 1 … n."""
    index: Ints = np.arange(1, count + 1, dtype=np.int64)
    return np.column_stack([_cubic(index, primes) for primes in (X_PRIMES, Y_PRIMES, Z_PRIMES)])


def _cubic(index: Ints, primes: tuple[int, int, int, int]) -> Floats:
    a, b, c, d = primes
    return np.asarray((a + index * (b + index * (c + index * d % PERIOD) % PERIOD)) % PERIOD / PERIOD)


def _uniform_points(count: int, seed: int) -> Floats:
    return np.random.default_rng(seed).random((count, 3))


def _perspective(z: Floats) -> Floats:
    """Radii relative to the foremost sphere: log 11 / log(i + 10), i = 1 for the smallest z."""
    place = np.empty(len(z))
    place[np.argsort(z, kind="stable")] = np.arange(1, len(z) + 1)
    return np.asarray(math.log(11.0) / np.log(place + 10.0))


def _within_square(unit: Floats, radius: Floats) -> Floats:
    """The points with x and y shrunk, in place, from [0, 1] to [r, 1 − r]; z stays."""
    if np.any(radius > 0.5):
        raise InputError(f"discs of radius {radius.max():.4g} do not fit into the unit square, expected at most 0.5")
    for axis in (0, 1):
        unit[:, axis] *= 1.0 - 2.0 * radius
        unit[:, axis] += radius
    return unit


def _sub_dots(column: Ints, row: Ints) -> tuple[Ints, Ints]:
    """Every dot becomes a square of spheres."""
    side = np.arange(DOTS_APART)
    wide, high = (part.ravel() for part in np.meshgrid(side, side))
    return (column[:, None] * DOTS_APART + wide).ravel(), (row[:, None] * DOTS_APART + high).ravel()


def _into_square(spheres: Spheres) -> Spheres:
    """Scale by a power of two, which keeps tangent discs exactly tangent, and centre in the unit square."""
    low = np.min(spheres.center[:, :2] - spheres.radius[:, None], axis=0)
    high = np.max(spheres.center[:, :2] + spheres.radius[:, None], axis=0)
    scale = 2.0 ** -math.ceil(math.log2(float(np.max(high - low))))
    middle = (low + high) / 2.0
    flat = (spheres.center[:, :2] - middle) * scale + 0.5
    return Spheres(np.column_stack([flat, spheres.center[:, 2]]), spheres.radius * scale)
