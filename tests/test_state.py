"""Orientations as quaternions, state files, and the commands and calls that say the same."""

import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result
from hypothesis import given
from hypothesis import strategies as st

import molviz
from molviz.cli import main
from molviz.errors import InputError, OptionError
from molviz.model.spheres import Spheres
from molviz.pipeline.state import KEPT, USUAL, checked_state, state_of_text, state_text
from molviz.pipeline.values import parse_orientation
from molviz.pipeline.views import ViewOptions, rotation_of, view_of
from molviz.viewer.command import call_of, command_of, words_of
from molviz.visibility.view import file_axes, middle

CAFFEINE = str(Path(__file__).parent.parent / "samples" / "caffeine.xyz")
BALLS = Spheres(np.array([[0.0, 1, 2], [5, 0, 1], [2, 7, 3]]), np.ones(3))
PARTS = st.floats(-10, 10)


def run(*words: str) -> Result:
    return CliRunner().invoke(main, list(words))


@pytest.mark.parametrize("axis", "xyz")
@pytest.mark.parametrize("degrees", [0.0, 30.0, -95.0, 180.0, 359.0])
def test_a_quaternion_is_a_turn_of_the_files_axes(axis: str, degrees: float) -> None:
    half = np.radians(degrees) / 2
    quaternion = [np.cos(half), *(np.sin(half) * (np.array(list("xyz")) == axis))]
    view = view_of(BALLS, ViewOptions(orientation=parse_orientation(quaternion)))
    assert np.allclose(view.rotation, file_axes(BALLS).rotated(axis, degrees).rotation, atol=1e-12)
    assert np.array_equal(view.center, middle(BALLS))


@given(st.tuples(PARTS, PARTS, PARTS, PARTS).filter(lambda q: np.linalg.norm(q) > 0.1), st.floats(0.01, 100))
def test_any_quaternion_is_a_rotation_whatever_its_length_and_sign(q: tuple[float, ...], factor: float) -> None:
    rotation = rotation_of(parse_orientation(q))
    assert np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-12) and np.linalg.det(rotation) > 0
    text = ",".join(repr(-factor * part) for part in q)
    assert np.allclose(rotation_of(parse_orientation(text)), rotation, atol=1e-12)


@pytest.mark.parametrize("value", ["", "1,2,3", "1,2,3,4,5", "a,b,c,d", "0,0,0,0", "nan,0,0,1", "inf,0,0,1", 5, [1, 2]])
def test_what_is_no_orientation_is_refused(value: Any) -> None:
    with pytest.raises(OptionError, match="^view: .*expected"):
        molviz.draw(CAFFEINE, view=value)


def test_a_text_and_its_numbers_are_one_view_to_the_last_bit() -> None:
    text = "0.04763,-0.93414,0.03102,0.35235"
    once = rotation_of(parse_orientation(text))
    assert np.array_equal(rotation_of(parse_orientation(parse_orientation(text))), once)


def test_the_view_comes_before_the_rotations(tmp_path: Path) -> None:
    one = molviz.draw(CAFFEINE, orient="file", rotate=["x,20", "z,40"]).svg()
    assert molviz.draw(CAFFEINE, view=(1, 0, 0, 0), rotate=["x,20", "z,40"]).svg() == one
    half = np.radians(20) / 2
    turned = molviz.draw(CAFFEINE, orient="file", rotate=["x,20", "z,40"]).view
    view = molviz.draw(CAFFEINE, view=(np.cos(half), np.sin(half), 0, 0), rotate="z,40").view
    assert np.allclose(view.rotation, turned.rotation, atol=1e-12)
    assert run("draw", CAFFEINE, "-o", str(tmp_path / "x.svg"), "--view", "-1,0,0,0").exit_code == 0
    assert run("hidden-lines", CAFFEINE, "-o", str(tmp_path / "x.svg"), "--view", "1,2,3,4").exit_code == 0


OPTIONS: dict[str, Any] = {
    "style": "flat", "color": ["element N=navy", 'name "C1"=#ff8000'], "palette": "clay", "legend": True,
    "title": 'a "b" \\ \x7f é 𝕏\n', "view": "0.5,0.5,-0.5,0.5", "perspective": 50, "background": "#ffe", "outline": 1.5,
    "rotate": ["x,30", "y,-10.5"], "chain": None, "water": True, "select": "not index 2", "scale_bar": "auto",
}  # fmt: skip


