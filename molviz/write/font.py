"""The font that files carry: the glyphs that a picture's texts need, cut out of a file of the package.

fonttools is imported here, and only when a picture has text.
"""

from collections.abc import Iterable
from importlib import resources
from io import BytesIO
from typing import NamedTuple

from molviz.picture.furniture.metrics import text_width
from molviz.picture.picture import Picture, Text, TextLayer

FILE = "Arimo-Regular.ttf"
NAME = "Arimo"
BEFORE = {"start": 0.0, "middle": 0.5, "end": 1.0}  # the share of a text's width before its x


class Font(NamedTuple):
    """A TrueType font of few glyphs, number 0 being what is shown for characters that it lacks."""

    data: bytes
    glyph: dict[str, int]  # of each character that has one
    advance: list[int]  # of each glyph, in thousandths of the size
    box: tuple[int, int, int, int]  # of all glyphs, in thousandths of the size
    ascent: int
    descent: int
    capital: int


def characters(picture: Picture) -> frozenset[str]:
    """Return the characters of all texts of a picture."""
    layers = (layer for layer in picture.layers if isinstance(layer, TextLayer))
    return frozenset("".join(text.text for layer in layers for text in layer.texts))


def font_of(wanted: frozenset[str]) -> Font:
    """Return the font with the glyphs of these characters; the same ones give the same bytes."""
    from fontTools.subset import Options, Subsetter
    from fontTools.ttLib import TTFont

    file = BytesIO(resources.files("molviz.write").joinpath("fonts", FILE).read_bytes())
    font, out = TTFont(file, recalcTimestamp=False), BytesIO()
    subsetter = Subsetter(Options(notdef_outline=True, recalc_timestamp=False, drop_tables=["name", "post", "OS/2"]))
    capital, codes = font["OS/2"].sCapHeight, font.getBestCmap()
    subsetter.populate(unicodes=[ord(character) for character in wanted])
    subsetter.subset(font)
    order = {name: number for number, name in enumerate(font.getGlyphOrder())}
    glyph = {character: order[codes[ord(character)]] for character in sorted(wanted) if ord(character) in codes}
    advances = [font["hmtx"][name][0] for name in order]
    del font["cmap"]  # PDF and PostScript bring encodings of their own
    font.save(out, reorderTables=None)
    head, line, per_mille = font["head"], font["hhea"], 1000 / font["head"].unitsPerEm
    lengths = [head.xMin, head.yMin, head.xMax, head.yMax, line.ascent, line.descent, capital, *advances]
    x0, y0, x1, y1, ascent, descent, top, *advance = (round(length * per_mille) for length in lengths)
    return Font(out.getvalue(), glyph, advance, (x0, y0, x1, y1), ascent, descent, top)


def left(text: Text) -> float:
    """Return where a text begins."""
    return text.x - BEFORE[text.anchor] * text_width(text.text, text.size)


def pieces(text: str, most: int) -> Iterable[str]:
    """Yield the text in pieces of at most ``most`` characters."""
    return (text[begin : begin + most] for begin in range(0, len(text), most))
