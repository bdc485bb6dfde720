"""The display list: everything a writer needs to know, and nothing about where it came from."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

import numpy as np

from molviz.arrays import Floats
from molviz.curves import Paths
from molviz.vectors import dot, transformed

SPREAD = 0.24  # points: the usual stroke in a fill's own colour that closes the hairline to its neighbour

Color: TypeAlias = tuple[int, int, int]  # sRGB, 0 to 255 each
Point: TypeAlias = tuple[float, float]
Stops: TypeAlias = tuple[tuple[float, Color], ...]  # at least two; offsets ascend from 0 to 1


@dataclass(frozen=True)
class RadialGradient:
    """The shade of a ball: points relative to its centre, y up.

    Offset 0 is the ``focus``, inside the circle of ``radius`` around the centre, which is offset 1; in between lie
    the circles that shrink evenly from the one to the other. Outside the circle the last colour goes on.
    """

    radius: float
    focus: Point
    stops: Stops


@dataclass(frozen=True)
class LinearGradient:
    """The shade of a stick: points relative to its shape's origin, y up; the end colours go on beyond the ends.

    The colour is constant across the line from ``start`` (offset 0) to ``end`` (offset 1).
    """

    start: Point
    end: Point
    stops: Stops


Gradient: TypeAlias = RadialGradient | LinearGradient
Paint: TypeAlias = Color | RadialGradient | LinearGradient  # sRGB, mixed linearly between stops


def offsets_at(gradient: Gradient, points: Floats) -> Floats:
    """Return the offsets (k,) of a gradient at points (k, 2); ends go on where the result is below 0 or above 1.

    Circle s of a ball has its centre at ``(1 − s) f`` and radius ``s R``. A point f + d lies on it where
    ``|d + s f|² = s² R²``, whose larger root is ``(d·f + √((d·f)² + (R² − f²) d²)) / (R² − f²)``.
    """
    if isinstance(gradient, LinearGradient):
        along = np.subtract(gradient.end, gradient.start)
        return np.asarray(transformed(points - gradient.start, along[None])[:, 0] / np.sum(along**2))
    focus = np.array(gradient.focus)
    d, left = points - focus, gradient.radius**2 - np.sum(focus**2)
    if left <= 0:  # a ball of no size at the digits that are written: all of it is edge
        return np.ones(len(points))
    product = transformed(d, focus[None])[:, 0]
    return np.asarray((product + np.sqrt(product**2 + left * dot(d, d))) / left)


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
    """Filled shapes, painted in order; one paint and one mark per shape.

    ``spread`` is the width of a stroke in the fill's own colour that closes the hairline which viewers that
    anti-alias leave between neighbours, in points; 0 for none. A gradient lies at its shape's ``origin`` (shapes, 2)
    on the page, so that shapes with equal gradients share one; None where all paints are colours. ``opacity`` is that
    of the layer as a whole: overlaps do not show. PostScript has none and mixes paints with the page's background.
    """

    name: str
    paths: Paths
    paint: Sequence[Paint]
    mark: Sequence[Mark]
    spread: float = 0.0
    origin: Floats | None = None
    opacity: float = 1.0


@dataclass(frozen=True)
class StrokeLayer:
    """Stroked paths of one colour and width in points, with round caps and joins; ``opacity`` as of a FillLayer.

    ``below`` is what lies under each shape, which PostScript mixes translucent lines with instead of the background.
    """

    name: str
    paths: Paths
    width: float
    color: Color = (0, 0, 0)
    mark: Sequence[Mark] = ()  # empty, or one per shape
    opacity: float = 1.0
    below: Sequence[Color] = ()  # empty, or one per shape


@dataclass(frozen=True)
class StackedLayer:
    """Fills and strokes with equally many shapes, painted shape by shape: all of shape 0, then of shape 1 over it.

    Shapes hide what is below them: all are opaque, whatever their layers say.
    """

    name: str
    fills: FillLayer
    strokes: Sequence[StrokeLayer]


@dataclass(frozen=True)
class ShadeLayer:
    """Translucent steps over opaque regions: step after step is painted with its opacity in ``color[k]`` inside clip k.

    ``steps`` has one shape per step in painting order, from the deepest and widest to the contact step. ``tone`` are
    the opaque regions below, one shape per colour in painting order; those with ``tone_clip`` k cover clip k. Formats
    without translucency paint the tones again, mixed with the shade, where steps cover them.
    """

    name: str
    steps: Paths
    opacity: Sequence[float]
    clip: Paths
    color: Sequence[Color]
    tone: Paths
    tone_color: Sequence[Color]
    tone_clip: Sequence[int]


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


Layer: TypeAlias = FillLayer | StrokeLayer | StackedLayer | ShadeLayer | TextLayer


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
