"""Options become values: the words of the command line, and what Python callers write in their place.

Every parser takes the text (``"8cm"``, ``"x,30"``, ``"#fff"``) as well as the value it stands for, and raises
ValueError for anything else; ``…_from`` take all options by name and raise OptionError naming the one that is wrong.
"""

import math
import re
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from molviz.errors import OptionError
from molviz.model.bonds import SOURCES
from molviz.model.radii import OWN, load_table
from molviz.model.selection import check_selection
from molviz.picture.coloring import CONTINUOUS, DISCRETE
from molviz.picture.colors import parse_color
from molviz.picture.furniture import ROUND
from molviz.picture.page import PAPER, Page, parse_length
from molviz.picture.picture import Color
from molviz.pipeline.inputs import LONGEST, SHORTEST, WATER_RADIUS, InputOptions
from molviz.pipeline.views import Quaternion, ViewOptions

Options = Mapping[str, Any]
T = TypeVar("T")

SMALLEST, LARGEST = 1e-6, 1e9  # of any number given as an option: what lies outside has no picture in doubles
MOST = 3600  # pictures of a turntable: a tenth of a degree each
MODELS = re.compile(r"[0-9]{1,18}(-[0-9]{1,18})?")  # more digits count more models than any file has
CHOICES = {
    "method": ("visible", "painter"),
    "fill": ("flat", "none"),
    "orient": ("principal", "file"),
    "page": ("fit", *PAPER),
    "color_by": ("auto", *DISCRETE, *CONTINUOUS),
    "parts": ("atoms", "merged"),
    "stereo": ("wall", "cross"),
    "bonds": SOURCES,
    "surface": ("vdw", "accessible"),
}


# ---- from a text or a value


def parse_positive(value: Any) -> float:
    """Return a number above 0."""
    return _number(value, SMALLEST)


def parse_distance(value: Any) -> float:
    """Return a length in ångström of a scene, which may be of any size that doubles hold."""
    return _number(value, SHORTEST, LONGEST)


def parse_not_negative(value: Any) -> float:
    """Return a number, 0 or more."""
    return _number(value, 0.0)


def parse_number(value: Any) -> float:
    """Return a number, of either sign."""
    return _number(value, -LARGEST)


def _number(value: Any, least: float, most: float = LARGEST) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise ValueError(f"{value!r} is not a number") from None
    if isinstance(value, bool) or not least <= number <= most:
        raise ValueError(f"{value!r} is not a number from {least:g} to {most:g}")
    return number


def parse_count(value: Any) -> int:
    """Return a whole number from 1 to ``MOST``."""
    number = _number(value, 1.0)
    if number != int(number) or number > MOST:
        raise ValueError(f"{value!r} is not a whole number from 1 to {MOST}")
    return int(number)


def parse_width(value: Any) -> float:
    """Return a length in points; numbers are points."""
    return parse_length(str(value))


def parse_margin(value: Any) -> float:
    """Return a length in points, which may be 0."""
    return 0.0 if str(value) in ("0", "0.0") else parse_width(value)


def parse_rotation(value: Any) -> tuple[str, float]:
    """Return axis and degrees of ``"x,30"`` or ``("x", 30)``."""
    axis, degrees = value.partition(",")[::2] if isinstance(value, str) else _pair(value)
    if str(axis).strip().lower() not in ("x", "y", "z") or degrees == "":
        raise ValueError(f"{value!r} is not a rotation; expected an axis and degrees, for example x,30")
    try:
        turn = float(degrees)
    except (TypeError, ValueError):
        turn = LARGEST
    if not abs(turn) < LARGEST:
        raise ValueError(f"{degrees!r} are no degrees; expected a number of at most {LARGEST:g}")
    return str(axis).strip().lower(), turn


def _pair(value: Any) -> tuple[Any, Any]:
    if not isinstance(value, tuple | list) or len(value) != 2:
        raise ValueError(f"{value!r} is not a rotation; expected ('x', 30) or 'x,30'")
    return value[0], value[1]


def parse_rotations(value: Any) -> tuple[tuple[str, float], ...]:
    """Return one rotation or several, in the order in which they are made."""
    several = isinstance(value, tuple | list) and not (len(value) == 2 and value[0] in ("x", "y", "z"))
    return tuple(map(parse_rotation, value if several else [value]))


def parse_orientation(value: Any) -> Quaternion:
    """Return the quaternion ``"w,x,y,z"`` or ``(w, x, y, z)``, of any length but 0, number by number as it is."""
    try:
        w, x, y, z = (float(part) for part in (value.split(",") if isinstance(value, str) else value))
    except (TypeError, ValueError):
        raise ValueError(f"{value!r} is no orientation; expected four numbers w,x,y,z") from None
    if not SMALLEST <= math.hypot(w, x, y, z) <= LARGEST:
        raise ValueError(f"{value!r} is no orientation; expected numbers that are not all 0, for example 1,0,0,0")
    return w, x, y, z


def parse_background(value: Any) -> Color | None:
    """Return a colour, given as text or as (red, green, blue) from 0 to 255; None for ``none``."""
    if value is None or str(value).lower() == "none":
        return None
    if isinstance(value, str):
        return parse_color(value)
    channels = tuple(int(channel) for channel in value)
    if len(channels) != 3 or channels != tuple(value) or not all(0 <= channel <= 255 for channel in channels):
        raise ValueError(f"{value!r} is not a colour; expected three whole numbers from 0 to 255")
    return channels


