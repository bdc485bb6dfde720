"""Numbers of any size: what doubles hold is drawn and measured, what they do not is refused by name, nothing warns."""

import json
import re
import warnings
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result
from hypothesis import given, settings
from hypothesis import strategies as st

import molviz
from molviz import InputError
from molviz.cli import main
from molviz.model.molecule import Molecule
from molviz.model.radii import load_table
from molviz.model.selection import select
from molviz.picture.palette import load_palette

DIGITS = "9" * 5000
SCENE = np.array([[0.0, 0, 0], [1.5, 0.4, 0.2], [0.3, 1.6, -0.7], [-1.2, 0.1, 0.9], [0.2, -1.3, 1.1]])
RADII = np.array([1.7, 1.2, 1.5, 1.1, 1.8])


def run(*words: str) -> Result:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        result = CliRunner().invoke(main, list(words))
    assert result.exception is None or isinstance(result.exception, SystemExit), repr(result.exception)
    assert result.exit_code in (0, 1, 2), result.stderr
    return result


def balls(path: Path, rows: object) -> str:
    path.write_text("".join(f"{x!r} {y!r} {z!r} {r!r}\n" for x, y, z, r in np.array(rows).tolist()), encoding="utf-8")
    return str(path)


@pytest.mark.parametrize("exponent", [*range(-50, 51, 10), -5, -3, 3, 5, 8])
def test_measures_scale_exactly(exponent: int) -> None:
    scale = 2.0 ** round(exponent * np.log2(10))
    one, other = molviz.measure((SCENE, RADII)), molviz.measure((SCENE * scale, RADII * scale))
    assert np.allclose(other.area, one.area * scale**2, rtol=1e-13, atol=0)
    assert np.isclose(other.volume, one.volume * scale**3, rtol=1e-13, atol=0)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("method", ["visible", "painter"])
@pytest.mark.parametrize("exponent", [-50, -20, -8, -5, -3, 3, 5, 8])
def test_small_and_large_scenes_are_seen_as_they_are(exponent: int, method: str) -> None:
    usual = molviz.draw((SCENE, RADII), style="flat", method=method, orient="file")
    scale = 2.0 ** round(exponent * np.log2(10))
    scaled = molviz.draw((SCENE * scale, RADII * scale), style="flat", method=method, orient="file", width="8cm")
    assert (scaled.visible, scaled.arcs) == (usual.visible, usual.arcs)
    same = [molviz.draw((SCENE * k, RADII * k), style="flat", method=method, orient="file", width="8cm", crease=0,
                        outline=0).svg().count("<path") for k in (1.0, scale)]  # fmt: skip
    assert same[0] == same[1] > 0


NUMBER = re.compile(r"-?(?:\d+\.?\d*|\.\d+)")
SIZED = {  # lengths among the options, which are the scene's
    "parallel": {}, "eye": {"perspective": 30.0}, "painter": {"method": "painter"},
    "bar": {"scale_bar": 2.0, "width": "9cm"}, "exposure": {"color_by": "exposure", "legend": True},
    "turntable": {"turntable": 3}, "stereo": {"stereo": "wall"},
    "labels": {"label": "index 1=x", "color": "x > {}=crimson"}, "scale": {"scale": 25.0},
}  # fmt: skip


def sized(how: str, style: str, scale: float) -> str:
    options = dict(SIZED[how], style=style)
    for name in ("perspective", "scale_bar"):
        options |= {name: options[name] * scale} if name in options else {}
    options |= {"scale": options["scale"] / scale} if "scale" in options else {}
    options |= {"color": options["color"].format(0.25 * scale)} if "color" in options else {}
    drawing = molviz.draw((SCENE * scale, RADII * scale), **options)
    svg = drawing.to("svg").decode()
    return re.sub(r'(id|class|href)="[^"]*"|url\(#[^)]*\)|<style.*?</style>', "", svg)  # names are of this very file


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("how", SIZED)
@pytest.mark.parametrize("scale", [1e-5, 1e-3, 1e3])
def test_a_scene_times_a_power_of_ten_is_drawn_like_the_scene(scale: float, how: str) -> None:
    for style in ("goodsell", "cel", "shaded", "hatch", "flat"):
        if how != "painter" or style != "goodsell":
            pictures = [re.sub("<text.*?</text>|<desc.*?</desc>", "", sized(how, style, one)) for one in (1.0, scale)]
            usual, other = (np.array(NUMBER.findall(picture), dtype=float) for picture in pictures)
            assert len({NUMBER.sub("0", picture) for picture in pictures}) == 1
            assert np.allclose(usual, other, rtol=0, atol=0.0201)  # the last digit that is written


def test_lengths_in_a_picture_are_those_of_the_scene() -> None:
    for scale, text in ((1.0, "2 Å"), (1e3, "200 nm"), (1e-5, "2e-05 Å")):
        svg = molviz.draw((SCENE * scale, RADII * scale), scale_bar=2 * scale).svg()
        assert f">{text}</text>" in svg
    for scale in (1.0, 1e3, 1e-5):
        drawing = molviz.draw((SCENE * scale, RADII * scale), orient="file")
        told = json.loads(drawing.to("json"))
        center = np.array([one["center"] for one in sorted(told["spheres"], key=lambda one: one["atom"])])
        assert np.allclose(center, SCENE * scale, rtol=0, atol=1e-4 * 1.8 * scale)
        with pytest.raises(InputError, match=f"more than {2.55 * scale:.2f}"[:13]):
            molviz.draw((SCENE * scale, RADII * scale), perspective=0.5 * scale, orient="file")


