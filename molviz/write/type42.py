"""A TrueType font inside PostScript, which calls that Type 42 (Adobe Technical Note 5012)."""

from typing import NamedTuple

from molviz.write.font import NAME, Font

FIRST = 128  # the code of the first character beyond ASCII; a font has 256
LINE = 240  # digits of hexadecimal on a line
MISSING = "missing"  # name of the glyph at code 0; a program may leave out one that is called .notdef


class Type42(NamedTuple):
    """The lines that define a font, and the code of each character that it can show."""

    name: str
    lines: list[str]
    code: dict[str, int]

    def string(self, text: str) -> str:
        """Return a text as the inside of a string: plain letters as they are, everything else as octal codes."""
        codes = (self.code.get(character, 0) for character in text)
        return "".join(
            chr(code) if 32 <= code < 127 and chr(code) not in "()\\" else f"\\{code:03o}" for code in codes
        )


def type42(font: Font) -> Type42:
    """Return the font, letters of ASCII at their own codes and up to 128 others behind.

    Code 0 shows what the font lacks, and whatever would be the 129th other.
    """
    others = (character for character in font.glyph if not character.isascii())
    code = {character: ord(character) for character in font.glyph if character.isascii()}
    code.update(zip(others, range(FIRST, 256), strict=False))
    name = f"{NAME}-molviz"
    shown = sorted((number, font.glyph[character], glyph_name(character)) for character, number in code.items())
    digits = font.data.hex() + ("00" if len(font.data) % 2 == 0 else "")  # of odd strings the last byte is dropped
    box = " ".join(f"{length / 1000:g}" for length in font.box)
    lines = [
        f"%%BeginResource: font {name}",
        f"11 dict begin/FontName/{name} def/FontType 42 def/PaintType 0 def/FontMatrix[1 0 0 1 0 0]def",
        f"/FontBBox[{box}]def/Encoding 256 array 0 1 255{{1 index exch/.notdef put}}for",
        *(f"dup {number}/{name} put" for number, _, name in shown),
        f"dup 0/{MISSING} put def/CharStrings {len(shown) + 2} dict dup begin/.notdef 0 def/{MISSING} 0 def",
        *(f"/{name} {glyph} def" for _, glyph, name in shown),
        "end def/sfnts[<",
        *(digits[first : first + LINE] for first in range(0, len(digits), LINE)),
        ">]def FontName currentdict end definefont pop",
        "%%EndResource",
    ]
    return Type42(name, lines, code)


def glyph_name(character: str) -> str:
    """Return the name by which programs know the character of a glyph (Adobe Glyph List)."""
    from fontTools.agl import UV2AGL

    return str(UV2AGL.get(ord(character), f"uni{ord(character):04X}"))
