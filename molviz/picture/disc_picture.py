"""Visible arcs and regions of discs become a picture: one layer of fills, one of strokes, a shape a disc."""

from dataclasses import dataclass

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.model.spheres import Spheres
from molviz.curves import Paths, PlaneArcs
from molviz.picture.picture import Color, FillLayer, Layer, Mark, Picture, StrokeLayer
from molviz.visibility.disc_grid import Square
from molviz.visibility.disc_regions import DiscRegions
from molviz.visibility.discs import DiscArcs

NEAR, FAR = (0xFD, 0xF6, 0xE3), (0x58, 0x6E, 0x75)  # the ends of the colour ramp from the front to the back
SPREAD = 0.25  # points: closes the hairline between neighbouring fills


@dataclass(frozen=True)
class DiscLook:
    """Lengths in points: width of the square, margin around it, line width (0 for no lines)."""

    width: float = 432.0
    margin: float = 9.0
    outline: float = 0.5
    color: Color = (0, 0, 0)


def disc_picture(
    spheres: Spheres, square: Square, arcs: DiscArcs, regions: DiscRegions | None, look: DiscLook, title: str = ""
) -> Picture:
    """Return the square on a page with the visible arcs, over the visible regions if they are given."""
    layers: list[Layer] = [] if regions is None else [_fills(spheres, square, regions, look)]
    if look.outline > 0:
        layers.append(_strokes(spheres, square, arcs, look))
    side = look.width + 2.0 * look.margin
    return Picture(side, side, _box(spheres, square, look), layers, title=title)


def whole_circles(count: int) -> DiscArcs:
    """Return every perimeter whole, as drawn before hidden lines are removed."""
    nobody = np.full(count, -1)
    return DiscArcs(np.arange(count), np.zeros(count), np.full(count, 2.0 * np.pi), nobody, nobody)


def _strokes(spheres: Spheres, square: Square, arcs: DiscArcs, look: DiscLook) -> StrokeLayer:
    """A shape a disc, an open loop an arc."""
    discs, first = np.unique(arcs.circle, return_index=True)
    curves = _plane_arcs(spheres, square, look, arcs.circle, arcs.start, arcs.sweep)
    paths = Paths(curves, np.arange(len(arcs.circle) + 1), np.append(first, len(arcs.circle)))
    return StrokeLayer("visible arcs", paths, look.outline, look.color, _marks("arc", discs))


def _fills(spheres: Spheres, square: Square, regions: DiscRegions, look: DiscLook) -> FillLayer:
    curves = _plane_arcs(spheres, square, look, regions.circle, regions.start, regions.sweep)
    paths = Paths(curves, regions.loop_start, regions.region_start)
    colors = _ramp(spheres.center[:, 2])[regions.disc]
    return FillLayer(
        "visible regions", paths, [tuple(color) for color in colors.tolist()], _marks("disc", regions.disc), SPREAD
    )


def _plane_arcs(
    spheres: Spheres, square: Square, look: DiscLook, circle: Ints, start: Floats, sweep: Floats
) -> PlaneArcs:
    """Arcs of perimeters on the page: the square's lower left corner at (margin, margin)."""
    radius = spheres.radius[circle]
    zero = np.zeros(len(circle))
    u, v = np.column_stack([radius, zero]), np.column_stack([zero, radius])
    scale = look.width / square.side
    shift = look.margin - scale * np.array([square.x, square.y])
    return PlaneArcs(spheres.center[circle, :2], u, v, start, sweep).moved(scale, shift)


def _ramp(z: Floats) -> Ints:
    """Colours (n, 3) from the nearest to the farthest disc."""
    depth = (z - z.min()) / max(float(np.ptp(z)), np.finfo(float).tiny)
    return np.rint(np.array(NEAR) + depth[:, None] * (np.array(FAR) - np.array(NEAR))).astype(np.int64)


def _marks(kind: str, discs: Ints) -> list[Mark]:
    return [Mark(f"{kind}-{disc}") for disc in discs.tolist()]


def _box(spheres: Spheres, square: Square, look: DiscLook) -> tuple[float, float, float, float]:
    """The box of all discs is that of what is visible: nothing hides the outermost points but discs that share them."""
    scale, corner = look.width / square.side, np.array([square.x, square.y])
    low = np.min(spheres.center[:, :2] - spheres.radius[:, None], axis=0) - corner
    high = np.max(spheres.center[:, :2] + spheres.radius[:, None], axis=0) - corner
    reach = look.outline / 2.0
    x0, y0 = (low * scale + look.margin - reach).tolist()
    x1, y1 = (high * scale + look.margin + reach).tolist()
    return x0, y0, x1, y1
