"""``molviz.view``: the page in a notebook, as a widget that asks the kernel."""

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from molviz.errors import OptionError, expected_instead
from molviz.pipeline.state import KEPT, USUAL, with_state
from molviz.pipeline.subject import reading_of
from molviz.viewer.session import Input, Session

if TYPE_CHECKING:
    from molviz.viewer.widget import ViewWidget

PAGE = Path(__file__).parent / "page"
IMPORT = re.compile(r'^import \{[^}]*\} from "\./([\w.]+)";\n', re.MULTILINE)
SETS = ("turntable", "stereo")  # options of many pictures, of which the page shows one
NEEDED = "molviz.view needs anywidget; expected: pip install 'molviz[notebook]'"


def view(x: Any, **options: Any) -> "ViewWidget":
    """Return ``x`` as a widget that a notebook shows: to be turned, styled and saved there.

    ``x`` and the options are those of ``molviz.draw``, but for sets of pictures (``turntable``, ``stereo``, several
    models). Where a notebook cannot run, it shows the drawing itself. Raises InputError, naming what is wrong, and
    ModuleNotFoundError where anywidget is not installed.
    """
    for name in options:
        if name not in USUAL or name in SETS:
            raise OptionError(f"no option {name!r}; {expected_instead(name, USUAL, 'those of molviz.draw')}")
    try:
        from molviz.viewer.widget import ViewWidget
    except ModuleNotFoundError as missing:
        raise ModuleNotFoundError(NEEDED) from missing
    options = with_state(options, list(options))
    reading = reading_of(x)
    is_path = isinstance(x, str | os.PathLike)
    shown = Input(reading.models[0].name, os.fspath(x) if is_path else "", reading, repr(str(x)) if is_path else "x")
    session = Session([shown], {name: options[name] for name in KEPT if name in options})
    session.begun(0)
    return ViewWidget(session)


def joined(name: str) -> str:
    """Return a module of the page together with all that it imports, as one module."""
    parts: dict[str, str] = {}

    def add(file: str) -> None:
        text = (PAGE / file).read_text(encoding="utf-8")
        for needed in IMPORT.findall(text):
            if needed not in parts:
                add(needed)
        parts[file] = re.sub(r"^export (?!default)", "", IMPORT.sub("", text), flags=re.MULTILINE)

    add(name)
    return "\n".join(parts.values())
