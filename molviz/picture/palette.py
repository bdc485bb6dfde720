"""Palettes: the colours of entities, ligands and chains, from TOML files."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from molviz import toml
from molviz.errors import OptionError, expected_instead
from molviz.picture.colors import parse_color
from molviz.picture.picture import Color

FOLDER = Path(__file__).parent / "palettes"
PALETTES = tuple(sorted(path.stem for path in FOLDER.glob("*.toml")))
DEFAULT = "tide"
LARGEST_TINT = 20.0  # L*: more leaves room for no second tint


@dataclass(frozen=True)
class Tones:
    """The colours of one thing; what each is for is said in palettes/tide.toml."""

    carbon: Color
    hetero: Color
    ink: Color
    shade: Color


@dataclass(frozen=True)
class Palette:
    """Colours by meaning; every key is explained in palettes/tide.toml."""

    title: str
    ink: Color
    haze: Color
    metal: Color
    tint: float
    ligand: Tones
    entity: tuple[Tones, ...]
    chain: tuple[Color, ...]

    def repeats(self, chains: int) -> bool:
        """Tell whether so many chains are more than there are chain colours, so that some share one."""
        return chains > len(self.chain)


TONES = ("carbon", "hetero", "ink", "shade")
KEYS = ("title", "ink", "haze", "metal", "tint", "ligand", "entity", "chain")


def load_palette(name: str) -> Palette:
    """Return a palette by name or from the user's TOML file, which states only what differs from its ``base``.

    ``base`` is the name of a palette (default ``tide``); the keys of ``ligand`` differ singly, ``entity`` and ``chain``
    as a whole. Raises OptionError, naming the key, for what is no palette.
    """
    if name in PALETTES:
        return _palette(_table(FOLDER / f"{name}.toml", name), name)
    table = _table(Path(name), name)
    _check_keys(table, ("base", *KEYS), "", name)
    base = table.pop("base", DEFAULT)
    if base not in PALETTES:
        raise OptionError(f"palette key 'base': {base!r} is no palette; expected one of {', '.join(PALETTES)}", name)
    whole = _table(FOLDER / f"{base}.toml", base) | table
    if isinstance(table.get("ligand"), dict):
        whole["ligand"] = _table(FOLDER / f"{base}.toml", base)["ligand"] | table["ligand"]
    return _palette(whole, name)


def _table(path: Path, source: str) -> dict[str, Any]:
    try:
        return toml.read(path)
    except OSError:
        expected = expected_instead(source, PALETTES, f"one of {', '.join(PALETTES)} or a TOML file")
        raise OptionError(f"no such palette or file; {expected}", source) from None
    except ValueError as wrong:
        raise OptionError(f"not a palette: {wrong}; expected TOML", source) from None


def _palette(table: dict[str, Any], source: str) -> Palette:
    return Palette(
        title=_title(table["title"], source),
        ink=_color(table["ink"], "ink", source),
        haze=_color(table["haze"], "haze", source),
        metal=_color(table["metal"], "metal", source),
        tint=_tint(table["tint"], source),
        ligand=_tones(table["ligand"], "ligand", source),
        entity=tuple(
            _tones(row, f"entity[{number}]", source)
            for number, row in enumerate(_filled(table["entity"], "entity", source), start=1)
        ),
        chain=_chain(_filled(table["chain"], "chain", source), source),
    )


def _check_keys(table: dict[str, Any], known: tuple[str, ...], where: str, source: str) -> None:
    for key in table:
        if key not in known:
            raise OptionError(f"palette key '{where}{key}' is unknown; expected {', '.join(known)}", source)


def _title(value: object, source: str) -> str:
    if not isinstance(value, str):
        raise OptionError(f"palette key 'title': {value!r} is not a text", source)
    return value


def _tint(value: object, source: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value <= LARGEST_TINT:
        raise OptionError(f"palette key 'tint': {value!r}; expected a number from 0 to {LARGEST_TINT:g}", source)
    return float(value)


def _color(value: object, key: str, source: str) -> Color:
    if not isinstance(value, str):
        raise OptionError(f"palette key '{key}': {value!r} is not a colour; expected a text like \"#9cc3d1\"", source)
    try:
        return parse_color(value)
    except ValueError as wrong:
        raise OptionError(f"palette key '{key}': {wrong}", source) from None


def _tones(value: object, key: str, source: str) -> Tones:
    if not isinstance(value, dict):
        raise OptionError(f"palette key '{key}': {value!r}; expected a table of {', '.join(TONES)}", source)
    _check_keys(value, TONES, f"{key}.", source)
    missing = [name for name in TONES if name not in value]
    if missing:
        raise OptionError(f"palette key '{key}.{missing[0]}' is missing; expected {', '.join(TONES)}", source)
    return Tones(*(_color(value[name], f"{key}.{name}", source) for name in TONES))


def _filled(value: object, key: str, source: str) -> list[Any]:
    if not isinstance(value, list) or not value:
        raise OptionError(f"palette key '{key}': {value!r}; expected a list with something in it", source)
    return value


def _chain(values: list[Any], source: str) -> tuple[Color, ...]:
    colors = tuple(_color(value, f"chain[{number}]", source) for number, value in enumerate(values, start=1))
    for number, color in enumerate(colors, start=1):
        earlier = colors.index(color) + 1
        if earlier < number:
            raise OptionError(f"palette key 'chain[{number}]' is the same colour as chain[{earlier}]", source)
    return colors
