"""Labels with leaders."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats
from molviz.picture.furniture.box import Box, Piece, polygons, segments
from molviz.picture.furniture.label_places import label_places
from molviz.picture.furniture.metrics import CAPITAL, DESCENT, one_line, shortened, text_width
from molviz.picture.picture import Color, FillLayer, Mark, StrokeLayer, Text, TextLayer

SIZE = 8.0  # points, of the text
WIDEST = 200.0  # points of a text
HEIGHT = (CAPITAL + 2 * DESCENT) * SIZE  # of a line, capitals in the middle
BESIDE = 2.5  # points between a leader and its text
LINE = 0.5  # points, the width of a leader
HALO = 0.8  # points on both sides of a leader, so that it is seen over the drawing


class Label(NamedTuple):
    """What a text names: a point of the drawing's plane in ångström."""

    x: float
    y: float
    text: str


def labels(
    wanted: Sequence[Label], discs: Floats, scale: float, colors: tuple[Color, Color]
) -> tuple[list[Piece], Box]:
    """Return the labels around discs (n, 3), x y r in ångström, and the box of all; colours of the ink and of halos.

    There must be at least one label. Points are ``scale × ångström``.
    """
    texts = [shortened(one_line(label.text), SIZE, WIDEST) for label in wanted]
    width = np.array([text_width(text, SIZE) + 2 * BESIDE for text in texts])
    anchor = scale * np.array([label[:2] for label in wanted], dtype=float)
    slots = label_places(anchor, np.array([width.max(), HEIGHT]), scale * discs)
    boxes = slots.boxes(np.column_stack([width, np.full(len(width), HEIGHT)]))
    lines = [
        Text(x + side * BESIDE, (y0 + y1 - CAPITAL * SIZE) / 2, text, SIZE, "start" if side > 0 else "end")
        for text, x, side, (_, y0, _, y1) in zip(
            texts, slots.corner[:, 0].tolist(), slots.side[:, 0].tolist(), boxes.tolist(), strict=True
        )
    ]
    low, high = boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)
    layers = [*_leaders(anchor, slots.end, *colors), TextLayer("labels", lines, colors[0])]
    return layers, Box(*low.tolist(), *high.tolist())


def _leaders(anchor: Floats, end: Floats, ink: Color, halo: Color) -> list[Piece]:
    """Lines on wider strips that part them from the drawing."""
    run = end - anchor
    side = np.column_stack([-run[:, 1], run[:, 0]]) * ((HALO + LINE / 2) / np.hypot(*run.T))[:, None]
    strips = polygons(np.stack([anchor - side, end - side, end + side, anchor + side], axis=1))
    marks = [Mark(f"halo{row}") for row in range(len(anchor))]
    under = FillLayer("leader halos", strips, [halo] * len(anchor), marks)
    return [under, StrokeLayer("leaders", segments(anchor, end), LINE, ink)]
