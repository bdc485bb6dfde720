"""Style files: every key is read, every wrong one is named, and only a style or an InputError comes out."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz import toml
from molviz.errors import InputError
from molviz.picture.style import FOLDER, MOST_BASES, STYLES, Style, load_style

FLAT: dict[str, Any] = toml.loads((FOLDER / "flat.toml").read_text(encoding="utf-8"))
CHOICES = {
    "fill": "ball", "parts": "merged", "lines.crease_where": "between", "colors.scheme": "chain",
}  # fmt: skip
ROWS = {
    "shade.steps": [[2.0, 6.0, 0.1]], "shade.large_steps": [[2.0, 6.0, 0.1]], "light.direction": [[0, 0, 1]],
    "light.terminators": [[0.1, 0.2]], "light.highlights": [[0.1, 0.2]], "colors.ramp": ["red", "blue"],
}  # fmt: skip


def keys(table: dict[str, Any], where: str = "") -> Iterator[tuple[str, Any]]:
    """All keys of a table of tables with their values, by names like ``lines.color``."""
    for key, value in table.items():
        if isinstance(value, dict):
            yield from keys(value, f"{where}{key}.")
        else:
            yield f"{where}{key}", value


def is_one_of_many(name: str) -> bool:
    """Whether a key is a colour of an element or residue, of which one each stands for all."""
    section, _, last = name.rpartition(".")
    return section in ("colors.element", "colors.residue") and last not in ("C", "HOH")


KEYS = {name: value for name, value in keys(FLAT) if not is_one_of_many(name)}


def text_of(table: dict[str, Any], head: str = "") -> str:
    """A table of tables as TOML; JSON's texts, lists and numbers are TOML's as well."""
    plain = {key: value for key, value in table.items() if not isinstance(value, dict)}
    lines = [f"{json.dumps(key)} = {value_of(value)}" for key, value in plain.items()]
    for key, value in table.items():
        if isinstance(value, dict):
            name = f"{head}.{json.dumps(key)}" if head else json.dumps(key)
            lines += [f"[{name}]", text_of(value, name)]
    return "\n".join(lines)


def value_of(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(value_of, value))}]"
    return {"NaN": "nan", "Infinity": "inf", "-Infinity": "-inf"}.get(json.dumps(value), json.dumps(value))


def with_key(name: str, value: Any) -> dict[str, Any]:
    """A table that states this key only."""
    *sections, key = name.split(".")
    table: dict[str, Any] = {key: value}
    for section in reversed(sections):
        table = {section: table}
    return table


def loaded(folder: Path, table: dict[str, Any] | str) -> Style:
    path = folder / "own.toml"
    path.write_text(table if isinstance(table, str) else text_of(table), encoding="utf-8")
    return load_style(str(path))


def other(name: str, value: Any) -> Any:
    """Another valid value of a key."""
    if name in CHOICES:
        return CHOICES[name]
    if name in ROWS:
        return ROWS[name]
    if isinstance(value, str):
        return value + " too" if name == "title" else "#123456"
    return value + 0.125 if isinstance(value, float) and value < 0.8 else value / 2 if isinstance(value, float) else 3


@pytest.mark.parametrize("name", STYLES)
def test_every_style_can_be_loaded_and_says_what_it_is(name: str) -> None:
    style = load_style(name)
    assert style.title and {"flat", "goodsell", "cel", "shaded", "line", "print", "hatch"} == set(STYLES)
    assert len({load_style(one).title for one in STYLES}) == len(STYLES)


@pytest.mark.parametrize("name", KEYS)
def test_every_key_is_read(name: str, tmp_path: Path) -> None:
    assert loaded(tmp_path, with_key(name, KEYS[name])) == load_style("flat")
    assert loaded(tmp_path, with_key(name, other(name, KEYS[name]))) != load_style("flat")


@pytest.mark.parametrize("name", KEYS)
def test_a_wrong_value_is_an_error_that_names_the_key(name: str, tmp_path: Path) -> None:
    wrong = [True, 1e300, -1e300, float("nan"), float("inf"), 10**400, [], [1], [["x"]], [[[]]]]
    if name != "title":
        wrong += ["no such thing"]
    if isinstance(KEYS[name], list):
        wrong += [[[1.0] * 7], 1]
    for value in wrong:
        if isinstance(value, list) and value == [] and isinstance(KEYS[name], list) and name in EMPTY:
            continue
        with pytest.raises(InputError) as error:
            loaded(tmp_path, with_key(name, value))
        assert name in str(error.value) and "own.toml" in str(error.value), (value, str(error.value))


EMPTY = ("shade.steps", "shade.large_steps", "light.terminators", "light.highlights")  # which may be


@pytest.mark.parametrize("name", KEYS)
def test_a_table_in_the_place_of_a_value_and_a_value_in_the_place_of_a_table(name: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=name):
        loaded(tmp_path, with_key(name, {"x": 1}))
    if "." in name:
        section = name.split(".")[0]
        with pytest.raises(InputError, match=f"{section} is expected to be a table"):
            loaded(tmp_path, {section: 1})


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("[lines]\noutlin = 1", "lines.outlin; did you mean 'outline'"),
        ("fil = 'flat'", "did you mean 'fill'"),
        ("[zzz]\nx = 1", "expected one of title, fill"),
        ("[ink]\nouter = 1.0", "no style has a key ink.outer"),
        ("[colors.elements]\nC = 'red'", "did you mean 'element'"),
        ("[colors.element]\nC = 'rde'", "colors.element.C"),
        ("base = 'goodsel'", "did you mean 'goodsell'"),
        ("base = 3", "base = 3"),
        ("base = 'nowhere.toml'", "no such style or file"),
        ("fill = 'flat", "not a style"),
        ("fill = 'flat'\nfill = 'flat'", "not a style"),
        ("[hatch]\nnearest = 0.001", "hatch.nearest"),
        ("[hatch]\nfarthest = 0.0", "hatch.farthest"),
        ("[light]\ndirection = [[0, 0, 0]]", "light.direction"),
        ("x = " + "[" * 5000 + "]" * 5000, "not a style"),
        ("x = " + "{a=" * 3000 + "1" + "}" * 3000, "not a style"),
        ("[" + "a." * 3000 + "b]\nx = 1", "not a style"),
    ],
)
def test_what_is_wrong_is_said(text: str, told: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as error:
        loaded(tmp_path, text)
    assert told in str(error.value)


def test_not_text_at_all(tmp_path: Path) -> None:
    for data in (b"\xff\xfe\x00", b"\x00", b'title = "\xe9"'):
        (tmp_path / "x.toml").write_bytes(data)
        with pytest.raises(InputError, match="not a style"):
            load_style(str(tmp_path / "x.toml"))
    for name in (str(tmp_path), "", "\0", "x" * 5000):
        with pytest.raises(InputError):
            load_style(name)


def test_a_style_states_only_what_differs_from_its_base(tmp_path: Path) -> None:
    goodsell = load_style("goodsell")
    own = loaded(tmp_path, {"base": "goodsell", "fog": {"strength": 0.0}, "colors": {"element": {"C": "#010203"}}})
    assert own.ink == goodsell.ink and own.shade == goodsell.shade and own.fog.begin == goodsell.fog.begin
    assert own.fog.strength == 0 and own.colors.element["C"] == (1, 2, 3)
    assert own.colors.element["N"] == goodsell.colors.element["N"]
    assert loaded(tmp_path, {"colors": {"element": {"Xx": "red"}}}).colors.element["Xx"] == (255, 0, 0)


def test_a_base_may_be_a_file_and_a_circle_is_told(tmp_path: Path) -> None:
    for k in range(MOST_BASES + 3):
        base = "goodsell" if k == 0 else str(tmp_path / f"{k - 1}.toml")
        (tmp_path / f"{k}.toml").write_text(f"base = {json.dumps(base)}\n[fog]\nsteps = {k + 1}\n", encoding="utf-8")
    third = load_style(str(tmp_path / "2.toml"))
    assert third.fog.steps == 3 and third.ink == load_style("goodsell").ink
    (tmp_path / "0.toml").write_text(f"base = {json.dumps(str(tmp_path / '1.toml'))}", encoding="utf-8")
    with pytest.raises(InputError, match="in a circle"):
        load_style(str(tmp_path / "2.toml"))


values = st.recursive(
    st.none() | st.booleans() | st.integers(-(10**30), 10**30) | st.floats() | st.text(max_size=8)
    | st.sampled_from(["red", "#fff", "goodsell", "flat", "between", 0.5, 1.0]),
    lambda inner: st.lists(inner, max_size=4),
    max_leaves=6,
).filter(lambda value: value is not None)  # fmt: skip


@given(st.lists(st.tuples(st.sampled_from([*KEYS, "base", "colors.element.Zz", "x", "lines.x.y"]), values), max_size=4))
@settings(max_examples=60)
def test_anything_else_is_a_style_or_an_input_error(
    tmp_path_factory: pytest.TempPathFactory, stated: list[tuple[str, Any]]
) -> None:
    table: dict[str, Any] = {}
    for name, value in stated:
        *sections, key = name.split(".")
        inner = table
        for section in sections:
            inner = inner.setdefault(section, {})
        inner[key] = value
    try:
        assert isinstance(loaded(tmp_path_factory.getbasetemp(), table), Style)
    except InputError as error:
        assert str(error)
