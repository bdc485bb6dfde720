"""From atoms, their representations and bonds to the balls and sticks that are drawn.

A ball-and-stick ball is a part of the space-filling ball, a ball of sticks alone as wide as they are: all its sticks
then meet in planes. A bond has the thinner stick of its two ends' representations, and one with a space-filling atom
the stick of its other end. Double and triple bonds of ball-and-stick atoms are as many parallel sticks, in the plane of
the neighbours; aromatic ones a stick and, inside the ring, a thinner one; all single where the balls are too small for
several. What sticks may not do, meet anything but their own balls, is the matter of ``molviz.geometry.stick_rules``.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints, Strings
from molviz.geometry.rows import expand
from molviz.geometry.stick_rules import Rods, lengths, settled
from molviz.model.bonds import AROMATIC, Bonds
from molviz.model.representations import BALL_AND_STICK, STICKS, USUAL, Sizes
from molviz.model.spheres import Balls, Spheres
from molviz.model.sticks import Sticks
from molviz.vectors import dot

LONGEST = 6.0  # ångström, above the bond of Cs2: a longer one joins atoms in different cells of a crystal
MOST_STICKS = 60  # of one atom; one of more is no atom, and looking at all pairs of its sticks takes a while
SLANT = 0.006  # of a stick's radius, by which parallel ones may miss their true ends: 1e-3 Å, nothing that can be seen
FAINT = 1e-12  # weight of the direction that a bond's sticks lie in where no neighbour says one
# Sticks of a bond of each order, as parts of the radius of a single one: radius, and offset from the line of centres.
# Between two of them is a gap that can be seen, and together they are at most one and a half times as wide.
_PARALLEL = {
    1.0: ((1.0, 0.0),),
    AROMATIC: ((0.5, -0.7), (0.25, 0.9)),  # the thinner one inside the ring
    2.0: ((0.4, -0.8), (0.4, 0.8)),
    3.0: ((0.33, -1.1), (0.33, 0.0), (0.33, 1.1)),
}


class BallsAndSticks(NamedTuple):
    """What stands for n atoms in a drawing."""

    balls: Balls  # (n,)
    sticks: Sticks
    notes: tuple[str, ...]  # what is odd


def solids_of(spheres: Spheres, representation: Strings, bonds: Bonds, sizes: Sizes = USUAL) -> BallsAndSticks:
    """Return balls and sticks of n atoms.

    ``spheres`` (n,) are the space-filling ones, ``representation`` (n,) the names of any representations but ``hide``.
    Sticks of which nothing would be seen, because the balls at their ends meet around them, are left out.
    """
    rods, notes = _rods(spheres, representation, bonds, sizes)
    radius, rods, more = settled(spheres, _ball_radii(spheres, representation, sizes), rods)
    balls = Spheres(spheres.center, radius)
    return BallsAndSticks(balls, _parallel_sticks(balls, rods), notes + more)


def _ball_radii(spheres: Spheres, style: Strings, sizes: Sizes) -> Floats:
    radius = np.where(style == BALL_AND_STICK, sizes.ball_scale * spheres.radius, spheres.radius)
    return np.where(style == STICKS, sizes.stick(STICKS), radius)


def _rods(spheres: Spheres, style: Strings, bonds: Bonds, sizes: Sizes) -> tuple[Rods, tuple[str, ...]]:
    """Return what joins the balls of bonds, several sticks of one bond as one rod, and what is odd about them."""
    thickness = np.full(len(style), np.inf)
    for name in (BALL_AND_STICK, STICKS):
        thickness[style == name] = sizes.stick(name)
    first, second = bonds.atoms.T
    radius = np.minimum(thickness[first], thickness[second])
    wanted = np.isfinite(radius)
    degree = np.bincount(bonds.atoms[wanted].ravel(), minlength=len(style))
    crowded = np.maximum(degree[first], degree[second]) > MOST_STICKS
    unfit = wanted & (crowded | (lengths(spheres.center, first, second) > LONGEST))
    several = (style[first] == BALL_AND_STICK) & (style[second] == BALL_AND_STICK)
    balls = sizes.ball_scale * np.minimum(spheres.radius[first], spheres.radius[second])
    order = np.where(several & _end_in_planes(bonds.order, radius, balls), bonds.order, 1.0)
    reach = radius * _reach(order)
    count = int(np.sum(unfit))
    notes = (f"{count} bonds longer than {LONGEST:g} Å, or of atoms with more than {MOST_STICKS}, are not drawn",)
    rods = Rods(first, second, radius, reach, order, np.ones(len(order)))
    return rods.take(wanted & ~unfit), notes if count else ()


def _end_in_planes(order: Floats, radius: Floats, balls: Floats) -> Bools:
    """Return which bonds (m,) may have several sticks, of a single stick's radius (m,) and the lesser ball's (m,).

    A stick of radius s at the offset o ends in a plane near to its true end on a ball of radius r; it misses that by
    about ``(os)² / 2τ³`` at most, ``τ² = r² − o² − s²``.
    """
    near, radius = np.isin(order, list(_PARALLEL)), np.where(np.isfinite(radius), radius, 0.0)
    for one, sticks in _PARALLEL.items():
        for s, o in sticks:
            depth = np.sqrt(np.maximum(balls**2 - (o**2 + s**2) * radius**2, 0.0))
            near &= (order != one) | ((o * s) ** 2 * radius**3 <= 2.0 * SLANT * depth**3)
    return near


def _reach(order: Floats) -> Floats:
    """Return how far (m,) the sticks of bonds reach from the line of centres, in radii of a single stick."""
    orders, which = np.unique(order, return_inverse=True)
    reach = [max(radius + abs(offset) for radius, offset in _PARALLEL[one]) for one in orders.tolist()]
    return np.array(reach, dtype=float)[which]


# ---- several sticks of one bond


def _parallel_sticks(balls: Spheres, rods: Rods) -> Sticks:
    """Return the sticks of all rods, in their order."""
    parts = [_PARALLEL[order] for order in rods.order.tolist()]
    rod, _ = expand(np.zeros(len(parts), dtype=np.int64), np.array([len(part) for part in parts], dtype=np.int64))
    table = np.array([stick for part in parts for stick in part]).reshape(-1, 2)
    across = np.zeros((len(parts), 3))
    several = np.flatnonzero(rods.order != 1.0)
    across[several] = _across(balls, rods, several)
    size = rods.radius[rod]
    return Sticks(rods.first[rod], rods.second[rod], size * table[:, 0], (size * table[:, 1])[:, None] * across[rod])


def _across(balls: Spheres, rods: Rods, several: Ints) -> Floats:
    """Return unit vectors (s, 3) at right angles to the given rods, in the plane that their neighbours come nearest to.

    It is the eigenvector of the greatest eigenvalue of Σ w wᵀ, w the parts of the neighbours' directions at right
    angles to the rod; it points to the side on which most aromatic neighbours are, inside the ring. Where all
    neighbours lie on the line of centres, any vector at right angles will do.
    """
    axis = _unit(balls.center[rods.second[several]] - balls.center[rods.first[several]])
    place = np.full(len(rods.first), -1)
    place[several] = np.arange(len(several))
    usual = _any_across(axis)
    spread, inner = FAINT * usual[:, :, None] * usual[:, None, :], np.zeros((len(several), 3))
    for rod, other, direction in _neighbours(balls, rods):
        row = place[rod]
        kept = row >= 0
        row, direction, ring = row[kept], direction[kept], rods.order[other[kept]] == AROMATIC
        w = direction - dot(direction, axis[row])[:, None] * axis[row]
        np.add.at(spread, row, w[:, :, None] * w[:, None, :])
        np.add.at(inner, row[ring], w[ring])
    across = np.linalg.eigh(spread)[1][:, :, -1]
    across = _unit(across - dot(across, axis)[:, None] * axis)
    side = np.where(dot(across, inner) < 0, -1.0, 1.0)
    return across * side[:, None]


def _neighbours(balls: Spheres, rods: Rods) -> list[tuple[Ints, Ints, Floats]]:
    """Return rows of rod, another rod at one of its balls, and the direction (m, 3) of that from the ball."""
    one, other, shared = rods.meetings()
    found = []
    for rod, neighbour in ((one, other), (other, one)):
        far = rods.first[neighbour] + rods.second[neighbour] - shared
        found.append((rod, neighbour, _unit(balls.center[far] - balls.center[shared])))
    return found


def _any_across(axis: Floats) -> Floats:
    """Return unit vectors (s, 3) at right angles to unit vectors and to the coordinate axis farthest from these."""
    least = np.eye(3)[np.argmin(np.abs(axis), axis=1)]
    return _unit(np.cross(axis, least))


def _unit(vectors: Floats) -> Floats:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1)[:, None])
