"""How wide text is: advances of the font that the writers embed, which has the widths of Helvetica and Arial."""

from functools import cache
from pathlib import Path

UNITS = 2048  # of the font's design space, to the size of the text
UNKNOWN = 2048  # the advance of characters that the font lacks: viewers show a square letter of another font
CAPITAL = 0.72  # of the size: height of capitals and digits above the baseline
DESCENT = 0.22  # of the size: depth of p, q and commas below it
LEADING = 1.25  # of the size: from one baseline to the next
ELLIPSIS = "…"


@cache
def _advances() -> dict[str, int]:
    """The advance of each character; a line of the table is an advance and its code points in hexadecimal."""
    table = Path(__file__).with_name("advances.txt").read_text(encoding="ascii")
    advances: dict[str, int] = {}
    for line in table.splitlines():
        advance, *spans = line.split()
        for span in spans:
            first, _, last = span.partition("-")
            advances.update((chr(code), int(advance)) for code in range(int(first, 16), int(last or first, 16) + 1))
    return advances


def text_width(text: str, size: float) -> float:
    """Return the width of a line of text in points."""
    advances = _advances()
    return sum(advances.get(character, UNKNOWN) for character in text) * size / UNITS


def one_line(text: str) -> str:
    """Return a text with every run of white space as one space."""
    return " ".join(text.split())


def shortened(text: str, size: float, width: float) -> str:
    """Return the text, cut with an ellipsis where it is wider than ``width`` points."""
    if text_width(text, size) <= width:
        return text
    allowed, end = width - text_width(ELLIPSIS, size), 0
    while text_width(text[: end + 1], size) <= allowed:
        end += 1
    return text[:end].rstrip() + ELLIPSIS


def wrapped(text: str, size: float, width: float, most: int) -> list[str]:
    """Return the text broken between words into lines of at most ``width`` points, the last of ``most`` lines cut."""
    lines: list[str] = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and (text_width(longer, size) <= width or len(lines) == most):
            lines[-1] = longer
        else:
            lines.append(word)
        if len(lines) == most and text_width(lines[-1], size) > width:
            break
    return [shortened(line, size, width) for line in lines]
