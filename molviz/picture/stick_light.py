"""Light on sticks: bands along them where the normal's cosine to the light is below or above a bound, and gradients.

At the angle φ about the axis, from straight towards the eye, the normal is ``g cos φ + n sin φ`` (g towards the eye, n
across), and its cosine to the light ``R cos (φ − φ0)`` with ``R = hypot(l·g, l·n)`` and ``φ0 = atan2(l·n, l·g)``.
"""

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.curves import Paths
from molviz.picture.cutting import kept_side
from molviz.picture.ink_shapes import in_colors
from molviz.picture.marks import region_mark
from molviz.picture.oklab import colors_of, mix
from molviz.picture.page import Placement
from molviz.picture.picture import FillLayer, LinearGradient, Stops, offsets_at
from molviz.picture.regions import closed_chains, shapes_of, stacked
from molviz.picture.shading import ball_gradients, color_of
from molviz.picture.style import Light, Style
from molviz.visibility.map import VisibilityMap
from molviz.visibility.occluders.stick import StickOccluders
from molviz.visibility.projection import Projection

STOPS = (0.0, 0.04, 0.14, 0.3, 0.5, 0.7, 0.86, 0.96, 1.0)  # of gradients, closer where a cylinder turns away


def half_faces(view_map: VisibilityMap, placement: Placement) -> tuple[Paths, Ints]:
    """Return the visible parts of halves of sticks on the page, one shape each, and which halves (s,), from 0."""
    count = len(view_map.spheres.radius)
    rows = np.flatnonzero(view_map.loops.face >= count)
    halves, shape = np.unique(view_map.loops.face[rows], return_inverse=True)
    arcs = view_map.arcs.moved(placement.scale, placement.shift)
    paths = shapes_of(arcs, view_map.curve_arcs.curve, closed_chains(view_map.loops, rows), shape)
    return paths, halves - count


class StickLight:
    """The sticks of a map as the light falls on them."""

    def __init__(self, view_map: VisibilityMap, projection: Projection, placement: Placement, light: Light) -> None:
        self.sticks: StickOccluders = view_map.sticks
        self.projection, self.placement, self.light = projection, placement, light
        self.paths, self.half = half_faces(view_map, placement)
        self.stick = self.half >> 1
        self.across = np.cross(self.sticks.facing, self.sticks.direction)[self.stick]
        self.facing = self.sticks.facing[self.stick]
        toward = np.array(light.direction)
        self.to_eye, self.to_side = (np.sum(axis * toward, axis=1) for axis in (self.facing, self.across))

    def bands(self, fill: Ints) -> list[FillLayer]:
        """Return the bands of light over halves of the colours ``fill`` (halves, 3), opaque, the darkest last."""
        layers, dark, bright = [], fill[self.half], fill[self.half]
        for cosine, opacity in self.light.terminators:
            dark = mix(dark, self.light.dark, opacity)
            sides = stacked([self._beyond(cosine, end) for end in (-1.0, 1.0)])
            layers += self._layer("terminators on sticks", sides, np.tile(dark, (2, 1)))
        for cosine, opacity in self.light.highlights:
            bright = mix(bright, self.light.bright, opacity)
            layers += self._layer("highlights on sticks", self._between(cosine), bright)
        return layers

    def _edges(self, cosine: float) -> tuple[Floats, Floats]:
        """The middle φ0 and half-width of the angles at which the cosine is larger; 0 where it never is, else π."""
        reach = np.hypot(self.to_eye, self.to_side)
        half = np.arccos(np.clip(cosine / np.maximum(reach, np.finfo(float).tiny), -1.0, 1.0))
        return np.arctan2(self.to_side, self.to_eye), half

    def _beyond(self, cosine: float, end: float) -> Paths:
        """What lies at angles beyond φ0 ± h; ``end`` is the sign."""
        middle, half = self._edges(cosine)
        return self._cut(self.paths, middle + end * half, end)

    def _between(self, cosine: float) -> Paths:
        middle, half = self._edges(cosine)
        return self._cut(self._cut(self.paths, middle - half, 1.0), middle + half, -1.0)

    def _cut(self, paths: Paths, angle: Floats, side: float) -> Paths:
        """The side of the lines along the sticks at the given angles on which angles are larger (side 1) or smaller."""
        angle = np.clip(angle, -np.pi / 2, np.pi / 2)
        first = self._page(angle, np.zeros(len(angle)))
        last = self._page(angle, self.sticks.length[self.stick])
        along = (last - first) / np.maximum(np.hypot(*(last - first).T), np.finfo(float).tiny)[:, None]
        return kept_side(paths, first, side * np.column_stack([-along[:, 1], along[:, 0]]))

    def _page(self, angle: Floats, along: Floats) -> Floats:
        """Points of the sticks at angles and lengths, on the page."""
        normal = self.facing * np.cos(angle)[:, None] + self.across * np.sin(angle)[:, None]
        point = self.sticks.start[self.stick] + self.sticks.radius[self.stick, None] * normal
        point = point + self.sticks.direction[self.stick] * along[:, None]
        return self.placement.scale * self.projection.page_points(point) + self.placement.shift

    def _layer(self, name: str, paths: Paths, color: Ints) -> list[FillLayer]:
        """The shapes that are not empty, if any, one for each colour."""
        if not len(paths.arcs.c):
            return []
        full: Bools = np.diff(paths.shape_start) > 0
        kept = np.append(paths.shape_start[:-1][full], paths.shape_start[-1])
        merged, distinct = in_colors(paths._replace(shape_start=kept), color[full])
        return [FillLayer(name, merged, colors_of(distinct), [region_mark("", name)] * len(distinct))]

    def gradients(self, fill: Ints, style: Style) -> tuple[list[LinearGradient], Floats]:
        """Return the shading of the halves of the colours ``fill`` (halves, 3), and their origins on the page."""
        middle = self.sticks.length[self.stick] / 2
        sides = [self._page(np.full(len(middle), end * np.pi / 2), middle) for end in (-1.0, 1.0)]
        origin = (sides[0] + sides[1]) / 2
        starts, ends = ((side - origin).round(2).tolist() for side in sides)
        return [
            LinearGradient(tuple(start), tuple(end), stops)
            for start, end, stops in zip(starts, ends, self._stops(fill[self.half], style), strict=True)
        ], origin

    def _stops(self, fill: Ints, style: Style) -> list[Stops]:
        """Colours across each half: those of a ball where its normal is the same, so that joints show no border."""
        distinct, which = np.unique(fill, axis=0, return_inverse=True)
        balls = ball_gradients(distinct, np.ones(len(distinct)), style)
        angle = np.arcsin(2 * np.array(STOPS) - 1)
        normal = self.facing[:, None] * np.cos(angle)[:, None] + self.across[:, None] * np.sin(angle)[:, None]
        shade = offsets_at(balls[0], normal[..., :2].reshape(-1, 2)).reshape(len(fill), -1)
        rows = []
        for ball, at in zip(which.ravel().tolist(), shade, strict=True):
            offset, color = zip(*balls[ball].stops, strict=True)
            channels = [np.interp(at, offset, channel).round() for channel in zip(*color, strict=True)]
            rows.append(tuple(zip(STOPS, map(color_of, np.stack(channels, axis=1).astype(int).tolist()), strict=True)))
        return rows
