"""``molviz hidden-lines``: exact visible arcs, and nothing but lines."""

import json
import time
from pathlib import Path

import click

from molviz.errors import InputError
from molviz.picture.disc_picture import DiscLook
from molviz.pipeline.hidden_discs import (
    HiddenDiscs,
    lettered_discs,
    picture_of,
    random_discs,
    statistics_table,
    to_bytes,
    to_json,
)  # fmt: skip
from molviz.pipeline.output import save

POSITIVE = click.FloatRange(0.0, min_open=True)


@click.command("hidden-lines")
@click.option("--random", "count", type=click.IntRange(1), metavar="N", help="Franklin's scene of N random spheres.")
@click.option("--text", metavar="WORD", help="A scene of layers of spheres that spell a word (his: CSE).")
@click.option("--depth", type=POSITIVE, metavar="D", help="Average number of discs over a point (default 10).")
@click.option("--radius", type=POSITIVE, metavar="R", help="Radius of the foremost sphere in a square of side 1.")
@click.option("--seed", type=click.IntRange(0), metavar="S", help="Seed (default: Franklin's own generator).")
@click.option("--shrink", is_flag=True, help="Smaller spheres farther back: his perspective.")
@click.option("--grid", type=click.IntRange(1, 16384), metavar="G", help="Cells a side (default: his formula).")
@click.option("--fill", is_flag=True, help="Paint the visible region of every disc too.")
@click.option("--outline", type=click.FloatRange(0.0), default=0.5, show_default=True, help="Line width in points.")
@click.option("--plotter", default="", metavar="MODEL", help="Plotter for .hpgl (default hp7475a).")
@click.option("--paper", default="", metavar="SIZE", help="Paper in the plotter (default a4).")
@click.option("--json", "as_json", is_flag=True, help="Print the statistics as one JSON object.")
@click.option("--quiet", is_flag=True, help="No summary line.")
@click.option("-o", "--output", type=click.Path(dir_okay=False, path_type=Path), help="File; its suffix is the format.")
def hidden_lines(
    count: int | None,
    text: str | None,
    depth: float | None,
    radius: float | None,
    seed: int | None,
    shrink: bool,
    grid: int | None,
    fill: bool,
    outline: float,
    plotter: str,
    paper: str,
    as_json: bool,
    quiet: bool,
    output: Path | None,
) -> None:
    """Remove the hidden lines of spheres, exactly. Formats: .ps .eps .svg .pdf .hpgl .json.

    \b
    molviz hidden-lines --random 10000             the statistics of Franklin's Fig. 8
    molviz hidden-lines --random 1000 -o gas.svg   the drawing
    molviz hidden-lines --text CSE -o cse.hpgl     the same for a pen plotter
    """
    if (count is None) == (text is None):
        raise click.UsageError("Give one of --random and --text.")
    begin = time.perf_counter()
    try:
        if text is not None:
            scene = lettered_discs(text, shrink=shrink, across=grid)
        else:
            scene = random_discs(count or 0, depth=depth, radius=radius, seed=seed, shrink=shrink, across=grid)
        if output is not None:
            data = _drawn(scene, output.suffix.lower(), DiscLook(outline=outline), fill, plotter, paper)
            save(data, output)
            if not quiet:
                click.echo(_summary(scene, len(data), time.perf_counter() - begin), err=True)
    except InputError as error:
        click.echo(f"molviz: {error}", err=True)
        raise SystemExit(1) from error
    if as_json:
        click.echo(json.dumps(scene.statistics()))
    elif output is None:
        click.echo(statistics_table(scene.statistics()))


def _drawn(scene: HiddenDiscs, suffix: str, look: DiscLook, fill: bool, plotter: str, paper: str) -> bytes:
    if suffix == ".json":
        return to_json(scene)
    return to_bytes(picture_of(scene, look, fill), suffix, plotter, paper)


def _summary(scene: HiddenDiscs, size: int, seconds: float) -> str:
    statistics = scene.statistics()
    visible = len(scene.spheres.radius) - int(str(statistics["hidden"]))
    return (
        f"{statistics['n']} spheres, {visible} with visible lines, {statistics['arcs']} arcs, "
        f"{size} bytes, {seconds:.2f} s"
    )
