"""Any number of threads gives the same bytes, and all of them may be used."""

import threading
from pathlib import Path

import pytest
from click.testing import CliRunner

from molviz import threads
from molviz.cli import main
from molviz.geometry import boundary, grid, intervals
from molviz.picture import compose, ink
from molviz.visibility import (
    bounds,
    culling,
    horizon_runs,
    junctions,
    named_arcs,
    occlusion,
    solids,
    stick_occlusion,
)
from molviz.write import columns

SAMPLES = Path(__file__).parent.parent / "samples"
MODULES = [(boundary, "BLOCK_ENTRIES", 1 << 9), (grid, "BLOCK_ROWS", 1 << 9), (culling, "BLOCK_ROWS", 1 << 9),
           (intervals, "BLOCK_ROWS", 1 << 7), (compose, "MANY", 1), (ink, "BLOCK_SAMPLES", 1 << 7),
           (bounds, "BLOCK_PAIRS", 1 << 7), (named_arcs, "MANY", 1), (junctions, "MANY", 1), (columns, "BLOCK", 1 << 6),
           *((module, "BLOCK_ROWS", 1 << 7) for module in (horizon_runs, occlusion, solids, stick_occlusion)),
           ]  # fmt: skip


@pytest.fixture(autouse=True)
def _small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Small scenes have several blocks; the number of threads is as before in the end."""
    monkeypatch.setattr(threads, "_chosen", [])
    for module, name, size in MODULES:
        monkeypatch.setattr(module, name, size)


@pytest.mark.parametrize(
    "words",
    [["draw", f"{SAMPLES}/1a8o.pdb", "--to", "svg"], ["draw", f"{SAMPLES}/1a8o.pdb", "--rep", "sticks", "--to", "svg"],
     ["draw", f"{SAMPLES}/c60.xyz", "--perspective", "30", "--to", "ps"],
     ["hidden-lines", "--random", "3000", "--fill", "flat", "--to", "pdf"], ["measure", f"{SAMPLES}/1a8o.pdb"]],
)  # fmt: skip
def test_any_number_of_threads_gives_the_same_bytes(words: list[str]) -> None:
    more = [] if words[0] == "measure" else ["-o", "-"]
    numbers = ("1", "2", "5")
    results = [CliRunner().invoke(main, [*words, *more, "--quiet", "--threads", number]) for number in numbers]
    assert [result.exit_code for result in results] == [0, 0, 0]
    assert results[0].stdout_bytes == results[1].stdout_bytes == results[2].stdout_bytes != b""


def test_results_are_in_the_order_of_the_blocks_and_threads_work_side_by_side() -> None:
    threads.use(3)
    together = threading.Barrier(3, timeout=20)

    def work(block: int) -> int:
        together.wait()  # for two others
        return block**2

    assert threads.in_threads(work, range(3)) == [0, 1, 4]


def test_by_default_there_are_as_many_as_processors_that_may_be_used() -> None:
    assert threads.count() >= 1
    threads.use(7)
    assert threads.count() == 7


def test_what_fails_in_a_thread_is_raised() -> None:
    threads.use(2)
    with pytest.raises(ZeroDivisionError):
        threads.in_threads(lambda block: 1 // block, [1, 0, 1])
