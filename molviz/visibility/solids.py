"""Spheres and sticks together: what is seen at a point of the page, and whose curves come near whose."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.geometry.grid import Neighbours
from molviz.geometry.rows import blocks, expand, ordered
from molviz.model.spheres import Spheres
from molviz.threads import in_threads
from molviz.vectors import dot
from molviz.visibility.bounds import Bounds
from molviz.visibility.eye import occluders_of
from molviz.visibility.occluders.sphere import SphereOccluders
from molviz.visibility.occluders.stick import StickOccluders
from molviz.visibility.occlusion import Discs, discs_of, overlaps
from molviz.visibility.projection import Projection
from molviz.visibility.view import View

BACKGROUND = -1
BLOCK_ROWS = 1 << 16  # (point, solid) rows at a time: their columns stay in cache
ABOVE = 1e-9  # ångström, by which a stick is nearer than the ball on which it lies


class Solids(NamedTuple):
    """n spheres and k sticks; the halves of stick j at its first and second ball are number n + 2 j and n + 2 j + 1."""

    spheres: SphereOccluders
    sticks: StickOccluders

    @property
    def balls(self) -> int:
        """The number of spheres."""
        return len(self.spheres.spheres.radius)

    def rows(self, solid: Ints) -> Ints:
        """Return the numbers of spheres and sticks, n + k, of solids (m,), which count the halves of sticks."""
        return np.where(solid < self.balls, solid, (solid + self.balls) // 2)

    def seen_halves(self, solid: Ints) -> Ints:
        """Return the solids (m,), of a stick whose middle lies in a ball the half that is outside of it instead."""
        stick = np.maximum(solid - self.balls, 0) >> 1
        middle = np.append(self.sticks.middle(), 0.0)[stick]
        hidden = (solid >= self.balls) & np.isinf(middle)
        return np.where(hidden, self.balls + 2 * stick + (middle < 0), solid)

    def overlaps(self, projection: Projection, view: View) -> Neighbours:
        """Return which of n spheres and k sticks may overlap each on the page."""
        discs = discs_of(self.spheres.horizons(), projection)
        if len(self.sticks.length):
            around = discs_of(occluders_of(self._around_sticks(), view).horizons(), projection)
            discs = Discs(*(np.concatenate(columns) for columns in zip(discs, around, strict=True)))
        return overlaps(discs)

    def bounds(self, projection: Projection, view: View) -> Bounds:
        """Return what n spheres and k sticks keep within; a stick between the images of spheres around its ends."""
        sticks, images = self.sticks, discs_of(self.spheres.horizons(), projection)
        end = sticks.start + sticks.direction * sticks.length[:, None]
        first, second = (
            discs_of(occluders_of(Spheres(center, sticks.radius), view).horizons(), projection)
            for center in (sticks.start, end)
        )
        around = [self.spheres.spheres, self._around_sticks()]
        center, radius = (np.concatenate(columns) for columns in zip(*around, strict=True))
        nearness = projection.nearness(center)
        return Bounds(
            np.concatenate([images.center, first.center]), np.concatenate([images.center, second.center]),
            np.concatenate([images.radius, np.maximum(first.radius, second.radius)]),
            nearness - radius, nearness + radius,
        )  # fmt: skip

    def _around_sticks(self) -> Spheres:
        """A sphere around each stick."""
        half = self.sticks.length / 2
        center = self.sticks.start + self.sticks.direction * half[:, None]
        return Spheres(center, np.hypot(half, self.sticks.radius))

    def surfaces(self, entry: Ints, page: Floats, projection: Projection) -> tuple[Floats, Ints]:
        """Return how near each of n spheres and k sticks lies at page points (m, 2), −∞ beside it; and which solid."""
        stick = np.flatnonzero(entry >= self.balls)
        if not len(stick):
            return self.spheres.surface(entry, page), entry
        ball = np.flatnonzero(entry < self.balls)
        nearness, solid = np.empty(len(entry)), entry.copy()
        nearness[ball] = self.spheres.surface(entry[ball], page[ball])
        row = entry[stick] - self.balls
        far, beyond = self.sticks.hits(row, *projection.rays(page[stick]))
        nearness[stick], solid[stick] = -far, self.balls + 2 * row + beyond
        beside = np.flatnonzero(np.any(self.sticks.ends.offset[2 * row] != 0.0, axis=1) & np.isfinite(far))
        nearness[stick[beside]] = self._as_cut(row[beside], page[stick[beside]], far[beside], projection)
        return nearness, solid

    def _as_cut(self, stick: Ints, page: Floats, far: Floats, projection: Projection) -> Floats:
        """Return how near sticks (m,) beside the line of centres lie at page points, ``far`` along the lines of sight.

        The planes at their ends say what is stick and what is ball: beyond them a stick lies on its ball, even where it
        is a little inside, and else the ball on it.
        """
        origin, ray = projection.rays(page)
        point, nearness, ends = origin + far[:, None] * ray, -far, self.sticks.ends
        for end in (2 * stick, 2 * stick + 1):
            sphere = ends.sphere[end]
            from_center = point - self.spheres.spheres.center[sphere]
            beyond = dot(from_center, ends.m[end]) > ends.t[end]
            inside = dot(from_center, from_center) < self.spheres.spheres.radius[sphere] ** 2
            ball = self.spheres.surface(sphere, page)
            nearness = np.where(beyond & inside, np.maximum(nearness, ball + ABOVE), nearness)
            under = ~beyond & ~inside & np.isfinite(ball)
            nearness = np.where(under, np.minimum(nearness, ball - ABOVE), nearness)
        return nearness

    def nearest(self, near: Neighbours, own: Ints, points: Floats, projection: Projection, bounds: Bounds) -> Ints:
        """Return the solid seen at page points (m, 2) on the images of spheres or sticks ``own`` (m,), itself left out.

        BACKGROUND where there is none.
        """
        begin, end = near.start[own], near.start[own + 1]

        def nearest(block: slice) -> Ints:
            row, entry = expand(begin[block], end[block])
            item, at = near.item[entry], points[block]
            inside = np.flatnonzero(bounds.meet_discs(item, at.take(row, axis=0), np.zeros(len(row))))
            row, item = row[inside], item[inside]
            surface, solid = self.surfaces(item, at.take(row, axis=0), projection)
            rows = np.flatnonzero(surface > -np.inf)
            rows = rows[ordered(row[rows], surface[rows])]
            found = np.full(len(at), BACKGROUND)
            found[row[rows]] = solid[rows]  # ascending: the last one written is the nearest
            return found

        return np.concatenate([np.empty(0, dtype=np.int64), *in_threads(nearest, blocks(end - begin, BLOCK_ROWS))])