def test_what_a_table_gives_radii_is_drawn_in_angstrom() -> None:
    molecule = Molecule.of("x", SCENE, np.array(["C", "N", "O", "H", "S"]))
    for options in ({}, {"scale_radii": 0.01}, {"radii": "covalent"}):
        assert molviz.draw(molecule, style="flat", **options)._options.unit == 1.0  # type: ignore[arg-type]
    assert molviz.draw((SCENE, RADII * 0.4))._options.unit == 1.0
    assert molviz.draw((SCENE, RADII * 0.04))._options.unit == 0.1


@settings(deadline=None, max_examples=40)
@given(st.lists(st.tuples(*[st.floats(allow_nan=False, allow_infinity=False)] * 3,
                          st.floats(min_value=5e-324, allow_infinity=False)), min_size=1, max_size=5))  # fmt: skip
def test_any_balls_are_answered_or_refused(rows: list[tuple[float, ...]]) -> None:
    table = np.array(rows)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", UserWarning)
        for action in (molviz.measure, molviz.draw, lambda x: molviz.draw(x, method="painter", style="flat")):
            try:
                action((table[:, :3], table[:, 3]))
            except InputError as wrong:
                assert "expected" in str(wrong)


@pytest.mark.parametrize("command", [["measure", "--json"], ["info", "--json"], ["draw", "-o", "x.svg"]])
@pytest.mark.parametrize("rows", [[(1e300, 0, 0, 1)], [(0, 0, 0, 1e308), (1, 0, 0, 1)], [(0, 0, 0, 1e-200)]])
def test_what_doubles_do_not_hold_is_named(
    command: list[str], rows: object, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result = run(*command, balls(tmp_path / "x.xyzr", rows))
    assert result.exit_code == 1 and re.search(r"atom 1 has a (coordinate|radius) of \S+ Å; expected", result.stderr)
    assert not result.stdout or not json.loads(result.stdout)["results"]


def test_an_atom_too_far_to_be_placed_is_measured_and_not_drawn(tmp_path: Path) -> None:
    source = balls(tmp_path / "x.xyzr", [(0, 0, 0, 1.0), (0, 5e19, 0, 1.0)])
    assert json.loads(run("measure", "--json", source).stdout)["results"][0]["area"] == pytest.approx(8 * np.pi)
    result = run("draw", source, "-o", str(tmp_path / "x.svg"))
    assert result.exit_code == 1 and "lost in the rounding" in result.stderr and not (tmp_path / "x.svg").exists()


@pytest.mark.parametrize("words", [["--select", f"resi {DIGITS}-{DIGITS}"], ["--select", f"x < {DIGITS}"],
    ["--select", f"within {DIGITS} of all"], ["--model", DIGITS], ["--probe", DIGITS], ["--scale-radii", DIGITS],
    ["--rotate", f"x,{DIGITS}"], ["--turntable", DIGITS], ["--label", f"resi {DIGITS}"]])  # fmt: skip
def test_options_of_thousands_of_digits_are_answered(words: list[str], tmp_path: Path) -> None:
    source = balls(tmp_path / "x.xyzr", np.column_stack([SCENE, RADII]))
    assert run("draw", source, "-o", str(tmp_path / "x.svg"), *words).stderr


def test_residues_of_thousands_of_digits_are_selected() -> None:
    residue = np.array(["5", DIGITS, "7A"])
    molecule = Molecule.of("x", np.zeros((3, 3)), np.array(["C"] * 3), residue=residue)
    assert select(molecule, f"resi 6-{DIGITS}").tolist() == [False, True, True]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("distance", ["1e300", "1e155", "1e20", "2", "1e-300", "0"])
def test_any_distance_selects(distance: str) -> None:
    position = np.array([[0.0, 0, 0], [1.9, 0, 0], [1e60, 0, 0], [1e60, -1e60, 3]])
    molecule = Molecule.of("x", position, np.array(["O", "C", "C", "C"]))
    gap = np.linalg.norm(position, axis=1)
    assert select(molecule, f"within {distance} of element O").tolist() == (gap <= float(distance)).tolist()


NOT_TOML = ["x = " + "[" * 5000 + "]" * 5000, "[" + "a." * 3000 + "b]\nx = 1", f"[elements]\nC = {DIGITS}",
            "[elements]\nC = 0x" + "f" * 5000, "title = " + "0x" + "f" * 5000]  # fmt: skip


@pytest.mark.parametrize("text", NOT_TOML)
@pytest.mark.parametrize("load", [load_table, load_palette])
def test_toml_without_end_is_refused(load: object, text: str, tmp_path: Path) -> None:
    path = tmp_path / "x.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as error:
        load(str(path))  # type: ignore[operator]
    assert str(path) in str(error.value) and len(str(error.value)) < 500
