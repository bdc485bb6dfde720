"""PDF: arcs as cubic Béziers within a thousandth of a point, layers that a viewer can switch off."""

import re
from codecs import BOM_UTF16_BE
from collections.abc import Iterator
from io import BytesIO

import numpy as np
import pydyf

from molviz.arrays import Bools, Texts
from molviz.curves import Paths
from molviz.picture.picture import Color, FillLayer, Layer, Picture, StackedLayer, StrokeLayer, TextLayer
from molviz.write.ellipse import (
    bezier_handles,
    bezier_pieces,
    closed_loops,
    in_equal_pieces,
    on_axes,
    starts_and_ends,
    with_straight_pieces,
)
from molviz.write.font import Font, characters, font_of, left
from molviz.write.pdf_font import embedded
from molviz.write.text import clean, number, numbers

PLACES = 3
STRUCTURE = re.compile("trailer|xref|obj|stream|%%EOF")


def write_pdf(picture: Picture) -> bytes:
    """Return the picture as PDF 1.7, one page of its own size; no dates and no identifier."""
    pdf, out = pydyf.PDF(), BytesIO()
    pdf.info.update({"Title": text_string(picture.title), "Producer": pydyf.String("molviz")})
    if picture.description:
        pdf.info["Subject"] = text_string(picture.description)
    groups = [pydyf.Dictionary({"Type": "/OCG", "Name": text_string(layer.name)}) for layer in picture.layers]
    wanted = characters(picture)
    font = font_of(wanted) if wanted else None
    content = pydyf.Stream([line.encode() for line in page_lines(picture, font)], compress=True)
    for part in [*groups, content]:
        pdf.add_object(part)
    references = pydyf.Array([group.reference for group in groups])
    pdf.catalog["OCProperties"] = pydyf.Dictionary(
        {"OCGs": references, "D": pydyf.Dictionary({"Order": references, "ON": references})}
    )
    resources = {"Properties": pydyf.Dictionary({f"L{k}": group.reference for k, group in enumerate(groups)})}
    if font is not None:
        resources["Font"] = pydyf.Dictionary({"F": embedded(pdf, font).reference})
    pdf.add_page(page(pdf, picture, pydyf.Dictionary(resources), content))
    pdf.write(out)
    return out.getvalue()


def text_string(text: str) -> pydyf.String | bytes:
    """Return a text as a PDF string; in hexadecimal where it has a word that some readers look for in the file."""
    text = clean(text)
    if STRUCTURE.search(text):
        return b"<" + (BOM_UTF16_BE + text.encode("utf-16-be")).hex().encode() + b">"
    return pydyf.String(text)


def page(pdf: pydyf.PDF, picture: Picture, resources: pydyf.Dictionary, content: pydyf.Stream) -> pydyf.Dictionary:
    """Return the page object."""
    box = pydyf.Array([0, 0, number(picture.width, PLACES), number(picture.height, PLACES)])
    return pydyf.Dictionary(
        {
            "Type": "/Page", "Parent": pdf.pages.reference, "MediaBox": box,
            "Resources": resources, "Contents": content.reference,
        }
    )  # fmt: skip


def page_lines(picture: Picture, font: Font | None) -> Iterator[str]:
    """Yield the operators that paint the page."""
    yield "1 J 1 j"
    if picture.background is not None:
        size = f"{number(picture.width, PLACES)} {number(picture.height, PLACES)}"
        yield f"{color_text(picture.background)} rg 0 0 {size} re f"
    for row, layer in enumerate(picture.layers):
        yield f"/OC /L{row} BDC"
        yield from layer_lines(layer, font)
        yield "EMC"


def color_text(color: Color) -> str:
    """Return a colour as three numbers from 0 to 1, fine enough to come back as the same bytes."""
    return " ".join(number(value / 255, 4) for value in color)


def layer_lines(layer: Layer, font: Font | None) -> Iterator[str]:
    """Yield the operators of a layer; ``font`` has the characters of all texts."""
    if isinstance(layer, TextLayer):
        yield from written(layer, font) if font else ()
    elif isinstance(layer, StackedLayer):
        yield from stacked(layer)
    elif isinstance(layer, FillLayer):
        yield f"{number(layer.spread, PLACES)} w"
        yield from filled(layer, shape_texts(layer.paths))
    else:
        yield pen(layer)
        yield from (f"{shape} S" for shape in shape_texts(layer.paths) if shape)


