"""Two pictures of one thing, as its left and its right eye see it, beside each other on one page."""

from dataclasses import replace

import numpy as np

from molviz.arrays import Floats
from molviz.curves import Paths
from molviz.picture.page import POINTS, Page
from molviz.picture.picture import FillLayer, Layer, Picture, ShadeLayer, StackedLayer, StrokeLayer

HALF_WIDTH = 56 * POINTS["mm"]  # of each drawing: eyes that look straight ahead are 60 to 65 mm apart


def page_of_half(page: Page) -> Page:
    """Return the page of one of the two pictures; one whose size nobody asked for is as wide as eyes are apart."""
    usual = page.size == "fit" and page.width is None and page.scale is None
    return replace(page, beside=2, width=HALF_WIDTH if usual else page.width)


def beside(left: Picture, right: Picture) -> Picture:
    """Return the page with both pictures, whose pages are equally large; everything is on both, so that it fuses."""
    shift = np.array([left.width, 0.0])
    layers = [replace(layer, name=f"left {layer.name}") for layer in left.layers]
    layers += [replace(_moved(layer, shift), name=f"right {layer.name}") for layer in right.layers]
    x0, y0, _, y1 = left.box
    _, low, x1, high = right.box
    box = (x0, min(y0, low), left.width + x1, max(y1, high))
    return replace(left, width=left.width + right.width, box=box, layers=layers)


def _moved(layer: Layer, shift: Floats) -> Layer:
    """The layer with all its points shifted."""
    if isinstance(layer, FillLayer):
        return _moved_fills(layer, shift)
    if isinstance(layer, StrokeLayer):
        return _moved_strokes(layer, shift)
    if isinstance(layer, StackedLayer):
        strokes = [_moved_strokes(stroke, shift) for stroke in layer.strokes]
        return replace(layer, fills=_moved_fills(layer.fills, shift), strokes=strokes)
    if isinstance(layer, ShadeLayer):
        steps, clip, tone = (_shifted(paths, shift) for paths in (layer.steps, layer.clip, layer.tone))
        return replace(layer, steps=steps, clip=clip, tone=tone)
    x, y = shift.tolist()
    return replace(layer, texts=[replace(text, x=text.x + x, y=text.y + y) for text in layer.texts])


def _moved_fills(layer: FillLayer, shift: Floats) -> FillLayer:
    origin = None if layer.origin is None else layer.origin + shift
    return replace(layer, paths=_shifted(layer.paths, shift), origin=origin)


def _moved_strokes(layer: StrokeLayer, shift: Floats) -> StrokeLayer:
    return replace(layer, paths=_shifted(layer.paths, shift))


def _shifted(paths: Paths, shift: Floats) -> Paths:
    return paths._replace(arcs=paths.arcs.moved(1.0, shift))
