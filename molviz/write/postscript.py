"""PostScript and EPS: short procedures, true arcs, one line of text per arc."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TypeAlias

from molviz.arrays import Floats
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
from molviz.write.font import characters, font_of, left, pieces
from molviz.write.paint import FLATNESS, border_colors, gradients, mixed_color, opaque, origins, shading
from molviz.write.postscript_path import shape_texts
from molviz.write.postscript_shade import SHADE_PROCEDURES, shade_lines
from molviz.write.text import ascii_line, encoded_lines, number
from molviz.write.type42 import Type42, type42

Names: TypeAlias = dict[Gradient, str]

COMMENT = 200  # characters of a name or a description on a line
SHOWN = 50  # characters shown at once, four bytes each: no line is longer than 255

# a1 a2 major minor rotation cx cy E (F backwards): the arc is built in the unit circle's frame, then that frame is
# dropped, so that the pen stays round. PostScript paints every pixel that a shape touches, so that no line is lost; an
# interpreter that smooths edges does so with parts of pixels, where all shapes grow for nothing. R tells ghostscript,
# if it smooths, to paint what is covered.
PROLOG = r"""%%BeginProlog
/molviz 24 dict def molviz begin
/M matrix def
/m{moveto}bind def
/l{lineto}bind def
/q{curveto}bind def
/A{arc}bind def
/N{arcn}bind def
/G{M currentmatrix pop translate rotate scale 0 0 1 5 -2 roll}bind def
/E{G arc M setmatrix}bind def
/F{G arcn M setmatrix}bind def
/h{closepath}bind def
/f{fill}bind def
/s{stroke}bind def
/b{gsave fill grestore stroke}bind def
/w{setlinewidth}bind def
/c{3{255 div 3 1 roll}repeat setrgbcolor}bind def
/R{currentpagedevice/GraphicsAlphaBits 2 copy known{get}{pop pop 1}ifelse 1 gt
/.setfilladjust2 where{pop{0 0 .setfilladjust2}if}{pop}ifelse}bind def"""

# A shape with a gradient: gsave, its path, the colour of its border; k strokes it; S0 x y g paints shading S0 at x, y.
GRADIENT_PROCEDURES = r"""/k{gsave stroke grestore}bind def
/g{clip newpath translate shfill grestore}bind def"""


def write_postscript(picture: Picture) -> Iterator[bytes]:
    """Yield the picture as a PostScript page of its own size (DSC 3.0, level 2)."""
    return write_postscript_pages([picture])


def write_postscript_pages(pictures: Sequence[Picture]) -> Iterator[bytes]:
    """Yield a PostScript page for each picture, all of the size of the first."""
    size = f"{number(pictures[0].width)} {number(pictures[0].height)}"
    return document(pictures, "%!PS-Adobe-3.0", [f"<</PageSize[{size}]>>setpagedevice"])


def write_eps(picture: Picture) -> Iterator[bytes]:
    """Yield the picture as Encapsulated PostScript (EPSF 3.0), cut to what is painted."""
    return document([picture], "%!PS-Adobe-3.0 EPSF-3.0", [])


def document(pictures: Sequence[Picture], header: str, setup: list[str]) -> Iterator[bytes]:
    """Yield the whole document; ``setup`` are lines to be run before the pages."""
    return encoded_lines(document_lines(pictures, header, setup))


def document_lines(pictures: Sequence[Picture], header: str, setup: list[str]) -> Iterator[str]:
    """Yield the lines of the document."""
    wanted = frozenset[str]().union(*map(characters, pictures))
    font = type42(font_of(wanted)) if wanted else None
    setup = [*(font.lines if font else []), *setup]
    setup = ["%%BeginSetup", *setup, "%%EndSetup"] if setup else []
    pictures = [on_paper(picture) for picture in pictures]
    layers = [layer for picture in pictures for layer in picture.layers]
    names = {gradient: f"S{row}" for row, gradient in enumerate(gradients(layers))}
    prolog = [PROLOG, *definitions(layers, names), "end", "%%EndProlog"]
    yield from (header, *comments(pictures, 3 if names else 2), *prolog, *setup)
    for number_of_page, picture in enumerate(pictures, start=1):
        yield f"%%Page: {number_of_page} {number_of_page}"
        yield f"molviz begin gsave 1 setlinecap 1 setlinejoin {FLATNESS} setflat R newpath"
        yield from background(picture)
        yield from body(picture, names, font)
        yield from ("grestore end", "showpage")
    yield from ("%%Trailer", "%%EOF")


def on_paper(picture: Picture) -> Picture:
    """Return the picture with opaque layers, as they look on its background or white paper."""
    paper = picture.background or (255, 255, 255)
    return replace(picture, layers=[opaque(layer, paper) for layer in picture.layers])


def definitions(layers: Sequence[Layer], names: Names) -> Iterator[str]:
    """Yield the procedures and gradients that few pictures need."""
    if names:
        yield GRADIENT_PROCEDURES
    yield from (f"/{name}{shading(gradient)}def" for gradient, name in names.items())
    if any(isinstance(layer, ShadeLayer) for layer in layers):
        yield SHADE_PROCEDURES


def comments(pictures: Sequence[Picture], level: int) -> Iterator[str]:
    """Yield the header comments; no date, so that the same picture gives the same bytes."""
    first, boxes = pictures[0], list(map(painted_box, pictures))
    box = [limit(sides) for limit, sides in zip((min, min, max, max), zip(*boxes, strict=True), strict=True)]
    tight = [math.floor(box[0]), math.floor(box[1]), math.ceil(box[2]), math.ceil(box[3])]
    yield "%%BoundingBox: " + " ".join(map(str, tight))
    yield "%%HiResBoundingBox: " + " ".join(f"{value:.3f}" for value in box)
    yield f"%%Title: {ascii_line(first.title)[:COMMENT]}"
    yield from (f"% drawn by {part}" for part in pieces(ascii_line(first.description), COMMENT))
    yield from ("%%Creator: molviz", f"%%LanguageLevel: {level}", "%%DocumentData: Clean7Bit")
    yield from (f"%%Pages: {len(pictures)}", "%%EndComments")


def painted_box(picture: Picture) -> tuple[float, float, float, float]:
    """Return the box of all that is painted on a page."""
    return picture.box if picture.background is None else (0.0, 0.0, picture.width, picture.height)


def background(picture: Picture) -> list[str]:
    """Return the painted page, or nothing."""
    if picture.background is None:
        return []
    return [f"{color_text(picture.background)} 0 0 {number(picture.width)} {number(picture.height)} rectfill"]


def body(picture: Picture, names: Names, font: Type42 | None) -> Iterator[str]:
    """Yield the lines of all layers."""
    for layer in picture.layers:
        yield f"% layer {ascii_line(layer.name)[:COMMENT]}"
        yield from layer_lines(layer, names, font)


def color_text(color: Color) -> str:
    """Return the command that sets a colour."""
    return "{} {} {} c".format(*color)


def layer_lines(layer: Layer, names: Names, font: Type42 | None) -> Iterator[str]:
    """Yield the lines of a layer: per shape its title, its colour where it changes, its path.

    ``font`` has the characters of all texts.
    """
    if isinstance(layer, TextLayer):
        yield from written(layer, font) if font else ()
    elif isinstance(layer, StackedLayer):
        yield from stacked(layer, names)
    elif isinstance(layer, ShadeLayer):
        yield from shade_lines(layer)
    elif isinstance(layer, StrokeLayer):
        yield pen(layer)
        yield from stroked(layer)
    else:
        yield f"{number(layer.spread, 3)} w"
        yield from filled(layer, names)


def written(layer: TextLayer, font: Type42) -> Iterator[str]:
    """Yield lines of text."""
    yield color_text(layer.color)
    for one in layer.texts:
        yield f"/{font.name} {number(one.size)} selectfont {number(left(one))} {number(one.y)} m"
        yield from (f"({font.string(piece)}) show" for piece in pieces(one.text, SHOWN))


def pen(layer: StrokeLayer) -> str:
    """Return the commands that set width and colour of the lines of a layer."""
    return f"{number(layer.width, 3)} w {color_text(layer.color)}"


def stacked(layer: StackedLayer, names: Names) -> Iterator[str]:
    """Yield the lines of a stacked layer, shape by shape: its fill, then its strokes over that."""
    fills, spread = layer.fills, layer.fills.spread
    filled, places, borders = shape_texts(fills.paths, True), origins(fills), border_colors(fills)
    strokes = [(pen(one), shape_texts(one.paths, False)) for one in layer.strokes]
    for shape, path in enumerate(filled):
        yield from title_line(fills.mark[shape])
        paint = fills.paint[shape]
        if isinstance(paint, tuple):
            yield from (color_text(paint), *present(path), f"{number(spread, 3)} w b" if spread else "f")
        else:
            yield f"{number(spread, 3)} w"
            border = borders[shape] if spread else None
            yield from shaded(path, border, f"{names[paint]} {place_text(places[shape])}")
        for command, texts in strokes:
            text = next(texts)
            if text:
                yield from (command, text)


def stroked(layer: StrokeLayer) -> Iterator[str]:
    """Yield the lines of a stroke layer; every loop is stroked by itself, as old interpreters hold short paths only."""
    for shape, path in enumerate(shape_texts(layer.paths, False)):
        if layer.mark:
            yield from title_line(layer.mark[shape])
        if layer.below:
            yield color_text(mixed_color(layer.below[shape], layer.color, layer.opacity))
        yield from present(path)


def filled(layer: FillLayer, names: Names) -> Iterator[str]:
    """Yield the lines of a fill layer."""
    current: Paint | None = None
    places, borders = origins(layer), border_colors(layer)
    for shape, path in enumerate(shape_texts(layer.paths, True)):
        yield from title_line(layer.mark[shape])
        paint = layer.paint[shape]
        if not isinstance(paint, tuple):
            border = borders[shape] if layer.spread else None
            yield from shaded(path, border, f"{names[paint]} {place_text(places[shape])}")
            continue
        if paint != current:
            current = paint
            yield color_text(paint)
        yield from (*present(path), "b" if layer.spread else "f")


def present(text: str) -> list[str]:
    """Return a text as lines, none where it is empty."""
    return [text] if text else []


def shaded(path: str, border: Color | None, shading_and_place: str) -> Iterator[str]:
    """Yield the lines of a shape with a gradient, over a stroke in the colour of its border if it spreads."""
    yield from ("gsave", *present(path))
    if border is not None:
        yield f"{color_text(border)} k"
    yield f"{shading_and_place} g"


def place_text(point: Floats) -> str:
    """Return a point (2,) as two numbers."""
    return " ".join(number(value) for value in point.tolist())


def title_line(mark: Mark) -> list[str]:
    """Return the comment that names a shape, if it has a title."""
    return [f"% {ascii_line(mark.title)[:COMMENT]}"] if mark.title else []
