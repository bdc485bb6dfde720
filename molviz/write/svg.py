"""SVG: one element per shape, in groups that any editor shows by name."""

import hashlib
from collections import Counter
from collections.abc import Iterator, Sequence
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from svgwrite import Drawing
from svgwrite.container import Group, Style, Use
from svgwrite.masking import ClipPath
from svgwrite.path import Path
from svgwrite.shapes import Rect
from svgwrite.text import Text

from molviz.curves import Paths
from molviz.picture.picture import (
    Color,
    FillLayer,
    Gradient,
    Layer,
    Mark,
    Paint,
    Picture,
    ShadeLayer,
    StackedLayer,
    StrokeLayer,
    TextLayer,
)
from molviz.write.gzipped import gzipped
from molviz.write.paint import origins
from molviz.write.svg_gradient import gradient_element
from molviz.write.svg_leaves import Leaves, element, title
from molviz.write.svg_path import path_data
from molviz.write.text import clean, number, token

DUBLIN_CORE = "http://purl.org/dc/elements/1.1/"
RDF = "http://www.w3.org/1999/02/22-rdf-syntax-ns#"
INKSCAPE = "http://www.inkscape.org/namespaces/inkscape"
FACES = "Helvetica, Arial, Arimo, 'Liberation Sans', sans-serif"  # all as wide as each other
OWN = "\x01"  # begins names that only the file itself calls; no text can hold it
OFTEN = 4  # shapes of one colour from which on a class is shorter than the colour itself


def write_svg(picture: Picture) -> Iterator[bytes]:
    """Yield the picture as SVG 1.1 in UTF-8; lengths in points."""
    drawing = empty_drawing(picture)
    elements = Elements(drawing)
    for layer in picture.layers:
        drawing.add(elements.layer(layer, picture.height))
    return finished(drawing, elements)


def empty_drawing(picture: Picture) -> Drawing:
    """Return the root of a picture's page with what it is called, and its background."""
    width, height = number(picture.width), number(picture.height)
    drawing = Drawing(size=(f"{width}pt", f"{height}pt"), viewBox=f"0 0 {width} {height}", profile="full", debug=False)
    drawing["xmlns:inkscape"] = INKSCAPE
    describe(drawing, picture)
    if picture.background is not None:
        drawing.add(Rect((0, 0), (width, height), fill=hexadecimal(picture.background), factory=drawing))
    return drawing


def finished(drawing: Drawing, elements: "Elements", more: str = "") -> Iterator[bytes]:
    """Yield the file; its style sheet has the rules of the elements, and ``more``.

    Letters made of its content set its own names apart from those of other drawings in one web page.
    """
    if elements.rules or more:
        drawing.defs.add(Style("".join(f".{name}{{{rule}}}" for rule, name in elements.rules.items()) + more))
    head, defs, drawn = drawing.tostring().partition("<defs")
    content = hashlib.sha256()  # and not of what drew it
    for piece in elements.leaves.put_into(defs + drawn + "\n"):
        content.update(piece.encode())
    letters = "".join(chr(ord("a") + int(digit, 16)) for digit in content.hexdigest()[:4])
    yield f'<?xml version="1.0" encoding="utf-8"?>\n{head}'.replace(OWN, letters).encode()
    for piece in elements.leaves.put_into(defs + drawn + "\n"):
        yield piece.replace(OWN, letters).encode()


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


def write_svgz(picture: Picture) -> Iterator[bytes]:
    """Yield the picture as gzipped SVG, without a date."""
    return gzipped(write_svg(picture))


def hexadecimal(color: Color) -> str:
    """Return a colour as ``#rrggbb``, or ``#rgb`` where that says the same."""
    text = "#{:02x}{:02x}{:02x}".format(*color)
    return f"#{text[1::2]}" if text[1::2] == text[2::2] else text


