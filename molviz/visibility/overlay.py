"""Copies of spheres laid over a map: what of them is seen marks parts of the surfaces, exactly, by a second map.

A copy that is enlarged and lowered away from the eye is a skirt hung from its sphere: it is seen where the surface lies
deeper than the skirt, near the edges of whatever stands before something far behind. A copy that is moved a little away
from a light and grown as little is seen on the side of its sphere that the light does not reach.
"""

import numpy as np

from molviz.arrays import Bools, Floats, Ints, distinct
from molviz.geometry.grid import meeting_pairs
from molviz.geometry.rows import expand
from molviz.model.spheres import Spheres
from molviz.visibility.eye import from_the_eye, projection_of
from molviz.visibility.map import BACKGROUND, VisibilityMap
from molviz.visibility.occluders.stick import StickOccluders
from molviz.visibility.scene import labelled_map
from molviz.visibility.view import View

MOVED = 1e-3  # of a radius: how far a copy that marks a side of its sphere is moved, and sticks out at most


def seen_spheres(view_map: VisibilityMap) -> Ints:
    """Return the spheres that have a face, ascending."""
    faces = distinct(view_map.loops.face)
    return np.asarray(faces[(faces != BACKGROUND) & (faces < len(view_map.spheres.radius))])


def seen_halves(view_map: VisibilityMap) -> Ints:
    """Return the halves of sticks that have a face, from 0, ascending; ``view_map`` tells them from the spheres."""
    faces = distinct(view_map.loops.face)
    return np.asarray(faces[faces >= len(view_map.spheres.radius)] - len(view_map.spheres.radius))


def beads_on(sticks: StickOccluders, seen: Ints, wider: float, sag: float) -> tuple[Spheres, Ints]:
    """Return balls along the seen halves of sticks, between those at their ends, and the half of each.

    Balls of radius R at distances h leave ``R − √(R² − h²/4)``, about ``h²/8R``, of the cylinder between them: that is
    at most ``sag`` when they are ``wider`` by some ångström.
    """
    stick = distinct(seen >> 1)
    radius, length = sticks.radius[stick], sticks.length[stick]
    count = np.ceil(length / np.sqrt(8 * (radius + wider) * sag)).astype(np.int64)
    row, number = expand(np.ones_like(count), count)
    share = number / count[row]
    half = 2 * stick[row] + (share > 0.5)
    shown = np.isin(half, seen)
    stick, share = stick[row[shown]], share[shown]
    center = sticks.start[stick] + (share * sticks.length[stick])[:, None] * sticks.direction[stick]
    return Spheres(center, sticks.radius[stick]), half[shown]


def seen_of_copies(spheres: Spheres, copies: Spheres, view: View) -> VisibilityMap:
    """Return the map in which face 0 is what is seen of the spheres and face 1 what is seen of copies among them.

    Both in eye coordinates of the view.
    """
    both = Spheres(*(np.concatenate(columns) for columns in zip(spheres, copies, strict=True)))
    is_copy = (np.arange(len(both.radius)) >= len(spheres.radius)).astype(np.int64)
    return labelled_map(both, is_copy, from_the_eye(view))


def skirts(spheres: Spheres, rows: Ints, reach: float, low: float, view: View) -> Spheres:
    """Return copies of the given spheres, larger by ``reach`` and farther from the eye by ``low`` ångström."""
    return projection_of(view).receded(spheres.take(rows).enlarged(1.0, reach), low)


def drop_at_edge(radius: Floats, reach: float, low: float) -> Floats:
    """Return how deep below its sphere's horizon a skirt meets the line of sight past it: ``low − √(2 r R + R²)``."""
    return low - np.sqrt(2 * radius * reach + reach**2)


def shaded_sides(spheres: Spheres, light: Floats, cosine: float) -> Spheres:
    """Return copies that are seen where the normal's cosine to the unit vector ``light`` is below ``cosine``.

    Moved by ε away from the light and with ``r'² = r² + ε² + 2 ε r cosine``, a copy contains the points of its sphere
    with ``n · light < cosine``.
    """
    moved = MOVED * spheres.radius
    radius = np.sqrt(spheres.radius**2 + moved**2 + 2 * moved * spheres.radius * cosine)
    return Spheres(spheres.center - moved[:, None] * light, radius)


def on_ledges(page: Floats, height: Floats, wanted: Ints, within: float, below: Floats, least: int) -> Bools:
    """Tell of which wanted spheres at least ``least`` others lie within a distance on the page and higher than below.

    ``page`` (n, 2) are the images of the centres, ``height`` (n,) how near they are, ``below`` one height per wanted
    sphere. Lone tips, which are not part of a surface, have none.
    """
    flat = np.column_stack([page, np.zeros(len(page))])
    one, other = meeting_pairs(Spheres(flat, np.full(len(page), within / 2)))
    lowest = np.full(len(page), np.inf)  # that counts; nothing does for what is not wanted
    lowest[wanted] = below
    many = np.zeros(len(page), dtype=np.int64)
    for own, near in ((one, other), (other, one)):
        many += np.bincount(own[height[near] > lowest[own]], minlength=len(page))
    return np.asarray(many[wanted] >= least)
