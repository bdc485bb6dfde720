"""The front door for Python: the options of the command line, drawings in any format, warnings and errors."""

import inspect
import pydoc
import subprocess
import sys
import warnings
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import click
import numpy as np
import pytest
from click.testing import CliRunner, Result
from hypothesis import given
from hypothesis import strategies as st

import molviz
from molviz.cli import main
from molviz.cli.draw import draw_command
from molviz.cli.measure import measure_command
from molviz.cli.surface import surface_command
from molviz.errors import InputError, InternalError
from molviz.geometry.general_position import Degenerate, first_general
from molviz.geometry.measure import measure_spheres
from molviz.model.spheres import Spheres
from molviz.picture.options import DrawOptions
from molviz.picture.palette import load_palette
from molviz.pipeline.draw import DrawRequest, draw_request_from, suffixes
from molviz.pipeline.inputs import InputOptions, loaded_from
from molviz.pipeline.outputs import pieces_of
from molviz.pipeline.values import (
    input_options_from,
    parse_background,
    parse_chains,
    parse_margin,
    parse_rotations,
    parse_width,
    view_options_from,
)
from molviz.pipeline.views import ViewOptions, checked_view
from molviz.readers import read

SAMPLES = Path(__file__).parent.parent / "samples"
CAFFEINE = str(SAMPLES / "caffeine.xyz")
PROTEIN = str(SAMPLES / "1a8o.pdb")
FUNCTIONS: list[Callable[..., Any]] = [molviz.draw, molviz.measure, molviz.visible, molviz.Scene]


def run(*words: str) -> Result:
    return CliRunner().invoke(main, list(words))


# ---- one set of options


NOT_IN_PYTHON = {
    "inputs": "x is the first argument, and one thing is drawn by a call",
    "output": "save(path) says where",
    "to": "to(format) says what",
    "format_": "read(path, format=…) says what a file is; standard input is the command line's",
    "unpack_all": "read(path, unpack_all=True) reads such an archive",
    "show": "a notebook shows a drawing by itself",
    "threads": "molviz.threads.use(number)",
    "quiet": "Python's warning filters do it",
    "strict": "Python's warning filters do it",
    "plotter": "of one format: to('hpgl', plotter=…), save(path, plotter=…)",
    "paper": "of one format, as the plotter",
    "mesh": "of files: Surface.mesh(kind, edge), save(path, mesh=…)",
    "edge": "of meshes, as their kind",
    "jobs": "one thing is drawn by a call",
    "dask": "one thing is drawn by a call",
    "per": "measure gives the areas of all atoms as an array",
    "as_json": "measure gives arrays",
    "as_csv": "measure gives arrays",
}


def options_of(command: click.Command) -> dict[str, Any]:
    usual = {option.name: option.default for option in command.params if option.name not in NOT_IN_PYTHON}
    multiple = {option.name for option in command.params if isinstance(option, click.Option) and option.multiple}
    return {str(name): default if name not in multiple else tuple(default or ()) for name, default in usual.items()}


def keywords_of(function: Callable[..., Any]) -> dict[str, Any]:
    return {name: one.default for name, one in inspect.signature(function).parameters.items() if name != "x"}


COMMANDS = [(molviz.draw, draw_command), (molviz.measure, measure_command), (molviz.surface, surface_command)]


@pytest.mark.parametrize(("function", "command"), COMMANDS)
def test_keywords_are_the_long_options_with_their_defaults(
    function: Callable[..., Any], command: click.Command
) -> None:
    with click.Context(command):
        assert keywords_of(function) == options_of(command)


@pytest.mark.parametrize("function", FUNCTIONS)
def test_the_same_option_has_the_same_default_everywhere(function: Callable[..., Any]) -> None:
    usual = keywords_of(molviz.draw) | {"view": None}
    assert all(usual[name] == default for name, default in keywords_of(function).items())
    assert keywords_of(molviz.measure).keys() <= keywords_of(function).keys()


def test_tables_of_options_have_the_same_defaults() -> None:
    usual = keywords_of(molviz.draw)
    assert input_options_from(usual) == InputOptions(water=None)
    assert input_options_from(keywords_of(molviz.measure)) == InputOptions()
    assert view_options_from(usual) == ViewOptions()
    assert draw_request_from(usual) == DrawRequest(DrawOptions(load_palette("tide")))


