"""What the page's panel offers: options of ``molviz draw``, with their choices from the front door's own tables."""

from typing import Any

from molviz.model.representations import REPRESENTATIONS
from molviz.picture.palette import PALETTES
from molviz.picture.style import STYLES
from molviz.pipeline.state import USUAL
from molviz.pipeline.values import CHOICES

GROUPS = {  # of the panel, and the options in each with what people read beside them
    "Look": {
        "style": "Style", "rep": "Representation", "bonds": "Bonds", "stick_radius": "Radius of sticks, Å",
        "ball_scale": "Scale of balls", "color_by": "Colour by", "palette": "Palette",
        "color": "Colours of selections", "parts": "Regions", "outline": "Outline",
        "crease": "Crease", "background": "Background",
    },
    "Atoms": {
        "select": "Selection", "chain": "Chains", "water": "Water", "no_hydrogens": "Leave out hydrogens",
        "model": "Model", "scale_radii": "Scale of radii", "surface": "Surface", "probe": "Probe, Å",
        "cavities": "Only what lines a cavity",
    },
    "Beside it": {"label": "Labels", "title": "Title", "scale_bar": "Scale bar", "legend": "Legend"},
    "View and page": {"perspective": "Eye's distance, Å", "width": "Width", "page": "Page"},
}  # fmt: skip
HINTS = {
    "rep": "resn HEM=sticks", "color": "resn HEM=crimson", "background": "none, white, #ffe",
    "select": "chain A or water", "chain": "A,B", "label": "resn HEM={resn} {resi}", "width": "8cm",
    "perspective": "none: parallel", "outline": "points", "crease": "points",
}  # fmt: skip
TURNED = ("view", "orient", "rotate")  # what the pointer does to the view, without a field
NAMES = (*(name for fields in GROUPS.values() for name in fields if name in USUAL), *TURNED)  # what a page may ask for
NUMBERS = ("outline", "crease", "perspective", "scale_radii", "probe", "stick_radius", "ball_scale")


def panel() -> list[dict[str, Any]]:
    """Return the groups of the panel with their fields: name, label, kind, choices and the usual value of each."""
    return [
        {"title": title, "fields": [_field(name, label) for name, label in fields.items() if name in USUAL]}
        for title, fields in GROUPS.items()
    ]


def _field(name: str, label: str) -> dict[str, Any]:
    usual = USUAL[name]
    usual = list(usual) if isinstance(usual, tuple) else usual
    return {
        "name": name, "label": label, "usual": usual, "kind": _kind(name), "choices": list(choices_of(name)),
        "hint": HINTS.get(name, ""),
    }  # fmt: skip


def choices_of(name: str) -> tuple[str, ...]:
    """Return the values that an option may have where they can be counted, else none."""
    tables = {"style": ("auto", *STYLES), "palette": PALETTES, "rep": REPRESENTATIONS, **CHOICES}
    return tuple(tables.get(name, ()))


def _kind(name: str) -> str:
    if USUAL[name] is False:
        return "flag"
    if name == "scale_bar":
        return "auto"
    if USUAL[name] == () and name != "chain":
        return "list"
    if choices_of(name):
        return "choice"
    return "number" if name in NUMBERS else "text"
