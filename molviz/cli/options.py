"""Options that several commands share: click's words become values of the pipeline."""

import math
import sys
from collections.abc import Callable
from typing import Any, TypeAlias

import click

from molviz.errors import InputError
from molviz.model.radii import DEFAULT
from molviz.picture.colors import parse_color
from molviz.picture.page import PAPER, parse_length
from molviz.picture.picture import Color
from molviz.pipeline.inputs import FORMATS, InputOptions, Loaded, load

Decorator: TypeAlias = Callable[[Callable[..., Any]], Any]
SMALLEST, LARGEST = 1e-6, 1e9  # of any number given as an option: what lies outside has no picture in doubles


class Parsed(click.ParamType[Any]):
    """An option's type from a function that raises ValueError."""

    def __init__(self, name: str, parse: Callable[[str], Any]) -> None:
        self.name, self.parse = name, parse

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the value, or fail with click's usage error."""
        if not isinstance(value, str):
            return value
        try:
            return self.parse(value)
        except ValueError as wrong:
            self.fail(str(wrong), param, ctx)


class Number(click.FloatRange):
    """A finite number in a range; click alone lets ``nan`` pass, which is never out of range."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Return the number, or fail with click's usage error."""
        number: float = super().convert(value, param, ctx)
        if math.isnan(number):
            self.fail(f"{value!r} is not a number", param, ctx)
        return number


def parse_rotation(text: str) -> tuple[str, float]:
    """Return axis and degrees of ``x,30``."""
    axis, comma, degrees = text.partition(",")
    if axis.strip().lower() not in ("x", "y", "z") or not comma:
        raise ValueError(f"{text!r} is not a rotation; expected an axis and degrees, for example x,30")
    turn = float(degrees)
    if not abs(turn) < LARGEST:
        raise ValueError(f"{degrees!r} are no degrees; expected a number of at most {LARGEST:g}")
    return axis.strip().lower(), turn


def parse_background(text: str) -> Color | None:
    """Return a colour, or None for ``none``."""
    return None if text.lower() == "none" else parse_color(text)


LENGTH = Parsed("length", parse_length)
ROTATION = Parsed("axis,degrees", parse_rotation)
BACKGROUND = Parsed("color", parse_background)
POSITIVE = Number(min=SMALLEST, max=LARGEST)
NOT_NEGATIVE = Number(min=0, max=LARGEST)


def applied(*options: Decorator) -> Decorator:
    """Return a decorator that adds the options in the order given."""

    def decorate(command: Callable[..., Any]) -> Any:
        for option in reversed(options):
            command = option(command)
        return command

    return decorate


model_option = click.option("--model", "--frame", "model", default="1", show_default=True, help="Model or frame.")
part_options = applied(
    click.option("--assembly", metavar="ID", help="Biological assembly, from the file's own operators."),
    click.option("--select", metavar="EXPR", help="Keep part of it, e.g. 'chain A and not water'."),
    click.option("--no-water", is_flag=True, help="Leave out water."),
    click.option("--no-hydrogens", is_flag=True, help="Leave out hydrogen and deuterium."),
    click.option("--chain", metavar="A,B", help="Keep these chains."),
    click.option("--radii", default=DEFAULT, show_default=True, metavar="NAME|FILE", help="Table of radii."),
    click.option("--scale-radii", type=POSITIVE, default=1.0, metavar="X", help="Multiply all radii."),
    click.option("--probe", type=NOT_NEGATIVE, default=0.0, metavar="R", help="Add to all radii, in Å."),
    click.option("--format", "format_", type=click.Choice(FORMATS), help="Input format, where - is read."),
    click.option("--quiet", is_flag=True, help="No summary line and no warnings."),
    click.option("--strict", is_flag=True, help="Warnings become errors."),
)
input_options = applied(model_option, part_options)
eye_options = applied(
    click.option(
        "--orient",
        type=click.Choice(["principal", "file"]),
        default="principal",
        show_default=True,
        help="Starting orientation: principal axes, widest side across, or as in the file.",
    ),
    click.option("--rotate", type=ROTATION, multiple=True, help="Then turn about an axis of the page; repeatable."),
    click.option("--perspective", type=POSITIVE, metavar="DISTANCE", help="Central projection; eye's distance in Å."),
)
page_options = applied(
    click.option("--width", type=LENGTH, help="Width of the drawing, e.g. 8cm."),
    click.option("--scale", type=POSITIVE, metavar="PT_PER_ANGSTROM", help="Points per ångström, instead."),
    click.option("--margin", type=Parsed("length", lambda text: 0.0 if text == "0" else parse_length(text))),
    click.option("--page", type=click.Choice(["fit", *PAPER]), default="fit", show_default=True, help="Page size."),
    click.option("--background", type=BACKGROUND, default="none", show_default=True, help="Colour, or none."),
    click.option("--outline", type=NOT_NEGATIVE, metavar="W", help="Width of outlines, pt; 0 for none."),
    click.option("--crease", type=NOT_NEGATIVE, metavar="W", help="Width of creases, pt; 0 for none."),
)


def input_options_from(options: dict[str, Any]) -> InputOptions:
    """Take the input options out of a command's keyword arguments."""
    chain = options.pop("chain")
    return InputOptions(
        model=options.pop("model"),
        assembly=options.pop("assembly"),
        select=options.pop("select"),
        water=not options.pop("no_water"),
        hydrogens=not options.pop("no_hydrogens"),
        chains=tuple(part.strip() for part in chain.split(",")) if chain else (),
        radii=options.pop("radii"),
        scale_radii=options.pop("scale_radii"),
        probe=options.pop("probe"),
        format=options.pop("format_"),
    )


def load_and_warn(source: str, wanted: InputOptions, quiet: bool, strict: bool) -> list[Loaded]:
    """Return the wanted models; warnings go to standard error, or are raised as InputError if strict."""
    data = _standard_input() if source == "-" else None
    loaded = load(source, wanted, data)
    warnings = dict.fromkeys(warning for one in loaded for warning in one.warnings)
    for warning in warnings:
        if strict:
            raise InputError(warning)
        if not quiet:
            click.echo(f"molviz: {warning}", err=True)
    return loaded


def _standard_input() -> bytes:
    if sys.stdin is None:  # closed by the caller
        raise InputError("standard input is closed; expected the content of a file", "-")
    return sys.stdin.buffer.read()


def only_model(loaded: list[Loaded]) -> Loaded:
    """Return the one model that a picture shows; raises InputError where there are more."""
    if len(loaded) > 1:
        count = len(loaded)
        raise InputError(f"has {count} models, and a picture shows one; expected --model NUMBER", loaded[0].source)
    return loaded[0]
