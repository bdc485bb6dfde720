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
from molviz.vectors import dot, transformed
from molviz.write.text import number

FLATNESS = "0.2"  # of a device's pixel: curves flattened more coarsely, as many interpreters do, have corners
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


def border_colors(layer: FillLayer) -> list[Color]:
    """Return what closes the hairlines of each shape where a format cannot stroke with a gradient.

    It is the mean colour of the shape's gradient at the middles of its arcs, or its colour.
    """
    loop_shape = np.repeat(np.arange(len(layer.paint)), np.diff(layer.paths.shape_start))
    shape = np.repeat(loop_shape, np.diff(layer.paths.loop_start))
    arcs, colors = layer.paths.arcs, list(layer.paint)
    points = arcs.at(arcs.middle()) - origins(layer)[shape]
    first = np.searchsorted(shape, np.arange(len(colors) + 1)).tolist()
    for row, paint in enumerate(layer.paint):
        if not isinstance(paint, tuple):
            colors[row] = mean_color(paint, points[first[row] : first[row + 1]])
    return [color for color in colors if isinstance(color, tuple)]


def mean_color(gradient: Gradient, points: Floats) -> Color:
    """Return the mean colour of a gradient at points (k, 2) relative to its origin, that of its end without points."""
    offset, table = zip(*gradient.stops, strict=True)
    at = offsets_at(gradient, points) if len(points) else np.ones(1)
    red, green, blue = (round(float(np.interp(at, offset, channel).mean())) for channel in zip(*table, strict=True))
    return red, green, blue


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


def opaque(layer: Layer, paper: Color) -> Layer:
    """Return a layer whose paints are mixed with the colour of the paper, as they look where nothing else is below.

    Lines that know what is below stay as they are.
    """
    if isinstance(layer, FillLayer):
        seen = {paint: mixed(paint, layer.opacity, paper) for paint in dict.fromkeys(layer.paint)}
        return replace(layer, paint=[seen[paint] for paint in layer.paint], opacity=1.0)
    if isinstance(layer, StrokeLayer) and not layer.below:
        return replace(layer, color=mixed_color(paper, layer.color, layer.opacity), opacity=1.0)
    return layer


def mixed(paint: Paint, opacity: float, paper: Color) -> Paint:
    """Return what is seen of a paint of that opacity on paper."""
    if isinstance(paint, tuple):
        return mixed_color(paper, paint, opacity)
    stops = tuple((offset, mixed_color(paper, color, opacity)) for offset, color in paint.stops)
    return replace(paint, stops=stops)


def mixed_color(below: Color, above: Color, opacity: float) -> Color:
    """Return what is seen of two colours: ``below + opacity (above − below)`` in sRGB, as viewers do."""
    red, green, blue = (round(b + opacity * (a - b)) for b, a in zip(below, above, strict=True))
    return red, green, blue
