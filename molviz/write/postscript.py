"""PostScript and EPS: short procedures, true arcs, one line of text per arc."""

import math
from collections.abc import Iterator

import numpy as np

from molviz.arrays import Bools, Floats, Texts
from molviz.curves import Paths, PlaneArcs
from molviz.picture.picture import Color, FillLayer, Layer, Mark, Picture, StackedLayer, StrokeLayer, TextLayer
from molviz.write.ellipse import THIN, closed_loops, on_axes, with_straight_pieces
from molviz.write.font import characters, font_of, left, pieces
from molviz.write.text import ascii_line, number, numbers
from molviz.write.type42 import Type42, type42

COMMENT = 200  # characters of a name or a description on a line
SHOWN = 50  # characters shown at once, four bytes each: no line is longer than 255

# a1 a2 major minor rotation cx cy E (F backwards): the arc is built in the unit circle's frame, then that frame is
# dropped, so that the pen stays round.
PROLOG = r"""%%BeginProlog
/molviz 16 dict def molviz begin
/M matrix def
/m{moveto}bind def
/l{lineto}bind def
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
end
%%EndProlog"""


def write_postscript(picture: Picture) -> bytes:
    """Return the picture as a PostScript page of its own size (DSC 3.0, level 2)."""
    size = f"{number(picture.width)} {number(picture.height)}"
    return document(picture, "%!PS-Adobe-3.0", [f"<</PageSize[{size}]>>setpagedevice"])


def write_eps(picture: Picture) -> bytes:
    """Return the picture as Encapsulated PostScript (EPSF 3.0), cut to what is painted."""
    return document(picture, "%!PS-Adobe-3.0 EPSF-3.0", [])


def document(picture: Picture, header: str, setup: list[str]) -> bytes:
    """Return the whole document; ``setup`` are lines to be run before the page."""
    wanted = characters(picture)
    font = type42(font_of(wanted)) if wanted else None
    setup = [*(font.lines if font else []), *setup]
    setup = ["%%BeginSetup", *setup, "%%EndSetup"] if setup else []
    page = ["%%Page: 1 1", "molviz begin gsave 1 setlinecap 1 setlinejoin newpath"]
    trailer = ["grestore end", "showpage", "%%Trailer", "%%EOF"]
    lines = [header, *comments(picture), PROLOG, *setup, *page, *background(picture), *body(picture, font), *trailer]
    return ("\n".join(lines) + "\n").encode("ascii")


def comments(picture: Picture) -> Iterator[str]:
    """Yield the header comments; no date, so that the same picture gives the same bytes."""
    box = picture.box if picture.background is None else (0.0, 0.0, picture.width, picture.height)
    tight = [math.floor(box[0]), math.floor(box[1]), math.ceil(box[2]), math.ceil(box[3])]
    yield "%%BoundingBox: " + " ".join(map(str, tight))
    yield "%%HiResBoundingBox: " + " ".join(f"{value:.3f}" for value in box)
    yield f"%%Title: {ascii_line(picture.title)[:COMMENT]}"
    yield from (f"% drawn by {part}" for part in pieces(ascii_line(picture.description), COMMENT))
    yield from ("%%Creator: molviz", "%%LanguageLevel: 2", "%%DocumentData: Clean7Bit", "%%Pages: 1", "%%EndComments")


def background(picture: Picture) -> list[str]:
    """Return the painted page, or nothing."""
    if picture.background is None:
        return []
    return [f"{color_text(picture.background)} 0 0 {number(picture.width)} {number(picture.height)} rectfill"]


def body(picture: Picture, font: Type42 | None) -> Iterator[str]:
    """Yield the lines of all layers."""
    for layer in picture.layers:
        yield f"% layer {ascii_line(layer.name)[:COMMENT]}"
        yield from layer_lines(layer, font)


def color_text(color: Color) -> str:
    """Return the command that sets a colour."""
    return "{} {} {} c".format(*color)


def layer_lines(layer: Layer, font: Type42 | None) -> Iterator[str]:
    """Yield the lines of a layer: per shape its title, its colour where it changes, its path.

    ``font`` has the characters of all texts.
    """
    if isinstance(layer, TextLayer):
        yield from written(layer, font) if font else ()
    elif isinstance(layer, StackedLayer):
        yield from stacked(layer)
    elif isinstance(layer, StrokeLayer):
        yield pen(layer)
        yield from stroked(layer)
    else:
        yield f"{number(layer.spread, 3)} w"
        yield from filled(layer)


def written(layer: TextLayer, font: Type42) -> Iterator[str]:
    """Yield lines of text."""
    yield color_text(layer.color)
    for one in layer.texts:
        yield f"/{font.name} {number(one.size)} selectfont {number(left(one))} {number(one.y)} m"
        yield from (f"({font.string(piece)}) show" for piece in pieces(one.text, SHOWN))


