"""SVG: one element per shape, in groups that any editor shows by name."""

import gzip
from collections import Counter
from collections.abc import Sequence
from typing import Any
from xml.etree.ElementTree import Element, SubElement

from svgwrite import Drawing
from svgwrite.container import Group, Style
from svgwrite.path import Path
from svgwrite.shapes import Rect
from svgwrite.text import Text

from molviz.picture.picture import Color, FillLayer, Layer, Mark, Picture, StackedLayer, StrokeLayer, TextLayer
from molviz.write.svg_path import path_data
from molviz.write.text import clean, number, token

DUBLIN_CORE = "http://purl.org/dc/elements/1.1/"
RDF = "http://www.w3.org/1999/02/22-rdf-syntax-ns#"
INKSCAPE = "http://www.inkscape.org/namespaces/inkscape"
FACES = "Helvetica, Arial, Arimo, 'Liberation Sans', sans-serif"  # all as wide as each other
OFTEN = 4  # shapes of one colour from which on a class is shorter than the colour itself


def write_svg(picture: Picture) -> bytes:
    """Return the picture as SVG 1.1 in UTF-8; lengths in points."""
    width, height = number(picture.width), number(picture.height)
    drawing = Drawing(size=(f"{width}pt", f"{height}pt"), viewBox=f"0 0 {width} {height}", profile="full", debug=False)
    drawing["xmlns:inkscape"] = INKSCAPE
    describe(drawing, picture)
    if picture.background is not None:
        drawing.add(Rect((0, 0), (width, height), fill=hexadecimal(picture.background), factory=drawing))
    elements = Elements(drawing)
    for layer in picture.layers:
        drawing.add(elements.layer(layer, picture.height))
    if elements.rules:
        drawing.defs.add(Style("".join(f".{name}{{{rule}}}" for rule, name in elements.rules.items())))
    return f'<?xml version="1.0" encoding="utf-8"?>\n{drawing.tostring()}\n'.encode()


