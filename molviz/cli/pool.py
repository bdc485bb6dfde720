"""The work of a batch done by other processes: a pool of this machine's, or a Dask cluster."""

import multiprocessing
import os
import signal
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from functools import partial
from typing import Any, TypeVar

from molviz import threads
from molviz.cli import failures
from molviz.cli.batch import STANDARD_INPUT, Outcome, Where, Work
from molviz.errors import InputError, OptionError

ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
SECONDS = 30  # in which a scheduler answers

Attempt = Callable[..., Outcome]
T = TypeVar("T")
R = TypeVar("R")


def outcomes(sources: Sequence[str], work: Work, where: Where, attempt: Attempt) -> Iterator[Outcome]:
    """Yield what becomes of each input, in their order; standard input is read here, and nowhere else."""
    remote = [source for source in sources if source != STANDARD_INPUT]
    job = partial(attempt, work, elsewhere=True)
    done = _by_dask(remote, job, where.dask) if where.dask else _by_pool(remote, job, where.jobs)
    try:
        for source in sources:
            yield attempt(work, source) if source == STANDARD_INPUT else next(done)
    finally:
        done.close()


# ---- this machine


def _by_pool(sources: Sequence[str], job: Callable[..., Outcome], jobs: int) -> Generator[Outcome, None, None]:
    """Yield outcomes; a process that dies takes those at work with it: they are done again, its own input alone."""
    left = list(sources)
    while left:
        with _executor(min(jobs or os.cpu_count() or 1, len(left))) as executor:
            futures = [executor.submit(job, source=source) for source in left]
            yield from _results(futures, left)
        if left:
            yield _alone(left.pop(0), job)


def _results(futures: Sequence["Future[Outcome]"], left: list[str]) -> Iterator[Outcome]:
    """Yield results as long as no process dies; each takes its input from those that are left."""
    for future in futures:
        try:
            outcome = future.result()
        except BrokenProcessPool:
            return
        left.pop(0)
        yield outcome


def _alone(source: str, job: Callable[..., Outcome]) -> Outcome:
    with _executor(1) as executor:
        try:
            return executor.submit(job, source=source).result()
        except BrokenProcessPool:
            line = f"molviz: {source}: the process ended before it was done (out of memory?)"
            return Outcome(source, None, (line,), failures.STATUS)


@contextmanager
def _executor(jobs: int) -> Iterator[Executor]:
    """A pool of processes of one thread each, which ends, with all that they do, where anything goes wrong here."""
    before = {name: os.environ.get(name) for name in ONE_THREAD}
    os.environ.update(dict.fromkeys(ONE_THREAD, "1"))
    executor = ProcessPoolExecutor(jobs, multiprocessing.get_context("spawn"), _begin)
    try:
        yield executor
    except BaseException:
        for child in multiprocessing.active_children():
            child.terminate()
        raise
    finally:
        executor.shutdown(cancel_futures=True)
        for name, value in before.items():
            os.environ.pop(name) if value is None else os.environ.update({name: value})


def _begin() -> None:
    """Let Ctrl-C, which reaches all processes of a terminal, be the parent's business; SIGTERM ends without traces."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, _end)


def _end(number: int, frame: object) -> None:
    raise SystemExit(failures.TERMINATED)


# ---- a cluster


def _by_dask(sources: Sequence[str], job: Callable[..., Outcome], address: str) -> Generator[Outcome, None, None]:
    """Yield outcomes of the workers of a cluster, which see the same files."""
    client = _client(address)
    try:
        futures = [client.submit(job, source=source, pure=False) for source in sources]
        for source, future in zip(sources, futures, strict=True):
            yield _outcome_of(source, future)
    finally:
        client.close()


@contextmanager
def shared_by_dask(address: str) -> Iterator[Callable[[Callable[[T], R], Iterable[T]], Iterator[R]]]:
    """Yield what does as ``map`` does, by the workers of a cluster; few parts are under way at a time.

    Raises InputError where the cluster cannot do one.
    """
    client = _client(address)

    def each(work: Callable[[T], R], parts: Iterable[T]) -> Iterator[R]:
        under_way: deque[tuple[Any, Any]] = deque()
        for part in parts:
            sent = client.scatter(part, hash=False)  # kept until it is used: it cannot be made anew
            under_way.append((sent, client.submit(_by_one_thread, work, sent, pure=False)))
            if len(under_way) > 2 * len(client.ncores()):
                yield _result(under_way.popleft()[1])
        while under_way:
            yield _result(under_way.popleft()[1])

    try:
        yield each
    finally:
        client.close()


def _by_one_thread(work: Callable[[T], R], part: T) -> R:
    threads.use(1)
    return work(part)


def _result(future: Any) -> Any:
    try:
        return future.result()
    except Exception as failure:
        reason = " ".join(f"{type(failure).__name__}: {failure}".split())
        raise InputError(f"the cluster could not do it ({reason})") from None


def _client(address: str) -> Any:
    try:
        from distributed import Client
    except ImportError:
        raise OptionError("--dask: the package distributed is missing; expected pip install 'molviz[dask]'") from None
    try:
        return Client(address, timeout=SECONDS)  # type: ignore[no-untyped-call]
    except (OSError, ValueError) as wrong:
        raise OptionError(f"--dask: no scheduler answers at {address!r} ({wrong}); expected tcp://HOST:PORT") from None


def _outcome_of(source: str, future: Any) -> Outcome:
    """The outcome of one input; a worker that died more often than the scheduler bears is a failure."""
    try:
        outcome: Outcome = future.result()
    except Exception as failure:
        line = f"molviz: {source}: the cluster could not do it ({type(failure).__name__}: {failure})"
        return Outcome(source, None, (" ".join(line.split()),), failures.STATUS)
    return outcome
