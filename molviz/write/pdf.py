"""PDF: arcs as cubic Béziers within a thousandth of a point, layers that a viewer can switch off."""

import re
from codecs import BOM_UTF16_BE
from collections import Counter
from collections.abc import Iterator, Sequence
from io import BytesIO

import pydyf

from molviz.arrays import Floats
from molviz.picture.picture import (
    Color,
    FillLayer,
    Gradient,
    Layer,
    Paint,
    Picture,
    ShadeLayer,
    StackedLayer,
    StrokeLayer,
    TextLayer,
)
from molviz.write.font import Font, left
from molviz.write.paint import FLATNESS, border_colors, origins, shares
from molviz.write.pdf_path import PLACES, shape_texts
from molviz.write.pdf_resources import Resources, SharedFont
from molviz.write.text import clean, number

STRUCTURE = re.compile("trailer|xref|obj|stream|%%EOF")


def write_pdf(picture: Picture) -> Iterator[bytes]:
    """Yield the picture as PDF 1.7, one page of its own size; no dates and no identifier."""
    return write_pdf_pages([picture])


def write_pdf_pages(pictures: Sequence[Picture]) -> Iterator[bytes]:
    """Yield one page for each picture, with one font and one set of layers for all; named as the first."""
    pdf, out, first = pydyf.PDF(), BytesIO(), pictures[0]
    pdf.info.update({"Title": text_string(first.title), "Producer": pydyf.String("molviz")})
    if first.description:
        pdf.info["Subject"] = text_string(first.description)
    named = [layer_names(picture) for picture in pictures]
    groups = {
        name: pydyf.Dictionary({"Type": "/OCG", "Name": text_string(name[0])})
        for name in dict.fromkeys(name for names in named for name in names)
    }
    for group in groups.values():
        pdf.add_object(group)
    references = pydyf.Array([group.reference for group in groups.values()])
    pdf.catalog["OCProperties"] = pydyf.Dictionary(
        {"OCGs": references, "D": pydyf.Dictionary({"Order": references, "ON": references})}
    )
    font = SharedFont(pictures)
    for picture, layers in zip(pictures, named, strict=True):
        add_page(pdf, picture, [groups[layer] for layer in layers], font)
    pdf.write(out)
    yield out.getvalue()


def layer_names(picture: Picture) -> list[tuple[str, int]]:
    """Return the name of each layer, and how many before it have the same: what is equal on two pages is one layer."""
    before: Counter[str] = Counter()
    names = []
    for layer in picture.layers:
        names.append((layer.name, before[layer.name]))
        before[layer.name] += 1
    return names


def add_page(pdf: pydyf.PDF, picture: Picture, groups: list[pydyf.Dictionary], font: SharedFont) -> None:
    """Add a picture as a page; ``groups`` are those of its layers."""
    names = Resources(picture, font.font)
    content = pydyf.Stream([line.encode() for line in page_lines(picture, names)], compress=True)
    pdf.add_object(content)
    layers = pydyf.Dictionary({f"L{k}": group.reference for k, group in enumerate(groups)})
    resources = pydyf.Dictionary({"Properties": layers, **names.add_to(pdf), **font.add_to(pdf)})
    pdf.add_page(page(pdf, picture, resources, content, names))


def text_string(text: str) -> pydyf.String | bytes:
    """Return a text as a PDF string; in hexadecimal where it has a word that some readers look for in the file."""
    text = clean(text)
    if STRUCTURE.search(text):
        return b"<" + (BOM_UTF16_BE + text.encode("utf-16-be")).hex().encode() + b">"
    return pydyf.String(text)


def page(
    pdf: pydyf.PDF, picture: Picture, resources: pydyf.Dictionary, content: pydyf.Stream, names: Resources
) -> pydyf.Dictionary:
    """Return the page object."""
    box = pydyf.Array([0, 0, number(picture.width, PLACES), number(picture.height, PLACES)])
    return pydyf.Dictionary(
        {
            "Type": "/Page", "Parent": pdf.pages.reference, "MediaBox": box,
            "Resources": resources, "Contents": content.reference, **names.page_entries(),
        }
    )  # fmt: skip


def page_lines(picture: Picture, names: Resources) -> Iterator[str]:
    """Yield the operators that paint the page."""
    yield f"1 J 1 j {FLATNESS} i"
    if picture.background is not None:
        size = f"{number(picture.width, PLACES)} {number(picture.height, PLACES)}"
        yield f"{shares(picture.background)} rg 0 0 {size} re f"
    for row, layer in enumerate(picture.layers):
        yield f"/OC /L{row} BDC"
        yield from layer_lines(layer, names)
        yield "EMC"


