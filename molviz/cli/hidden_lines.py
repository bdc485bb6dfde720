"""``molviz hidden-lines``: exact visible arcs, and nothing but lines unless asked for."""

import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import click

from molviz.cli.batch import for_each, shared_by
from molviz.cli.draw import (
    drawing_options,
    output_options,
    plotter_options,
    refuse_shared_targets,
    run_drawings,
    suffix_of,
)
from molviz.cli.options import POSITIVE, applied, cluster_option, input_options, load_and_warn
from molviz.cli.progress import Progress
from molviz.cli.telling import say, tell_json
from molviz.picture.disc_picture import WIDTH, DiscLook
from molviz.pipeline.hidden_discs import (
    Each,
    HiddenDiscs,
    drawn,
    lettered_discs,
    molecule_discs,
    random_discs,
    statistics_table,
)
from molviz.pipeline.inputs import InputOptions, only_model
from molviz.pipeline.outputs import makes_folder, save, target_of
from molviz.pipeline.values import input_options_from, page_from, view_options_from
from molviz.pipeline.views import ViewOptions

STAGES = 2  # hidden lines, writing
LARGEST_GRID = 16384  # cells a side: more would not fit into memory
KINDS = ("fused", "discs")  # fused spheres, or opaque discs ordered by their centres alone
USUAL_LINE = 0.5  # points

scene_options = applied(
    click.option("--random", "count", type=click.IntRange(1), metavar="N", help="Franklin's N random spheres."),
    click.option("--text", metavar="WORD", help="A scene of layers of spheres that spell a word (his: CSE)."),
    click.option("--depth", type=POSITIVE, metavar="D", help="Average number of discs over a point (default 10)."),
    click.option("--radius", type=POSITIVE, metavar="R", help="Radius of the foremost sphere in a square of side 1."),
    click.option("--seed", type=click.IntRange(0), metavar="S", help="Seed (default: Franklin's own generator)."),
    click.option("--shrink", is_flag=True, help="Smaller spheres farther back: his perspective."),
    click.option("--grid", type=click.IntRange(1, LARGEST_GRID), metavar="G", help="Cells a side (default: his)."),
)
@click.command("hidden-lines")
@click.argument("inputs", nargs=-1, metavar="[INPUT]...")
@scene_options
@output_options
@click.option("--fill", is_flag=False, flag_value="flat", default="none", help="Paint the visible regions too.")
@click.option("--json", "as_json", is_flag=True, help="Print the statistics as one JSON object.")
@drawing_options
@click.option(
    "--as", "kind", type=click.Choice(KINDS), default="fused", show_default=True, help="A molecule's atoms as these."
)
@plotter_options
@cluster_option
@input_options
def hidden_lines_command(inputs: tuple[str, ...], **options: Any) -> None:
    """Remove the hidden lines of spheres and sticks, exactly. Formats: .ps .eps .svg .svgz .pdf .hpgl .json.

    \b
    Examples:
      molviz hidden-lines caffeine.xyz -o caffeine.svg       a molecule as fused spheres
      molviz hidden-lines caffeine.xyz --rep sticks -o s.pdf its bonds as sticks
      molviz hidden-lines 1a8o.pdb --as discs -o it.ps       its atoms as discs
      molviz hidden-lines --random 10000                     the statistics of Franklin's Fig. 8
      molviz hidden-lines --random 1000 -o gas.svg           the drawing
      molviz hidden-lines --text CSE -o cse.hpgl             his lettered scene, for a pen plotter
    """
    if options["fill"] not in ("flat", "none"):
        raise click.UsageError(f"no fill {options['fill']!r}; expected flat or none")
    if sum([bool(inputs), options["count"] is not None, options["text"] is not None]) != 1:
        raise click.UsageError("nothing to draw, or two things; expected INPUT, --random or --text")
    if not inputs or options["kind"] == "discs":
        _refuse_solid(options)
    if options["style"] == "auto":
        options["style"] = "flat"
    if not inputs:
        with shared_by(options["dask"]) as each:
            _discs(options["output"], partial(_scene, options, each), options)
    elif options["kind"] == "discs":
        with shared_by(options["dask"]) as each:
            _molecules_as_discs(inputs, options, each)
    elif options["as_json"]:
        raise click.UsageError("--json tells the statistics of discs; expected --as discs, --random or --text")
    else:
        run_drawings(inputs, {"jobs": 1} | options)


def _refuse_solid(options: dict[str, Any]) -> None:
    """Raise UsageError for options that discs, which lie flat, have no meaning for."""
    for name in ("turntable", "stereo", "rep"):
        if options[name]:
            raise click.UsageError(f"discs lie flat; expected --{name} with fused spheres only")


def _molecules_as_discs(inputs: tuple[str, ...], options: dict[str, Any], each: Each) -> None:
    wanted, eye, output = input_options_from(options), view_options_from(options), options["output"]
    suffix = suffix_of(output, options["to"]) if output else ""
    if output:
        refuse_shared_targets(inputs, output, suffix, options)

    def one(source: str) -> None:
        target = target_of(source, output, suffix) if output else None
        _discs(target, partial(_molecule, source, wanted, eye, options, each), options)

    for_each(inputs, one, lambda _: None, quiet=options["quiet"])


def _discs(target: str | None, scene_of: Callable[[], HiddenDiscs], options: dict[str, Any]) -> None:
    """Hide the lines of a scene of discs; draw it, and tell its statistics where asked for or nothing is drawn."""
    began, progress = time.monotonic(), Progress(STAGES)
    progress("hidden lines")
    scene = scene_of()
    if target:
        progress("writing")
        look = _look(options)
        suffix = suffix_of(target, options["to"])
        pieces = drawn(scene, suffix, look, options["fill"] == "flat", options["plotter"], options["paper"])
        size = save(target, pieces, makes_folder(options["output"]))
        progress.close()
        if not options["quiet"]:
            say(_summary(target, scene, size, time.monotonic() - began))
    if options["as_json"]:
        tell_json(scene.statistics())
    elif not target:
        click.echo(statistics_table(scene.statistics()))


def _look(options: dict[str, Any]) -> DiscLook:
    """How discs are drawn: one kind of line, black."""
    page = page_from(options)
    if page.size == "fit" and page.width is None and page.scale is None:
        page = replace(page, width=WIDTH)
    outline = USUAL_LINE if options["outline"] is None else options["outline"]
    return DiscLook(page, outline, background=options["background"])


def _scene(options: dict[str, Any], each: Each) -> HiddenDiscs:
    """The scene that the options ask for, without its hidden lines."""
    shrink, across = options["shrink"], options["grid"]
    if options["text"] is not None:
        return lettered_discs(options["text"], shrink=shrink, across=across)
    depth, radius, seed = options["depth"], options["radius"], options["seed"]
    return random_discs(
        options["count"], depth=depth, radius=radius, seed=seed, shrink=shrink, across=across, each=each
    )


def _molecule(
    source: str, wanted: InputOptions, eye: ViewOptions, options: dict[str, Any], each: Each
) -> HiddenDiscs:
    loaded = load_and_warn(source, wanted, options["quiet"], options["strict"])
    return molecule_discs(only_model(loaded), eye, options["grid"], each)


def _summary(target: str, scene: HiddenDiscs, size: int, seconds: float) -> str:
    return (
        f"{target}: {len(scene.spheres.radius)} spheres, {scene.visible()} with visible lines, "
        f"{len(scene.arcs.circle)} arcs, {size} bytes, {seconds:.2f} s"
    )
