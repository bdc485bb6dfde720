"""What a picture looks like: colours and line widths, from a TOML file."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from molviz import toml
from molviz.errors import InputError
from molviz.picture.colors import parse_color
from molviz.picture.picture import Color

FOLDER = Path(__file__).parent / "styles"
STYLES = tuple(sorted(path.stem for path in FOLDER.glob("*.toml")))


@dataclass(frozen=True)
class Line:
    """A line is ``width`` points wide, at small scales ``angstrom`` of the drawing."""

    width: float
    angstrom: float

    def at(self, scale: float) -> float:
        """Return the width in points in a drawing of ``scale`` points per ångström."""
        return min(self.width, self.angstrom * scale)


@dataclass(frozen=True)
class Style:
    """Colours are taste and live here; radii are physics and do not."""

    line_color: Color
    outline: Line
    crease: Line
    unknown: Color
    element: dict[str, Color]
    residue: dict[str, Color]
    chain: tuple[Color, ...]
    ramp: tuple[Color, ...]


def load_style(name: str) -> Style:
    """Return a style by name or from the user's TOML file; raises InputError where it is neither or lacks something."""
    path = FOLDER / f"{name}.toml" if name in STYLES else Path(name)
    try:
        return _style(toml.loads(path.read_text(encoding="utf-8")))
    except OSError:
        raise InputError(f"no such style or file; expected one of {', '.join(STYLES)} or a TOML file", name) from None
    except KeyError as missing:
        raise InputError(f"not a style: it lacks {missing}; expected what styles/default.toml has", name) from None
    except (AttributeError, TypeError, ValueError) as wrong:
        raise InputError(f"not a style: {wrong}", name) from None


def _style(table: dict[str, Any]) -> Style:
    lines, colors = table["lines"], table["colors"]
    return Style(
        line_color=parse_color(lines["color"]),
        outline=Line(float(lines["outline"]), float(lines["outline_angstrom"])),
        crease=Line(float(lines["crease"]), float(lines["crease_angstrom"])),
        unknown=parse_color(colors["unknown"]),
        element={name: parse_color(text) for name, text in colors["element"].items()},
        residue={name: parse_color(text) for name, text in colors["residue"].items()},
        chain=tuple(parse_color(text) for text in colors["chain"]),
        ramp=tuple(parse_color(text) for text in colors["ramp"]),
    )
