"""The legend of a continuous colour scheme: a bar of its colours with numbers beside it."""

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.curves import Paths, PlaneArcs
from molviz.picture.coloring import on_ramp
from molviz.picture.picture import SPREAD, FillLayer, Layer, Mark, Text, TextLayer
from molviz.picture.style import Style

STEPS = 48  # flat rectangles: exact in every format, and finer than the eye tells apart
BAR = 12.0  # points wide
WIDTH = 90.0  # points that bar and numbers take beside a drawing
SIZE = 8.0  # of the text


def legend(values: Floats, title: str, style: Style, x: float, low: float, high: float) -> list[Layer]:
    """Return a bar from the least value at height ``low`` to the greatest at ``high``, its left edge at ``x``."""
    known = values[np.isfinite(values)]
    least, greatest = (float(known.min()), float(known.max())) if len(known) else (0.0, 0.0)
    steps = np.linspace(0.0, 1.0, STEPS)
    marks = [Mark(f"legend{row}") for row in range(STEPS)]
    bar = FillLayer("legend", _rectangles(x, low, high), on_ramp(steps, style.colors.ramp, style.colors.unknown), marks, SPREAD)
    ticks = [
        Text(x + BAR + 4, low + share * (high - low) - SIZE / 3, f"{least + share * (greatest - least):.4g}", SIZE)
        for share in (0.0, 0.5, 1.0)
    ]
    return [bar, TextLayer("legend text", [*ticks, Text(x, high + SIZE, title, SIZE)], style.lines.color)]


def _rectangles(x: float, low: float, high: float) -> Paths:
    """Rectangles on top of each other; a side is an arc of an ellipse without width."""
    half = (high - low) / STEPS / 2
    middle = low + half * (2 * np.arange(STEPS) + 1)
    corner = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    side = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    size = np.array([BAR / 2, half])
    center = np.column_stack([np.full(STEPS, x + BAR / 2), middle])[:, None] + (corner + side) * size
    u = np.broadcast_to(side * size, center.shape)
    count = 4 * STEPS
    arcs = PlaneArcs(
        center.reshape(-1, 2), u.reshape(-1, 2), np.zeros((count, 2)), np.full(count, np.pi), np.full(count, np.pi)
    )
    loops: Ints = np.arange(0, count + 1, 4)
    return Paths(arcs, loops, np.arange(STEPS + 1))
