"""``molviz draw``: pictures of molecules."""

import os
import shlex
import time
from collections.abc import Iterable
from dataclasses import replace
from pathlib import PurePath
from typing import Any

import click

from molviz.cli.batch import for_each
from molviz.cli.main import TYPED
from molviz.cli.options import Parsed, applied, eye_options, input_options, load_and_warn, page_options, shared, warn
from molviz.cli.progress import Progress
from molviz.cli.telling import say, tell_json
from molviz.picture.palette import PALETTES
from molviz.picture.style import STYLES
from molviz.pipeline.draw import Drawing, DrawRequest, draw_request_from, suffixes
from molviz.pipeline.inputs import InputOptions
from molviz.pipeline.outputs import makes_folder, refuse_inputs, save, target_of
from molviz.pipeline.sets import ONE_EACH, DrawingSet, SetOptions, drawn, holds_set, set_options_from
from molviz.pipeline.values import input_options_from, parse_count, parse_scale_bar, view_options_from
from molviz.pipeline.views import ViewOptions

PLACES = ("-o", "--output", "--to")  # options that say where a result goes
STAGES = 3  # reading, what is seen, writing

SCALE_BAR = Parsed("ångström", parse_scale_bar)
COUNT = Parsed("number", parse_count)

output_options = applied(
    click.option("-o", "--output", metavar="FILE", help="Its suffix is the format; many: a folder or {stem}."),
    click.option("--to", metavar="FORMAT", help="Format (svg, ps, …) where the output is - or a folder."),
)
drawing_options = applied(
    shared("method", show_default=True),
    shared("check", help="Verify the invariants of the visibility map first."),
    shared("style", show_default=True, metavar="NAME|FILE.toml", help=f"auto, {', '.join(STYLES)}, or a file."),
    shared("color_by", show_default=True, help="What colours mean; auto: entities of polymers, else elements."),
    shared("color", multiple=True, metavar="SELECTION=COLOR", help="Over any scheme; repeatable, the last one wins."),
    shared("palette", show_default=True, metavar="NAME|FILE.toml", help=f"{', '.join(PALETTES)}, or a file."),
    shared("parts", help="A region for each atom, or one for all of a colour and chain (default: the style's)."),
    shared(
        "label", multiple=True, metavar="SELECTION[=TEXT]",
        help="Write its name or TEXT, which may hold {resn} {resi} {name} {chain} {element}; repeatable.",
    ),
    shared("scale_bar", type=SCALE_BAR, is_flag=False, flag_value="auto", metavar="[ÅNGSTRÖM]", help="A scale bar."),
    shared("title", metavar="TEXT", help="Written above the drawing."),
    shared("legend", help="What the colours mean."),
    shared("surface", help="Balls as they are, or enlarged by --probe (1.4 Å unless given)."),
    shared("cavities", help="Only the balls that line a cavity (of --probe, 1.4 Å unless given; of vdw, 0)."),
    shared("water", help="Draw water, which is left out otherwise if there is anything else."),
    eye_options,
    shared("turntable", type=COUNT, metavar="N", help="N views about the y axis: {n} in FILE, pages, animation."),
    shared("stereo", help="Two views beside each other, for eyes that look straight ahead or that cross."),
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
@shared("fill", help="Regions filled or not (default: the style's).")
@plotter_options
@click.option("--json", "as_json", is_flag=True, help="The summary as one JSON object a line on standard output.")
@input_options
def draw_command(inputs: tuple[str, ...], **options: Any) -> None:
    """Draw molecules as exact vector pictures.

    \b
    Examples:
      molviz draw caffeine.xyz -o caffeine.svg
      molviz draw 4hhb.pdb --color 'resn HEM=crimson' --label 'resn HEM' -o 4hhb.ps
      molviz draw *.cif -o 'pictures/{stem}.pdf'
      molviz draw 4hhb.pdb --turntable 36 -o spin.svg
      molviz draw nmr.cif --model all -o 'frames/{n}.svg'
    """
    run_drawings(inputs, options)


def run_drawings(inputs: tuple[str, ...], options: dict[str, Any]) -> None:
    """Draw every input with the options of ``draw``."""
    look, together = draw_request_from(options), set_options_from(options)
    wanted, eye = input_options_from(options), view_options_from(options)
    suffix, output = suffix_of(options["output"], options["to"]), options["output"] or "-"
    refuse_shared_targets(inputs, output, suffix, options)
    if options.get("as_json") and output == "-":
        raise click.UsageError("--json and the picture cannot both go to standard output; expected -o FILE")
    if together.many and not holds_set(output, suffix):
        raise click.UsageError(f"{suffix} holds one picture; {ONE_EACH}")

    def one(source: str) -> None:
        _draw_one(source, target_of(source, output, suffix), suffix, wanted, look, eye, together, options)

    for_each(inputs, one)


def drawn_by(source: str) -> str:
    """Return the command that draws one input, as it may be typed again: without where the result goes."""
    typed = click.get_current_context().meta.get(TYPED, [])
    kept: list[str] = []
    for before, word in zip(["", *typed], typed, strict=False):
        named = word.partition("=")[0]
        if before not in PLACES and named not in (*PLACES, "--quiet", "--strict", "--json"):
            kept.append(word)
    inputs = click.get_current_context().params.get("inputs", ())
    options = [word for word in kept[1:] if word not in inputs]
    return shlex.join(["molviz", *kept[:1], PurePath(source).name, *options])


def read_by(options: dict[str, Any]) -> tuple[str, ...]:
    """Return the names of all files that a command reads: its inputs, and what its options name."""
    inputs = click.get_current_context().params.get("inputs", ())
    return (*inputs, *(options[name] for name in ("style", "palette", "radii") if name in options))


def refuse_shared_targets(inputs: tuple[str, ...], output: str, suffix: str, options: dict[str, Any]) -> None:
    """Raise UsageError where one input's drawing would overwrite another's, or OptionError where it would an input."""
    drawn_from: dict[str, str] = {}
    for source in inputs:
        target = target_of(source, output, suffix)
        refuse_inputs(target, read_by(options))
        if target in drawn_from and target != output:
            both = f"{drawn_from[target]} and {source}"
            raise click.UsageError(f"{both} would both be drawn to {target}; expected inputs of different names")
        if target in drawn_from:
            raise click.UsageError("several inputs need several outputs: -o FOLDER/ or -o 'FOLDER/{stem}.svg'")
        drawn_from[target] = source


def _draw_one(
    source: str,
    target: str,
    suffix: str,
    wanted: InputOptions,
    look: DrawRequest,
    eye: ViewOptions,
    together: SetOptions,
    options: dict[str, Any],
) -> None:
    began, progress = time.monotonic(), Progress(STAGES)
    progress("reading")
    models, size = load_and_warn(source, wanted, options["quiet"], options["strict"]), 0
    try:
        progress("what is seen")
        described = replace(look, description=drawn_by(source))
        drawing = drawn(models, described, eye, together, options["method"], options["check"])
        warn(drawing.notes, options["quiet"], options["strict"])
        progress("writing")
        for path, data in files_of(drawing, target, suffix, options["plotter"], options["paper"]):
            refuse_inputs(path, read_by(options))
            save(path, data, makes_folder(options["output"] or ""))
            size += len(data)
    finally:
        progress.close()
    seconds = time.monotonic() - began
    if options.get("as_json"):
        tell_json(_summary_as_data(source, target, drawing, size, seconds))
    elif not options["quiet"]:
        say(_summary(source, target, drawing, size, seconds))


def files_of(
    drawing: Drawing | DrawingSet, target: str, suffix: str, plotter: str, paper: str
) -> Iterable[tuple[str, bytes]]:
    """Return the name and the content of each file that is to be written."""
    if isinstance(drawing, DrawingSet):
        return drawing.files(target, suffix, plotter, paper)
    return [(target, drawing.to(suffix, plotter, paper))]


def _summary(source: str, target: str, drawing: Drawing | DrawingSet, size: int, seconds: float) -> str:
    pictures = f"{len(drawing)} pictures, " if isinstance(drawing, DrawingSet) else ""
    return (
        f"{source} -> {target}: {pictures}{drawing.atoms_read} atoms read, {drawing.atoms_drawn} drawn, "
        f"{drawing.visible} visible, {drawing.arcs} arcs, {size} bytes, {seconds:.2f} s"
    )


def _summary_as_data(
    source: str, target: str, drawing: Drawing | DrawingSet, size: int, seconds: float
) -> dict[str, Any]:
    return {
        "file": source, "output": target, "atoms": drawing.atoms_read, "drawn": drawing.atoms_drawn,
        "visible": drawing.visible, "arcs": drawing.arcs, "bytes": size, "seconds": round(seconds, 3),
    }  # fmt: skip


def suffix_of(output: str | None, to: str | None) -> str:
    """Return the format asked for: by --to, else by the output's suffix; SVG into a folder."""
    known = suffixes()
    folder = bool(output) and (str(output).endswith("/") or os.path.isdir(str(output)))  # noqa: PTH112 (Path.is_dir raises for names too long)
    usual = ".svg" if folder else PurePath(output or "").suffix
    suffix = f".{to.removeprefix('.')}" if to else usual
    if suffix.lower() in known:
        return suffix.lower()
    names = " ".join(known)
    if not output and not to:
        raise click.UsageError(f"nowhere to draw to; expected -o FILE with one of the suffixes {names}")
    raise click.UsageError(f"no format {suffix!r}; expected one of {names} (with --to where standard output has none)")
