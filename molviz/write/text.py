"""Numbers and names as text: short, and harmless whatever a file called its atoms."""

import re
import unicodedata
from collections.abc import Iterable, Iterator
from functools import cache
from itertools import islice

PLAIN = {"′": "'", "″": "''", "’": "'", "‘": "'", "“": '"', "”": '"', "–": "-", "—": "-", "−": "-", "×": "x", "·": "."}
NOT_A_NAME, NAME_START = re.compile("[^A-Za-z0-9_.-]"), re.compile("[A-Za-z_]")
BATCH = 4096
NOT_XML = "[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]"


def number(value: float, places: int = 2) -> str:
    """Return a number rounded to some places, without what may be left out: ``-0.50`` is ``-.5``."""
    text = f"{value:.{places}f}"
    text = text.rstrip("0").rstrip(".") if places else text
    if text.startswith("0."):
        return text[1:]
    return "-" + text[2:] if text.startswith("-0.") else "0" if text == "-0" else text


def encoded_lines(lines: Iterable[str]) -> Iterator[bytes]:
    """Yield lines of ASCII, some thousands at a time."""
    return (("\n".join(several) + "\n").encode("ascii") for several in batches(lines))


def batches(texts: Iterable[str]) -> Iterator[list[str]]:
    """Yield some thousands of texts at a time."""
    rest = iter(texts)
    return iter(lambda: list(islice(rest, BATCH)), [])


def clean(text: str) -> str:
    """Return a text in which characters that XML cannot hold became U+FFFD."""
    return text if text.isascii() and text.isprintable() else re.sub(NOT_XML, "\ufffd", text)


def ascii_line(text: str) -> str:
    """Return a text on one line of printable ASCII, with ``?`` for every other character."""
    return re.sub("[^ -~]", "?", " ".join(text.split()))


def plotter_text(text: str) -> str:
    """Return a text in what every plotter can letter: ASCII without the semicolon, which ends commands.

    Letters lose their accents, Greek ones are spelt out, signs become the nearest there is, or ``?``.
    """
    return ascii_line("".join(map(_plainly, text))).replace(";", ",")


def _plainly(character: str) -> str:
    """A character in ASCII where there is a way to say it."""
    name = unicodedata.name(character, "")
    if name.startswith("GREEK") and "LETTER" in name:
        word = name.split("LETTER ")[1].split()[0].lower()
        return word.capitalize() if "CAPITAL" in name else word
    decomposed = unicodedata.normalize("NFKD", PLAIN.get(character, character))
    return "".join(part for part in decomposed if not unicodedata.combining(part))


@cache
def token(text: str) -> str:
    """Return a text as an XML name that is safe as an id and as a CSS class."""
    word = NOT_A_NAME.sub("_", text)
    return word if NAME_START.match(word) else f"_{word}"
