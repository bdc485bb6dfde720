"""What there is to choose from: styles, palettes and tables of radii, each with a line on what it is."""

from typing import Any

from molviz.errors import OptionError, expected_instead
from molviz.model import radii
from molviz.picture import palette, style


def styles() -> list[dict[str, Any]]:
    """Return the name and the title of every style."""
    return [{"name": name, "title": style.load_style(name).title} for name in style.STYLES]


def palettes() -> list[dict[str, Any]]:
    """Return the name and the title of every palette, and which one is used unless another is asked for."""
    return [
        {"name": name, "title": palette.load_palette(name).title, "default": name == palette.DEFAULT}
        for name in palette.PALETTES
    ]


def radii_tables() -> list[dict[str, Any]]:
    """Return the name, title and source of every table of radii, and which one is used unless another is asked for.

    The last is no table but the radii that a file itself has.
    """
    tables = [
        {"name": name, "title": table.title, "source": table.source, "default": name == radii.DEFAULT}
        for name, table in ((name, radii.load_table(name)) for name in radii.TABLES)
    ]
    own = {"name": radii.OWN, "title": "the radii that the file itself has", "source": radii.OWN_SOURCE}
    return [*tables, own | {"default": False}]


def text_of(name: str) -> dict[str, str]:
    """Return the kind of a style or palette, its name and its TOML file as it stands.

    Raises OptionError, with the nearest name, where there is neither.
    """
    for kind, module, names in (("style", style, style.STYLES), ("palette", palette, palette.PALETTES)):
        if name in names:
            return {"kind": kind, "name": name, "toml": (module.FOLDER / f"{name}.toml").read_text(encoding="utf-8")}
    known = (*style.STYLES, *palette.PALETTES)
    expected = expected_instead(name, known, f"one of {', '.join(known)}")
    raise OptionError(f"no style or palette {name!r}; {expected}")
