"""A bar with its length."""

import math

import numpy as np

from molviz.picture.furniture.box import Box, Piece, segments
from molviz.picture.furniture.metrics import CAPITAL, DESCENT, text_width
from molviz.picture.picture import Color, StrokeLayer, Text, TextLayer

SIZE = 8.0  # points, of the text
SHARE = 0.2  # of the drawing's width: the bar whose length nobody asked for, before it is rounded
TICK = 4.0  # points, the height of the ends
LINE = 1.0  # points
GAP = 3.0  # points between the bar and its text
NANOMETRE = 10.0  # ångström; lengths of ten of them or more are told in nanometres


def round_length(length: float) -> float:
    """Return the one of 1, 2, 5 times a power of ten that is nearest to a length in ratio."""
    power = 10.0 ** math.floor(math.log10(length))
    return min((step * power for step in (1.0, 2.0, 5.0, 10.0)), key=lambda step: abs(math.log(step / length)))


def length_text(length: float) -> str:
    """Return a length in ångström as text."""
    return f"{length:.4g} Å" if length < 10 * NANOMETRE else f"{length / NANOMETRE:.4g} nm"


def scale_bar(
    length: float, scale: float, middle: float, top: float, color: Color, unit: float = 1.0
) -> tuple[list[Piece], Box]:
    """Return a bar of ``length`` times ``unit`` ångström, in the middle at x, below y = ``top``, and its box.

    In a central view it holds at the distance of the centre.
    """
    half, y, text = length * scale / 2, top - TICK / 2 - LINE / 2, length_text(length * unit)
    left, right = middle - half, middle + half
    start = np.array([[left, y], [left, y - TICK / 2], [right, y - TICK / 2]])
    end = np.array([[right, y], [left, y + TICK / 2], [right, y + TICK / 2]])
    baseline = y - TICK / 2 - GAP - CAPITAL * SIZE
    reach = max(half + LINE / 2, text_width(text, SIZE) / 2)
    layers: list[Piece] = [
        StrokeLayer("scale bar", segments(start, end), LINE, color),
        TextLayer("scale bar text", [Text(middle, baseline, text, SIZE, "middle")], color),
    ]
    return layers, Box(middle - reach, baseline - DESCENT * SIZE, middle + reach, top)
