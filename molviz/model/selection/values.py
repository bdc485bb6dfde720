"""Lists of values in a selection: names with wildcards, numbers and ranges; each becomes a test of one text."""

import re
from collections.abc import Sequence
from fnmatch import fnmatchcase

from molviz.model.selection.words import WITH_CAPITALS, Test, is_element, leading_number

_NUMBER = r"-?\d+"
RANGE = re.compile(rf"({_NUMBER})[-:]({_NUMBER})", re.ASCII)
PLACE = re.compile(rf"{_NUMBER}[A-Za-z]?", re.ASCII)  # a number with its insertion code
BETWEEN = ("to", "-", ":")  # words between the two ends of a range
PLUS = re.compile(r"(?<=.)\+(?=.)")  # at either end it belongs to the name: NA+


def parts_of(word: str) -> list[str]:
    """Return the values that a word lists: parted by +."""
    return PLUS.split(word)


def names_test(column: str, values: Sequence[tuple[str, bool]]) -> Test:
    """Return whether a text is one of the values: (text, whether it is quoted and so has no wildcards)."""
    raised = [(text if column in WITH_CAPITALS else text.upper(), quoted) for text, quoted in values]
    exact = {text for text, quoted in raised if quoted or not set("*?") & set(text)}
    patterns = [_pattern(text) for text, quoted in raised if not quoted and text not in exact]
    return lambda text: text in exact or any(fnmatchcase(text, pattern) for pattern in patterns)


def _pattern(text: str) -> str:
    """Return a pattern in which * and ? alone mean more than themselves."""
    return text.replace("[", "[[]")


def is_name(column: str, text: str) -> bool:
    """Tell whether a text can be a value of a column of texts: elements are known ones."""
    return column != "elem" or bool(set("*?") & set(text)) or is_element(text)


def is_number(column: str, text: str) -> bool:
    """Tell whether a text can be a value of a column of numbers: a number, a range, or a place with insertion code."""
    return bool(RANGE.fullmatch(text) or (PLACE if column == "resi" else re.compile(_NUMBER, re.ASCII)).fullmatch(text))


def numbers_test(values: Sequence[str]) -> Test:
    """Return whether a number, with or without its insertion code, is one of the values or within one of the ranges."""
    spans = [(float(span[1]), float(span[2])) for span in map(RANGE.fullmatch, values) if span]
    exact = set(values)

    def test(text: str) -> bool:
        return text in exact or any(low <= leading_number(text) <= high for low, high in spans)

    return test
