"""Many inputs: the same bytes whoever does the work, a count at the end, and none that stops the rest."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from molviz.cli import main
from molviz.cli.batch import Outcome, Where, attempt, for_each
from molviz.cli.pool import outcomes
from molviz.cli.telling import say

SAMPLES = Path(__file__).parent.parent / "samples"
CAFFEINE = SAMPLES / "caffeine.xyz"
BROKEN = {"b1.xyz": "9\n\nC 0 0 0\n", "d.pdb": "\x00\x01", "e.cif": "data_x\n", "missing.xyz": None}


def run(*words: str) -> Result:
    return CliRunner().invoke(main, list(words))


@pytest.fixture
def inputs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Nine files by name, four of them broken; one of the others warns."""
    monkeypatch.chdir(tmp_path)
    for name in ("a.xyz", "b.xyz", "f.xyz", "g.xyz"):
        shutil.copy(CAFFEINE, name)
    Path("c.xyz").write_text("2\n\nC1 0 0 0\nQq 3 0 0\n", encoding="ascii")
    for name, text in BROKEN.items():
        Path(name).write_text(text, encoding="ascii") if text is not None else None
    return sorted(["a.xyz", "b.xyz", "c.xyz", "f.xyz", "g.xyz", *BROKEN])


def told(result: Result) -> str:
    return re.sub(r"\d+\.\d\d s\b|out\d", "", result.stderr)


def test_processes_draw_the_same_bytes_and_say_the_same(inputs: list[str]) -> None:
    results = [run("draw", *inputs, "-o", f"out{jobs}/", "-j", str(jobs)) for jobs in (1, 2)]
    assert [result.exit_code for result in results] == [1, 1]
    assert told(results[0]) == told(results[1])
    files = [{path.name: path.read_bytes() for path in Path(f"out{jobs}").iterdir()} for jobs in (1, 2)]
    assert files[0] == files[1] and sorted(files[0]) == ["a.svg", "b.svg", "c.svg", "f.svg", "g.svg"]


@pytest.mark.parametrize("words", [["info", "--json"], ["info"], ["measure", "--csv"], ["measure", "--per", "atom"]])
def test_numbers_are_the_same_and_in_the_order_of_the_inputs(words: list[str], inputs: list[str]) -> None:
    one, two = (run(*words, *inputs, "--jobs", jobs) for jobs in ("1", "0"))
    assert (one.stdout, one.stderr, one.exit_code) == (two.stdout, two.stderr, two.exit_code)
    assert one.exit_code == 1 and re.findall(r"\b[a-g]\.xyz\b", one.stdout)[:1] == ["a.xyz"]


def test_a_count_and_a_table_of_failures_close_a_batch(inputs: list[str]) -> None:
    lines = run("measure", *inputs, "-j", "2").stderr.splitlines()
    assert lines[-5] == "molviz: 5 of 9 inputs done, 4 failed:"
    assert [line.split()[:2] for line in lines[-4:]] == [[name, "1"] for name in sorted(BROKEN)]
    assert "only 1 follow" in lines[-4] and all(sum(name in line for line in lines) >= 2 for name in BROKEN)
    assert run("measure", "a.xyz", "b.xyz", "f.xyz").stderr == "molviz: 3 of 3 inputs done\n"
    assert run("measure", "a.xyz", "b.xyz", "f.xyz", "--quiet").stderr == "" == run("measure", "a.xyz", "b.xyz").stderr


def test_the_exit_status_is_that_of_the_worst(inputs: list[str]) -> None:
    assert run("info", "a.xyz", "b.xyz", "-j", "2").exit_code == 0
    assert run("info", *inputs, "--model", "2", "-j", "2").exit_code == 2
    assert run("info", "a.xyz", "b.xyz", "-j", "2", "--dask", "x:1").exit_code == 2
    assert run("info", "a.xyz", "-j", "-1").exit_code == 2


def test_every_drawing_has_its_json_line_from_processes_too(inputs: list[str]) -> None:
    result = run("draw", *inputs, "-o", "{stem}.svg", "--json", "-j", "2")
    assert [json.loads(line)["output"] for line in result.stdout.splitlines()] == [f"{k}.svg" for k in "abcfg"]


def test_standard_input_is_read_in_a_batch_too(inputs: list[str]) -> None:
    words = ["info", "a.xyz", "-", "b.xyz", "-j", "2", "--format", "xyz", "--json"]
    result = CliRunner().invoke(main, words, input=CAFFEINE.read_bytes())
    assert [one["file"] for one in json.loads(result.stdout)["results"]] == ["a.xyz", "-", "b.xyz"]


def test_what_draws_a_picture_does_not_say_by_whom_it_was_drawn(inputs: list[str]) -> None:
    for number, words in enumerate((["--jobs", "2"], ["-j2"], [], ["--jobs=2"])):
        assert run("draw", "a.xyz", "b.xyz", *words, "-o", f"{number}-{{stem}}.svg").exit_code == 0
    assert len({Path(f"{number}-a.svg").read_bytes() for number in range(4)}) == 1


def work(source: str) -> str:
    """Ends its process without a word, fails, or says something."""
    if source == "dies":
        os._exit(9)
    if source == "fails":
        raise ZeroDivisionError("on purpose")
    say(f"of {source}")
    return source.upper()


