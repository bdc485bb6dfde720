"""Many inputs to one command: each is done by itself, and one bad file does not stop the rest."""

import sys
from collections.abc import Callable, Sequence

import click

from molviz.cli import failures
from molviz.cli.telling import say
from molviz.errors import InputError

PASSED_ON = (click.exceptions.Exit, click.ClickException, click.Abort, OSError, MemoryError)


def for_each(sources: Sequence[str], do: Callable[[str], None]) -> None:
    """Do something for every input; failures are reported, and the exit status at the end is that of the worst."""
    status = 0
    for source in sources:
        try:
            do(source)
        except InputError as wrong:
            say(f"molviz: {wrong}")
            status = max(status, failures.status_of(wrong))
        except PASSED_ON:
            raise
        except Exception as failure:
            say(f"{failures.line_about(failure)} ({source})")
            status = failures.STATUS
    if status:
        sys.exit(status)
