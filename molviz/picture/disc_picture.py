"""Visible arcs and regions of discs become a picture: one layer of fills, one of strokes, a shape a disc."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.curves import Paths, PlaneArcs
from molviz.model.spheres import Spheres
from molviz.picture.coloring import on_ramp
from molviz.picture.picture import Color, FillLayer, Layer, Mark, Picture, StrokeLayer
from molviz.visibility.disc_regions import DiscRegions
from molviz.visibility.discs import DiscArcs

NEAR, FAR = (0xFD, 0xF6, 0xE3), (0x58, 0x6E, 0x75)  # the ends of the colour ramp from the front to the back
SPREAD = 0.25  # points: closes the hairline between neighbouring fills


@dataclass(frozen=True)
class DiscLook:
    """Lengths in points: width of all discs together, margin around them, line width (0 for no lines)."""

    width: float = 432.0
    margin: float = 9.0
    outline: float = 0.5
    color: Color = (0, 0, 0)


class _Page(NamedTuple):
    """Where the plane lies on the page: ``x → scale x + shift``."""

    size: tuple[float, float]
    scale: float
    shift: Floats


def disc_picture(
    spheres: Spheres, arcs: DiscArcs, regions: DiscRegions | None, look: DiscLook, title: str = ""
) -> Picture:
    """Return a page as large as the scene with the visible arcs, over the visible regions if they are given."""
    page = _page(spheres, look)
    layers: list[Layer] = [] if regions is None else [_fills(spheres, page, regions)]
    if look.outline > 0:
        layers.append(_strokes(spheres, page, arcs, look))
    width, height = page.size
    border = look.margin - look.outline / 2.0
    return Picture(width, height, (border, border, width - border, height - border), layers, title=title)


def whole_circles(count: int) -> DiscArcs:
    """Return every perimeter whole, as drawn before hidden lines are removed."""
    nobody = np.full(count, -1)
    return DiscArcs(np.arange(count), np.zeros(count), np.full(count, 2.0 * np.pi), nobody, nobody)


def _page(spheres: Spheres, look: DiscLook) -> _Page:
    """The box of all discs is that of what is visible: nothing hides the outermost points but discs that share them."""
    low, high = (corner[:2] for corner in spheres.box())
    scale = look.width / float(high[0] - low[0])
    height = scale * float(high[1] - low[1])
    size = look.width + 2.0 * look.margin, height + 2.0 * look.margin
    return _Page(size, scale, look.margin - scale * low)


def _strokes(spheres: Spheres, page: _Page, arcs: DiscArcs, look: DiscLook) -> StrokeLayer:
    """A shape a disc, an open loop an arc."""
    discs, first = np.unique(arcs.circle, return_index=True)
    curves = _plane_arcs(spheres, page, arcs.circle, arcs.start, arcs.sweep)
    paths = Paths(curves, np.arange(len(arcs.circle) + 1), np.append(first, len(arcs.circle)))
    return StrokeLayer("visible arcs", paths, look.outline, look.color, _marks("s", discs))


def _fills(spheres: Spheres, page: _Page, regions: DiscRegions) -> FillLayer:
    curves = _plane_arcs(spheres, page, regions.circle, regions.start, regions.sweep)
    paths = Paths(curves, regions.loop_start, regions.region_start)
    shade = on_ramp(spheres.center[:, 2], (NEAR, FAR), FAR)
    colors = [shade[disc] for disc in regions.disc.tolist()]
    return FillLayer("visible regions", paths, colors, _marks("f", regions.disc), SPREAD)


def _plane_arcs(spheres: Spheres, page: _Page, circle: Ints, start: Floats, sweep: Floats) -> PlaneArcs:
    """Arcs of perimeters on the page."""
    radius = spheres.radius[circle]
    zero = np.zeros(len(circle))
    u, v = np.column_stack([radius, zero]), np.column_stack([zero, radius])
    return PlaneArcs(spheres.center[circle, :2], u, v, start, sweep).moved(page.scale, page.shift)


def _marks(kind: str, discs: Ints) -> list[Mark]:
    return [Mark(f"{kind}{disc}") for disc in discs.tolist()]
