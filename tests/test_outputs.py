"""Nothing is lost: links stay, pipes and devices are written into, inputs are never overwritten, all or nothing."""

import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

import molviz
from molviz import InputError
from molviz.cli import main
from molviz.pipeline.outputs import save

SAMPLES = Path(__file__).parent.parent / "samples"
CAFFEINE = str(SAMPLES / "caffeine.xyz")


def run(*words: str) -> Result:
    return CliRunner().invoke(main, list(words))


def test_a_symbolic_link_stays_and_what_it_names_is_written(tmp_path: Path) -> None:
    (tmp_path / "there").mkdir()
    target, link = tmp_path / "there" / "x.svg", tmp_path / "x.svg"
    for _ in range(2):  # the file is missing at first
        link.unlink(missing_ok=True)
        link.symlink_to(Path("there") / "x.svg")
        assert run("draw", CAFFEINE, "-o", str(link)).exit_code == 0
        assert link.is_symlink() and target.read_bytes().startswith(b"<?xml")
    assert sorted(tmp_path.rglob("*")) == [target.parent, target, link]


def test_a_circle_of_links_is_told(tmp_path: Path) -> None:
    one, two = tmp_path / "a.svg", tmp_path / "b.svg"
    one.symlink_to(two)
    two.symlink_to(one)
    result = run("draw", CAFFEINE, "-o", str(one))
    assert result.exit_code == 1 and "cannot be written" in result.stderr
    assert one.is_symlink() and two.is_symlink()


def test_a_pipe_is_written_into(tmp_path: Path) -> None:
    pipe, got = tmp_path / "x.svg", []
    os.mkfifo(pipe)
    reader = threading.Thread(target=lambda: got.append(pipe.read_bytes()))
    reader.start()
    assert save(str(pipe), [b"pic", b"ture"]) == 7
    reader.join(10)
    assert got == [b"picture"] and pipe.is_fifo() and list(tmp_path.iterdir()) == [pipe]


def test_a_device_is_written_into(tmp_path: Path) -> None:
    before = Path(os.devnull).stat()
    link = tmp_path / "x.svg"
    link.symlink_to(os.devnull)
    for target in (os.devnull, str(link)):
        assert run("draw", CAFFEINE, "-o", target, "--to", "svg").exit_code == 0
    after = Path(os.devnull).stat()
    assert (before.st_ino, before.st_mode, before.st_rdev) == (after.st_ino, after.st_mode, after.st_rdev)


@pytest.mark.parametrize("name", ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1", "/dev/fd/3", "link"])
def test_standard_output_by_name_is_appended_to_where_it_is_a_file(name: str, tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to("/dev/stdout")
    words = f"'{sys.executable}' -m molviz draw '{CAFFEINE}' --to svg --quiet -o {name}"
    (tmp_path / "log").write_bytes(b"before\n")
    subprocess.run(["sh", "-c", f"{words} {'3' if name[-1] == '3' else ''}>> log"], cwd=tmp_path, check=True)
    told = (tmp_path / "log").read_bytes()
    assert told.startswith(b"before\n<?xml") and told.rstrip().endswith(b"</svg>")
    assert subprocess.run(["sh", "-c", f"{words} 3>&1 | tail -c 7"], cwd=tmp_path, capture_output=True,
                          check=True).stdout.strip() == b"</svg>"  # fmt: skip


@pytest.mark.parametrize("how", ["same", "hard", "symbolic", "folder", "numbered", "option"])
def test_an_output_that_is_an_input_is_refused(how: str, tmp_path: Path) -> None:
    data = Path(CAFFEINE).read_bytes() if how != "option" else b"title = 'mine'\n"
    source, other = tmp_path / "1.svg", tmp_path / "other.svg"
    source.write_bytes(data)
    if how == "hard":
        other.hardlink_to(source)
    if how == "symbolic":
        other.symlink_to(source)
    output = {"same": source, "option": source, "folder": tmp_path, "numbered": tmp_path / "{n}.svg"}.get(how, other)
    words = {"numbered": ["--turntable", "2"], "option": ["--style", str(source)]}.get(how, [])
    drawn = CAFFEINE if how == "option" else str(source)
    result = run("draw", drawn, *words, "-o", str(output))
    assert result.exit_code == 2 and f"is the input {source} itself" in result.stderr
    assert source.read_bytes() == data and not set(tmp_path.iterdir()) - {source, other}


def test_python_refuses_to_overwrite_what_it_drew(tmp_path: Path) -> None:
    source = tmp_path / "mine.svg"
    source.write_bytes(Path(CAFFEINE).read_bytes())
    for more in ({}, {"turntable": 2}):
        with pytest.raises(InputError, match="itself"):
            molviz.draw(source, **more).save(source)
    assert source.read_bytes() == Path(CAFFEINE).read_bytes()


@pytest.mark.parametrize(("output", "more", "made"),
    [("new/", [], True), ("new/{stem}.svg", [], True), ("new/{n}.svg", ["--turntable", "2"], True),
     ("new/x.svg", [], False)])  # fmt: skip
def test_folders_are_made_for_folders_and_patterns_alone(
    output: str, more: list[str], made: bool, tmp_path: Path
) -> None:
    result = run("draw", CAFFEINE, *more, "-o", f"{tmp_path}/{output}")
    assert (result.exit_code == 0) is made is (tmp_path / "new").exists()
    assert made or (result.exit_code == 1 and "no such folder" in result.stderr)


@pytest.mark.parametrize("where", ["-o", "--style", "--radii", "--palette", "INPUT"])
def test_an_overlong_name_is_blamed_itself(where: str, tmp_path: Path) -> None:
    name = "x" * 5000 + ".svg"
    target = [] if where == "-o" else ["-o", str(tmp_path / "x.svg")]
    result = run("draw", *target, *([name] if where == "INPUT" else [CAFFEINE, where, name]))
    assert result.exit_code in (1, 2) and name in result.stderr and "standard output" not in result.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_end_from_outside_leaves_nothing_half_written(number: int, status: int, tmp_path: Path) -> None:
    code = (
        "import molviz.pipeline.outputs as outputs, pathlib, time\n"
        "from molviz.cli import main\n"
        "whole = outputs.os.fdopen\n"
        "def slow(*words):\n"
        "    pathlib.Path('begun').touch(); time.sleep(30)\n"
        "outputs.os.fdopen = slow\n"
        f"main(['draw', {CAFFEINE!r}, '-o', 'x.svg'])\n"
    )
    (tmp_path / "x.svg").write_bytes(b"before")
    process = subprocess.Popen([sys.executable, "-c", code], cwd=tmp_path, stderr=subprocess.PIPE)
    end = time.monotonic() + 60
    while not (tmp_path / "begun").exists() and time.monotonic() < end:
        time.sleep(0.02)
    process.send_signal(number)
    told = process.communicate(timeout=30)[1]
    assert process.returncode == status and b"Traceback" not in told
    assert {path.name for path in tmp_path.iterdir()} == {"x.svg", "begun"}
    assert (tmp_path / "x.svg").read_bytes() == b"before"


def test_with_standard_error_closed_everything_works(tmp_path: Path) -> None:
    shell = f"'{sys.executable}' -m molviz draw '{CAFFEINE}' -o x.svg 2>&-"
    assert subprocess.run(["sh", "-c", shell], cwd=tmp_path, check=False).returncode == 0
    assert (tmp_path / "x.svg").read_bytes().startswith(b"<?xml")