def written(layer: TextLayer, font: Font) -> Iterator[str]:
    """Yield lines of text as numbers of glyphs in hexadecimal, which nothing in a text can leave."""
    yield f"{color_text(layer.color)} rg"
    for one in layer.texts:
        place = f"{number(left(one), PLACES)} {number(one.y, PLACES)}"
        glyphs = "".join(f"{font.glyph.get(character, 0):04x}" for character in one.text)
        yield f"BT /F {number(one.size)} Tf {place} Td <{glyphs}> Tj ET"


def pen(layer: StrokeLayer) -> str:
    """Return the operators that set width and colour of the lines of a layer."""
    return f"{number(layer.width, PLACES)} w {color_text(layer.color)} RG"


def stacked(layer: StackedLayer) -> Iterator[str]:
    """Yield the operators of a stacked layer, shape by shape: its fill, then its strokes over that."""
    fills, paint = shape_texts(layer.fills.paths), "B" if layer.fills.spread else "f"
    strokes = [(pen(one), shape_texts(one.paths)) for one in layer.strokes]
    for row, (fill, color) in enumerate(zip(fills, layer.fills.paint, strict=True)):
        text = color_text(color)
        yield f"{number(layer.fills.spread, PLACES)} w {text} rg {text} RG {fill} {paint}"
        yield from (f"{command} {shapes[row]} S" for command, shapes in strokes if shapes[row])


def shape_texts(paths: Paths) -> list[str]:
    """Return the operators of the loops of each shape."""
    loops, bounds = loop_texts(paths), paths.shape_start.tolist()
    return ["\n".join(filter(None, loops[first:stop])) for first, stop in zip(bounds, bounds[1:], strict=False)]


def filled(layer: FillLayer, shapes: list[str]) -> Iterator[str]:
    """Yield the filled shapes, with a colour where it changes."""
    current = None
    for shape, color in zip(shapes, layer.paint, strict=True):
        if color != current:
            current, text = color, color_text(color)
            yield f"{text} rg {text} RG" if layer.spread else f"{text} rg"
        if shape:
            yield f"{shape} {'B' if layer.spread else 'f'}"


def loop_texts(paths: Paths) -> list[str]:
    """Return the operators of each loop, empty where it has no arc."""
    paths, straight = as_cubics(paths)
    words, first, stop = arc_texts(paths, straight).tolist(), paths.loop_start[:-1], paths.loop_start[1:]
    held = stop > first
    rows = paths.arcs.take(first[held])
    move = np.full(len(first), "", dtype=object)
    move[held] = joined(numbers(rows.at(rows.start), PLACES)) + " m\n"
    bodies = ["\n".join(words[a:b]) for a, b in zip(first.tolist(), stop.tolist(), strict=True)]
    ends = np.where(closed_loops(paths), " h", "").tolist()
    return [start + text + end if text else "" for start, text, end in zip(move.tolist(), bodies, ends, strict=True)]


def as_cubics(paths: Paths) -> tuple[Paths, Bools]:
    """Return the paths cut so that one cubic or one straight piece stands for each arc, and which are straight."""
    paths, straight = with_straight_pieces(paths)
    count = np.where(straight, 1, bezier_pieces(on_axes(paths.arcs).major, paths.arcs.sweep))
    return in_equal_pieces(paths, count), np.repeat(straight, count)


def arc_texts(paths: Paths, straight: Bools) -> Texts:
    """Return the operator (k,) of each arc."""
    end = starts_and_ends(paths)[1]
    points = numbers(np.column_stack([*bezier_handles(paths.arcs), end]), PLACES)
    return np.asarray(np.where(straight, joined(points[:, 4:]) + " l", joined(points) + " c"), dtype=object)


def joined(words: Texts) -> Texts:
    """Return the rows of words (k, m) as one text (k,) each."""
    spaced = words.copy()
    spaced[:, 1:] = " " + spaced[:, 1:]
    return np.asarray(spaced.sum(axis=1), dtype=object)
