"""The display list: everything a writer needs to know, and nothing about where it came from."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from molviz.curves import Paths

SPREAD = 0.24  # points: the usual stroke in a fill's own colour that closes the hairline to its neighbour

Color: TypeAlias = tuple[int, int, int]  # sRGB, 0 to 255 each


@dataclass(frozen=True)
class Mark:
    """What a shape stands for, where a format can say so.

    ``groups`` are (name, css classes) pairs from the outside in: ``(("A", "chain"), ("CYS 32", "residue CYS"))``;
    shapes that follow each other with a common prefix belong into the same nested groups. Names come from files:
    writers escape them.
    """

    id: str
    title: str = ""
    classes: tuple[str, ...] = ()
    groups: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class FillLayer:
    """Filled shapes, painted in order; one colour and one mark per shape.

    ``spread`` is the width of a stroke in the fill's own colour that closes the hairline which viewers that
    anti-alias leave between neighbours, in points; 0 for none.
    """

    name: str
    paths: Paths
    color: Sequence[Color]
    mark: Sequence[Mark]
    spread: float = 0.0


@dataclass(frozen=True)
class StrokeLayer:
    """Stroked paths of one colour and width in points, with round caps and joins."""

    name: str
    paths: Paths
    width: float
    color: Color = (0, 0, 0)
    mark: Sequence[Mark] = ()  # empty, or one per shape


@dataclass(frozen=True)
class StackedLayer:
    """Fills and strokes with equally many shapes, painted shape by shape: all of shape 0, then of shape 1 over it."""

    name: str
    fills: FillLayer
    strokes: Sequence[StrokeLayer]


@dataclass(frozen=True)
class Text:
    """A line of text whose baseline starts, has its middle or ends (``anchor``) at x, y; size in points.

    Texts come from files: writers escape them.
    """

    x: float
    y: float
    text: str
    size: float
    anchor: Literal["start", "middle", "end"] = "start"


@dataclass(frozen=True)
class TextLayer:
    """Lines of text in one colour, in a sans-serif face with the widths of Helvetica."""

    name: str
    texts: Sequence[Text]
    color: Color = (0, 0, 0)


Layer: TypeAlias = FillLayer | StrokeLayer | StackedLayer | TextLayer


@dataclass(frozen=True)
class Picture:
    """A page of ``width`` × ``height`` points, y up, origin in the lower left corner; layers in painting order.

    ``box`` is the tight bounding box of everything painted (x0, y0, x1, y1), line widths included.
    """

    width: float
    height: float
    box: tuple[float, float, float, float]
    layers: Sequence[Layer]
    title: str = ""
    background: Color | None = None
    description: str = field(default="", kw_only=True)
