"""The command line: options become values, then one call each."""

import click


@click.group()
def main() -> None:
    """Exact vector drawings and exact numbers of molecules made of spheres."""
