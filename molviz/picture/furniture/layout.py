"""Everything beside the molecule finds its place: labels around it, legend at the right, title above, scale bar below.

All of it is laid out in points with the drawing at ``scale × ångström``; only then is it known how much room to keep
free on each side, and where the page's origin lies.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import reduce
from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats
from molviz.errors import InputError
from molviz.picture.furniture.box import Box, Piece
from molviz.picture.furniture.labels import Label, labels
from molviz.picture.furniture.legend import Ramp, Swatches, legend
from molviz.picture.furniture.metrics import CAPITAL, DESCENT, LEADING, text_width, wrapped
from molviz.picture.furniture.scale_bar import SHARE, round_length, scale_bar
from molviz.picture.page import NO_MARGINS, Margins, Page, Placement, place
from molviz.picture.picture import Color, Text, TextLayer

AROUND = 10.0  # points between the drawing with its labels and title or scale bar
LEGEND_GAP = 16.0  # points between these and the legend
TITLE_SIZE = 11.0  # points
NARROWEST_TITLE = 160.0  # points: narrower drawings have titles wider than themselves
TITLE_LINES = 4
ROUNDS = 12  # of fitting to a page of fixed size, where room for furniture makes the drawing smaller
ROUND = 0.0  # the length of a scale bar that is to be round and about a fifth of the drawing's width


@dataclass(frozen=True)
class Furniture:
    """What stands beside a drawing; coordinates in ångström on the drawing's plane."""

    title: str = ""
    scale_bar: float | None = None  # ångström, or ROUND
    unit: float = 1.0  # ångström, what stands for one in these and in the drawing
    legend: Ramp | Swatches | None = None
    labels: Sequence[Label] = ()
    discs: Floats = field(default_factory=lambda: np.empty((0, 3)))  # x y r, whose union labels stay off
    color: Color = (0, 0, 0)  # of lines and texts
    halo: Color = (255, 255, 255)  # of what parts leaders from the drawing: the page's colour


class Furnished(NamedTuple):
    """Where the drawing goes, and what is to be painted after it."""

    placement: Placement
    layers: list[Piece]
    box: Box | None  # of all that is painted besides the drawing
    free: Margins  # points kept free beside the drawing


class _Arranged(NamedTuple):
    """Furniture with the drawing at ``scale`` times its coordinates."""

    layers: list[Piece]
    box: Box | None
    free: Margins


def furnish(
    page: Page, low: Floats, high: Floats, line: float, furniture: Furniture, at_least: Margins = NO_MARGINS
) -> Furnished:
    """Return the layout of a drawing from ``low`` to ``high`` (2,) ångström with ``line`` points around it.

    Pictures of one set are framed alike with ``at_least`` the largest ``free`` of any of them. Where a page of fixed
    size leaves less room, the drawing is smaller; a page that fits is as large as needed. Raises InputError where the
    furniture alone is larger than the page.
    """
    free, scale = at_least, 0.0
    for _ in range(ROUNDS):
        placement = place(page, low, high, line, free)
        if placement.scale != scale:
            scale = placement.scale
            drawing = Box(*(scale * low - line).tolist(), *(scale * high + line).tolist())
            arranged = _arranged(scale, drawing, furniture)
        if free.or_more(arranged.free) == free:
            break
        free = free.or_more(arranged.free)
    if free.left + free.right > placement.width or free.bottom + free.top > placement.height:
        raise InputError(f"page {page.size} has no room for all that stands beside the drawing; expected a larger page")
    layers = [_moved(layer, placement.shift) for layer in arranged.layers]
    box = arranged.box and Box(*(np.array(arranged.box) + np.tile(placement.shift, 2)).tolist())
    return Furnished(placement, layers, box, free)


def _arranged(scale: float, drawing: Box, furniture: Furniture) -> _Arranged:
    """All furniture around the drawing's box, from the inside out."""
    parts: list[tuple[list[Piece], Box]] = []
    color, middle = furniture.color, (drawing.x0 + drawing.x1) / 2
    if furniture.labels:
        parts.append(labels(furniture.labels, furniture.discs, scale, (color, furniture.halo)))
    inner = _around(drawing, parts)
    if furniture.legend is not None:
        parts.append(legend(furniture.legend, inner.x1 + LEGEND_GAP, drawing, color))
    if furniture.scale_bar is not None:
        length = furniture.scale_bar or round_length(SHARE * (drawing.x1 - drawing.x0) / scale)
        parts.append(scale_bar(length, scale, middle, inner.y0 - AROUND, color, furniture.unit))
    if furniture.title.strip():
        top = _around(drawing, parts).y1 + AROUND
        parts.append(_title(furniture.title, middle, top, drawing.x1 - drawing.x0, color))
    whole = _around(drawing, parts)
    free = Margins(drawing.x0 - whole.x0, drawing.y0 - whole.y0, whole.x1 - drawing.x1, whole.y1 - drawing.y1)
    layers = [layer for pieces, _ in parts for layer in pieces]
    return _Arranged(layers, _around(parts[0][1], parts) if parts else None, free)


def _around(box: Box, parts: Sequence[tuple[list[Piece], Box]]) -> Box:
    """The box that holds another and those of all parts."""
    return reduce(Box.around, (beside for _, beside in parts), box)


def _title(text: str, middle: float, bottom: float, width: float, color: Color) -> tuple[list[Piece], Box]:
    """The title in lines about as wide as the drawing, above y = ``bottom``, and its box."""
    lines = wrapped(text, TITLE_SIZE, max(width, NARROWEST_TITLE), TITLE_LINES)
    step = LEADING * TITLE_SIZE
    last = bottom + DESCENT * TITLE_SIZE
    texts = [
        Text(middle, last + (len(lines) - 1 - row) * step, line, TITLE_SIZE, "middle")
        for row, line in enumerate(lines)
    ]
    reach = max(text_width(line, TITLE_SIZE) for line in lines) / 2
    return [TextLayer("title", texts, color)], Box(
        middle - reach, bottom, middle + reach, texts[0].y + CAPITAL * TITLE_SIZE
    )


def _moved(layer: Piece, shift: Floats) -> Piece:
    """The layer with all its points shifted."""
    if isinstance(layer, TextLayer):
        x, y = shift.tolist()
        return replace(layer, texts=[replace(text, x=text.x + x, y=text.y + y) for text in layer.texts])
    return replace(layer, paths=layer.paths._replace(arcs=layer.paths.arcs.moved(1.0, shift)))
