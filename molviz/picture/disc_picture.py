"""Visible arcs and regions of discs become a picture: one layer of fills, one of strokes, a shape a disc."""

from dataclasses import dataclass

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.curves import Paths, PlaneArcs
from molviz.discs.regions import DiscRegions
from molviz.geometry.circles import CircleArcs
from molviz.model.spheres import Spheres
from molviz.picture.coloring import on_ramp
from molviz.picture.page import Page, Placement, place
from molviz.picture.picture import SPREAD, Color, FillLayer, Layer, Mark, Picture, StrokeLayer

NEAR, FAR = (0xFD, 0xF6, 0xE3), (0x58, 0x6E, 0x75)  # the ends of the colour ramp from the front to the back
WIDTH = 432.0  # points, of a scene whose size nobody asked for


@dataclass(frozen=True)
class DiscLook:
    """Where on the page, and the width of lines in points (0 for none)."""

    page: Page = Page(width=WIDTH)
    outline: float = 0.5
    background: Color | None = None


def disc_picture(spheres: Spheres, arcs: CircleArcs, regions: DiscRegions | None, look: DiscLook) -> Picture:
    """Return a page with the visible arcs, over the visible regions if they are given.

    The box of all discs is that of what is visible: nothing hides the outermost points but discs that share them.
    """
    low, high = (corner[:2] for corner in spheres.box())
    half = look.outline / 2.0
    placed = place(look.page, low, high, half)
    layers: list[Layer] = [] if regions is None else [_fills(spheres, placed, regions)]
    if look.outline > 0:
        layers.append(_strokes(spheres, placed, arcs, look))
    corners = [placed.scale * low + placed.shift - half, placed.scale * high + placed.shift + half]
    x0, y0, x1, y1 = np.concatenate(corners).tolist()
    return Picture(placed.width, placed.height, (x0, y0, x1, y1), layers, background=look.background)


def _strokes(spheres: Spheres, page: Placement, arcs: CircleArcs, look: DiscLook) -> StrokeLayer:
    """A shape a disc, an open loop an arc."""
    discs, first = np.unique(arcs.circle, return_index=True)
    curves = _plane_arcs(spheres, page, arcs.circle, arcs.start, arcs.sweep)
    paths = Paths(curves, np.arange(len(arcs.circle) + 1), np.append(first, len(arcs.circle)))
    return StrokeLayer("visible arcs", paths, look.outline, mark=_marks("s", discs))


def _fills(spheres: Spheres, page: Placement, regions: DiscRegions) -> FillLayer:
    curves = _plane_arcs(spheres, page, regions.circle, regions.start, regions.sweep)
    paths = Paths(curves, regions.loop_start, regions.region_start)
    shade = on_ramp(spheres.center[:, 2], (NEAR, FAR), FAR)
    colors = [shade[disc] for disc in regions.disc.tolist()]
    return FillLayer("visible regions", paths, colors, _marks("f", regions.disc), SPREAD)


def _plane_arcs(spheres: Spheres, page: Placement, circle: Ints, start: Floats, sweep: Floats) -> PlaneArcs:
    """Arcs of perimeters on the page."""
    radius = spheres.radius[circle]
    zero = np.zeros(len(circle))
    u, v = np.column_stack([radius, zero]), np.column_stack([zero, radius])
    return PlaneArcs(spheres.center[circle, :2], u, v, start, sweep).moved(page.scale, page.shift)


def _marks(kind: str, discs: Ints) -> list[Mark]:
    return [Mark(f"{kind}{disc}") for disc in discs.tolist()]