def test_a_state_file_says_what_differs_and_is_read_back(tmp_path: Path) -> None:
    text = state_text({**USUAL, **OPTIONS})
    back = state_of_text(text)
    assert back == {name: value for name, value in OPTIONS.items() if value is not None}
    assert state_of_text(state_text(USUAL)) == {}
    path = tmp_path / "state.toml"
    path.write_text(text, encoding="utf-8")
    expected = molviz.draw(CAFFEINE, **OPTIONS).svg()
    assert molviz.draw(CAFFEINE, view_from=path).svg() == expected
    assert molviz.draw(CAFFEINE, view_from=path, style="shaded").svg() == molviz.draw(
        CAFFEINE, **(OPTIONS | {"style": "shaded"})
    ).svg()


def test_options_typed_beside_a_state_file_win(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("molviz.cli.draw.drawn_by", lambda source: "")
    (tmp_path / "state.toml").write_text("style = 'flat'\nlegend = true\nview = [1, 2, 3, 4]\n", encoding="utf-8")
    words = ["draw", CAFFEINE, "-o", str(tmp_path / "x.svg"), "--view-from", str(tmp_path / "state.toml")]
    drawn = {}
    for more in ([], ["--style", "auto"], ["--view", "1,0,0,0"]):
        assert run(*words, *more).exit_code == 0
        drawn[" ".join(more)] = (tmp_path / "x.svg").read_text(encoding="utf-8")
    assert drawn[""] == molviz.draw(CAFFEINE, style="flat", legend=True, view="1,2,3,4").svg()
    assert drawn["--style auto"] == molviz.draw(CAFFEINE, legend=True, view="1,2,3,4").svg()
    assert drawn["--view 1,0,0,0"] == molviz.draw(CAFFEINE, style="flat", legend=True, view="1,0,0,0").svg()


@pytest.mark.parametrize(
    ("text", "told"),
    [("styel = 'flat'", "did you mean 'style'?"), ("legend = 'yes'", "true or false"),
     ("[style]\nbase = 'flat'", "style"),
     ("style = ", "not a state file"), ("view_from = 'x'", "no option"), ("style = 'godsell'", "goodsell"),
     ("view = [1, 2]", "four numbers"), ("title = 5", "no text")],
)  # fmt: skip
def test_what_is_no_state_file_is_refused(text: str, told: str, tmp_path: Path) -> None:
    path = tmp_path / "state.toml"
    path.write_text(text, encoding="utf-8")
    result = run("draw", CAFFEINE, "-o", str(tmp_path / "x.svg"), "--view-from", str(path))
    assert result.exit_code == 2 and told in result.stderr and len(result.stderr.splitlines()) == 1
    with pytest.raises(OptionError, match=told.replace("?", r"\?")):
        molviz.draw(CAFFEINE, view_from=path)


def test_a_state_file_that_is_not_there_or_would_be_overwritten(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"none\.toml: cannot be read"):
        molviz.draw(CAFFEINE, view_from=tmp_path / "none.toml")
    state = tmp_path / "state.svg"
    state.write_text("style = 'flat'", encoding="utf-8")
    assert run("draw", CAFFEINE, "-o", str(state), "--view-from", str(state)).exit_code == 2
    assert state.read_text(encoding="utf-8") == "style = 'flat'"


def test_words_and_calls_say_the_same(tmp_path: Path) -> None:
    command = command_of(CAFFEINE, OPTIONS, "x.svg")
    subprocess.run([sys.executable, "-m", *shlex.split(command)], check=True, cwd=tmp_path, capture_output=True)
    written = re.sub("(?s)<metadata>.*?</metadata>", "", (tmp_path / "x.svg").read_text(encoding="utf-8"))
    called = eval(call_of(repr(CAFFEINE), OPTIONS), {"molviz": molviz})  # noqa: S307
    assert called.svg() == written
    assert words_of(USUAL) == [] and call_of("x", USUAL) == "molviz.draw(x)"


@pytest.mark.parametrize(
    ("options", "words"),
    [({"rotate": ("x", 30.0)}, "--rotate x,30"), ({"width": 0.1}, "--width 0.1"), ({"label": "all"}, "--label all"),
     ({"rotate": [("x", 30.0), ["y", 1e-7]]}, "--rotate x,30 --rotate y,1e-07"), ({"model": "1"}, ""),
     ({"background": (255, 0, 16)}, "--background '#ff0010'"), ({"model": 2}, "--model 2"),
     ({"color": [("all", (1, 2, 3))]}, "--color 'all=#010203'"),
     ({"legend": False}, ""), ({"view": (1, 0.5, 0, 0)}, "--view 1,0.5,0,0"), ({"scale_radii": 1}, "")],
)  # fmt: skip
def test_words_of_values_of_python(options: dict[str, Any], words: str) -> None:
    assert shlex.join(words_of(options)) == words


def test_states_hold_all_options_but_the_file_itself() -> None:
    assert set(USUAL) - set(KEPT) == {"view_from"}
    assert checked_state({}) == {}
