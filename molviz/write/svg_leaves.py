"""Elements of SVG as text below the groups that svgwrite builds, which takes ten times as long for each."""

import re
from collections.abc import Iterator
from itertools import chain
from typing import Any
from xml.etree.ElementTree import ProcessingInstruction

from svgwrite.base import BaseElement

from molviz.write.text import batches, clean

PLACE = re.compile(r"<\?leaves (\d+)\?>")


class Run(BaseElement):  # type: ignore[misc]
    """A place in a group for elements that follow each other; the document has a mark there until they are put in."""

    elementname = "leaves"

    def __init__(self, number: int) -> None:
        super().__init__(debug=False)
        self.number, self.texts = number, list[str]()

    def get_xml(self) -> Any:
        """Return the mark, which no text in a document looks like: there, a < is escaped."""
        return ProcessingInstruction(self.elementname, str(self.number))


class Leaves:
    """All runs of a document."""

    def __init__(self) -> None:
        self.runs: list[Run] = []

    def add(self, group: Any, text: str) -> None:
        """Add an element, as text, at the end of a group."""
        if not group.elements or not isinstance(group.elements[-1], Run):
            self.runs.append(group.add(Run(len(self.runs))))
        group.elements[-1].texts.append(text)

    def put_into(self, document: str) -> Iterator[str]:
        """Yield the document with all elements in their places, some thousands of pieces at a time."""
        parts = PLACE.split(document)
        texts = (self.runs[int(part)].texts if row % 2 else [part] for row, part in enumerate(parts))
        return map("".join, batches(chain.from_iterable(texts)))


def element(name: str, attributes: dict[str, str], content: str = "") -> str:
    """Return an element as svgwrite writes it: attributes in alphabetical order, without empty ones.

    Values are safe as they are: numbers, tokens, colours.
    """
    words = "".join([f' {key}="{attributes[key]}"' for key in sorted(attributes) if attributes[key]])
    return f"<{name}{words}>{content}</{name}>" if content else f"<{name}{words} />"


def title(text: str) -> str:
    """Return the element that names the one it is in; nothing where the text is empty."""
    text = clean(text).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
    return f"<title>{text}</title>" if text else ""
