"""State files: the options of a picture as ``molviz view`` saves them, and as ``draw --view-from`` takes them up again.

A file is TOML; its keys are the long options of ``molviz draw`` with underscores, and only those that are not the usual
ones need to be there.
"""

import json
from collections.abc import Collection, Iterable
from inspect import signature
from pathlib import Path
from typing import Any

from molviz import toml
from molviz.errors import InputError, OptionError, expected_instead
from molviz.pipeline import door
from molviz.pipeline.values import Options

FROM = "view_from"
USUAL = {name: one.default for name, one in signature(door.draw).parameters.items() if name != "x"}
KEPT = tuple(name for name in USUAL if name != FROM)  # what a file may state
HEAD = "# molviz view: molviz draw INPUT --view-from THIS -o OUTPUT draws it"


def with_state(options: Options, stated: Collection[str]) -> dict[str, Any]:
    """Return options completed from the state file that they name, if any, but for those ``stated`` beside it.

    Raises InputError where the file cannot be read, and OptionError where it states what is no option.
    """
    path = options.get(FROM)
    if path is None:
        return dict(options)
    kept = _read(str(path))
    return {**options, **{name: value for name, value in kept.items() if name not in stated}}


def _read(path: str) -> dict[str, Any]:
    try:
        return checked_state(toml.read(Path(path)))
    except OSError as wrong:
        raise InputError(f"cannot be read: {wrong.strerror}", path) from None
    except OptionError as wrong:
        raise OptionError(str(wrong), path) from None
    except ValueError as wrong:
        raise OptionError(f"not a state file: {wrong}", path) from None


def state_of_text(text: str) -> dict[str, Any]:
    """Return the options that the content of a state file means; raises OptionError where it is none."""
    try:
        return checked_state(toml.parse(text))
    except OptionError:
        raise
    except ValueError as wrong:
        raise OptionError(f"not a state file: {wrong}") from None


def checked_state(table: dict[str, Any]) -> dict[str, Any]:
    """Return a table of options as it is; raises OptionError for names and kinds of values that no option has."""
    for name, value in table.items():
        if name not in KEPT:
            raise OptionError(f"no option {name!r}; {expected_instead(name, KEPT, 'those of molviz draw')}")
        flag = USUAL[name] is False
        if isinstance(value, dict) or (flag and not isinstance(value, bool)):
            raise OptionError(f"{name}: {value!r}; expected {'true or false' if flag else 'a text, number or list'}")
    return table


def state_text(options: Options) -> str:
    """Return the content of a state file: what differs from the usual options."""
    lines = [f"{name} = {_toml(options[name])}" for name in KEPT if name in options and not is_usual(name, options)]
    return "\n".join([HEAD, *lines, ""])


def is_usual(name: str, options: Options) -> bool:
    """Return whether an option is what it would be if nobody had said anything."""
    value, usual = options[name], USUAL[name]
    return value is None or value == usual or str(value) == str(usual) or (usual == () and not value)


def _toml(value: Any) -> str:
    """A value as TOML: its texts are those of JSON, but for the one control character that JSON leaves as it is."""
    if isinstance(value, Iterable) and not isinstance(value, str):
        return f"[{', '.join(map(_toml, value))}]"
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
