"""Gradients of SVG, in the coordinates of the shapes that they paint."""

from typing import Any

from svgwrite.gradients import LinearGradient as LinearElement
from svgwrite.gradients import RadialGradient as RadialElement

from molviz.picture.picture import Gradient, LinearGradient
from molviz.write.text import number

PLACES = 4


def gradient_element(gradient: Gradient, name: str) -> Any:
    """Return the element of a gradient; its y runs down, from the origin of a shape."""
    if isinstance(gradient, LinearGradient):
        element = LinearElement(y_down(gradient.start), y_down(gradient.end))
    else:
        element = RadialElement((0, 0), number(gradient.radius, PLACES), y_down(gradient.focus))
    element.update({"id": name, "gradientUnits": "userSpaceOnUse"})
    for offset, color in gradient.stops:
        element.add_stop_color(number(offset, PLACES), "#{:02x}{:02x}{:02x}".format(*color))
    return element


def y_down(point: tuple[float, float]) -> tuple[str, str]:
    """Return a point as SVG has it."""
    return number(point[0], PLACES), number(-point[1], PLACES)
