"""What there is to choose from is listed, and what is shown can be copied."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from molviz.cli import main
from molviz.model.radii import DEFAULT, OWN, TABLES
from molviz.picture import palette, style
from molviz.picture.palette import PALETTES, load_palette
from molviz.picture.style import STYLES, load_style


def told(*words: str) -> str:
    result = CliRunner().invoke(main, list(words))
    assert result.exit_code == 0 and not result.stderr, result.output
    return result.stdout


def test_styles_and_palettes_have_a_line_each() -> None:
    lines = told("styles").splitlines()
    for option, names, load in (("--style", STYLES, load_style), ("--palette", PALETTES, load_palette)):
        first = lines.index(option) + 1
        for name, line in zip(names, lines[first:], strict=False):
            assert line.split(maxsplit=1)[0] == name and load(name).title in line
    assert [line.split()[0] for line in lines if line.endswith("(default)")] == [palette.DEFAULT]
    assert len(lines) == len(STYLES) + len(PALETTES) + 3


def test_radii_have_a_title_and_a_source() -> None:
    lines = told("radii").splitlines()
    named = [line.split()[0] for line in lines if not line.startswith(" ")]
    assert named == [*TABLES, OWN] and max(map(len, lines)) <= 100
    assert [line.split()[0] for line in lines if line.endswith("(default)")] == [DEFAULT]


def test_json_says_the_same() -> None:
    listed, tables = json.loads(told("styles", "--json")), json.loads(told("radii", "--json"))["radii"]
    assert [row["name"] for row in listed["styles"]] == list(STYLES)
    assert [row["name"] for row in listed["palettes"]] == list(PALETTES)
    assert [row["title"] for row in tables][:-1] == list(TABLES.values())
    assert all(set(row) == {"name", "title", "source", "default"} and "(" in row["source"] for row in tables)


def test_every_name_is_a_style_or_a_palette_and_not_both() -> None:
    assert not set(STYLES) & set(PALETTES)


@pytest.mark.parametrize("name", [*STYLES, *PALETTES])
def test_what_is_shown_is_the_file_and_can_be_copied(name: str, tmp_path: Path) -> None:
    kind, module, load = ("style", style, load_style) if name in STYLES else ("palette", palette, load_palette)
    text, copy = told("styles", "--show", name), tmp_path / "mine.toml"
    assert text == (module.FOLDER / f"{name}.toml").read_text(encoding="utf-8")
    assert json.loads(told("styles", "--show", name, "--json")) == {"kind": kind, "name": name, "toml": text}
    copy.write_text(text, encoding="utf-8")
    assert load(str(copy)) == load(name)


@pytest.mark.parametrize(
    ("name", "answer"),
    [("goodsel", "did you mean 'goodsell'?"), ("tied", "did you mean 'tide'?"), ("zzz", "expected one of cel, flat")],
)
def test_unknown_names_are_answered(name: str, answer: str) -> None:
    result = CliRunner().invoke(main, ["styles", "--show", name])
    assert result.exit_code == 2 and result.stderr.startswith("molviz: no style or palette") and answer in result.stderr