def parse_painted(value: Any) -> tuple[str, Color]:
    """Return selection and colour of ``"resn HEM=crimson"`` (split at the last =) or ``("resn HEM", colour)``."""
    selection, sign, color = value.rpartition("=") if isinstance(value, str) else (*_couple(value)[:1], "=", value[1])
    if not sign or not str(selection).strip():
        raise ValueError(f"{value!r} is no colour of a selection; expected for example 'resn HEM=crimson'")
    parsed = parse_background(color)
    if parsed is None:
        raise ValueError(f"{color!r} is not a colour; expected #rgb, #rrggbb or a CSS name")
    return selection, parsed


def _couple(value: Any) -> tuple[Any, Any]:
    if not isinstance(value, tuple | list) or len(value) != 2:
        raise ValueError(f"{value!r} is no colour of a selection; expected ('resn HEM', 'crimson')")
    return value[0], value[1]


def parse_all_painted(value: Any) -> tuple[tuple[str, Color], ...]:
    """Return one pair of selection and colour or several, in the order in which they are painted."""
    one = isinstance(value, str) or (len(value) == 2 and isinstance(value[0], str) and "=" not in value[0])
    return tuple(map(parse_painted, [value] if one else value))


def parse_labels(value: Any) -> tuple[str, ...]:
    """Return one label ``SELECTION[=TEXT]`` or several."""
    return tuple(map(parse_text, [value] if isinstance(value, str) else value))


def parse_scale_bar(value: Any) -> float | None:
    """Return a length in ångström; a round one that suits the drawing for True or "auto", None for False."""
    if value is False or value is None:
        return None
    return ROUND if value is True or value in ("auto", ROUND) else parse_distance(value)


def parse_chains(value: Any) -> tuple[str, ...]:
    """Return the names of ``"A,B"`` or ``["A", "B"]``; none for None."""
    if not value:
        return ()
    return tuple(part.strip() for part in (value.split(",") if isinstance(value, str) else value))


def parse_text(value: Any) -> str:
    """Return a text as it is."""
    if not isinstance(value, str):
        raise ValueError(f"{value!r} is no text")
    return value


def parse_selection(value: Any) -> str:
    """Return an expression that the language of selections understands."""
    check_selection(parse_text(value))
    return str(value)


def parse_model(value: Any) -> str:
    """Return a number from 1, the first and the last of several (``"2-4"``) or ``"all"``, as text."""
    if value != "all" and not MODELS.fullmatch(str(value)):
        raise ValueError(f"no model or frame {value!r}; expected a number from 1, A-B or all")
    return str(value)


# ---- from all options by name


def input_options_from(options: Options) -> InputOptions:
    """Return which part of the input is wanted; raises OptionError for what is wrong whatever the input holds."""
    if options["radii"] != OWN:
        load_table(str(options["radii"]))
    probe, cavities = _probes_from(options)
    return InputOptions(
        model=given(options, "model", parse_model),
        assembly=given(options, "assembly", parse_text),
        select=given(options, "select", parse_selection),
        water=_water_from(options),
        hydrogens=not options["no_hydrogens"],
        chains=given(options, "chain", parse_chains) or (),
        radii=str(options["radii"]),
        scale_radii=given(options, "scale_radii", parse_positive),
        probe=probe,
        cavities=cavities,
        format=options.get("format_"),
        unpack_all=bool(options.get("unpack_all")),
    )


def _probes_from(options: Options) -> tuple[float, float | None]:
    """The probe of the balls that are drawn or measured, and that of the cavities whose lining is wanted, if it is."""
    probe: float = given(options, "probe", parse_not_negative)
    surface = chosen(options, "surface") if options.get("surface") is not None else None
    if surface == "vdw" and probe > 0:
        raise OptionError(f"surface: the van der Waals surface has no probe of {probe:g} Å; expected accessible")
    rolled = probe or WATER_RADIUS
    if surface == "accessible":
        probe = rolled
    if not options.get("cavities"):
        return probe, None
    return probe, 0.0 if surface == "vdw" else rolled


def _water_from(options: Options) -> bool | None:
    """Pictures leave water out unless told otherwise; of masks, and of numbers, nothing is left out unasked."""
    if options["no_water"]:
        return False
    return True if options.get("water", True) or options.get("color_by") == "index" else None


def page_from(options: Options) -> Page:
    """Return the page that is wanted."""
    return Page(
        size=chosen(options, "page"),
        width=given(options, "width", parse_width),
        scale=given(options, "scale", parse_positive),
        margin=given(options, "margin", parse_margin),
    )


def view_options_from(options: Options) -> ViewOptions:
    """Return where the user looks from."""
    return ViewOptions(
        orient=chosen(options, "orient"),
        rotations=given(options, "rotate", parse_rotations) or (),
        distance=given(options, "perspective", parse_distance),
        orientation=given(options, "view", parse_orientation),
    )


def chosen(options: Options, name: str) -> str:
    """Return an option that is one of ``CHOICES``."""
    value: str = options[name]
    if value not in CHOICES[name]:
        raise OptionError(f"{name}: {value!r}; expected one of {', '.join(CHOICES[name])}")
    return value


def given(options: Options, name: str, parse: Callable[[Any], T]) -> Any:
    """Return the parsed value of an option, None where it is None."""
    if options[name] is None:
        return None
    try:
        return parse(options[name])
    except OptionError:
        raise
    except ValueError as wrong:
        raise OptionError(f"{name}: {wrong}") from None
    except (AttributeError, TypeError, OverflowError):
        raise OptionError(f"{name}: {options[name]!r} is of no use here; see help(molviz.draw)") from None
