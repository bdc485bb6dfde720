"""``molviz draw``: pictures of molecules."""

import time
from pathlib import Path, PurePath
from typing import Any

import click

from molviz.cli.batch import for_each
from molviz.cli.options import (
    applied,
    eye_options,
    input_options,
    input_options_from,
    load_and_warn,
    only_model,
    page_options,
)
from molviz.cli.progress import Progress
from molviz.picture.coloring import CONTINUOUS, SCHEMES
from molviz.picture.compose import DrawOptions
from molviz.picture.page import Page
from molviz.picture.style import STYLES, load_style
from molviz.pipeline.draw import Drawing, OutputFormat, ViewOptions, draw, suffixes
from molviz.pipeline.inputs import InputOptions
from molviz.pipeline.outputs import save, target_of

STAGES = 4  # reading, map, picture, writing

output_options = applied(
    click.option("-o", "--output", metavar="FILE", help="Its suffix is the format; many: a folder or {stem}."),
    click.option("--to", metavar="FORMAT", help="Format (svg, ps, …) where the output is - or a folder."),
)
drawing_options = applied(
    click.option("--method", type=click.Choice(["visible", "painter"]), default="visible", show_default=True),
    click.option("--check", is_flag=True, help="Verify the invariants of the visibility map first."),
    click.option("--style", default="flat", show_default=True, metavar="NAME|FILE.toml", help=f"One of {STYLES}."),
    click.option("--color-by", type=click.Choice([*SCHEMES, *CONTINUOUS]), default="element", show_default=True),
    click.option("--legend", is_flag=True, help="A legend for colours by bfactor or exposure."),
    eye_options,
    page_options,
)
plotter_options = applied(
    click.option("--plotter", default="", metavar="MODEL", help="Plotter for .hpgl (default hp7475a)."),
    click.option("--paper", default="", metavar="SIZE", help="Paper in the plotter (default a4)."),
)


@click.command("draw")
@click.argument("inputs", nargs=-1, required=True, metavar="INPUT...")
@output_options
@drawing_options
@click.option("--fill", type=click.Choice(["flat", "none"]), default="flat", show_default=True)
@plotter_options
@input_options
def draw_command(inputs: tuple[str, ...], **options: Any) -> None:
    """Draw molecules as exact vector pictures.

    \b
    Examples:
      molviz draw caffeine.xyz -o caffeine.svg
      molviz draw 4hhb.pdb --color-by chain --no-water -o 4hhb.ps
      molviz draw *.cif -o 'pictures/{stem}.pdf'
    """
    run_drawings(inputs, options)


def run_drawings(inputs: tuple[str, ...], options: dict[str, Any]) -> None:
    """Draw every input with the options of ``draw``."""
    wanted, look, eye = input_options_from(options), draw_options_from(options), view_options_from(options)
    form = OutputFormat(suffix_of(options["output"], options["to"]), options["plotter"], options["paper"])
    output = options["output"] or "-"
    refuse_shared_targets(inputs, output, form.suffix)

    def one(source: str) -> None:
        _draw_one(source, target_of(source, output, form.suffix), form, wanted, look, eye, options)

    for_each(inputs, one)


def refuse_shared_targets(inputs: tuple[str, ...], output: str, suffix: str) -> None:
    """Raise UsageError where one input's drawing would overwrite another's."""
    if len({target_of(source, output, suffix) for source in inputs}) < len(inputs):
        raise click.UsageError("several inputs need several outputs: -o FOLDER/ or -o 'FOLDER/{stem}.svg'")


def _draw_one(
    source: str,
    target: str,
    form: OutputFormat,
    wanted: InputOptions,
    look: DrawOptions,
    eye: ViewOptions,
    options: dict[str, Any],
) -> None:
    began, progress = time.monotonic(), Progress(STAGES)
    progress("reading")
    loaded = load_and_warn(source, wanted, options["quiet"], options["strict"])
    one = only_model(loaded)
    try:
        drawing = draw(one, form, look, eye, options["method"], options["check"], progress)
    finally:
        progress.close()
    save(target, drawing.data)
    if not options["quiet"]:
        click.echo(_summary(source, target, drawing, time.monotonic() - began), err=True)


def _summary(source: str, target: str, drawing: Drawing, seconds: float) -> str:
    return (
        f"{source} -> {target}: {drawing.atoms} atoms read, {drawing.visible} visible, {drawing.arcs} arcs, "
        f"{len(drawing.data)} bytes, {seconds:.2f} s"
    )


def suffix_of(output: str | None, to: str | None) -> str:
    """Return the format asked for: by --to, else by the output's suffix; SVG into a folder."""
    known = suffixes()
    folder = bool(output) and (str(output).endswith("/") or Path(str(output)).is_dir())
    usual = ".svg" if folder else PurePath(output or "").suffix
    suffix = f".{to.removeprefix('.')}" if to else usual
    if suffix.lower() in known:
        return suffix.lower()
    names = " ".join(known)
    if not output and not to:
        raise click.UsageError(f"nowhere to draw to; expected -o FILE with one of the suffixes {names}")
    raise click.UsageError(f"no format {suffix!r}; expected one of {names} (with --to where standard output has none)")


def draw_options_from(options: dict[str, Any]) -> DrawOptions:
    """Take the look out of a command's keyword arguments."""
    if options["legend"] and options["color_by"] not in CONTINUOUS:
        raise click.UsageError(f"--legend explains numbers; expected --color-by {' or '.join(CONTINUOUS)}")
    return DrawOptions(
        style=load_style(options["style"]),
        color_by=options["color_by"],
        fill=options["fill"],
        outline=options["outline"],
        crease=options["crease"],
        background=options["background"],
        page=page_from(options),
        legend=options["legend"],
    )


def page_from(options: dict[str, Any]) -> Page:
    """Take the page out of a command's keyword arguments."""
    return Page(options["page"], options["width"], options["scale"], options["margin"])


def view_options_from(options: dict[str, Any]) -> ViewOptions:
    """Take the view out of a command's keyword arguments."""
    return ViewOptions(options["orient"], options["rotate"], options["perspective"])
