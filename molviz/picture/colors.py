"""Colours as people write them: names of CSS and hexadecimal digits."""

import difflib
import re
from functools import cache
from pathlib import Path

from molviz import toml
from molviz.picture.picture import Color

_HEXADECIMAL = re.compile(r"#([0-9a-f]{3}|[0-9a-f]{6})", re.IGNORECASE)


@cache
def css_colors() -> dict[str, str]:
    """Return the 148 named colours of CSS, each as ``#rrggbb``."""
    return toml.loads((Path(__file__).parent / "css_colors.toml").read_text(encoding="utf-8"))


def parse_color(text: str) -> Color:
    """Return the colour of ``#rgb``, ``#rrggbb`` or a CSS name in any case; raises ValueError for anything else."""
    written = text.strip()
    value = written if written.startswith("#") else css_colors().get(written.lower(), "")
    if not _HEXADECIMAL.fullmatch(value):
        raise ValueError(f"{text!r} is not a colour{_meant(written)}; expected #rgb, #rrggbb or a name that CSS knows")
    digits = value[1:] if len(value) == 7 else "".join(2 * digit for digit in value[1:])
    return int(digits[0:2], 16), int(digits[2:4], 16), int(digits[4:6], 16)


def _meant(written: str) -> str:
    """Return a question for what was meant, where a name or digits without their # come near enough."""
    if _HEXADECIMAL.fullmatch(f"#{written}"):
        return f", did you mean '#{written}'?"
    near = difflib.get_close_matches(written.lower(), css_colors(), n=1)
    return f", did you mean {near[0]!r}?" if near else ""
