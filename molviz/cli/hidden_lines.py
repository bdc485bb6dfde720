"""``molviz hidden-lines``: exact visible arcs, and nothing but lines."""

import json
import time
from pathlib import PurePath
from typing import Any

import click

from molviz.cli.options import POSITIVE, applied
from molviz.cli.progress import Progress
from molviz.picture.disc_picture import DiscLook
from molviz.pipeline.hidden_discs import HiddenDiscs, drawn, lettered_discs, random_discs, statistics_table
from molviz.pipeline.outputs import save

STAGES = 2  # hidden lines, writing
LARGEST_GRID = 16384  # cells a side: more would not fit into memory

scene_options = applied(
    click.option("--random", "count", type=click.IntRange(1), metavar="N", help="Franklin's N random spheres."),
    click.option("--text", metavar="WORD", help="A scene of layers of spheres that spell a word (his: CSE)."),
    click.option("--depth", type=POSITIVE, metavar="D", help="Average number of discs over a point (default 10)."),
    click.option("--radius", type=POSITIVE, metavar="R", help="Radius of the foremost sphere in a square of side 1."),
    click.option("--seed", type=click.IntRange(0), metavar="S", help="Seed (default: Franklin's own generator)."),
    click.option("--shrink", is_flag=True, help="Smaller spheres farther back: his perspective."),
    click.option("--grid", type=click.IntRange(1, LARGEST_GRID), metavar="G", help="Cells a side (default: his)."),
)
plotter_options = applied(
    click.option("--plotter", default="", metavar="MODEL", help="Plotter for .hpgl (default hp7475a)."),
    click.option("--paper", default="", metavar="SIZE", help="Paper in the plotter (default a4)."),
)


@click.command("hidden-lines")
@scene_options
@plotter_options
@click.option("--fill", is_flag=True, help="Paint the visible region of every disc too.")
@click.option("--outline", type=click.FloatRange(0.0), default=0.5, show_default=True, help="Line width in points.")
@click.option("--json", "as_json", is_flag=True, help="Print the statistics as one JSON object.")
@click.option("--quiet", is_flag=True, help="No summary line.")
@click.option("--to", metavar="FORMAT", help="Format (svg, ps, …) where the output is -.")
@click.option("-o", "--output", metavar="FILE", help="Its suffix is the format: .ps .eps .svg .pdf .hpgl .json.")
def hidden_lines_command(**options: Any) -> None:
    """Remove the hidden lines of spheres, exactly.

    \b
    Examples:
      molviz hidden-lines --random 10000             the statistics of Franklin's Fig. 8
      molviz hidden-lines --random 1000 -o gas.svg   the drawing
      molviz hidden-lines --text CSE -o cse.hpgl     the same for a pen plotter
    """
    if (options["count"] is None) == (options["text"] is None):
        raise click.UsageError("nothing to draw, or two things; expected one of --random and --text")
    began, progress = time.monotonic(), Progress(STAGES)
    progress("hidden lines")
    scene = _scene(options)
    if options["output"]:
        progress("writing")
        suffix = f".{options['to']}" if options["to"] else PurePath(options["output"]).suffix.lower()
        look = DiscLook(outline=options["outline"])
        data = drawn(scene, suffix, look, options["fill"], options["plotter"], options["paper"])
        progress.close()
        save(options["output"], data)
        if not options["quiet"]:
            click.echo(_summary(options["output"], scene, len(data), time.monotonic() - began), err=True)
    if options["as_json"]:
        click.echo(json.dumps(scene.statistics()))
    elif not options["output"]:
        click.echo(statistics_table(scene.statistics()))


def _scene(options: dict[str, Any]) -> HiddenDiscs:
    """The scene that the options ask for, without its hidden lines."""
    shrink, across = options["shrink"], options["grid"]
    if options["text"] is not None:
        return lettered_discs(options["text"], shrink=shrink, across=across)
    depth, radius, seed = options["depth"], options["radius"], options["seed"]
    return random_discs(options["count"], depth=depth, radius=radius, seed=seed, shrink=shrink, across=across)


def _summary(target: str, scene: HiddenDiscs, size: int, seconds: float) -> str:
    return (
        f"{target}: {len(scene.spheres.radius)} spheres, {scene.visible()} with visible lines, "
        f"{len(scene.arcs.circle)} arcs, {size} bytes, {seconds:.2f} s"
    )