@pytest.mark.parametrize(
    ("words", "keywords"),
    [
        ("--width 300", {"width": 300}),
        ("--width 8cm --margin 0", {"width": "8cm", "margin": 0}),
        ("--rotate x,30 --rotate y,-10", {"rotate": [("x", 30), ("y", -10)]}),
        ("--rotate x,30 --rotate y,-10", {"rotate": ["x,30", ("Y", -10.0)]}),
        ("--rotate z,12.5", {"rotate": ("z", 12.5)}),
        ("--rotate z,12.5", {"rotate": "z,12.5"}),
        ("--chain A,B --color-by chain", {"chain": ["A", "B"], "color_by": "chain"}),
        ("--chain A --model 1", {"chain": "A", "model": "1"}),
        ("--background #ffffee", {"background": (255, 255, 238)}),
        ("--background white", {"background": np.array([255, 255, 255])}),
        ("--no-water --no-hydrogens --fill none", {"no_water": True, "no_hydrogens": True, "fill": "none"}),
        ("--select", {"select": "resi 160-170"}),
        ("--perspective 150 --page a4 --outline 2 --crease 0", {"perspective": 150, "page": "a4", "outline": 2,
                                                               "crease": 0}),
        ("--radii alvarez --scale-radii 0.5 --probe 0.1", {"radii": "alvarez", "scale_radii": 0.5, "probe": 0.1}),
        ("--style print --method painter --scale 3", {"style": "print", "method": "painter", "scale": 3}),
        ("--color-by exposure --legend --orient file", {"color_by": "exposure", "legend": True, "orient": "file"}),
    ],
)  # fmt: skip
def test_python_and_the_command_line_draw_the_same(
    words: str, keywords: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("molviz.cli.draw.drawn_by", lambda source: "")  # what Python has no words for
    path = tmp_path / "x.svg"
    more = [keywords["select"]] if words == "--select" else []
    result = run("draw", PROTEIN, "-o", str(path), *words.split(), *more)
    assert result.exit_code == 0, result.output
    assert molviz.draw(PROTEIN, **keywords).svg() == path.read_text(encoding="utf-8")
    assert path.read_text(encoding="utf-8") != molviz.draw(PROTEIN).svg() or words == "--chain A --model 1"


PARTS = """\
HETATM    1  CA  GLY A   1       0.000   0.000   0.000  1.00 10.00           C
HETATM    2  HA  GLY A   1       1.000   0.000   0.000  1.00 10.00           H
HETATM    3  CA  GLY B   2       0.000   9.000   0.000  1.00 10.00           C
HETATM    4  O   HOH B   3       0.000   0.000   9.000  1.00 10.00           O
HETATM    5  H1  HOH A   4       9.000   9.000   0.000  1.00 10.00           H
"""


@pytest.mark.parametrize(
    ("keywords", "rows"),
    [({}, [0, 1, 2, 3, 4]), ({"no_water": True}, [0, 1, 2]), ({"no_hydrogens": True}, [0, 2, 3]),
     ({"chain": "A"}, [0, 1, 4]), ({"chain": ["B", "A"]}, [0, 1, 2, 3, 4]), ({"chain": " B , C"}, [2, 3]),
     ({"select": "resi 1-3"}, [0, 1, 2, 3]), ({"select": "chain A", "no_water": True}, [0, 1]),
     ({"select": "chain A", "no_hydrogens": True, "no_water": True}, [0]), ({"chain": ""}, [0, 1, 2, 3, 4])],
)  # fmt: skip
def test_the_part_that_is_drawn_obeys_every_option(keywords: dict[str, Any], rows: list[int], tmp_path: Path) -> None:
    path = tmp_path / "parts.pdb"
    path.write_text(PARTS, encoding="ascii")
    scene = molviz.Scene(path, **keywords)
    assert scene.molecule.row.tolist() == rows and len(scene.spheres.radius) == len(rows)
    drawing = molviz.draw(path, water=True, **keywords)
    assert (drawing.atoms_read, drawing.atoms_drawn) == (5, len(rows))
    assert len(molviz.visible(path, **keywords).area) == len(molviz.measure(path, **keywords).area) == len(rows)


def test_what_leaves_nothing_names_the_chains_there_are(tmp_path: Path) -> None:
    path = tmp_path / "parts.pdb"
    path.write_text(PARTS, encoding="ascii")
    with pytest.raises(InputError, match="no atoms are left.*A, B$"):
        molviz.draw(path, select="resi 77")
    with pytest.raises(InputError, match="not named$"):
        molviz.draw(([[0, 0, 0]], [1]), no_water=True, select="chain A")


def test_models_and_assemblies_are_those_asked_for(tmp_path: Path) -> None:
    """The second model has two atoms; its assembly 2 has a copy 30 Å along x."""
    head = "REMARK 350 BIOMOLECULE: {}\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n"
    rows = "REMARK 350   BIOMT1   {0}  1.000000  0.000000  0.000000       {1:8.5f}\n" \
           "REMARK 350   BIOMT2   {0}  0.000000  1.000000  0.000000        0.00000\n" \
           "REMARK 350   BIOMT3   {0}  0.000000  0.000000  1.000000        0.00000\n"  # fmt: skip
    lines = PARTS.splitlines(keepends=True)
    models = f"MODEL        1\n{lines[0]}ENDMDL\nMODEL        2\n{lines[0]}{lines[1]}ENDMDL\n"
    path = tmp_path / "two.pdb"
    path.write_text(head.format(1) + rows.format(1, 0.0) + head.format(2) + rows.format(1, 0.0)
                    + rows.format(2, 30.0) + models, encoding="ascii")  # fmt: skip
    parts: list[tuple[dict[str, Any], list[float]]] = [
        ({}, [0]), ({"model": 2}, [0, 1]), ({"model": "1"}, [0]), ({"assembly": "1", "model": 2}, [0, 1]),
        ({"assembly": "2", "model": 2}, [0, 1, 30, 31]), ({"assembly": "2"}, [0, 30]),
    ]  # fmt: skip
    for keywords, x in parts:
        with pytest.warns(UserWarning, match="the models differ in atoms: from 1 to 2"):
            assert sorted(molviz.Scene(path, **keywords).molecule.position[:, 0].tolist()) == x, keywords
    for number in (0, 3, -1, 1.5, "3-4", "x", ""):
        with pytest.raises(InputError, match="model"):
            molviz.draw(path, model=number)  # type: ignore[arg-type]
    assert [one.model for one in loaded_from(read(path), InputOptions(model="all"))] == [1, 2]


def test_atoms_smaller_than_a_pixel_are_those_4000_radii_apart() -> None:
    for reach, told in ((7990.0, 0), (8010.0, 1)):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            molviz.Scene(([[0, 0, 0], [0, reach, 0]], [2.0, 1.0]))
        assert [str(one.message).count("extend over") for one in caught] == [1] * told


# ---- drawings


def test_the_map_is_verified_where_that_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*arguments: object) -> None:
        raise InternalError("a face is open")

    for stage in ("draw", "visible"):
        monkeypatch.setattr(f"molviz.pipeline.{stage}.check_map", fails)
    assert molviz.draw(CAFFEINE).arcs
    seen = molviz.visible(CAFFEINE)
    for check in (partial(molviz.draw, CAFFEINE, check=True), seen.check):
        with pytest.raises(InternalError, match="a face is open"):
            check()


