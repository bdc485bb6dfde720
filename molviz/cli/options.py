"""Options that several commands share: click's words become values of the pipeline."""

import sys
from collections.abc import Callable, Iterable
from typing import Any, TypeAlias

import click

from molviz import threads
from molviz.cli.telling import say
from molviz.errors import InputError
from molviz.pipeline.inputs import FORMATS, InputOptions, Loaded, load
from molviz.pipeline.state import USUAL
from molviz.pipeline.values import (
    CHOICES,
    parse_background,
    parse_distance,
    parse_margin,
    parse_not_negative,
    parse_orientation,
    parse_positive,
    parse_rotation,
    parse_width,
)

Decorator: TypeAlias = Callable[[Callable[..., Any]], Any]


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


LENGTH = Parsed("length", parse_width)
MARGIN = Parsed("length", parse_margin)
ORIENTATION = Parsed("w,x,y,z", parse_orientation)
ROTATION = Parsed("axis,degrees", parse_rotation)
BACKGROUND = Parsed("color", parse_background)
DISTANCE = Parsed("number", parse_distance)
POSITIVE = Parsed("number", parse_positive)
NOT_NEGATIVE = Parsed("number", parse_not_negative)


def shared(name: str, **more: Any) -> Decorator:
    """Return a click option that ``molviz.draw`` has as a keyword argument, with the same default.

    It is a flag where that default is False, and a choice where there are ``CHOICES``.
    """
    flag = f"--{name.replace('_', '-')}"
    if USUAL[name] is False:
        return click.option(flag, is_flag=True, default=False, **more)
    if name in CHOICES:
        more["type"] = click.Choice(CHOICES[name])
    return click.option(flag, default=USUAL[name], **more)


def applied(*options: Decorator) -> Decorator:
    """Return a decorator that adds the options in the order given."""

    def decorate(command: Callable[..., Any]) -> Any:
        for option in reversed(options):
            command = option(command)
        return command

    return decorate


def _use_threads(ctx: click.Context, param: click.Parameter, number: int | None) -> None:
    if number is not None:
        threads.use(number)


def input_options_with(probe: Decorator) -> Decorator:
    """Return the options that say which part of an input is wanted; what a probe means is the command's."""
    return applied(
        click.option(
            "--model",
            "--frame",
            "model",
            type=str,
            default=USUAL["model"],
            show_default=True,
            help="Number; A-B or all.",
        ),
        shared("assembly", metavar="ID", help="Biological assembly, from the file's own operators."),
        shared("select", metavar="EXPR", help="Keep part of it: 'chain A and resi 10-20' (molviz help selections)."),
        shared("no_water", help="Leave out water."),
        shared("no_hydrogens", help="Leave out hydrogen and deuterium."),
        shared("chain", metavar="A,B", help="Keep these chains."),
        shared("radii", show_default=True, metavar="NAME|FILE", help="Table of radii."),
        shared("scale_radii", type=POSITIVE, metavar="X", help="Multiply all radii."),
        probe,
        click.option("--format", "format_", type=click.Choice(FORMATS), help="Input format, where - is read."),
        click.option("--unpack-all", is_flag=True, help="Archives too that hold far more than molecules do."),
        click.option(
            "--threads",
            type=click.IntRange(1),
            metavar="N",
            expose_value=False,
            callback=_use_threads,
            help="Threads that share the work (default: one for each processor).",
        ),
        click.option("--quiet", is_flag=True, help="No summary line and no warnings."),
        click.option("--strict", is_flag=True, help="Warnings become errors."),
    )


input_options = input_options_with(shared("probe", type=NOT_NEGATIVE, metavar="R", help="Add to all radii, in Å."))
cluster_option = click.option(
    "--dask", metavar="ADDRESS", help="Let a Dask cluster do the work (pip install 'molviz[dask]')."
)
batch_options = applied(
    click.option(
        "-j", "--jobs", type=click.IntRange(0), default=1, metavar="N", help="So many inputs at once; 0: all cores."
    ),
    cluster_option,
)
eye_options = applied(
    shared(
        "orient",
        show_default=True,
        help="Starting orientation: principal axes, widest side across, or as in the file.",
    ),
    shared("view", type=ORIENTATION, help="Instead: the quaternion that turns the file's axes into the page's."),
    shared("rotate", type=ROTATION, multiple=True, help="Then turn about an axis of the page; repeatable."),
    shared("perspective", type=DISTANCE, metavar="DISTANCE", help="Central projection; eye's distance in Å."),
)
page_options = applied(
    shared("width", type=LENGTH, help="Width of the drawing, e.g. 8cm."),
    shared("scale", type=POSITIVE, metavar="PT_PER_ANGSTROM", help="Points per ångström, instead."),
    shared("margin", type=MARGIN, help="Around the drawing, e.g. 5mm."),
    shared("page", show_default=True, help="Page size."),
    shared("background", type=BACKGROUND, show_default=True, help="Colour, or none."),
    shared("outline", type=NOT_NEGATIVE, metavar="W", help="Width of outlines, pt; 0 for none."),
    shared("crease", type=NOT_NEGATIVE, metavar="W", help="Width of creases, pt; 0 for none."),
)


def load_and_warn(source: str, wanted: InputOptions, quiet: bool, strict: bool) -> list[Loaded]:
    """Return the wanted models; warnings go to standard error, or are raised as InputError if strict."""
    data = _standard_input() if source == "-" else None
    loaded = load(source, wanted, data)
    warn([warning for one in loaded for warning in one.warnings], quiet, strict)
    return loaded


def warn(warnings: Iterable[str], quiet: bool, strict: bool) -> None:
    """Tell each warning once on standard error, or raise the first as InputError if strict."""
    for warning in dict.fromkeys(warnings):
        if strict:
            raise InputError(warning)
        if not quiet:
            say(f"molviz: warning: {warning}")


def _standard_input() -> bytes:
    if sys.stdin is None:  # closed by the caller
        raise InputError("standard input is closed; expected the content of a file", "-")
    return sys.stdin.buffer.read()