def layer_lines(layer: Layer, names: Resources) -> Iterator[str]:
    """Yield the operators of a layer; a translucent one is a form that is painted as a whole."""
    if isinstance(layer, FillLayer | StrokeLayer) and layer.opacity < 1:
        form = names.form(opaque_lines(layer, names), True)
        yield f"q {names.opacity(layer.opacity)} gs {form} Do Q"
    else:
        yield from opaque_lines(layer, names)


def opaque_lines(layer: Layer, names: Resources) -> Iterator[str]:
    """Yield the operators of a layer without its opacity."""
    if isinstance(layer, TextLayer):
        yield from written(layer, names.font) if names.font else ()
    elif isinstance(layer, StackedLayer):
        yield from stacked(layer, names)
    elif isinstance(layer, ShadeLayer):
        yield from shade_lines(layer, names)
    elif isinstance(layer, FillLayer):
        yield f"{number(layer.spread, PLACES)} w"
        yield from filled(layer, names)
    else:
        yield pen(layer)
        yield from (f"{shape} S" for shape in shape_texts(layer.paths) if shape)


def written(layer: TextLayer, font: Font) -> Iterator[str]:
    """Yield lines of text as numbers of glyphs in hexadecimal, which nothing in a text can leave."""
    yield f"{shares(layer.color)} rg"
    for one in layer.texts:
        place = f"{number(left(one), PLACES)} {number(one.y, PLACES)}"
        glyphs = "".join(f"{font.glyph.get(character, 0):04x}" for character in one.text)
        yield f"BT /F {number(one.size)} Tf {place} Td <{glyphs}> Tj ET"


def pen(layer: StrokeLayer) -> str:
    """Return the operators that set width and colour of the lines of a layer."""
    return f"{number(layer.width, PLACES)} w {shares(layer.color)} RG"


def stacked(layer: StackedLayer, names: Resources) -> Iterator[str]:
    """Yield the operators of a stacked layer, shape by shape: its fill, then its strokes over that."""
    fills, width = layer.fills, number(layer.fills.spread, PLACES)
    places, borders, paint = origins(fills), border_colors(fills), "B" if fills.spread else "f"
    strokes = [(pen(one), shape_texts(one.paths)) for one in layer.strokes]
    for row, (shape, fill) in enumerate(zip(shape_texts(fills.paths), fills.paint, strict=True)):
        if isinstance(fill, tuple):
            yield f"{width} w {shares(fill)} rg {shares(fill)} RG {shape} {paint}"
        elif shape:
            border = borders[row] if fills.spread else None
            yield f"{width} w {shaded(shape, fill, places[row], border, names)}"
        stroked = [(command, next(shapes)) for command, shapes in strokes]
        yield from (f"{command} {line} S" for command, line in stroked if line)


def filled(layer: FillLayer, names: Resources) -> Iterator[str]:
    """Yield the filled shapes, with a colour where it changes."""
    current: Paint | None = None
    shapes, places, borders = shape_texts(layer.paths), origins(layer), border_colors(layer)
    for shape, paint, place, border in zip(shapes, layer.paint, places, borders, strict=True):
        if isinstance(paint, tuple) and paint != current:
            current, text = paint, shares(paint)
            yield f"{text} rg {text} RG" if layer.spread else f"{text} rg"
        if shape and isinstance(paint, tuple):
            yield f"{shape} {'B' if layer.spread else 'f'}"
        elif shape and not isinstance(paint, tuple):
            yield shaded(shape, paint, place, border if layer.spread else None, names)


def shaded(shape: str, gradient: Gradient, place: Floats, border: Color | None, names: Resources) -> str:
    """Return the operators of a shape with a gradient, over a stroke in the colour of its border if it spreads."""
    x, y = (number(value) for value in place.tolist())
    stroke = f"{shape} W n" if border is None else f"{shares(border)} RG {shape} W S"
    return f"q {stroke} 1 0 0 1 {x} {y} cm {names.shading(gradient)} sh Q"


def shade_lines(layer: ShadeLayer, names: Resources) -> Iterator[str]:
    """Yield the clips, in each of them the form of all steps, which have the colour that is set before."""
    steps = zip(shape_texts(layer.steps), layer.opacity, strict=True)
    form = names.form((f"{names.opacity(opacity)} gs {shape} f" for shape, opacity in steps if shape), False)
    for shape, color in zip(shape_texts(layer.clip), layer.color, strict=True):
        if shape:
            yield f"q {shape} W n {shares(color)} rg {form} Do Q"
