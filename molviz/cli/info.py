"""``molviz info``: what was read."""

from dataclasses import dataclass
from typing import Any

import click

from molviz.cli.batch import for_each, where_from
from molviz.cli.options import batch_options, input_options, load_and_warn
from molviz.cli.telling import tell_json, visible
from molviz.pipeline.info import info
from molviz.pipeline.inputs import InputOptions
from molviz.pipeline.values import input_options_from


@click.command("info")
@click.argument("inputs", nargs=-1, required=True, metavar="INPUT...")
@click.option("--json", "as_json", is_flag=True, help="One JSON object on standard output.")
@input_options
@batch_options
def info_command(inputs: tuple[str, ...], as_json: bool, quiet: bool, **options: Any) -> None:
    """Tell what was read, and whether the hard sphere model holds.

    k is the ratio of the largest to the smallest radius, rho the least distance of two centres in units of the
    radius; with small k and large rho few spheres meet any one of them, and all of molviz runs in linear time.

    \b
    Example:
      molviz info 4hhb.pdb --json
    """
    wanted = input_options_from(options)
    results: list[dict[str, Any]] = []

    def tell(told: list[dict[str, Any]]) -> None:
        results.extend(told)
        if not as_json:
            click.echo("\n\n".join(map(_as_text, told)))

    try:
        for_each(inputs, InfoTask(wanted, quiet, options["strict"]), tell, where_from(options), quiet)
    finally:
        if as_json:
            tell_json({"results": results})


@dataclass(frozen=True)
class InfoTask:
    """What is to be done for each input; other processes can do it."""

    wanted: InputOptions
    quiet: bool
    strict: bool

    def __call__(self, source: str) -> list[dict[str, Any]]:
        """Return what there is to tell of the models of one input."""
        return [info(loaded) for loaded in load_and_warn(source, self.wanted, self.quiet, self.strict)]


def _as_text(result: dict[str, Any]) -> str:
    elements = ", ".join(f"{symbol} {count}" for symbol, count in result["elements"].items())
    rho = "one sphere only" if result["rho"] is None else f"{result['rho']:.3f}"
    rows = [
        (result["file"], f"{result['format']}, model {result['model']} of {result['models']}: {result['title']}"),
        ("atoms", f"{result['atoms']} ({elements})"),
        ("bonds", str(result["bonds"])),
        ("k", f"{result['k']:.3f}"),
        ("rho", rho),
        ("intersecting spheres", f"{result['max_neighbours']} at most, {result['mean_neighbours']:.2f} on average"),
        ("components", str(result["components"])),
    ]
    return "\n".join(f"{visible(name):<21} {visible(text)}" for name, text in rows)
