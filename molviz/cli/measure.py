"""``molviz measure``: options become values, measurements become a table, CSV or JSON."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import click

from molviz.cli.batch import for_each, where_from
from molviz.cli.options import batch_options, input_options, load_and_warn
from molviz.cli.telling import tell_csv, tell_json, visible
from molviz.model.radii import TABLES
from molviz.pipeline.inputs import InputOptions
from molviz.pipeline.measure import PER, Measurement, Part, measurement
from molviz.pipeline.values import input_options_from
from molviz.rounding import SUM_DIGITS, significant

Row = dict[str, Any]


@click.command("measure")
@click.argument("inputs", nargs=-1, required=True, metavar="INPUT...")
@click.option("--per", type=click.Choice(PER), help="Areas of all atoms, residues or chains as well.")
@click.option("--json", "as_json", is_flag=True, help="One JSON object on standard output.")
@click.option("--csv", "as_csv", is_flag=True, help="Comma-separated values, to the last digit.")
@input_options
@batch_options
def measure_command(
    inputs: tuple[str, ...], per: str | None, as_json: bool, as_csv: bool, quiet: bool, strict: bool, **options: Any
) -> None:
    """Tell the exact area (Å²) and volume (Å³) of the union of the balls.

    With --probe 1.4 the area is the solvent-accessible one. Of a selection, area and volume are what it has alone;
    exposed is what the rest of the model leaves free of its area, and buried the difference.

    \b
    Examples:
      molviz measure 4hhb.pdb --probe 1.4 --no-water --per residue
      molviz measure 4hhb.pdb --probe 1.4 --select 'chain A' --json
    """
    if as_json and as_csv:
        raise click.UsageError("--json and --csv exclude each other")
    wanted = input_options_from(options)
    measured: list[Measurement] = []
    try:
        for_each(inputs, MeasureTask(wanted, per, quiet, strict), measured.extend, where_from(options), quiet)
    finally:
        _tell(measured, wanted, per, as_json, as_csv)


@dataclass(frozen=True)
class MeasureTask:
    """What is to be done for each input; other processes can do it."""

    wanted: InputOptions
    per: str | None
    quiet: bool
    strict: bool

    def __call__(self, source: str) -> list[Measurement]:
        """Measure one input: its models, of which ``wanted.select`` may be a part that others bury."""
        models = load_and_warn(source, replace(self.wanted, select=None), self.quiet, self.strict)
        return [measurement(loaded, self.wanted.select, self.per) for loaded in models]


def _tell(measured: list[Measurement], wanted: InputOptions, per: str | None, as_json: bool, as_csv: bool) -> None:
    if as_json:
        results = [_totals(one, wanted) | {"per": [_part(part) for part in one.parts]} for one in measured]
        tell_json({"results": results})
    elif as_csv:
        tell_csv(_rows(measured, wanted, per))
    elif measured:
        click.echo("\n".join(_table(measured, wanted)))


def _totals(one: Measurement, wanted: InputOptions) -> Row:
    row = {"file": one.file, "model": one.model, "atoms": one.atoms, "radii": wanted.radii, "probe": wanted.probe}
    return row | {"area": one.area, "volume": one.volume} | _split(one.area, one.exposed)


def _part(part: Part) -> Row:
    return {"id": part.id, "area": part.area} | _split(part.area, part.exposed)


def _split(area: float, exposed: float | None) -> Row:
    return {} if exposed is None else {"exposed": exposed, "buried": significant(area - exposed, SUM_DIGITS)}


def _rows(measured: Iterable[Measurement], wanted: InputOptions, per: str | None) -> Iterator[Row]:
    """One row per model, or per atom, residue or chain of each."""
    for one in measured:
        if per is None:
            yield _totals(one, wanted)
        for part in one.parts:
            yield {"file": one.file, "model": one.model, "probe": wanted.probe} | _part(part)


def _table(measured: list[Measurement], wanted: InputOptions) -> Iterator[str]:
    title = f" ({TABLES[wanted.radii]})" if wanted.radii in TABLES else ""
    yield f"radii {visible(wanted.radii)}{title}, probe {wanted.probe:g} Å; areas in Å², volumes in Å³"
    width = max(len(visible(one.file)) for one in measured)
    for one in measured:
        yield (
            f"{visible(one.file):<{width}}  model {one.model}  {one.atoms} atoms  area {one.area:.3f}  "
            f"volume {one.volume:.3f}{_split_text(one.area, one.exposed)}"
        )
        longest = max((len(visible(part.id)) for part in one.parts), default=0)
        for part in one.parts:
            yield f"  {visible(part.id):<{longest}}  {part.area:12.3f}{_split_text(part.area, part.exposed)}"


def _split_text(area: float, exposed: float | None) -> str:
    return "".join(f"  {name} {value:.3f}" for name, value in _split(area, exposed).items())
