"""``molviz clash``: options become values, overlapping pairs become a table, CSV or JSON."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import click

from molviz.cli.options import Parsed, input_options, load_and_warn
from molviz.cli.progress import Progress
from molviz.cli.telling import tell_csv, tell_json, visible
from molviz.errors import OptionError
from molviz.model.radii import TABLES
from molviz.pipeline.clash import Pair, clash
from molviz.pipeline.inputs import InputOptions, Loaded, means_several
from molviz.pipeline.outputs import stem_of
from molviz.pipeline.placements import parse_transform
from molviz.pipeline.values import input_options_from, parse_number, parse_selection

TRANSFORM = Parsed("matrix", parse_transform)
NUMBER = Parsed("number", parse_number)
SELECTION = Parsed("selection", parse_selection)


@click.command("clash")
@click.argument("a", metavar="A")
@click.argument("b", metavar="B")
@click.option(
    "--transform", type=TRANSFORM, metavar="MATRIX|FILE.toml",
    help="Move B: 12 or 16 numbers, row by row, turn and shift; or a file with matrix, or rotation and translation.",
)  # fmt: skip
@click.option(
    "--tolerance", type=NUMBER, default=0.0, show_default=True, metavar="Å",
    help="Overlap that is no clash; below 0, a gap that is one.",
)  # fmt: skip
@click.option("--select-b", type=SELECTION, metavar="EXPR", help="Keep this of B, whatever --select and --chain say.")
@click.option("--model-b", metavar="N", help="Model of B, where --model is that of A.")
@click.option("--json", "as_json", is_flag=True, help="One JSON object on standard output.")
@click.option("--csv", "as_csv", is_flag=True, help="Comma-separated values, to the last digit.")
@input_options
def clash_command(a: str, b: str, as_json: bool, as_csv: bool, quiet: bool, strict: bool, **options: Any) -> None:
    """Tell which atoms of A overlap which of B, and by how much (Å): the sum of the radii less the distance.

    All options on what is read hold for both. A pair that overlaps by more than --tolerance counts, deepest first.
    The exit status is 0 whether there are any or not.

    \b
    Examples:
      molviz clash receptor.pdb ligand.sdf --no-hydrogens --tolerance 0.4
      molviz clash 1hpv.pdb 1hpv.pdb --select protein --select-b 'resn 478' --json
      molviz clash 1hpv.pdb caffeine.xyz --transform '1 0 0 7.5  0 1 0 -2  0 0 1 21'
    """
    if as_json and as_csv:
        raise click.UsageError("--json and --csv exclude each other")
    if a == b == "-":
        raise click.UsageError("A and B cannot both be standard input")
    wanted, progress = input_options_from(options), Progress(3)
    try:
        loaded = []
        for source, asked in ((a, wanted), (b, _of_b(wanted, options))):
            progress(f"reading {stem_of(source)}")
            loaded.append(_load(source, _with_format(asked, source, (a, b)), quiet, strict))
        progress("comparing")
        pairs = clash(loaded[0], loaded[1], options["transform"], options["tolerance"])
    finally:
        progress.close()
    _tell(loaded, pairs, wanted, options, as_json, as_csv)


def _of_b(wanted: InputOptions, options: dict[str, Any]) -> InputOptions:
    if options["select_b"] is not None:
        wanted = replace(wanted, select=options["select_b"], chains=())
    return wanted if options["model_b"] is None else replace(wanted, model=options["model_b"])


def _with_format(wanted: InputOptions, source: str, both: tuple[str, str]) -> InputOptions:
    """--format is that of standard input, where it is one of the two."""
    return wanted if "-" not in both or source == "-" else replace(wanted, format=None)


def _load(source: str, wanted: InputOptions, quiet: bool, strict: bool) -> Loaded:
    if means_several(wanted.model):
        raise OptionError(f"no one model {wanted.model!r}; expected a number from 1", source)
    return load_and_warn(source, wanted, quiet, strict)[0]


def _tell(
    loaded: list[Loaded], pairs: tuple[Pair, ...], wanted: InputOptions, options: dict[str, Any],
    as_json: bool, as_csv: bool,
) -> None:  # fmt: skip
    if as_csv:
        tell_csv((pair._asdict() for pair in pairs), Pair._fields)
    elif as_json:
        told = {"files": [one.source for one in loaded], "models": [one.model for one in loaded]}
        said = {"radii": wanted.radii, "probe": wanted.probe, "tolerance": options["tolerance"]}
        deepest = pairs[0].overlap if pairs else None
        found = {"pairs": [pair._asdict() for pair in pairs], "count": len(pairs), "deepest": deepest}
        tell_json(told | said | found)
    else:
        click.echo("\n".join(_table(loaded, pairs, wanted, options)))


def _table(
    loaded: list[Loaded], pairs: tuple[Pair, ...], wanted: InputOptions, options: dict[str, Any]
) -> Iterator[str]:
    title = f" ({TABLES[wanted.radii]})" if wanted.radii in TABLES else ""
    yield f"radii {visible(wanted.radii)}{title}, probe {wanted.probe:g} Å; distances and overlaps in Å"
    width = max(len(visible(one.source)) for one in loaded)
    for name, one, moved in zip("AB", loaded, ("", ", moved" if options["transform"] else ""), strict=True):
        yield f"{name}  {visible(one.source):<{width}}  model {one.model}  {len(one.molecule)} atoms{moved}"
    deepest = f", the deepest by {pairs[0].overlap:.3f}" if pairs else ""
    yield f"{len(pairs)} pairs overlap by more than {options['tolerance']:g} Å{deepest}"
    longest = [
        max((len(visible(name)) for name in names), default=0) for names in zip(*map(_names, pairs), strict=True)
    ]
    for pair in pairs:
        names = "  ".join(f"{visible(name):<{size}}" for name, size in zip(_names(pair), longest, strict=True))
        yield f"  {names}  distance {pair.distance:8.3f}  overlap {pair.overlap:8.3f}"


def _names(pair: Pair) -> tuple[str, str]:
    return pair.a_id, pair.b_id
