"""``molviz radii``: the tables of radii and where they come from."""

import textwrap
from typing import Any

import click

from molviz.cli.telling import tell_json
from molviz.pipeline.catalogue import radii_tables

WIDTH = 100  # characters of a line
INDENT = 11  # of what stands beside a name


@click.command("radii")
@click.option("--json", "as_json", is_flag=True, help="One JSON object on standard output.")
def radii_command(as_json: bool) -> None:
    """List the tables of radii, with the publication that each is from.

    \b
    Examples:
      molviz radii
      molviz measure 4hhb.pdb --radii protor
    """
    tables = radii_tables()
    if as_json:
        tell_json({"radii": tables})
    else:
        click.echo("\n".join(map(_as_text, tables)))


def _as_text(table: dict[str, Any]) -> str:
    default = " (default)" if table["default"] else ""
    indent = " " * INDENT
    source = textwrap.fill(table["source"], WIDTH, initial_indent=indent, subsequent_indent=indent)
    return f"{table['name']:<{INDENT}}{table['title']}{default}\n{source}"