def pen(layer: StrokeLayer) -> str:
    """Return the commands that set width and colour of the lines of a layer."""
    return f"{number(layer.width, 3)} w {color_text(layer.color)}"


def stacked(layer: StackedLayer) -> Iterator[str]:
    """Yield the lines of a stacked layer, shape by shape: its fill, then its strokes over that."""
    fills, paint = layer.fills, f"{number(layer.fills.spread, 3)} w b" if layer.fills.spread else "f"
    fill_loops = shape_texts(fills.paths, True)
    strokes = [(pen(one), shape_texts(one.paths, False)) for one in layer.strokes]
    for shape, loops in enumerate(fill_loops):
        yield from title_line(fills.mark[shape])
        yield color_text(fills.paint[shape])
        yield from (*loops, paint)
        for command, texts in strokes:
            if texts[shape]:
                yield from (command, *(f"{loop} s" for loop in texts[shape]))


def shape_texts(paths: Paths, filled: bool) -> list[list[str]]:
    """Return the commands of the loops of each shape."""
    loops, bounds = loop_texts(paths, filled), paths.shape_start.tolist()
    return [list(filter(None, loops[first:stop])) for first, stop in zip(bounds, bounds[1:], strict=False)]


def stroked(layer: StrokeLayer) -> Iterator[str]:
    """Yield the lines of a stroke layer; every loop is stroked by itself, as old interpreters hold short paths only."""
    for shape, loops in enumerate(shape_texts(layer.paths, False)):
        if layer.mark:
            yield from title_line(layer.mark[shape])
        yield from (f"{loop} s" for loop in loops)


def filled(layer: FillLayer) -> Iterator[str]:
    """Yield the lines of a fill layer."""
    paint, current = "b" if layer.spread else "f", None
    for shape, loops in enumerate(shape_texts(layer.paths, True)):
        yield from title_line(layer.mark[shape])
        if layer.paint[shape] != current:
            current = layer.paint[shape]
            yield color_text(current)
        yield from (*loops, paint)


def title_line(mark: Mark) -> list[str]:
    """Return the comment that names a shape, if it has a title."""
    return [f"% {ascii_line(mark.title)[:COMMENT]}"] if mark.title else []


def loop_texts(paths: Paths, filled: bool) -> list[str]:
    """Return the commands of each loop.

    An arc starts a path by itself, but would be joined to the loop before it; a straight piece always needs a start.
    """
    paths, straight = with_straight_pieces(paths)
    words, first, stop = arc_texts(paths.arcs, straight).tolist(), paths.loop_start[:-1], paths.loop_start[1:]
    held, closed = stop > first, closed_loops(paths)
    move = np.full(len(first), "", dtype=object)
    moved = held.copy()
    moved[held] &= filled | straight[first[held]]
    rows = paths.arcs.take(first[moved])
    move[moved] = phrase(rows.at(rows.start)) + " m\n"
    bounds = zip(first.tolist(), stop.tolist(), strict=True)
    bodies = ["\n".join(words[a:b]) for a, b in bounds]
    ends = np.where(closed, " h", "").tolist()
    return [start + text + end if text else "" for start, text, end in zip(move.tolist(), bodies, ends, strict=True)]


def phrase(values: Floats) -> Texts:
    """Return the rows (k, m) of numbers as texts (k,), separated by spaces."""
    words = numbers(values)
    words[:, 1:] = " " + words[:, 1:]
    return np.asarray(words.sum(axis=1), dtype=object)


def arc_texts(arcs: PlaneArcs, straight: Bools) -> Texts:
    """Return the command (k,) of each arc: circles by centre, radius and angles, ellipses under their own matrix."""
    axes = on_axes(arcs)
    rotation, sweep = np.degrees(axes.rotation), np.degrees(axes.sweep)
    circle = axes.major - axes.minor < THIN
    start = np.mod(np.degrees(axes.start) + np.where(circle, rotation, 0.0), 360.0)
    angles, forward = np.column_stack([start, start + sweep]), axes.sweep >= 0
    as_circle = phrase(np.column_stack([arcs.c, axes.major, angles])) + np.where(forward, " A", " N").astype(object)
    shape = np.column_stack([angles, axes.major, axes.minor, rotation, arcs.c])
    as_ellipse = phrase(shape) + np.where(forward, " E", " F").astype(object)
    as_line = phrase(arcs.at(arcs.start + arcs.sweep)) + " l"
    return np.asarray(np.where(straight, as_line, np.where(circle, as_circle, as_ellipse)), dtype=object)
