"""SVG: one element per shape, in groups that any editor shows by name."""

import gzip
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import repeat
from typing import Any

from svgwrite import Drawing
from svgwrite.container import Group
from svgwrite.path import Path
from svgwrite.shapes import Rect

from molviz.picture.picture import Color, FillLayer, Layer, Mark, Picture, StrokeLayer
from molviz.write.svg_path import path_data
from molviz.write.text import clean, number, token

INKSCAPE = "http://www.inkscape.org/namespaces/inkscape"
NAMELESS = Mark("")


def write_svg(picture: Picture) -> bytes:
    """Return the picture as SVG 1.1 in UTF-8; lengths in points."""
    width, height = number(picture.width), number(picture.height)
    drawing = Drawing(size=(f"{width}pt", f"{height}pt"), viewBox=f"0 0 {width} {height}", profile="full", debug=False)
    drawing["xmlns:inkscape"] = INKSCAPE
    drawing.set_desc(clean(picture.title) or None, clean(picture.description) or None)
    if picture.background is not None:
        drawing.add(Rect((0, 0), (width, height), fill=hexadecimal(picture.background), factory=drawing))
    elements = Elements(drawing)
    for layer in picture.layers:
        drawing.add(elements.layer(layer, picture.height))
    return f'<?xml version="1.0" encoding="utf-8"?>\n{drawing.tostring()}\n'.encode()


def write_svgz(picture: Picture) -> bytes:
    """Return the picture as gzipped SVG, without a date."""
    return gzip.compress(write_svg(picture), mtime=0)


def hexadecimal(color: Color) -> str:
    """Return a colour as ``#rrggbb``, or ``#rgb`` where that says the same."""
    text = "#{:02x}{:02x}{:02x}".format(*color)
    return f"#{text[1::2]}" if text[1::2] == text[2::2] else text


class Elements:
    """Makes the elements of one drawing and keeps their ids apart."""

    def __init__(self, drawing: Drawing) -> None:
        self.drawing = drawing
        self.taken: Counter[str] = Counter()

    def fresh_id(self, wish: str) -> str:
        """Return a valid id like ``wish`` that this drawing does not have yet."""
        word = token(wish)
        self.taken[word] += 1
        return word if self.taken[word] == 1 else self.fresh_id(f"{word}-{self.taken[word]}")

    def layer(self, layer: Layer, height: float) -> Group:
        """Return the group of a layer, which Inkscape takes for a layer of its own."""
        group = self.group(layer.name)
        group["inkscape:groupmode"], group["inkscape:label"] = "layer", clean(layer.name)
        data = path_data(layer.paths, height)
        if isinstance(layer, FillLayer):
            usual = Counter(layer.color).most_common(1)[0][0] if layer.color else None
            group.update(fill_attributes(usual, layer.spread) | spread_attributes(layer.spread))
            own = ({} if color == usual else fill_attributes(color, layer.spread) for color in layer.color)
            self.fill(group, data, layer.mark, own)
        else:
            group.update(stroke_attributes(layer))
            self.fill(group, data, layer.mark, repeat({}))
        return group

    def group(self, name: str, **attributes: str) -> Group:
        """Return an empty group with an id like ``name``."""
        return Group(id=self.fresh_id(name), factory=self.drawing, **attributes)

    def fill(self, layer: Group, data: Sequence[str], marks: Sequence[Mark], own: Iterator[dict[str, str]]) -> None:
        """Add the shapes to the layer's group; without marks all of them are one path."""
        if not marks:
            data, marks = ["".join(data)], [NAMELESS]
        nest = Nest(self, layer)
        for d, mark, attributes in zip(data, marks, own, strict=False):
            if d:
                nest.enter(mark.groups).add(self.shape(d, mark, attributes))

    def shape(self, d: str, mark: Mark, attributes: dict[str, str]) -> Path:
        """Return the element of one shape."""
        path = Path(d, factory=self.drawing, **attributes)
        if mark.id:
            path["id"] = self.fresh_id(mark.id)
        if mark.classes:
            path["class"] = " ".join(map(token, mark.classes))
        if mark.title:
            path.set_desc(clean(mark.title))
        return path


class Nest:
    """The groups that are open while shapes are added one after another."""

    def __init__(self, elements: Elements, root: Group) -> None:
        self.elements = elements
        self.names: list[tuple[str, str]] = []
        self.open: list[Group] = [root]

    def enter(self, names: Sequence[tuple[str, str]]) -> Group:
        """Return the innermost group of that name, keeping open what it has in common with the last one."""
        same = [new == old for new, old in zip(names, self.names, strict=False)]
        common = [*same, False].index(False)
        del self.names[common:], self.open[common + 1 :]
        for name, css_class in names[common:]:
            group = self.elements.group(name, class_=token(css_class))
            group.set_desc(clean(name))
            self.open.append(self.open[-1].add(group))
            self.names.append((name, css_class))
        return self.open[-1]


def fill_attributes(color: Color | None, spread: float) -> dict[str, str]:
    """Return how a filled shape looks; the stroke of the spread has the fill's colour."""
    if color is None:
        return {}
    fill = hexadecimal(color)
    return {"fill": fill, "stroke": fill} if spread else {"fill": fill}


def spread_attributes(spread: float) -> dict[str, str]:
    """Return the stroke of a layer whose fills grow by half the spread on either side."""
    return {"stroke-width": number(spread, 3), "stroke-linejoin": "round"} if spread else {}


def stroke_attributes(layer: StrokeLayer) -> dict[str, Any]:
    """Return how the lines of a layer look."""
    return {
        "fill": "none", "stroke": hexadecimal(layer.color), "stroke-width": number(layer.width, 3),
        "stroke-linecap": "round", "stroke-linejoin": "round",
    }  # fmt: skip
