"""What a picture looks like: choices from TOML files, each of which may say only how it differs from another.

Every key of every section has a type and stands in ``styles/flat.toml`` with its meaning. Colours are taste and live
here; radii are physics and do not.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from molviz import toml
from molviz.errors import OptionError, expected_instead
from molviz.picture.colors import parse_color
from molviz.picture.ink import InkStyle, Pen
from molviz.picture.picture import Color

FOLDER = Path(__file__).parent / "styles"
STYLES = tuple(sorted(path.stem for path in FOLDER.glob("*.toml")))
ROOT = "flat"  # the style that states every key
WIDEST = 1000.0  # points or ångström of any line or distance
DEEPEST = 1000.0  # ångström of any jump or skirt
CLOSEST = 0.1  # points between lines of hatching: closer ones are a tone, and too many
LEAST_RAMP = 1e-3  # ångström between the jumps at which lines begin and are full
MOST_BASES = 8  # of a chain of styles; a longer one is a circle

Table = dict[str, Any]


@dataclass(frozen=True)
class Line:
    """A line is ``width`` points wide, at small scales ``angstrom`` of the drawing."""

    width: float
    angstrom: float

    def at(self, scale: float) -> float:
        """Return the width in points in a drawing of ``scale`` points per ångström."""
        return min(self.width, self.angstrom * scale)


@dataclass(frozen=True)
class Lines:
    """Strokes along edges; ``crease_where`` is ``all``, or ``between`` for those between chains and at ligands."""

    color: Color
    outline: Line
    crease: Line
    crease_opacity: float
    crease_where: str


@dataclass(frozen=True)
class Fog:
    """How much of the background far spheres take on, from which share of the depth on, and in how many steps."""

    strength: float
    begin: float
    steps: int


@dataclass(frozen=True)
class ShadeStep:
    """A contact shade: a skirt ``reach`` ångström wide, hung ``low`` ångström below its sphere."""

    reach: float
    low: float
    opacity: float


@dataclass(frozen=True)
class Shade:
    """Contact shade in steps, from the widest to the narrowest; fewer for scenes of ``large_from`` visible spheres."""

    steps: tuple[ShadeStep, ...]
    large_steps: tuple[ShadeStep, ...]
    large_from: int


@dataclass(frozen=True)
class Light:
    """Bands of light: the direction towards it, and (cosine, opacity) of where it ends and where it is mirrored."""

    direction: tuple[float, float, float]
    dark: Color
    terminators: tuple[tuple[float, float], ...]
    bright: Color
    highlights: tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Ball:
    """How much of the light's bright and dark colours a shaded ball takes on where it is brightest and darkest."""

    bright: float
    dark: float


@dataclass(frozen=True)
class Hatch:
    """Parallel lines over regions: points between them for the darkest and the lightest tone, and their angle."""

    nearest: float
    farthest: float
    angle: float
    width: float


@dataclass(frozen=True)
class Colors:
    """The scheme by default, and the style's own colours; those of chains and entities are the palette's."""

    scheme: str
    unknown: Color
    element: dict[str, Color]
    residue: dict[str, Color]
    ramp: tuple[Color, ...]


@dataclass(frozen=True)
class Style:
    """All that a picture's look depends on besides the user's options."""

    title: str
    fill: str
    parts: str
    lines: Lines
    ink: InkStyle
    fog: Fog
    shade: Shade
    light: Light
    ball: Ball
    hatch: Hatch
    colors: Colors


def load_style(name: str) -> Style:
    """Return a style by name or from the user's TOML file.

    Raises OptionError where it is neither, for keys that no style has and for values of the wrong kind.
    """
    whole = _whole(name, 0)
    try:
        return _style(_Section(whole))
    except ValueError as wrong:
        raise OptionError(f"not a style: {wrong}", name) from None


@cache
def _root() -> Table:
    return toml.loads((FOLDER / f"{ROOT}.toml").read_text(encoding="utf-8"))


def _whole(name: str, depth: int) -> Table:
    """The table of a style laid over those that it is based on."""
    if name == ROOT:
        return _root()
    if depth > MOST_BASES:
        raise OptionError("styles are based on each other in a circle", name)
    table = _read(name)
    base = table.pop("base", ROOT)
    if not isinstance(base, str):
        raise OptionError(f"base = {base!r} is no name of a style", name)
    _refuse_unknown(table, _root(), "", name)
    return _laid_over(_whole(base, depth + 1), table)


def _read(name: str) -> Table:
    path = FOLDER / f"{name}.toml" if name in STYLES else Path(name)
    try:
        return toml.read(path)
    except ValueError as wrong:
        raise OptionError(f"not a style: {wrong}", name) from None
    except OSError:
        expected = expected_instead(name, STYLES, f"one of {', '.join(STYLES)} or a TOML file")
        raise OptionError(f"no such style or file; {expected}", name) from None


def _refuse_unknown(table: Table, known: Table, where: str, name: str) -> None:
    for key, value in table.items():
        if where in ("colors.element.", "colors.residue."):
            continue
        if key not in known:
            expected = expected_instead(key, known, f"one of {', '.join(known)}")
            raise OptionError(f"no style has a key {where}{key}; {expected}", name)
        if isinstance(known[key], dict) != isinstance(value, dict):
            kind = "a table" if isinstance(known[key], dict) else "a value"
            raise OptionError(f"not a style: {where}{key} is expected to be {kind}", name)
        if isinstance(value, dict):
            _refuse_unknown(value, known[key], f"{where}{key}.", name)


def _laid_over(base: Table, table: Table) -> Table:
    """The base with the table's values in the place of its own, section by section."""
    both = dict(base)
    for key, value in table.items():
        inner = base.get(key)
        both[key] = _laid_over(inner, value) if isinstance(value, dict) and isinstance(inner, dict) else value
    return both


