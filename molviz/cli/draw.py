"""``molviz draw``: pictures of molecules."""

import os
import shlex
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import PurePath
from typing import Any, NamedTuple

import click
from click.core import ParameterSource

from molviz.cli.batch import for_each, shared_by, where_from
from molviz.cli.main import TYPED
from molviz.cli.options import (
    POSITIVE,
    Parsed,
    applied,
    batch_options,
    eye_options,
    input_options,
    load_and_warn,
    page_options,
    shared,
    warn,
)
from molviz.cli.progress import Progress
from molviz.cli.telling import say, tell_json
from molviz.model.representations import REPRESENTATIONS
from molviz.picture.palette import PALETTES
from molviz.picture.style import STYLES
from molviz.pipeline.draw import Drawing, DrawRequest, draw_request_from, suffixes
from molviz.pipeline.inputs import InputOptions
from molviz.pipeline.outputs import makes_folder, refuse_inputs, save, target_of
from molviz.pipeline.sets import ONE_EACH, DrawingSet, SetOptions, drawn, holds_set, set_options_from
from molviz.pipeline.state import with_state
from molviz.pipeline.values import input_options_from, parse_count, parse_scale_bar, view_options_from
from molviz.pipeline.views import ViewOptions
from molviz.viewer.terminal import UNABLE, show

# options that say where the result goes, and who makes it
PLACES = ("-o", "--output", "--to", "-j", "--jobs", "--dask", "--threads")
STAGES = 3  # reading, what is seen, writing

SCALE_BAR = Parsed("ångström", parse_scale_bar)
COUNT = Parsed("number", parse_count)

output_options = applied(
    click.option("-o", "--output", metavar="FILE", help="Its suffix is the format; many: a folder or {stem}."),
    click.option("--to", metavar="FORMAT", help="Format (svg, ps, …) where the output is - or a folder."),
)
look_options = applied(
    shared("method", show_default=True, help="The exact map, or pieces that cover each other."),
    shared("check", help="Verify the invariants of the visibility map first."),
    shared("rep", multiple=True, metavar="[SELECTION=]NAME", help=f"{', '.join(REPRESENTATIONS)}; repeatable."),
    shared("bonds", show_default=True, help="Bonds of the file and, where it has none, by distance."),
    shared("ball_scale", type=POSITIVE, show_default=True, metavar="X", help="Balls of ball-and-stick, in radii."),
    shared("stick_radius", type=POSITIVE, metavar="R", help="In Å (default: 0.15, of sticks alone 0.2)."),
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
    page_options,
)
set_options = applied(
    shared("turntable", type=COUNT, metavar="N", help="N views about the y axis: {n} in FILE, pages, animation."),
    shared("stereo", help="Two views beside each other, for eyes that look straight ahead or that cross."),
)
drawing_options = applied(look_options, set_options)
plotter_options = applied(
    click.option("--plotter", default="", metavar="MODEL", help="Plotter for .hpgl (default hp7475a)."),
    click.option("--paper", default="", metavar="SIZE", help="Paper in the plotter (default a4)."),
)


@click.command("draw")
@click.argument("inputs", nargs=-1, required=True, metavar="INPUT...")
@output_options
@drawing_options
@shared("fill", help="Regions filled or not (default: the style's).")
@shared("view_from", metavar="FILE", help="Options that the page of molviz view saved; those typed beside it win.")
@plotter_options
@click.option("--show", is_flag=True, help="A small preview in a terminal that can show pictures; needs no -o.")
@click.option("--json", "as_json", is_flag=True, help="The summary as one JSON object a line on standard output.")
@input_options
@batch_options
def draw_command(inputs: tuple[str, ...], **options: Any) -> None:
    """Draw molecules as exact vector pictures.

    \b
    Examples:
      molviz draw caffeine.xyz -o caffeine.svg
      molviz draw 4hhb.pdb --color 'resn HEM=crimson' --label 'resn HEM' -o 4hhb.ps
      molviz draw *.cif -o 'pictures/{stem}.pdf' -j 0
      molviz draw 1hpv.pdb --rep 'resn 478=sticks' -o pocket.svg
      molviz draw 4hhb.pdb --turntable 36 -o spin.svg
      molviz draw nmr.cif --model all -o 'frames/{n}.svg'
    """
    run_drawings(inputs, options)


def run_drawings(inputs: tuple[str, ...], options: dict[str, Any]) -> None:
    """Draw every input with the options of ``draw``."""
    options = with_state(options, stated())
    look, together = draw_request_from(options), set_options_from(options)
    wanted, eye = input_options_from(options), view_options_from(options)
    suffix, output = format_and_output(options)
    refuse_shared_targets(inputs, output, suffix, options)
    printed = "--json" if options.get("as_json") else "--show" if options.get("show") else ""
    if printed and output == "-":
        raise click.UsageError(f"{printed} and the picture cannot both go to standard output; expected -o FILE")
    if together.many and not holds_set(output, suffix):
        raise click.UsageError(f"{suffix} holds one picture; {ONE_EACH}")

    where = where_from(options)
    with shared_by(where.dask if len(inputs) == 1 else None) as each:  # the tiles of one large map
        task = DrawTask(
            wanted, replace(look, each=each), eye, together, output, suffix, options["plotter"], options["paper"],
            options["method"], options["check"], options["quiet"], options["strict"],
            {source: drawn_by(source) for source in inputs}, read_by(options), len(inputs) == 1,
            bool(options.get("show")),
        )  # fmt: skip
        tell = _tell_json if options.get("as_json") else _tell(options["quiet"])
        for_each(inputs, task, tell, where, options["quiet"])


