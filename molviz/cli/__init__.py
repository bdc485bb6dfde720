"""The command line: options become values, then one call each."""

import click

from molviz.cli.hidden_lines import hidden_lines


@click.group()
def main() -> None:
    """Exact vector drawings and exact numbers of molecules made of spheres."""


main.add_command(hidden_lines)
