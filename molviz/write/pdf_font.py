"""A font inside a PDF: glyphs by number, and the characters that they stand for, so that text can be searched."""

from collections.abc import Sequence

import pydyf

from molviz.write.font import NAME, Font

TAG = "MOLVIZ"  # six letters in front of its name tell that a font is not whole
PLAIN = 32  # flag: not symbols only
BLOCK = 100  # entries of a block of a character map, the most it may have


def embedded(pdf: pydyf.PDF, font: Font) -> pydyf.Dictionary:
    """Add a font to a PDF (ISO 32000-1, 9.7) and return it; text is two bytes a glyph."""
    name = f"/{TAG}+{NAME}"
    file = pydyf.Stream([font.data], {"Length1": len(font.data)}, compress=True)
    names = pydyf.Stream([line.encode() for line in character_map(font)], compress=True)
    pdf.add_object(file)
    pdf.add_object(names)
    described = pydyf.Dictionary(
        {
            "Type": "/FontDescriptor", "FontName": name, "Flags": PLAIN, "FontBBox": pydyf.Array(font.box),
            "ItalicAngle": 0, "Ascent": font.ascent, "Descent": font.descent, "CapHeight": font.capital, "StemV": 80,
            "FontFile2": file.reference,
        }
    )  # fmt: skip
    pdf.add_object(described)
    system = pydyf.Dictionary(
        {"Registry": pydyf.String("Adobe"), "Ordering": pydyf.String("Identity"), "Supplement": 0}
    )
    glyphs = pydyf.Dictionary(
        {
            "Type": "/Font", "Subtype": "/CIDFontType2", "BaseFont": name, "CIDSystemInfo": system,
            "FontDescriptor": described.reference, "CIDToGIDMap": "/Identity",
            "W": pydyf.Array([0, pydyf.Array(font.advance)]),
        }
    )  # fmt: skip
    pdf.add_object(glyphs)
    whole = pydyf.Dictionary(
        {
            "Type": "/Font", "Subtype": "/Type0", "BaseFont": name, "Encoding": "/Identity-H",
            "DescendantFonts": pydyf.Array([glyphs.reference]), "ToUnicode": names.reference,
        }
    )  # fmt: skip
    pdf.add_object(whole)
    return whole


def character_map(font: Font) -> list[str]:
    """Return the lines that tell the character of each glyph, in UTF-16."""
    rows = sorted((glyph, character) for character, glyph in font.glyph.items())
    entries = [f"<{glyph:04x}> <{character.encode('utf-16-be').hex()}>" for glyph, character in rows]
    head = ["/CIDInit /ProcSet findresource begin 12 dict begin begincmap", "/CMapName /molviz def /CMapType 2 def"]
    head.append("1 begincodespacerange <0000> <ffff> endcodespacerange")
    return [*head, *_blocks(entries), "endcmap CMapName currentdict /CMap defineresource pop end end"]


def _blocks(entries: Sequence[str]) -> list[str]:
    """The entries in blocks of the size that readers must be able to hold."""
    lines = []
    for first in range(0, len(entries), BLOCK):
        block = entries[first : first + BLOCK]
        lines += [f"{len(block)} beginbfchar", *block, "endbfchar"]
    return lines