class Elements:
    """Makes the elements of one drawing and keeps their ids apart."""

    def __init__(self, drawing: Drawing) -> None:
        self.drawing = drawing
        self.leaves = Leaves()
        self.taken: dict[str, int] = {}
        self.rules: dict[str, str] = {}  # style rule → name of the class that stands for it
        self.servers: dict[Gradient, str] = {}  # gradient → its id

    def fresh_id(self, wish: str) -> str:
        """Return a valid id like ``wish`` that this drawing does not have yet."""
        word = token(wish)
        times = self.taken[word] = self.taken.get(word, 0) + 1
        return word if times == 1 else self.fresh_id(f"{word}-{times}")

    def own_id(self, wish: str) -> str:
        """Return the same for what only references find, apart from the ids of other drawings too."""
        return OWN + self.fresh_id(wish)

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
            self.regions(group, layer, height)
        elif isinstance(layer, ShadeLayer):
            self.shades(group, layer, height)
        else:
            group.update(spread_attributes(layer.fills.spread))
            self.stacks(group, layer, height)
        if isinstance(layer, FillLayer | StrokeLayer) and layer.opacity < 1:
            group["opacity"] = number(layer.opacity, 4)
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
            self.leaves.add(layer, element("path", {"d": "".join(data)}))
        nest = Nest(self, layer)
        for d, mark in zip(data, marks, strict=False):
            if d:
                self.leaves.add(nest.enter(mark.groups), self.named("path", {"d": d}, mark, ()))

    def regions(self, layer: Group, fills: FillLayer, height: float) -> None:
        """Add filled shapes in their groups."""
        nest, looks = Nest(self, layer), self.looks(fills)
        for path, mark, paint in zip(self.fill_paths(fills, height), fills.mark, fills.paint, strict=True):
            if path["d"]:
                name, attributes = looks[paint]
                self.leaves.add(nest.enter(mark.groups), self.named("path", path | attributes, mark, name))

    def fill_paths(self, fills: FillLayer, height: float) -> list[dict[str, str]]:
        """Return the path of each filled shape as attributes.

        One with a gradient is drawn about its origin, where the gradient is, and then moved.
        """
        data, places = path_data(about_origins(fills, height), height), origins(fills).tolist()
        paths = [{"d": d} for d in data]
        for path, paint, (x, y) in zip(paths, fills.paint, places, strict=True):
            if not isinstance(paint, tuple):
                path["transform"] = f"translate({number(x)},{number(height - y)})"
        return paths

    def shades(self, group: Group, layer: ShadeLayer, height: float) -> None:
        """Add translucent steps, written once, in the colour of each clip inside it."""
        steps = Group(id=self.own_id(f"{layer.name} steps"), factory=self.drawing)
        for d, opacity in zip(path_data(layer.steps, height), layer.opacity, strict=True):
            steps.add(Path(d, opacity=number(opacity, 4), factory=self.drawing))
        self.drawing.defs.add(steps)
        for d, color in zip(path_data(layer.clip, height), layer.color, strict=True):
            clip = ClipPath(id=self.own_id(f"{layer.name} clip"), factory=self.drawing)
            clip.add(Path(d, factory=self.drawing))
            self.drawing.defs.add(clip)
            inside = Group(clip_path=clip.get_funciri(), fill=hexadecimal(color), factory=self.drawing)
            inside.add(Use(steps.get_iri(), factory=self.drawing))
            group.add(inside)

    def stacks(self, layer: Group, stacked: StackedLayer, height: float) -> None:
        """Add one group per shape: its fill, and its strokes over that."""
        fills, looks = self.fill_paths(stacked.fills, height), self.looks(stacked.fills)
        strokes = [(self.rule(stroke_rule(one)), path_data(one.paths, height)) for one in stacked.strokes]
        for row, (mark, paint) in enumerate(zip(stacked.fills.mark, stacked.fills.paint, strict=True)):
            name, attributes = looks[paint]
            parts = [element("path", fills[row])] if fills[row]["d"] else []
            parts += [element("path", {"class": stroke, "d": data[row]}) for stroke, data in strokes if data[row]]
            self.leaves.add(layer, self.named("g", attributes, mark, name, "".join(parts)))

    def looks(self, fills: FillLayer) -> dict[Paint, tuple[tuple[str, ...], dict[str, str]]]:
        """Return classes and attributes that give a shape each paint: a class for those that come often."""
        looks: dict[Paint, tuple[tuple[str, ...], dict[str, str]]] = {}
        for paint, times in Counter(fills.paint).items():
            look = fill_attributes(self.paint_text(paint), fills.spread)
            rule = ";".join(f"{name}:{value}" for name, value in look.items())
            looks[paint] = ((self.rule(rule),), {}) if times >= OFTEN else ((), look)
        return looks

    def paint_text(self, paint: Paint) -> str:
        """Return a paint as the value of an attribute; a gradient is defined where it is first met."""
        if isinstance(paint, tuple):
            return hexadecimal(paint)
        if paint not in self.servers:
            server = gradient_element(paint, self.own_id("gradient"))
            self.drawing.defs.add(server)
            self.servers[paint] = server.get_funciri()
        return self.servers[paint]

    def rule(self, text: str) -> str:
        """Return the class with that style rule."""
        return self.rules.setdefault(text, f"{OWN}{len(self.rules)}")

    def group(self, name: str, **attributes: str) -> Group:
        """Return an empty group with an id like ``name``."""
        return Group(id=self.fresh_id(name), factory=self.drawing, **attributes)

    def named(
        self, name: str, attributes: dict[str, str], mark: Mark, classes: tuple[str, ...], content: str = ""
    ) -> str:
        """Return an element with the mark's id, classes and title, and more ``classes``."""
        own = {"id": self.fresh_id(mark.id), "class": " ".join([*map(token, mark.classes), *classes])}
        return element(name, attributes | own, title(mark.title) + content)


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
        for depth, (name, css_class) in enumerate(names[common:], common + 1):
            path = "_".join(outer for outer, _ in names[:depth])  # A_VAL 96: the same in every chain else
            group = self.elements.group(path, class_=" ".join(map(token, css_class.split())))
            group.set_desc(clean(name))
            self.open.append(self.open[-1].add(group))
            self.names.append((name, css_class))
        return self.open[-1]


def about_origins(fills: FillLayer, height: float) -> Paths:
    """Return the paths so that, with y down, the origins of gradients are at 0, 0; others as they are."""
    gradient = np.array([not isinstance(paint, tuple) for paint in fills.paint], dtype=bool)
    if not gradient.any():
        return fills.paths
    loop_shape = np.repeat(np.arange(len(gradient)), np.diff(fills.paths.shape_start))
    shape = np.repeat(loop_shape, np.diff(fills.paths.loop_start))
    shift = np.where(gradient[:, None], [0.0, height] - origins(fills), 0.0)
    arcs = fills.paths.arcs
    return fills.paths._replace(arcs=arcs._replace(c=arcs.c + shift[shape]))


def fill_attributes(fill: str, spread: float) -> dict[str, str]:
    """Return how a filled shape looks; the stroke of the spread has the fill's paint."""
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
