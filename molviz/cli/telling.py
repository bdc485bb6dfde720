"""What reaches the terminal: messages and results, and no character that it obeys."""

import csv
import json
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

import click

_KEPT: ContextVar[list[str] | None] = ContextVar("kept", default=None)  # what is said, where it is not written



def visible(text: str) -> str:
    """Return a text in one line, control characters (C0, DEL, C1) and what no encoding holds as escapes (``\\x1b``)."""
    if text.isprintable():
        return text
    return "".join(_escaped(letter) for letter in text)


def _escaped(letter: str) -> str:
    code = ord(letter)
    obeyed = code < 0x20 or 0x7F <= code < 0xA0 or letter in "\u2028\u2029"
    return letter.encode("unicode_escape").decode("ascii") if obeyed or 0xD800 <= code < 0xE000 else letter


def say(*lines: str) -> None:
    """Write lines to standard error, or keep them while they are ``collected``."""
    kept = _KEPT.get()
    if kept is None:
        click.echo("\n".join(map(visible, lines)), err=True)
    else:
        kept.extend(lines)


@contextmanager
def collected() -> Iterator[list[str]]:
    """Keep what is said meanwhile by this thread in a list."""
    lines: list[str] = []
    token = _KEPT.set(lines)
    try:
        yield lines
    finally:
        _KEPT.reset(token)


def tell_json(result: dict[str, Any]) -> None:
    """Write one JSON object, in ASCII, whatever the names in it: file names need not be text of any encoding."""
    click.echo(json.dumps(result))


def tell_csv(rows: Iterable[dict[str, Any]], header: Sequence[str] = ()) -> None:
    """Write comma-separated values; where no header is given, the first row's names are it."""
    writer = _csv_writer(header) if header else None
    for row in rows:
        writer = writer or _csv_writer(list(row))
        writer.writerow({name: visible(value) if isinstance(value, str) else value for name, value in row.items()})


def _csv_writer(header: Sequence[str]) -> "csv.DictWriter[str]":
    writer = csv.DictWriter(sys.stdout, header, lineterminator="\n")
    writer.writeheader()
    return writer
