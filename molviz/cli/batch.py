"""Many inputs to one command: each is done by itself, here or by other processes, and none stops the rest."""

import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple, TypeVar

import click

from molviz import threads
from molviz.cli import failures
from molviz.cli.progress import Progress
from molviz.cli.telling import collected, say, visible
from molviz.errors import InputError

PASSED_ON = (click.exceptions.Exit, click.ClickException, click.Abort, OSError)
STANDARD_INPUT = "-"
MANY = 3  # inputs: of fewer, all that was said is in view
LONGEST_REASON = 100  # letters of a reason in the table of failures; it was told in full before

T = TypeVar("T")
R = TypeVar("R")
Work = Callable[[str], Any]  # from the name of an input to a value; can be sent to other processes


class Outcome(NamedTuple):
    """What became of one input."""

    source: str
    value: Any  # None after a failure
    lines: tuple[str, ...]  # said meanwhile, the failure last
    status: int  # of a command that has this input alone


class Where(NamedTuple):
    """Who does the work: ``jobs`` processes here (0: one for each core), or a Dask cluster."""

    jobs: int = 1
    dask: str | None = None  # address of the scheduler


HERE = Where()


def where_from(options: dict[str, Any]) -> Where:
    """Return who is to do the work; raises UsageError where two are asked for."""
    if options["dask"] is not None and options["jobs"] != 1:
        raise click.UsageError("--jobs and --dask exclude each other: a cluster has its own processes")
    return Where(options["jobs"], options["dask"])


@contextmanager
def shared_by(address: str | None) -> Iterator[Callable[[Callable[[T], R], Iterable[T]], Iterable[R]]]:
    """Yield what does the parts of one large input in turn: this process, or the workers of a Dask cluster."""
    if address is None:
        yield map
        return
    from molviz.cli.pool import shared_by_dask  # here: rarely asked for, and long to import

    with shared_by_dask(address) as each:
        yield each


def for_each(
    sources: Sequence[str], work: Work, tell: Callable[[Any], None], where: Where = HERE, quiet: bool = False
) -> None:
    """Do some work for every input and tell each result, in their order; failures are told as they come.

    At the end of ``MANY`` inputs, their count and a table of failures; the exit status is that of the worst.
    """
    failed: list[Outcome] = []
    progress = Progress(len(sources))
    try:
        for number, outcome in enumerate(_outcomes(sources, work, where, progress), start=1):
            progress.close()
            say(*outcome.lines) if outcome.lines else None
            if outcome.status:
                failed.append(outcome)
            else:
                tell(outcome.value)
            if number < len(sources):
                progress(f"{number} of {len(sources)}")
    finally:
        progress.close()
    if len(sources) >= MANY and (failed or not quiet):
        say(*_closing(len(sources), failed))
    if failed:
        sys.exit(max(outcome.status for outcome in failed))


def _outcomes(sources: Sequence[str], work: Work, where: Where, progress: Progress) -> Iterator[Outcome]:
    """Yield what becomes of each input, in their order; whatever is said here is said at once."""
    if len(sources) > 1 and (where.dask or where.jobs != 1):
        from molviz.cli import pool  # here: many processes are rarely asked for, and take long to import

        yield from pool.outcomes(sources, work, where, attempt)
        return
    for source in sources:
        yield attempt(work, source)


def attempt(work: Work, source: str, elsewhere: bool = False) -> Outcome:
    """Return what became of one input; ``elsewhere``, in another process, one thread works, and nothing is
    said but kept for the outcome."""
    if not elsewhere:
        return _attempted(work, source, PASSED_ON)
    threads.use(1)
    with collected() as lines:
        outcome = _attempted(work, source, ())
    return outcome._replace(lines=(*lines, *outcome.lines))


def _attempted(work: Work, source: str, passed_on: tuple[type[Exception], ...]) -> Outcome:
    try:
        return Outcome(source, work(source), (), 0)
    except InputError as wrong:
        return Outcome(source, None, (f"molviz: {wrong}",), failures.status_of(wrong))
    except MemoryError:
        return Outcome(source, None, (f"molviz: {source}: not enough memory for this input",), 1)
    except passed_on:
        raise
    except Exception as failure:
        return Outcome(source, None, (f"{failures.line_about(failure)} ({source})",), failures.STATUS)


def _closing(count: int, failed: Sequence[Outcome]) -> Iterator[str]:
    """Yield the lines at the end: how many were done, and a row for each that failed."""
    yield f"molviz: {count - len(failed)} of {count} inputs done" + (f", {len(failed)} failed:" if failed else "")
    width = max((len(visible(outcome.source)) for outcome in failed), default=0)
    for outcome in failed:
        reason = outcome.lines[-1].removeprefix("molviz: ").removeprefix(f"{outcome.source}:").strip()
        shown = reason if len(reason) <= LONGEST_REASON else f"{reason[:LONGEST_REASON]}…"
        yield f"  {visible(outcome.source):<{width}}  {outcome.status:>2}  {shown}"
