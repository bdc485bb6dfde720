"""Paints that the writers share: which gradients a picture has, their dictionaries, colours without translucency."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from molviz.arrays import Floats
from molviz.picture.picture import (
    Color,
    FillLayer,
    Gradient,
    Layer,
    LinearGradient,
    Paint,
    StackedLayer,
    Stops,
    StrokeLayer,
)
from molviz.write.text import number

PLACES = 4  # of numbers in a gradient: colours come back as the same bytes


def gradients(layers: Sequence[Layer]) -> list[Gradient]:
    """Return the different gradients of all layers, in order of appearance."""
    fills = [layer.fills if isinstance(layer, StackedLayer) else layer for layer in layers]
    paints = [paint for layer in fills if isinstance(layer, FillLayer) for paint in dict.fromkeys(layer.paint)]
    return list(dict.fromkeys(paint for paint in paints if not isinstance(paint, tuple)))


def origins(layer: FillLayer) -> Floats:
    """Return where the gradient of each shape lies (shapes, 2), to hundredths; the corner of the page for colours."""
    flat = np.array([isinstance(paint, tuple) for paint in layer.paint], dtype=bool)
    place = np.zeros((len(flat), 2)) if layer.origin is None else layer.origin
    return np.asarray(np.where(flat[:, None], 0.0, np.round(place, 2)))


def edge(gradient: Gradient) -> Color:
    """Return the colour that closes hairlines where a format cannot stroke with a gradient: that of the rim."""
    return gradient.stops[-1][1]


def shares(color: Color) -> str:
    """Return a colour as three numbers from 0 to 1, fine enough to come back as the same bytes."""
    return " ".join(number(value / 255, PLACES) for value in color)


def shading(gradient: Gradient) -> str:
    """Return a gradient as a shading dictionary of type 2 or 3, in the syntax that PDF and PostScript share."""
    place: tuple[float, ...]
    if isinstance(gradient, LinearGradient):
        kind, place = 2, (*gradient.start, *gradient.end)
    else:
        kind, place = 3, (*gradient.focus, 0.0, 0.0, 0.0, gradient.radius)
    coordinates = " ".join(number(value, PLACES) for value in place)
    return (
        f"<</ShadingType {kind}/ColorSpace/DeviceRGB/Coords[{coordinates}]/Extend[true true]\n"
        f"/Function {stitched(gradient.stops)}>>"
    )


def stitched(stops: Stops) -> str:
    """Return the function of colours (type 3) made of one straight piece (type 2) between each stop and the next."""
    pairs = list(zip(stops, stops[1:], strict=False))
    pieces = "\n".join(
        f"<</FunctionType 2/Domain[0 1]/N 1/C0[{shares(first)}]/C1[{shares(last)}]>>" for (_, first), (_, last) in pairs
    )
    bounds = " ".join(number(offset, PLACES) for offset, _ in stops[1:-1])
    encode = " ".join(["0 1"] * len(pairs))
    return f"<</FunctionType 3/Domain[0 1]/Bounds[{bounds}]/Encode[{encode}]/Functions[\n{pieces}]>>"


def opaque(layer: Layer) -> Layer:
    """Return a layer whose paints are mixed with white, as they would look on white paper."""
    if isinstance(layer, FillLayer):
        mixed = {paint: whitened(paint, layer.opacity) for paint in dict.fromkeys(layer.paint)}
        return replace(layer, paint=[mixed[paint] for paint in layer.paint], opacity=1.0)
    if isinstance(layer, StrokeLayer):
        return replace(layer, color=mixed_color((255, 255, 255), layer.color, layer.opacity), opacity=1.0)
    return layer


def whitened(paint: Paint, opacity: float) -> Paint:
    """Return a paint of that opacity on white."""
    if isinstance(paint, tuple):
        return mixed_color((255, 255, 255), paint, opacity)
    stops = tuple((offset, mixed_color((255, 255, 255), color, opacity)) for offset, color in paint.stops)
    return replace(paint, stops=stops)


def mixed_color(below: Color, above: Color, opacity: float) -> Color:
    """Return what is seen of two colours: ``below + opacity (above − below)`` in sRGB, as viewers do."""
    red, green, blue = (round(b + opacity * (a - b)) for b, a in zip(below, above, strict=True))
    return red, green, blue