class _Section:
    """One table of a style; whatever is wrong raises ValueError that names the key."""

    def __init__(self, table: Table, name: str = "") -> None:
        self.table, self.name = table, name

    def section(self, key: str) -> "_Section":
        return _Section(self.table[key], f"{self.name}{key}.")

    def wrong(self, key: str, expected: str) -> ValueError:
        return ValueError(f"{self.name}{key} = {self.table[key]!r}; expected {expected}")

    def text(self, key: str) -> str:
        value = self.table[key]
        if not isinstance(value, str):
            raise self.wrong(key, "a text")
        return value

    def choice(self, key: str, known: Sequence[str]) -> str:
        if self.text(key) not in known:
            raise self.wrong(key, f"one of {', '.join(known)}")
        return self.text(key)

    def number(self, key: str, low: float, high: float) -> float:
        return self.checked(key, self.table[key], low, high)

    def checked(self, key: str, value: object, low: float, high: float) -> float:
        """Return a value as a number in a range; NaN is in none."""
        if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
            raise self.wrong(key, f"numbers from {low:g} to {high:g}")
        return float(value)

    def rows(self, key: str, *ranges: tuple[float, float]) -> list[tuple[float, ...]]:
        """Return a list of rows of numbers, one range for each column."""
        rows = self.table[key]
        if not isinstance(rows, list) or any(not isinstance(row, list) or len(row) != len(ranges) for row in rows):
            raise self.wrong(key, f"a list of rows of {len(ranges)} numbers")
        return [tuple(self.checked(key, x, *span) for x, span in zip(row, ranges, strict=True)) for row in rows]

    def color(self, key: str) -> Color:
        return self.parsed(key, self.table[key])

    def parsed(self, key: str, value: object) -> Color:
        try:
            return parse_color(value if isinstance(value, str) else "")
        except ValueError:
            raise self.wrong(key, "colours as #rrggbb or CSS names") from None

    def colors(self, key: str) -> tuple[Color, ...]:
        values = self.table[key]
        if not isinstance(values, list) or not values:
            raise self.wrong(key, "a list of colours")
        return tuple(self.parsed(key, value) for value in values)

    def colors_by_name(self, key: str) -> dict[str, Color]:
        inner = self.section(key)
        return {name: inner.color(name) for name in inner.table}


def _style(root: _Section) -> Style:
    return Style(
        title=root.text("title"),
        fill=root.choice("fill", ("flat", "ball", "none")),
        parts=root.choice("parts", ("atoms", "merged")),
        lines=_lines(root.section("lines")),
        ink=_ink(root.section("ink")),
        fog=_fog(root.section("fog")),
        shade=_shade(root.section("shade")),
        light=_light(root.section("light")),
        ball=Ball(root.section("ball").number("bright", 0, 1), root.section("ball").number("dark", 0, 1)),
        hatch=_hatch(root.section("hatch")),
        colors=_colors(root.section("colors")),
    )


def _lines(lines: _Section) -> Lines:
    outline, crease = (
        Line(lines.number(name, 0, WIDEST), lines.number(f"{name}_angstrom", 0, WIDEST))
        for name in ("outline", "crease")
    )
    where = lines.choice("crease_where", ("all", "between"))
    return Lines(lines.color("color"), outline, crease, lines.number("crease_opacity", 0, 1), where)


def _ink(ink: _Section) -> InkStyle:
    silhouette, between, inside = (
        Pen(ink.number(f"{kind}_angstrom", 0, WIDEST), ink.number(kind, 0, WIDEST))
        for kind in ("silhouette", "between", "inside")
    )
    faint = ink.number("faint", 0, DEEPEST)
    return InkStyle(silhouette, between, inside, faint, max(ink.number("full", 0, DEEPEST), faint + LEAST_RAMP))


def _fog(fog: _Section) -> Fog:
    return Fog(fog.number("strength", 0, 1), fog.number("begin", 0, 0.99), int(fog.number("steps", 1, 64)))


def _shade(shade: _Section) -> Shade:
    steps, large = (
        tuple(ShadeStep(*row) for row in shade.rows(key, (0.1, 50), (0.1, DEEPEST), (0, 1)))
        for key in ("steps", "large_steps")
    )
    return Shade(steps, large, int(shade.number("large_from", 0, 1e9)))


def _light(light: _Section) -> Light:
    direction = light.rows("direction", *[(-1e3, 1e3)] * 3)
    if len(direction) != 1 or not any(direction[0]):
        raise light.wrong("direction", "one row of three numbers, towards the light")
    ends, mirrored = (light.rows(key, (-1, 1), (0, 1)) for key in ("terminators", "highlights"))
    x, y, z = direction[0]
    size = math.hypot(x, y, z)
    return Light(
        (x / size, y / size, z / size), light.color("dark"), tuple((c, o) for c, o in ends),
        light.color("bright"), tuple((c, o) for c, o in mirrored),
    )  # fmt: skip


def _hatch(hatch: _Section) -> Hatch:
    nearest = hatch.number("nearest", 0, WIDEST)
    if 0 < nearest < CLOSEST:
        raise hatch.wrong("nearest", f"0 or numbers from {CLOSEST:g} to {WIDEST:g}")
    farthest = hatch.number("farthest", CLOSEST, WIDEST)
    return Hatch(nearest, farthest, hatch.number("angle", -360, 360), hatch.number("width", 0, WIDEST))


def _colors(colors: _Section) -> Colors:
    return Colors(
        scheme=colors.choice("scheme", ("element", "entity", "chain", "residue")),
        unknown=colors.color("unknown"),
        element=colors.colors_by_name("element"),
        residue=colors.colors_by_name("residue"),
        ramp=colors.colors("ramp"),
    )