def test_a_process_that_dies_is_a_failure_of_its_own_input_alone() -> None:
    done = list(outcomes(["a", "dies", "b", "fails", "c"], work, Where(jobs=2), attempt))
    assert [one.source for one in done] == ["a", "dies", "b", "fails", "c"]
    assert [one.value for one in done] == ["A", None, "B", None, "C"]
    assert [one.status for one in done] == [0, 70, 0, 70, 0]
    assert "the process ended" in done[1].lines[-1] and "on purpose" in done[3].lines[-1] and done[2].lines == ("of b",)


def test_memory_that_ends_is_a_failure_of_one_input() -> None:
    def greedy(source: str) -> str:
        raise MemoryError

    outcome = attempt(greedy, "a")
    assert outcome == Outcome("a", None, ("molviz: a: not enough memory for this input",), 1)


def test_a_terminal_shows_how_many_are_done(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("molviz.cli.progress.PATIENCE", -1.0)
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    for_each(["a", "b", "c"], work, lambda value: None, quiet=True)
    shown = capsys.readouterr().err
    assert "1 of 3" in shown and "2 of 3" in shown and "of a\n" in shown


@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_end_from_outside_ends_all_processes(number: int, status: int, tmp_path: Path) -> None:
    names = []
    for k in range(40):
        names.append(tmp_path / f"{k}.pdb")
        shutil.copy(SAMPLES / "1a8o.pdb", names[-1])
    command = [sys.executable, "-m", "molviz", "draw", *map(str, names), "-o", str(tmp_path / "out") + "/", "-j", "2"]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, start_new_session=True)
    while not (tmp_path / "out").is_dir() and process.poll() is None:
        time.sleep(0.05)
    children = children_of(process.pid)
    process.send_signal(number)
    process.communicate(timeout=60)
    assert process.returncode == status and len(children) >= 2
    for _ in range(100):
        if not any(Path(f"/proc/{child}").exists() for child in children):
            break
        time.sleep(0.1)
    assert not any(Path(f"/proc/{child}").exists() for child in children)
    for path in (tmp_path / "out").iterdir():
        assert path.suffix == ".svg" and path.read_bytes().rstrip().endswith(b"</svg>")


def children_of(process: int) -> list[int]:
    text = Path(f"/proc/{process}/task/{process}/children").read_text(encoding="ascii")
    return [int(child) for child in text.split()]


# ---- Dask


def test_a_cluster_gives_the_same(inputs: list[str]) -> None:
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=2, dashboard_address=None) as cluster:
        one = run("draw", *inputs, "-o", "out1/")
        two = run("draw", *inputs, "-o", "out2/", "--dask", cluster.scheduler_address)
        three = run("measure", *inputs, "--json", "--dask", cluster.scheduler_address)
    assert told(one) == told(two) and one.exit_code == two.exit_code == 1
    files = [{path.name: path.read_bytes() for path in Path(name).iterdir()} for name in ("out1", "out2")]
    assert files[0] == files[1] and len(files[0]) == 5
    assert three.stdout == run("measure", *inputs, "--json").stdout


def test_a_cluster_hides_the_lines_of_discs_band_by_band(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    distributed = pytest.importorskip("distributed")
    monkeypatch.chdir(tmp_path)
    scenes = {"random": ("--random", "2000", "--seed", "3"), "discs": (str(CAFFEINE), "--as", "discs")}
    for name, words in scenes.items():
        assert run("hidden-lines", *words, "-o", f"{name}.ps").exit_code == 0
    monkeypatch.setattr("molviz.discs.bands.BAND_DISCS", 7)
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        for name, words in scenes.items():
            address = cluster.scheduler_address
            assert run("hidden-lines", *words, "-o", f"{name}_there.ps", "--dask", address).exit_code == 0
            assert Path(f"{name}_there.ps").read_bytes() == Path(f"{name}.ps").read_bytes()


def test_a_cluster_makes_one_large_map_tile_by_tile(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    distributed = pytest.importorskip("distributed")
    monkeypatch.chdir(tmp_path)
    views = {"parallel": (), "central": ("--perspective", "60")}
    for name, words in views.items():
        assert run("draw", str(SAMPLES / "c60.xyz"), *words, "-o", f"{name}.svg").exit_code == 0
    monkeypatch.setattr("molviz.visibility.tiles.TILE_SPHERES", 7)
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        for name, words in views.items():
            there = ("-o", f"{name}_there.svg", "--dask", cluster.scheduler_address)
            assert run("draw", str(SAMPLES / "c60.xyz"), *words, *there).exit_code == 0
            assert Path(f"{name}_there.svg").read_bytes() == Path(f"{name}.svg").read_bytes()


def test_no_cluster_is_a_wrong_option(inputs: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("molviz.cli.pool.SECONDS", 1)
    result = run("info", *inputs, "--dask", "tcp://127.0.0.1:9")
    assert result.exit_code == 2 and "no scheduler answers at 'tcp://127.0.0.1:9'" in result.stderr
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert "pip install 'molviz[dask]'" in run("info", *inputs, "--dask", "tcp://127.0.0.1:9").stderr
