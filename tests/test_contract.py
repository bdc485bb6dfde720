"""What scripts rely on: exit statuses, messages that say what was meant, and JSON whatever the names are."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from molviz.cli import main

SAMPLES = Path(__file__).parent.parent / "samples"
CAFFEINE = str(SAMPLES / "caffeine.xyz")


def run(*words: str) -> Result:
    return CliRunner().invoke(main, list(words))


def molviz(*words: str | bytes) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run([sys.executable, "-m", "molviz", *words], capture_output=True, check=False)


@pytest.mark.parametrize(
    ("words", "told"),
    [(["--select", "watr"], "did you mean 'water'?"), (["--select", "chain"], "expected a value"),
     (["--style", "godsell"], "did you mean 'goodsell'?"), (["--style", "no.toml"], "or a TOML file"),
     (["--palette", "tied"], "did you mean 'tide'?"), (["--palette", "zzz"], "or a TOML file"),
     (["--radii", "bondy"], "did you mean 'bondi'?"), (["--radii", "zzz"], "or a table's path"),
     (["--model", "x"], "expected a number from 1"), (["--model", "2"], "the file has 1, numbered from 1"),
     (["--color", "elment C=red"], "did you mean 'element'?"), (["--label", "elment C"], "did you mean 'element'?")],
)  # fmt: skip
def test_an_option_that_cannot_be_used_exits_2_in_one_line(words: list[str], told: str, tmp_path: Path) -> None:
    result = run("draw", CAFFEINE, "-o", str(tmp_path / "x.svg"), *words)
    assert result.exit_code == 2 and told in result.stderr
    assert len(result.stderr.splitlines()) == 1 and result.stderr.startswith("molviz: ")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("words", [["--select", "watr"], ["--radii", "bondy"], ["--model", "x"]])
def test_a_wrong_option_is_told_once_however_many_inputs_there_are(words: list[str]) -> None:
    for command in ("measure", "surface", "info"):
        result = run(command, CAFFEINE, CAFFEINE, *words)
        assert result.exit_code == 2 and len(result.stderr.splitlines()) == 1 and not result.stdout


def test_one_bad_file_among_many_exits_1(tmp_path: Path) -> None:
    assert run("measure", CAFFEINE, str(tmp_path / "missing.pdb"), CAFFEINE).exit_code == 1


def test_two_inputs_with_one_stem_are_named(tmp_path: Path) -> None:
    shutil.copy(CAFFEINE, tmp_path / "caffeine.extxyz")
    result = run("draw", CAFFEINE, str(tmp_path / "caffeine.extxyz"), "-o", str(tmp_path / "out") + "/")
    assert result.exit_code == 2 and f"{CAFFEINE} and {tmp_path / 'caffeine.extxyz'}" in result.stderr


@pytest.mark.parametrize("command", ["info", "measure", "surface", "draw"])
def test_json_is_json_for_any_file_name(command: str, tmp_path: Path) -> None:
    name = os.fsencode(tmp_path) + b"/\xff\xe9\x1b\x7f\n\xc3\xa9.xyz"
    Path(os.fsdecode(name)).write_bytes(Path(CAFFEINE).read_bytes())
    more = ["-o", str(tmp_path / "x.svg")] if command == "draw" else []
    done = molviz(command, "--json", *more, name)
    assert done.returncode == 0 and done.stdout.isascii() and b"\x7f" not in done.stdout
    result = json.loads(done.stdout)
    assert os.fsencode((result if command == "draw" else result["results"][0])["file"]) == name


def test_the_summary_of_a_drawing_as_json(tmp_path: Path) -> None:
    target = tmp_path / "x.svg"
    result = run("draw", CAFFEINE, "--json", "-o", str(target))
    told = json.loads(result.stdout)
    assert result.exit_code == 0 and not result.stderr
    assert list(told) == ["file", "output", "atoms", "drawn", "visible", "arcs", "bytes", "seconds"]
    assert (told["file"], told["output"], told["bytes"]) == (CAFFEINE, str(target), target.stat().st_size)
    assert told["atoms"] == told["drawn"] == 24 and 0 < told["visible"] <= 24 and told["seconds"] >= 0


def test_every_drawing_has_a_json_line_of_its_own(tmp_path: Path) -> None:
    shutil.copy(CAFFEINE, tmp_path / "other.xyz")
    result = run("draw", CAFFEINE, str(tmp_path / "other.xyz"), "--json", "-o", str(tmp_path / "{stem}.svg"))
    assert [Path(json.loads(line)["output"]).name for line in result.stdout.splitlines()] == [
        "caffeine.svg", "other.svg",
    ]  # fmt: skip


def test_the_picture_and_its_summary_do_not_share_standard_output() -> None:
    assert run("draw", CAFFEINE, "--json", "-o", "-", "--to", "svg").exit_code == 2


def test_the_command_in_a_picture_says_nothing_of_json(tmp_path: Path) -> None:
    pictures = []
    for words in ([], ["--json"]):
        assert run("draw", CAFFEINE, *words, "-o", str(tmp_path / "x.svg")).exit_code == 0
        pictures.append((tmp_path / "x.svg").read_bytes())
    assert pictures[0] == pictures[1]


def test_long_lists_of_alternatives_are_cut(tmp_path: Path) -> None:
    rows = [f"HETATM{k:>5}  C   LIG {chr(48 + k)}   1    {2.0 * k:8.3f}   0.000   0.000" for k in range(70)]
    (tmp_path / "x.pdb").write_text("\n".join(rows) + "\n", encoding="ascii")
    result = run("info", str(tmp_path / "x.pdb"), "--select", "resi 7")
    assert result.exit_code == 1 and "0, 1, 2" in result.stderr and "… and 58 more" in result.stderr