@pytest.mark.parametrize("suffix", ["", ".tiff", ".json", "svg"])
def test_a_picture_has_no_other_formats_than_the_writers(suffix: str) -> None:
    with pytest.raises(InputError, match="no format is called .*expected"):
        pieces_of(molviz.draw(CAFFEINE)._picture, suffix)


def test_the_usual_plotter_is_one() -> None:
    drawing = molviz.draw(CAFFEINE)
    assert b"".join(pieces_of(drawing._pen_picture, ".hpgl")) == drawing.to("hpgl")


@pytest.mark.parametrize("suffix", suffixes())
def test_a_drawing_has_every_format(suffix: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("molviz.cli.draw.drawn_by", lambda source: "")
    drawing, path = molviz.draw(CAFFEINE), tmp_path / f"x{suffix}"
    assert run("draw", CAFFEINE, "-o", str(path)).exit_code == 0
    assert drawing.to(suffix) == drawing.to(suffix.removeprefix(".").upper()) == path.read_bytes()
    again = tmp_path / f"y{suffix.upper()}"
    drawing.save(again)
    assert again.read_bytes() == path.read_bytes()


def test_a_notebook_is_shown_the_svg() -> None:
    drawing = molviz.draw(CAFFEINE)
    assert drawing._repr_svg_() == drawing.svg() == drawing.to("svg").decode()


def test_what_is_seen_is_computed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    drawing = molviz.draw(CAFFEINE)
    monkeypatch.setattr("molviz.pipeline.draw.Scene", None)
    drawing.svg()
    monkeypatch.setattr("molviz.pipeline.draw.picture_of_map", None)
    assert drawing.to("pdf") and drawing.to("json")


def test_plotters_are_chosen_where_a_drawing_is_written(tmp_path: Path) -> None:
    drawing, path = molviz.draw(CAFFEINE), tmp_path / "x.hpgl"
    assert drawing.to("hpgl", paper="a3") != drawing.to("hpgl")
    drawing.save(path, paper="a3")
    assert path.read_bytes() == drawing.to("hpgl", paper="a3")
    with pytest.raises(InputError, match="plotter"):
        drawing.to("hpgl", plotter="none")


def test_formats_that_nobody_knows_and_files_that_cannot_be_are_refused(tmp_path: Path) -> None:
    drawing = molviz.draw(CAFFEINE)
    for wrong in ("tiff", "", 5):
        with pytest.raises(InputError, match="^format: .*expected one of .svg"):
            drawing.to(wrong)  # type: ignore[arg-type]
    for name in ("x", "x.tiff", "-"):
        with pytest.raises(InputError, match="^path: no format"):
            drawing.save(tmp_path / name if name != "-" else name)
    assert not list(tmp_path.iterdir())
    with pytest.raises(InputError, match="cannot be written"):
        drawing.save("/proc/none/x.svg")
    with pytest.raises(InputError, match="expected method visible"):
        molviz.draw(CAFFEINE, method="painter").to("json")


def test_numbers_of_a_drawing_are_those_of_the_summary(tmp_path: Path) -> None:
    result = run("draw", PROTEIN, "--no-water", "-o", str(tmp_path / "x.svg"))
    drawing = molviz.draw(PROTEIN, no_water=True)
    assert (drawing.atoms_read, drawing.atoms_drawn) == (644, 556)
    assert 0 < drawing.visible < drawing.atoms_drawn
    told = f"644 atoms read, 556 drawn, {drawing.visible} visible, {drawing.arcs} arcs, "
    assert told in result.stderr


# ---- what is shown of objects


def test_every_public_object_is_shown_in_one_line() -> None:
    reading = molviz.read(PROTEIN)
    scene = molviz.Scene(reading.models[0])
    shown = [
        reading, reading.models[0], molviz.draw(PROTEIN), molviz.visible(PROTEIN), scene, scene.spheres, scene.view,
        scene.map()[0], molviz.measure(PROTEIN), molviz.surface(CAFFEINE),
    ]  # fmt: skip
    for one in shown:
        assert "\n" not in repr(one) and len(repr(one)) < 120, repr(one)
        assert type(one).__name__ in repr(one)
    odd = molviz.Molecule.of("two\nlines", [[0, 0, 0]], ["C"])
    assert "\n" not in repr(odd) + repr(molviz.draw(odd)) + repr(molviz.Scene(odd))


def test_the_names_of_the_package_are_listed_and_explained() -> None:
    names = ["Drawing", "DrawingSet", "Index", "InputError", "InternalError", "Measure", "Molecule", "Reading",
             "Scene", "Surface", "View", "Visible", "draw", "measure", "read", "surface", "view",
             "visible"]  # fmt: skip
    assert dir(molviz) == names
    text = pydoc.plain(pydoc.render_doc(molviz))
    for name in names:
        assert name in text and getattr(molviz, name).__doc__, name
    assert "rotate" in pydoc.plain(pydoc.render_doc(molviz.draw))
    with pytest.raises(AttributeError, match="no attribute 'drawn'"):
        molviz.drawn  # noqa: B018


def test_reading_twice_reads_twice() -> None:
    code = f"""
import molviz
first = molviz.read({CAFFEINE!r})
from molviz import read
assert callable(read) and read is molviz.read
second = molviz.read({CAFFEINE!r})
assert len(first.models[0]) == len(second.models[0]) == len(read({CAFFEINE!r}).models[0]) == 24
"""
    subprocess.run([sys.executable, "-c", code], check=True)
    assert molviz.read is read
    with pytest.raises(InputError, match="^path: int is no path"):
        molviz.read(5)  # type: ignore[arg-type]


def test_naming_what_is_drawn_with_imports_next_to_nothing() -> None:
    """Numpy alone takes about 70 ms; no more than a fifth of that may come on top."""
    code = "import sys; old = set(sys.modules); import molviz; molviz.draw; print(*sorted(set(sys.modules) - old))"
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    imported = set(done.stdout.split())
    assert not {"numpy", "click", "gemmi", "svgwrite", "typing", "dataclasses", "inspect"} & imported
    assert {name for name in imported if name.startswith("molviz")} == {
        "molviz", "molviz.pipeline", "molviz.pipeline.door"
    }  # fmt: skip


# ---- what is wrong


numbers = st.sampled_from([float("nan"), float("inf"), -float("inf"), -1.0, "x", None, [], True, -1e-9, 1e10])


@given(st.sampled_from(FUNCTIONS), numbers)
def test_a_probe_that_is_no_length_is_refused_by_name(function: Callable[..., Any], probe: object) -> None:
    if probe is None:
        return
    with pytest.raises(ValueError, match="^probe: "):
        function(([[0, 0, 0]], [1]), probe=probe)


@pytest.mark.parametrize(
    ("name", "value"),
    [("scale_radii", 0), ("scale_radii", float("nan")), ("scale", -1), ("scale", float("inf")), ("width", "wide"),
     ("width", 0), ("width", True), ("margin", -1), ("outline", "thick"), ("crease", float("nan")), ("rotate", "x"),
     ("rotate", 30), ("rotate", [("w", 30)]), ("rotate", [("x", float("inf"))]), ("rotate", ("x", None)),
     ("background", (1, 2)), ("background", (0, 0, 256)), ("background", "pinkish"), ("background", (0.5, 0, 0)),
     ("perspective", 0), ("perspective", float("nan")), ("chain", 5), ("chain", "Z"), ("select", 5),
     ("select", "mood"), ("color_by", "mood"), ("method", "magic"), ("orient", "up"), ("page", "a5"), ("fill", "full"),
     ("style", "nope"), ("radii", "nope"), ("model", 2), ("model", 0), ("model", "1-2"), ("assembly", "7"),
     ("color", "crimson")],
)  # fmt: skip
def test_a_wrong_value_is_refused_by_name(name: str, value: object) -> None:
    with pytest.raises(InputError, match=f"(?i){name}"):
        molviz.draw(PROTEIN, **{name: value})


@pytest.mark.parametrize(
    ("x", "told"),
    [
        (([[0, 0, 0]], [1, 2]), "^radii: 2 for 1 centers"),
        (([[0, 0, float("nan")]], [1]), "^centers: row 0 is not finite"),
        (([[0, 0, 0], [0, float("inf"), 0]], [1, 1]), "^centers: row 1 is not finite"),
        (([[0, 0, 0]], [0]), "^radii: row 0 is 0.0"),
        (([[0, 0, 0]], [-1]), "^radii: row 0 is -1.0"),
        (([[0, 0, 0]], [float("inf")]), "^radii: row 0 is inf"),
        (([[0, 0, 0]], [float("nan")]), "^radii: row 0 is nan"),
        (([0, 0, 0], [1]), r"^centers: numbers of shape \(3,\); expected \(n, 3\)"),
        ((np.zeros((2, 2)), [1, 1]), r"^centers: numbers of shape \(2, 2\)"),
        (([[0, 0, 0]], [[1]]), r"^radii: numbers of shape \(1, 1\); expected \(n\)"),
        (([[0, 0, 0]], 1), r"^radii: numbers of shape \(\)"),
        (([["a", "b", "c"]], [1]), "^centers: not a table of numbers"),
        (([[1j, 0, 0]], [1]), "^centers: not a table of numbers"),
        (([[0, 0], [0, 0, 0]], [1, 1]), "^centers: not a table of numbers"),
        (([], []), "^x: no atoms"),
        (5, "^x: int is nothing made of spheres; expected a path"),
        (None, "^x: NoneType"),
        (([[0, 0, 0]], [1], 3), "^x: tuple"),
        ("missing.pdb", "^missing.pdb: cannot be read"),
    ],
)
@pytest.mark.parametrize("function", FUNCTIONS)
def test_what_is_not_made_of_spheres_is_refused(function: Callable[..., Any], x: object, told: str) -> None:
    with pytest.raises(InputError, match=told):
        function(x)


@pytest.mark.parametrize(
    ("column", "values"),
    [("position", [[0, 0, float("nan")]]), ("radius", [0.0]), ("radius", [float("inf")]), ("chain", ["A", "B"]),
     ("bfactor", ["high"]), ("element", [["C"]]), ("row", [0, 1])],
)  # fmt: skip
def test_a_molecule_of_wrong_columns_is_refused_by_name(column: str, values: list[Any]) -> None:
    columns: dict[str, Any] = {"position": [[0, 0, 0]], "element": ["C"]} | {column: values}
    with pytest.raises(InputError, match=f"^{column}: "):
        molviz.Molecule.of("wrong", **columns)


@pytest.mark.parametrize(
    "view",
    [5, molviz.View(np.zeros((3, 3)), np.zeros(3)), molviz.View(np.eye(2), np.zeros(3)),
     molviz.View(np.diag([1.0, 1, -1]), np.zeros(3)), molviz.View(np.full((3, 3), np.nan), np.zeros(3)),
     molviz.View(np.eye(3) * 1.1, np.zeros(3)), molviz.View(np.diag([2.0, 1, 1]), np.zeros(3)),
     molviz.View(np.eye(3) + np.eye(3, k=1) / 100, np.zeros(3)), molviz.View(np.eye(3), np.zeros(3), np.inf),
     molviz.View(np.eye(3), np.zeros(3), 0.0), molviz.View(np.eye(4), np.zeros(3)),
     molviz.View(np.eye(3), np.array([0, 0, np.inf])), molviz.View(np.eye(3), np.zeros(2)),
     molviz.View(np.eye(3), np.zeros(3), -5.0), molviz.View(np.eye(3), np.zeros(3), float("nan"))],
)  # fmt: skip
def test_a_wrong_view_is_refused_by_name(view: Any) -> None:
    scene = molviz.Scene(CAFFEINE)
    for look in (scene.map, scene.pieces, partial(molviz.visible, CAFFEINE)):
        with pytest.raises(InputError, match="^view: "):
            look(view)


def test_views_that_turn_but_for_rounding_are_taken() -> None:
    scene = molviz.Scene(CAFFEINE)
    for turn in range(0, 360, 15):
        view = scene.view.rotated("x", turn).rotated("y", turn / 2)
        nearly = molviz.View(view.rotation * (1 + 1e-8), view.center)
        lists = molviz.View(view.rotation.tolist(), view.center.tolist())  # type: ignore[arg-type]
        for one in (view, nearly, lists):
            assert checked_view(one, scene.spheres).rotation == pytest.approx(view.rotation)


@pytest.mark.parametrize(
    ("name", "value"),
    [("rotate", "x,"), ("rotate", "30,x"), ("rotate", ("x", 1, 2)), ("rotate", "x,1e9"), ("rotate", [("x", "a")]),
     ("background", "#12345"), ("background", (1, 2, 3, 4)), ("background", (-1, 0, 0)), ("scale", True),
     ("scale", "1e-7"), ("scale", 2e9), ("outline", -1e-9), ("probe", "1e10"), ("margin", "-0"), ("assembly", 5)],
)  # fmt: skip
def test_values_just_outside_are_refused(name: str, value: object) -> None:
    with pytest.raises(InputError, match=f"^{name}: "):
        molviz.draw(CAFFEINE, **{name: value})


def test_words_and_values_mean_the_same() -> None:
    assert parse_rotations("Z, 9") == parse_rotations(("z", 9)) == parse_rotations([(" z", "9")]) == (("z", 9.0),)
    assert parse_rotations(["x,1", "y,2"]) == parse_rotations((("x", 1), ["y", 2])) == (("x", 1.0), ("y", 2.0))
    assert parse_rotations([]) == () and parse_rotations([("x", 1), ("y", 2), ("z", 3)])[2] == ("z", 3.0)
    assert parse_background("None") is parse_background(None) is None
    assert parse_background((0, 255, 7)) == parse_background([0.0, 255, 7]) == (0, 255, 7)
    assert parse_background("#fff") == parse_background("white") == (255, 255, 255)
    assert parse_margin(0) == parse_margin("0") == parse_margin(0.0) == 0.0 and parse_margin("1in") == 72.0
    assert parse_width(3) == parse_width("3pt") == 3.0
    assert parse_chains("A, B") == parse_chains(["A", "B"]) == ("A", "B") and parse_chains(None) == ()


# ---- what is odd


@pytest.mark.parametrize("function", FUNCTIONS)
def test_what_is_odd_is_a_warning_at_the_line_of_the_caller(function: Callable[..., Any]) -> None:
    odd = molviz.Molecule.of("odd", [[0, 0, 0], [0, 0, 0]], ["X", "C"])
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        function(odd)
    assert [str(one.message).partition(",")[0] for one in told] == [
        "x: 1 atoms at exactly the place of an earlier atom", "x: radius guessed as 2.00 Å"
    ]  # fmt: skip
    assert {one.filename for one in told} == {__file__}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        function(CAFFEINE)


# ---- scenes


def test_a_scene_is_seen_from_anywhere_as_by_visible() -> None:
    scene = molviz.Scene(PROTEIN, no_water=True, select="chain A")
    for view in (None, scene.view.rotated("y", 30)):
        seen, row = scene.map(view)
        expected = molviz.visible(PROTEIN, view, no_water=True)
        assert len(seen.left) == len(expected.left)
        assert set(row[seen.loops.face[seen.loops.face >= 0]]) == set(np.flatnonzero(expected.area))
        pieces, own = scene.pieces(view)
        assert len(pieces.order) >= np.count_nonzero(expected.area) and own.max() < len(scene.molecule)


# ---- numbers that mislead


def test_exposure_is_that_of_the_tables_radii_whatever_is_drawn() -> None:
    molecule = molviz.read(PROTEIN).models[0]
    area = molviz.measure(molecule, probe=1.4).area
    usual = molviz.draw(PROTEIN, color_by="exposure", legend=True).svg()
    for name in (f"{area.min():.3g}", f"{area.max():.3g}"):
        assert name in usual
    colors = [exposure_colors(molviz.draw(PROTEIN, color_by="exposure", **more)) for more in
              ({}, {"probe": 1.0}, {"scale_radii": 0.5})]  # fmt: skip
    assert colors[0] == colors[1] == colors[2]


def exposure_colors(drawing: molviz.Drawing) -> list[Any]:
    from molviz.picture.coloring import on_ramp
    from molviz.pipeline.draw import color_values

    colors = drawing._options.chosen_style().colors
    return on_ramp(color_values(drawing._loaded, "exposure"), colors.ramp, colors.unknown)


def test_measuring_has_no_probe_unless_asked_for() -> None:
    one = molviz.measure(([[0, 0, 0]], [2.0]))
    assert one.volume == pytest.approx(32 * np.pi / 3) and one.area.sum() == pytest.approx(16 * np.pi)
    assert molviz.measure(([[0, 0, 0]], [2.0]), 1.0).area.sum() == pytest.approx(36 * np.pi)
    molecule = molviz.read(PROTEIN).models[0]
    kept = molviz.measure(PROTEIN, no_water=True, scale_radii=0.9)
    spheres = molviz.Scene(molecule, no_water=True).spheres
    assert kept.volume == measure_spheres(Spheres(spheres.center, 0.9 * spheres.radius)).volume


# ---- failures of molviz itself


def test_an_input_error_is_a_value_error_and_an_internal_one_is_not() -> None:
    assert issubclass(InputError, ValueError) and not issubclass(InternalError, ValueError)


def test_what_never_becomes_general_is_an_internal_failure() -> None:
    def query(attempt: int) -> None:
        raise Degenerate

    with pytest.raises(InternalError, match="special position.*failure of molviz: please report it"):
        first_general(query)


@pytest.mark.parametrize(
    ("failure", "told"),
    [(InternalError("a face is open"), "a face is open; "), (ZeroDivisionError("division\nby zero"),
     "ZeroDivisionError: division by zero; "), (KeyError("x"), "KeyError: 'x'; ")],
)  # fmt: skip
def test_internal_failures_are_one_line_and_status_70(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, failure: Exception, told: str
) -> None:
    def fails(*arguments: object, **named: object) -> None:
        raise failure

    monkeypatch.setattr("molviz.pipeline.draw.Scene", fails)
    words = ["draw", str(tmp_path / "missing.pdb"), CAFFEINE, "-o", str(tmp_path / "{stem}.svg")]
    result = run(*words)
    assert result.exit_code == 70 and not list(tmp_path.iterdir())
    missing, line = result.stderr.splitlines()
    assert "cannot be read" in missing
    assert line.startswith(f"molviz: {told}this is a failure of molviz: please report it together with the input")
    monkeypatch.setattr("molviz.cli.hidden_lines.random_discs", fails)
    result = run("hidden-lines", "--random", "10")
    assert result.exit_code == 70 and len(result.stderr.splitlines()) == 1
