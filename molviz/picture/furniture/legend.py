"""What the colours mean: a bar for a scheme of numbers, swatches with names for a scheme of names."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from molviz.picture.coloring import on_ramp
from molviz.picture.furniture.box import Box, Piece, rectangles
from molviz.picture.furniture.metrics import CAPITAL, one_line, shortened, text_width
from molviz.picture.picture import SPREAD, Color, FillLayer, Mark, Text, TextLayer

SIZE = 8.0  # points, of the text
STEPS = 48  # flat rectangles: exact in every format, and finer than the eye tells apart
BAR = 12.0  # points, the width of the bar
TALLEST, SHORTEST = 180.0, 60.0  # points, of the bar
GAP = 4.0  # points between a colour and its text
SWATCH = 8.0  # points, the side of a swatch
ROW = 13.0  # points from one swatch to the next
COLUMN_GAP = 12.0  # points
NAME = 110.0  # points, the widest name
FEWEST_ROWS = 12  # of a column, however low the drawing is
MOST = 120  # swatches; the rest is counted


@dataclass(frozen=True)
class Ramp:
    """Colours of numbers, from that of the least to that of the greatest."""

    title: str
    least: float
    greatest: float
    colors: Sequence[Color]


@dataclass(frozen=True)
class Swatches:
    """Colours of names, one or several of each, in the order in which they are listed."""

    entries: Sequence[tuple[str, Sequence[Color]]]
    title: str = ""


def legend(what: Ramp | Swatches, left: float, drawing: Box, color: Color) -> tuple[list[Piece], Box]:
    """Return the legend with its left edge at ``left``, half way up beside the drawing, and its box."""
    return _ramp(what, left, drawing, color) if isinstance(what, Ramp) else _swatches(what, left, drawing, color)


def _ramp(ramp: Ramp, left: float, drawing: Box, color: Color) -> tuple[list[Piece], Box]:
    height = min(max(drawing.y1 - drawing.y0 - 3 * SIZE, SHORTEST), TALLEST)
    low = (drawing.y0 + drawing.y1 - height) / 2
    edge = low + height * np.linspace(0.0, 1.0, STEPS + 1)
    boxes = np.column_stack([np.full(STEPS, left), edge[:-1], np.full(STEPS, left + BAR), edge[1:]])
    colors = on_ramp(np.linspace(0.0, 1.0, STEPS), ramp.colors, ramp.colors[0])
    bar = FillLayer("legend", rectangles(boxes), colors, [Mark(f"legend{row}") for row in range(STEPS)], SPREAD)
    texts = [
        Text(left + BAR + GAP, low + share * height - CAPITAL * SIZE / 2, f"{value:.4g}", SIZE)
        for share, value in zip((0.0, 0.5, 1.0), np.linspace(ramp.least, ramp.greatest, 3).tolist(), strict=True)
    ]
    texts.append(Text(left, low + height + SIZE, one_line(ramp.title), SIZE))
    top = low + height + (1 + CAPITAL) * SIZE
    box = Box(left, low - CAPITAL * SIZE / 2, max(map(_right, texts)), top)
    return [bar, TextLayer("legend text", texts, color)], box


def _right(text: Text) -> float:
    """Where a text that starts at its x ends."""
    return text.x + text_width(text.text, text.size)


def _swatches(swatches: Swatches, left: float, drawing: Box, color: Color) -> tuple[list[Piece], Box]:
    """In columns no taller than the drawing, filled one after the other."""
    shown = [(shortened(one_line(name), SIZE, NAME), colors) for name, colors in swatches.entries[:MOST]]
    rest = len(swatches.entries) - len(shown)
    lines = [name for name, _ in shown] + ([f"and {rest} more"] if rest else [])
    title = one_line(swatches.title)
    rows = _rows(len(lines), drawing.y1 - drawing.y0 - (ROW if title else 0.0))
    height = ROW * (rows + bool(title))
    top = (drawing.y0 + drawing.y1 + height) / 2
    corners = _corners(lines, rows, left, top - (ROW if title else 0.0))
    up = (SWATCH - CAPITAL * SIZE) / 2
    texts = [Text(left, top - CAPITAL * SIZE, title, SIZE)] if title else []
    texts += [Text(x + SWATCH + GAP, y + up, line, SIZE) for (x, y), line in zip(corners, lines, strict=True)]
    parts = [
        ((x + SWATCH * part / len(colors), y, x + SWATCH, y + SWATCH), color, Mark(f"legend {name}", name))
        for (name, colors), (x, y) in zip(shown, corners, strict=False)
        for part, color in enumerate(colors)  # each over the rest of the one before: no seams
    ]
    boxes, paints, marks = zip(*parts, strict=True) if parts else ((), (), ())
    fills = FillLayer("legend", rectangles(np.array(boxes)), paints, marks)
    right = max(map(_right, texts), default=left)
    return [fills, TextLayer("legend text", texts, color)], Box(left, top - height, right, top)


def _rows(count: int, height: float) -> int:
    """How many lines go into each column, so that the columns are as many as they must be and even."""
    most = max(int(height // ROW), FEWEST_ROWS)
    columns = max(math.ceil(count / most), 1)
    return math.ceil(count / columns)


def _corners(lines: Sequence[str], rows: int, left: float, top: float) -> list[tuple[float, float]]:
    """The lower left corner of the swatch of each line."""
    corners = []
    for start in range(0, len(lines), max(rows, 1)):
        column = lines[start : start + rows]
        corners += [(left, top - (row + 1) * ROW + (ROW - SWATCH) / 2) for row in range(len(column))]
        left += SWATCH + GAP + max(text_width(line, SIZE) for line in column) + COLUMN_GAP
    return corners
