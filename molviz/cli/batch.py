"""Many inputs to one command: each is done by itself, and one bad file does not stop the rest."""

import sys
from collections.abc import Callable, Sequence

import click

from molviz.errors import InputError


def for_each(sources: Sequence[str], do: Callable[[str], None]) -> None:
    """Do something for every input; failures are reported, and make the exit status 1 at the end."""
    failed = False
    for source in sources:
        try:
            do(source)
        except InputError as wrong:
            click.echo(f"molviz: {wrong}", err=True)
            failed = True
    if failed:
        sys.exit(1)
