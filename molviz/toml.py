"""The TOML parser: Python's own, and before Python 3.11 the package that it came from; files of people are checked."""

import sys
from pathlib import Path
from typing import Any

if sys.version_info >= (3, 11):
    from tomllib import loads
else:
    from tomli import loads

__all__ = ["loads", "parse", "read"]
MOST_DEPTH = 16  # of tables and lists in each other; nothing here has more than three
LARGEST_INTEGER = 2**63  # as TOML has it: larger ones have no decimal digits to be shown with


def read(path: Path) -> dict[str, Any]:
    """Return the table in a file; raises OSError where it cannot be read, and ValueError for what is no plain TOML."""
    return parse(path.read_text(encoding="utf-8"))


def parse(text: str) -> dict[str, Any]:
    """Return the table of a text; raises ValueError for what is no plain TOML."""
    try:
        table = loads(text)
    except RecursionError:
        raise ValueError("tables in tables without end") from None
    _check(table, ())
    return table


def _check(value: object, names: tuple[str, ...]) -> None:
    if len(names) > MOST_DEPTH:
        raise ValueError("tables in tables without end")
    if isinstance(value, int) and abs(value) >= LARGEST_INTEGER:
        raise ValueError(f"{'.'.join(names)} is a whole number of 64 bits or more; expected a smaller one")
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for name, one in inner:
        _check(one, (*names, str(name)))