def describe(drawing: Drawing, picture: Picture) -> None:
    """Name the picture for readers who hear it, and say in the metadata what drew it.

    An element with the role of an image is read out as a whole: its texts are told in its description.
    """
    said = [text.text for layer in picture.layers if isinstance(layer, TextLayer) for text in layer.texts]
    drawing["role"] = "img"
    drawing.set_desc(clean(picture.title) or "Drawing", clean("; ".join(["Drawn by molviz", *said])))
    if picture.description:
        data = Element("rdf:RDF", {"xmlns:rdf": RDF, "xmlns:dc": DUBLIN_CORE})
        work = SubElement(data, "rdf:Description", {"rdf:about": ""})
        for name, text in (("dc:creator", "molviz"), ("dc:source", picture.description)):
            SubElement(work, name).text = clean(text)
        drawing.set_metadata(data)


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
        self.rules: dict[str, str] = {}  # style rule → name of the class that stands for it

    def fresh_id(self, wish: str) -> str:
        """Return a valid id like ``wish`` that this drawing does not have yet."""
        word = token(wish)
        self.taken[word] += 1
        return word if self.taken[word] == 1 else self.fresh_id(f"{word}-{self.taken[word]}")

    def layer(self, layer: Layer, height: float) -> Group:
        """Return the group of a layer, which Inkscape takes for a layer of its own."""
        group = self.group(layer.name)
        group["inkscape:groupmode"], group["inkscape:label"] = "layer", clean(layer.name)
        if isinstance(layer, TextLayer):
            group.update({"fill": hexadecimal(layer.color), "font-family": FACES})
            self.texts(group, layer, height)
        elif isinstance(layer, StrokeLayer):
            group.update(stroke_attributes(layer))
            self.lines(group, path_data(layer.paths, height), layer.mark)
        elif isinstance(layer, FillLayer):
            group.update(spread_attributes(layer.spread))
            self.regions(group, path_data(layer.paths, height), layer)
        else:
            group.update(spread_attributes(layer.fills.spread))
            self.stacks(group, layer, height)
        return group

    def texts(self, group: Group, layer: TextLayer, height: float) -> None:
        """Add lines of text."""
        for one in layer.texts:
            look = {"font_size": number(one.size)} | ({} if one.anchor == "start" else {"text_anchor": one.anchor})
            place = (number(one.x), number(height - one.y))
            group.add(Text(clean(one.text), insert=place, factory=self.drawing, **look))

    def lines(self, layer: Group, data: Sequence[str], marks: Sequence[Mark]) -> None:
        """Add stroked shapes; without marks all of them are one path."""
        if not marks:
            layer.add(Path("".join(data), factory=self.drawing))
        nest = Nest(self, layer)
        for d, mark in zip(data, marks, strict=False):
            if d:
                nest.enter(mark.groups).add(self.named(Path(d, factory=self.drawing), mark, ()))

    def regions(self, layer: Group, data: Sequence[str], fills: FillLayer) -> None:
        """Add filled shapes in their groups."""
        nest, looks = Nest(self, layer), self.looks(fills)
        for d, mark, color in zip(data, fills.mark, fills.paint, strict=True):
            if d:
                name, attributes = looks[color]
                path = Path(d, factory=self.drawing, **attributes)
                nest.enter(mark.groups).add(self.named(path, mark, name))

    def stacks(self, layer: Group, stacked: StackedLayer, height: float) -> None:
        """Add one group per shape: its fill, and its strokes over that."""
        fills, looks = path_data(stacked.fills.paths, height), self.looks(stacked.fills)
        strokes = [(self.rule(stroke_rule(one)), path_data(one.paths, height)) for one in stacked.strokes]
        for row, (mark, color) in enumerate(zip(stacked.fills.mark, stacked.fills.paint, strict=True)):
            name, attributes = looks[color]
            group = self.named(Group(factory=self.drawing, **attributes), mark, name)
            group.add(Path(fills[row], factory=self.drawing))
            for stroke, data in strokes:
                if data[row]:
                    group.add(Path(data[row], class_=stroke, factory=self.drawing))
            layer.add(group)

    def looks(self, fills: FillLayer) -> dict[Color, tuple[tuple[str, ...], dict[str, str]]]:
        """Return classes and attributes that give a shape each colour: a class for those that come often."""
        looks: dict[Color, tuple[tuple[str, ...], dict[str, str]]] = {}
        for color, times in Counter(fills.paint).items():
            look = fill_attributes(color, fills.spread)
            rule = ";".join(f"{name}:{value}" for name, value in look.items())
            looks[color] = ((self.rule(rule),), {}) if times >= OFTEN else ((), look)
        return looks

    def rule(self, text: str) -> str:
        """Return the class with that style rule."""
        return self.rules.setdefault(text, f"s{len(self.rules)}")

    def group(self, name: str, **attributes: str) -> Group:
        """Return an empty group with an id like ``name``."""
        return Group(id=self.fresh_id(name), factory=self.drawing, **attributes)

    def named(self, element: Any, mark: Mark, more: tuple[str, ...]) -> Any:
        """Return the element with the mark's id, classes and title, and ``more`` classes."""
        element["id"] = self.fresh_id(mark.id)
        if mark.classes or more:
            element["class"] = " ".join([*map(token, mark.classes), *more])
        if mark.title:
            element.set_desc(clean(mark.title))
        return element


class Nest:
    """The groups that are open while shapes are added one after another."""

    def __init__(self, elements: Elements, root: Group) -> None:
        self.elements = elements
        self.names: list[tuple[str, str]] = []
        self.open: list[Group] = [root]

    def enter(self, names: Sequence[tuple[str, str]]) -> Group:
        """Return the innermost group of that name, keeping open what it has in common with the last one."""
        common = next((k for k, pair in enumerate(zip(names, self.names, strict=False)) if pair[0] != pair[1]), None)
        common = min(len(names), len(self.names)) if common is None else common
        del self.names[common:], self.open[common + 1 :]
        for name, css_class in names[common:]:
            group = self.elements.group(name, class_=" ".join(map(token, css_class.split())))
            group.set_desc(clean(name))
            self.open.append(self.open[-1].add(group))
            self.names.append((name, css_class))
        return self.open[-1]


def fill_attributes(color: Color, spread: float) -> dict[str, str]:
    """Return how a filled shape looks; the stroke of the spread has the fill's colour."""
    fill = hexadecimal(color)
    return {"fill": fill, "stroke": fill} if spread else {"fill": fill}


def spread_attributes(spread: float) -> dict[str, str]:
    """Return the stroke of a layer whose fills grow by half the spread on either side."""
    return {"stroke-width": number(spread, 3), "stroke-linejoin": "round"} if spread else {}


def stroke_attributes(layer: StrokeLayer) -> dict[str, str]:
    """Return how the lines of a layer look."""
    return {
        "fill": "none", "stroke": hexadecimal(layer.color), "stroke-width": number(layer.width, 3),
        "stroke-linecap": "round", "stroke-linejoin": "round",
    }  # fmt: skip


def stroke_rule(layer: StrokeLayer) -> str:
    """Return the same as a style rule."""
    return ";".join(f"{name}:{value}" for name, value in stroke_attributes(layer).items())
