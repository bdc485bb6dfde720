"""The command, or the call in Python, that makes a picture once more."""

import shlex
from collections.abc import Iterable, Sequence
from pathlib import PurePath
from typing import Any

from molviz.pipeline.state import KEPT, USUAL, is_usual
from molviz.pipeline.values import Options


def words_of(options: Options) -> list[str]:
    """Return the options of ``molviz draw`` as they may be typed; what is usual needs no word."""
    words: list[str] = []
    for name in (name for name in KEPT if name in options and not is_usual(name, options)):
        flag, value = f"--{name.replace('_', '-')}", options[name]
        if value is True:
            words += [flag]
        elif USUAL[name] == ():
            words += [word for one in _several(name, value) for word in (flag, _word(name, one))]
        else:
            words += [flag, _word(name, value)]
    return words


def _several(name: str, value: Any) -> Iterable[Any]:
    """The values of an option that may be repeated, where one alone may stand for a list of one."""
    single = isinstance(value, str) or (name == "rotate" and value[0] in ("x", "y", "z"))
    return [value] if single else list(value)


def _word(name: str, value: Any) -> str:
    if name == "background" and not isinstance(value, str):
        return "#" + "".join(f"{int(channel):02x}" for channel in value)
    if name == "color" and not isinstance(value, str):
        return f"{value[0]}={_word('background', value[1])}"
    if isinstance(value, Sequence) and not isinstance(value, str):
        return ",".join(_word("", one) for one in value)
    return _number(value) if isinstance(value, float) else str(value)


def _number(value: float) -> str:
    """The shortest text that is read as the same number."""
    return str(int(value)) if value == int(value) and abs(value) < 1e15 else repr(value)


def drawn_by(source: str, options: Options) -> str:
    """Return the command as a file says that it was drawn by: without folders, and without where it went."""
    return shlex.join(["molviz", "draw", PurePath(source).name, *words_of(options)])


def command_of(source: str, options: Options, output: str) -> str:
    """Return the command that writes the picture of a file."""
    return shlex.join(["molviz", "draw", source, *words_of(options), "-o", output])


def call_of(name: str, options: Options) -> str:
    """Return the call in Python that draws ``name``."""
    stated = [f"{one}={_plain(options[one])!r}" for one in KEPT if one in options and not is_usual(one, options)]
    return f"molviz.draw({', '.join([name, *stated])})"


def _plain(value: Any) -> Any:
    return [_plain(one) for one in value] if isinstance(value, list | tuple) else value
