"""The examples of the README do what they say, twice in one process."""

import re
import shlex
import shutil
import textwrap
from pathlib import Path

import pytest
from click.testing import CliRunner

from molviz.cli import main
from molviz.picture.style import load_style

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = [textwrap.dedent(block) for block in re.findall(r"(?m)(?:^(?: {4}.*|)\n)+", README)]
PYTHON = [block for block in BLOCKS if "import molviz" in block]
SHELL = [line for block in BLOCKS for line in block.splitlines() if line.startswith("molviz ")]
STYLES = re.findall(r"(?ms)^```toml\n(.*?)^```", README)
OPTIONS = [word for block in BLOCKS if block.strip().startswith("--") for word in re.findall(r"--[\w-]+", block)]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the samples in it, in which the examples run."""
    shutil.copytree(ROOT / "samples", tmp_path / "samples")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def written(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*") if path.is_file() and path.relative_to(folder).parts[0] != "samples"
    }  # fmt: skip


def test_there_are_examples() -> None:
    assert PYTHON and STYLES and len(SHELL) >= 3 and len(OPTIONS) > 15


def test_the_python_examples_run_twice(folder: Path) -> None:
    files = []
    for _ in range(2):
        names: dict[str, object] = {}
        for block in PYTHON:
            exec(compile(block, "README.md", "exec"), names)  # noqa: S102
        files.append(written(folder))
    assert files[0] == files[1] and any(name.endswith(".pdf") for name in files[0])


def test_the_shell_examples_run_twice(folder: Path) -> None:
    for line in SHELL:
        words = shlex.split(line, comments=True)[1:]
        opened = [match for word in words for match in (sorted(map(str, Path().glob(word))) if "*" in word else [word])]
        files = []
        for _ in range(2):
            result = CliRunner().invoke(main, opened)
            assert result.exit_code == 0, f"{line}: {result.output}"
            files.append(written(folder))
        assert files[0] == files[1]
        if "-o" not in words:
            assert result.stdout, line
            continue
        target = words[words.index("-o") + 1]
        assert any(Path(name).match(target.replace("{stem}", "*")) for name in files[0]), line


def test_the_options_that_are_named_exist() -> None:
    help_text = CliRunner().invoke(main, ["draw", "--help"]).output
    assert not [option for option in OPTIONS if option not in help_text]


def test_the_styles_are_styles(tmp_path: Path) -> None:
    for text in STYLES:
        (tmp_path / "mine.toml").write_text(text, encoding="utf-8")
        assert load_style(str(tmp_path / "mine.toml")) != load_style("goodsell")


def test_pictures_exist_and_all_are_shown() -> None:
    """`make gallery` draws what the README shows, and nothing else is kept."""
    shown = set(re.findall(r"\]\((docs/[^)]+)\)", README))
    assert shown == {f"docs/{path.name}" for path in (ROOT / "docs").iterdir()}
    assert shown == set(re.findall(r"-o (docs/\S+)", (ROOT / "Makefile").read_text(encoding="utf-8")))