def format_and_output(options: dict[str, Any]) -> tuple[str, str]:
    """Return the format and where it goes: a name, - for standard output, or "" where the picture is only shown."""
    if options.get("show") and not options["output"] and not options["to"]:
        return ".svg", ""
    return suffix_of(options["output"], options["to"]), options["output"] or "-"


def drawn_by(source: str) -> str:
    """Return the command that draws one input, as it may be typed again: without where and by whom it is done."""
    typed = click.get_current_context().meta.get(TYPED, [])
    kept: list[str] = []
    for before, word in zip(["", *typed], typed, strict=False):
        named = word.partition("=")[0]
        unnamed = before not in PLACES and named[:2] != "-j"
        if unnamed and named not in (*PLACES, "--quiet", "--strict", "--json", "--show"):
            kept.append(word)
    inputs = click.get_current_context().params.get("inputs", ())
    options = [word for word in kept[1:] if word not in inputs]
    return shlex.join(["molviz", *kept[:1], PurePath(source).name, *options])


def read_by(options: dict[str, Any]) -> tuple[str, ...]:
    """Return the names of all files that a command reads: its inputs, and what its options name."""
    inputs = click.get_current_context().params.get("inputs", ())
    named = (options.get(name) for name in ("style", "palette", "radii", "view_from"))
    return (*inputs, *(str(name) for name in named if name))


def stated() -> list[str]:
    """Return the names of the options that were typed."""
    context = click.get_current_context()
    return [name for name in context.params if context.get_parameter_source(name) is not ParameterSource.DEFAULT]


def refuse_shared_targets(inputs: tuple[str, ...], output: str, suffix: str, options: dict[str, Any]) -> None:
    """Raise UsageError where one input's drawing would overwrite another's, or OptionError where it would an input."""
    drawn_from: dict[str, str] = {}
    for source in inputs:
        target = target_of(source, output, suffix)
        refuse_inputs(target, read_by(options))
        if not target:
            continue
        if target in drawn_from and target != output:
            both = f"{drawn_from[target]} and {source}"
            raise click.UsageError(f"{both} would both be drawn to {target}; expected inputs of different names")
        if target in drawn_from:
            raise click.UsageError("several inputs need several outputs: -o FOLDER/ or -o 'FOLDER/{stem}.svg'")
        drawn_from[target] = source


@dataclass(frozen=True)
class DrawTask:
    """What is to be done for each input; other processes can do it."""

    wanted: InputOptions
    look: DrawRequest
    eye: ViewOptions
    together: SetOptions
    output: str
    suffix: str
    plotter: str
    paper: str
    method: str
    check: bool
    quiet: bool
    strict: bool
    described: dict[str, str]  # for each input, the command that draws it
    read: tuple[str, ...]  # names of all files that the command reads
    alone: bool  # the only input, whose stages are shown
    shown: bool  # in the terminal as well

    def __call__(self, source: str) -> "Drawn":
        """Draw one input and return what there is to tell of it."""
        began, progress = time.monotonic(), Progress(STAGES if self.alone else 0)
        progress("reading")
        models = load_and_warn(source, self.wanted, self.quiet, self.strict)
        try:
            progress("what is seen")
            look = replace(self.look, description=self.described[source])
            drawing = drawn(models, look, self.eye, self.together, self.method, self.check)
            warn(drawing.notes, self.quiet, self.strict)
            progress("writing")
            target = target_of(source, self.output, self.suffix) if self.output else ""
            size = self.saved(drawing, target) if target else 0
        finally:
            progress.close()
        if self.shown:
            warn(() if show(drawing.svg()) else [UNABLE], self.quiet, self.strict)
        pictures = len(drawing) if isinstance(drawing, DrawingSet) else None
        counts = (drawing.atoms_read, drawing.atoms_drawn, drawing.visible, drawing.arcs)
        return Drawn(source, target or "terminal", pictures, *counts, size, time.monotonic() - began)

    def saved(self, drawing: Drawing | DrawingSet, target: str) -> int:
        """Write all files of a drawing and return how many bytes they have."""
        size = 0
        for path, pieces in files_of(drawing, target, self.suffix, self.plotter, self.paper):
            refuse_inputs(path, self.read)
            size += save(path, pieces, makes_folder(self.output))
        return size


class Drawn(NamedTuple):
    """What there is to tell of one input that was drawn."""

    file: str
    output: str
    pictures: int | None  # of a set
    atoms: int
    drawn: int
    visible: int
    arcs: int
    bytes: int
    seconds: float


def files_of(
    drawing: Drawing | DrawingSet, target: str, suffix: str, plotter: str, paper: str
) -> Iterable[tuple[str, Iterable[bytes]]]:
    """Return the name and the pieces of each file that is to be written."""
    if isinstance(drawing, DrawingSet):
        return drawing.files(target, suffix, plotter, paper)
    return [(target, drawing.pieces(suffix, plotter, paper))]


def _tell(quiet: bool) -> Callable[[Drawn], None]:
    """Return what tells of a drawing in a line, or nothing."""

    def tell(one: Drawn) -> None:
        pictures = "" if one.pictures is None else f"{one.pictures} pictures, "
        counts = f"{one.atoms} atoms read, {one.drawn} drawn, {one.visible} visible, {one.arcs} arcs"
        if not quiet:
            say(f"{one.file} -> {one.output}: {pictures}{counts}, {one.bytes} bytes, {one.seconds:.2f} s")

    return tell


def _tell_json(one: Drawn) -> None:
    told = one._asdict() | {"seconds": round(one.seconds, 3)}
    tell_json({name: value for name, value in told.items() if name != "pictures"})


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
