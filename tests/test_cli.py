"""The command line as a user meets it."""

import json
import os
import subprocess
import sys
from itertools import product
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from click.testing import CliRunner, Result

from molviz.cli import main
from molviz.cli.main import COMMANDS
from molviz.errors import InputError
from molviz.model.spheres import Spheres
from molviz.pipeline.info import closest_ratio
from molviz.pipeline.outputs import save, target_of

SAMPLES = Path(__file__).parent.parent / "samples"
CAFFEINE = str(SAMPLES / "caffeine.xyz")
PROTEIN = str(SAMPLES / "1a8o.pdb")


def run(*words: str, stdin: bytes = b"") -> Result:
    return CliRunner().invoke(main, list(words), input=stdin)


def drawn(tmp_path: Path, *words: str, suffix: str = ".json") -> bytes:
    target = tmp_path / f"picture{suffix}"
    result = run("draw", *words, "-o", str(target), "--quiet")
    assert result.exit_code == 0, result.output
    return target.read_bytes()


@pytest.mark.parametrize(
    ("method", "suffix"),
    [("visible", ".json"), ("visible", ".hpgl"),
     *product(["visible", "painter"], [".svg", ".svgz", ".ps", ".eps", ".pdf"])],
)
def test_every_format_is_written_twice_the_same(tmp_path: Path, method: str, suffix: str) -> None:
    once = drawn(tmp_path, CAFFEINE, "--method", method, suffix=suffix)
    assert once == drawn(tmp_path, CAFFEINE, "--method", method, suffix=suffix)
    assert len(once) > 500


@pytest.mark.parametrize("suffix", [".json", ".hpgl"])
def test_what_cannot_be_painted_is_refused(tmp_path: Path, suffix: str) -> None:
    result = run("draw", CAFFEINE, "--method", "painter", "-o", str(tmp_path / f"x{suffix}"))
    assert result.exit_code == 1 and "expected method visible" in result.stderr


def test_the_summary_is_one_line_on_standard_error(tmp_path: Path) -> None:
    result = run("draw", CAFFEINE, "-o", str(tmp_path / "c.svg"))
    assert result.stdout == ""
    assert len(result.stderr.splitlines()) == 1
    for word in ("24 atoms read", "visible", "arcs", "bytes", " s"):
        assert word in result.stderr


def test_json_is_the_map_of_the_contract(tmp_path: Path) -> None:
    data = json.loads(drawn(tmp_path, PROTEIN, "--check", "--orient", "file"))
    assert (data["format"], data["version"], data["units"]) == ("molviz-visibility-map", 1, "angstrom")
    assert np.allclose(data["view"], np.eye(3))
    for number, arc in enumerate(data["arcs"]):
        assert set(arc) == {"kind", "spheres", "c", "u", "v", "start", "sweep", "left", "right", "from", "to"}
        assert arc["sweep"] > 0 and (arc["kind"] == "crease") == (arc["spheres"][1] >= 0), number
    for face in data["faces"]:
        for loop in face["loops"]:
            for edge, following in zip(loop, loop[1:] + loop[:1], strict=True):
                assert data["arcs"][edge >> 1]["right" if edge & 1 else "left"] == face["sphere"]
                end, begin = "from" if edge & 1 else "to", "to" if following & 1 else "from"
                assert data["arcs"][edge >> 1][end] == data["arcs"][following >> 1][begin]


def test_json_spheres_lie_where_the_file_has_them(tmp_path: Path) -> None:
    data = json.loads(drawn(tmp_path, CAFFEINE, "--orient", "file"))
    lines = Path(CAFFEINE).read_text(encoding="utf-8").splitlines()[2:]
    for sphere in data["spheres"]:
        expected = [float(word) for word in lines[sphere["atom"]].split()[1:4]]
        assert np.allclose(sphere["center"], expected, atol=2e-4)


def test_turning_about_the_line_of_sight_changes_no_area(tmp_path: Path) -> None:
    straight = json.loads(drawn(tmp_path, PROTEIN))
    turned = json.loads(drawn(tmp_path, PROTEIN, "--rotate", "z,37"))
    areas = [{face["sphere"]: face["area"] for face in data["faces"]} for data in (straight, turned)]
    atoms = [[sphere["atom"] for sphere in data["spheres"]] for data in (straight, turned)]
    by_atom = [{atoms[k][sphere]: area for sphere, area in areas[k].items()} for k in (0, 1)]
    assert by_atom[0].keys() == by_atom[1].keys()
    assert all(np.isclose(by_atom[0][atom], by_atom[1][atom], atol=1e-9) for atom in by_atom[0])


def test_standard_input_and_output() -> None:
    words = ["-", "--format", "xyz", "-o", "-", "--to", "svg", "--quiet"]
    result = run("draw", *words, stdin=Path(CAFFEINE).read_bytes())
    assert result.exit_code == 0
    root = ElementTree.fromstring(result.stdout_bytes)
    titles = [element.text for element in root.iter("{http://www.w3.org/2000/svg}title")]
    assert "N 4" in titles or any(title and title.startswith("N ") for title in titles)


def test_several_inputs_go_into_a_folder_and_one_bad_file_stops_nothing(tmp_path: Path) -> None:
    bad = tmp_path / "bad.xyz"
    bad.write_text("2\n\nC 0 0 0\n", encoding="utf-8")
    result = run("draw", CAFFEINE, str(bad), PROTEIN, "-o", f"{tmp_path}/out/", "--to", "svg")
    assert result.exit_code == 1
    assert f"molviz: {bad}:1:" in result.stderr
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["1a8o.svg", "caffeine.svg"]


def test_several_inputs_to_one_file_are_a_usage_error(tmp_path: Path) -> None:
    assert run("draw", CAFFEINE, PROTEIN, "-o", str(tmp_path / "one.svg")).exit_code == 2


def test_a_pattern_names_the_outputs(tmp_path: Path) -> None:
    assert run("draw", CAFFEINE, PROTEIN, "-o", str(tmp_path / "{stem}-x.svg"), "--quiet").exit_code == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["1a8o-x.svg", "caffeine-x.svg"]


def test_names_of_outputs_come_from_the_inputs(tmp_path: Path) -> None:
    packed = str(SAMPLES / "c60.xyz")
    assert run("draw", "-", "--format", "xyz", "-o", f"{tmp_path}/new/", "--to", "svg", "--quiet",
               stdin=Path(packed).read_bytes()).exit_code == 0  # fmt: skip
    assert [path.name for path in (tmp_path / "new").iterdir()] == ["stdin.svg"]
    assert target_of("a/1abc.pdb.gz", f"{tmp_path}", ".svg") == f"{tmp_path}/1abc.svg"  # a folder that is there
    assert target_of("a/1abc.pdb.gz", "b/{stem}{stem}.ps", ".svg") == "b/1abc1abc.ps"
    assert target_of("a.gz/x.y.cif", "b/", ".svg") == "b/x.y.svg" and target_of("x", "b", ".svg") == "b"


def test_files_have_the_usual_permissions_or_keep_theirs(tmp_path: Path) -> None:
    before = os.umask(0o027)
    try:
        save(str(tmp_path / "a" / "new.svg"), [b"1"], make_folder=True)
        (tmp_path / "old.svg").touch()
        (tmp_path / "old.svg").chmod(0o604)
        save(str(tmp_path / "old.svg"), [b"2"])
        assert os.umask(0o027) == 0o027
    finally:
        os.umask(before)
    modes = [path.stat().st_mode & 0o777 for path in (tmp_path / "a" / "new.svg", tmp_path / "old.svg")]
    assert modes == [0o640, 0o604] and (tmp_path / "old.svg").read_bytes() == b"2"


def test_a_failure_while_writing_leaves_nothing(tmp_path: Path) -> None:
    """A folder cannot be replaced by a file."""
    (tmp_path / "x.svg").mkdir()
    with pytest.raises(InputError, match="cannot be written"):
        save(str(tmp_path / "x.svg"), [b"1"])
    assert [path.name for path in tmp_path.iterdir()] == ["x.svg"] and (tmp_path / "x.svg").is_dir()


def test_a_failure_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
    target = tmp_path / "old.svg"
    target.write_text("old", encoding="utf-8")
    assert run("draw", str(tmp_path / "missing.pdb"), "-o", str(target)).exit_code == 1
    assert target.read_text(encoding="utf-8") == "old"
    assert [path.name for path in tmp_path.iterdir()] == ["old.svg"]


def test_an_output_that_cannot_be_written_is_told() -> None:
    result = run("draw", CAFFEINE, "-o", "/proc/none/x.svg")
    assert result.exit_code == 1 and "cannot be written" in result.stderr


@pytest.mark.parametrize(
    "words",
    [[], ["-o", "x.tiff"], ["-o", "x.svg", "--rotate", "30"], ["-o", "x.svg", "--width", "-3cm"],
     ["-o", "x.svg", "--background", "pinkish"]],
)  # fmt: skip
def test_a_wrong_command_line_exits_with_two(words: list[str]) -> None:
    result = run("draw", CAFFEINE, *words)
    assert result.exit_code == 2 and "Traceback" not in result.output


def test_warnings_become_errors_when_strict(tmp_path: Path) -> None:
    odd = tmp_path / "odd.xyz"
    odd.write_text("1\n\nXx 0 0 0\n", encoding="utf-8")
    assert run("draw", str(odd), "-o", str(tmp_path / "x.svg")).exit_code == 0
    strict = run("draw", str(odd), "-o", str(tmp_path / "y.svg"), "--strict")
    assert strict.exit_code == 1 and not (tmp_path / "y.svg").exists()


def test_sizes_are_what_was_asked_for(tmp_path: Path) -> None:
    wide = drawn(tmp_path, CAFFEINE, "--width", "10cm", "--margin", "0", "--outline", "0", suffix=".svg")
    assert b'width="284pt"' in wide  # 283.46 points, rounded up to whole ones
    paper = drawn(tmp_path, CAFFEINE, "--page", "a4", suffix=".ps")
    assert b"PageSize[595.28 841.89]" in paper


def test_info_tells_the_hard_sphere_model() -> None:
    result = run("info", CAFFEINE, "--json")
    told = json.loads(result.stdout)["results"][0]
    assert told["atoms"] == 24 and told["elements"] == {"C": 8, "H": 10, "N": 4, "O": 2}
    assert told["k"] == pytest.approx(1.7 / 1.2)
    assert told["bonds"] == 25 and 0.4 < told["rho"] < 1 and told["max_neighbours"] >= told["mean_neighbours"] > 4
    assert told["components"] == 1


def test_info_has_the_fields_of_the_contract(tmp_path: Path) -> None:
    path = tmp_path / "row.xyzr"
    path.write_text("0 0 0 1\n1.5 0 0 1\n3 0 0 2\n20 0 0 0.5\n", encoding="ascii")
    (told,) = json.loads(run("info", str(path), "--json").stdout)["results"]
    assert told == {
        "file": str(path), "format": "xyzr", "model": 1, "models": 1, "title": "row", "atoms": 4, "bonds": 0,
        "elements": {"X": 4}, "k": 4.0, "rho": 0.75, "max_neighbours": 2, "mean_neighbours": 1.0, "components": 2,
    }  # fmt: skip


@pytest.mark.parametrize(
    "rows",
    [[(0, 0, 0, 1)], [(0, 0, 0, 1), (0, 0, 7, 2)], [(0, 0, 0, 9), (0, 0, 20, 9), (0, 50, 0, 0.1), (0, 50, 2, 0.1)],
     [(0, 0, 0, 0.1), (0, 0, 3, 0.1), (90, 0, 0, 9), (90, 30, 0, 9)], [(0, 0, 0, 1), (0, 0, 0, 2)],
     [(0, 0, 0, 0.5), (0, 4, 0, 0.5), (100, 0, 0, 10), (139, 0, 0, 10)]],
)  # fmt: skip
def test_rho_is_the_least_distance_in_radii(rows: list[tuple[float, ...]]) -> None:
    """Over all pairs, each in units of the larger of its radii; of one ball there is none."""
    table = np.array(rows, dtype=float)
    ratios = [np.linalg.norm(table[a, :3] - table[b, :3]) / max(table[a, 3], table[b, 3])
              for a in range(len(rows)) for b in range(a)]  # fmt: skip
    expected = pytest.approx(min(ratios)) if ratios else None
    assert closest_ratio(Spheres(table[:, :3], table[:, 3])) == expected


def test_a_help_text_with_an_example_for_every_command() -> None:
    for name in main.list_commands(None):  # type: ignore[arg-type]
        assert f"molviz {name}" in run(name, "--help").output.replace("Usage: main", "")


def test_nothing_heavy_is_imported_for_help() -> None:
    code = "import sys, molviz.cli; sys.argv = ['molviz', '--help']; " \
        "import atexit; atexit.register(lambda: print({'numpy', 'gemmi', 'svgwrite', 'pydyf'} & set(sys.modules))); " \
        "molviz.cli.run()"
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert done.stdout.endswith("set()\n") and "hidden-lines" in done.stdout


def test_help_tells_of_every_command_what_the_command_does() -> None:
    for name, (_, told) in COMMANDS.items():
        assert told.split()[0] == run(name, "--help").output.splitlines()[2].split()[0]


@pytest.mark.parametrize(
    "words",
    [["--rotate", "x,nan"], ["--rotate", "x,inf"], ["--perspective", "nan"], ["--perspective", "1e300"],
     ["--scale", "nan"], ["--scale", "inf"], ["--scale", "0"], ["--outline", "nan"], ["--crease", "inf"],
     ["--scale-radii", "nan"], ["--scale-radii", "1e-300"], ["--probe", "nan"], ["--probe", "inf"],
     ["--width", "1e9cm"], ["--width", "nancm"], ["--width", "wide"], ["--margin", "-1cm"]],
)  # fmt: skip
def test_numbers_without_a_picture_are_usage_errors(words: list[str], tmp_path: Path) -> None:
    result = run("draw", CAFFEINE, "-o", str(tmp_path / "x.svg"), *words)
    assert result.exit_code == 2, result.output
    assert f"'{words[0]}'" in result.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.filterwarnings("error")
def test_an_eye_among_the_atoms_is_told_in_one_line(tmp_path: Path) -> None:
    result = run("draw", CAFFEINE, "-o", str(tmp_path / "x.svg"), "--perspective", "2")
    assert result.exit_code == 1
    assert result.stderr.startswith("molviz: ") and "perspective: " in result.stderr and "2.24 Å" in result.stderr


@pytest.mark.parametrize("text", ["[lines]\ncolor = 3\n", "lines = 3\n", "[colors]\nelement = 3\n", "x = [\n"])
def test_a_style_that_is_none_is_told_with_its_name(tmp_path: Path, text: str) -> None:
    style = tmp_path / "mine.toml"
    style.write_text(text, encoding="utf-8")
    result = run("draw", CAFFEINE, "-o", str(tmp_path / "x.svg"), "--style", str(style))
    assert result.exit_code == 2
    assert result.stderr.startswith(f"molviz: {style}: not a style: ")


def test_a_model_number_in_other_digits_is_no_number(tmp_path: Path) -> None:
    result = run("draw", CAFFEINE, "-o", str(tmp_path / "x.svg"), "--model", "²")
    assert result.exit_code == 2 and "no model or frame '²'" in result.stderr


def test_discs_of_several_inputs_do_not_overwrite_each_other(tmp_path: Path) -> None:
    words = ["hidden-lines", CAFFEINE, PROTEIN, "--as", "discs", "-o", str(tmp_path / "one.svg")]
    assert run(*words).exit_code == 2
    assert not list(tmp_path.iterdir())


def test_discs_show_one_model_and_json_is_of_discs(tmp_path: Path) -> None:
    two = tmp_path / "two.xyz"
    two.write_text("1\n\nC 0 0 0\n" * 2, encoding="utf-8")
    result = run("hidden-lines", str(two), "--as", "discs", "--model", "all", "--json")
    assert result.exit_code == 2 and "expected --model NUMBER" in result.stderr
    assert run("hidden-lines", CAFFEINE, "--json", "-o", str(tmp_path / "x.svg")).exit_code == 2


def test_an_input_taken_for_a_fill_is_named() -> None:
    assert "no fill 'mine.xyz'" in run("hidden-lines", "--fill", "mine.xyz").stderr


def test_atoms_smaller_than_a_pixel_are_told(tmp_path: Path) -> None:
    far = tmp_path / "far.xyz"
    far.write_text("2\n\nC -1e8 0 0\nC 1e8 0 0\n", encoding="utf-8")
    result = run("draw", str(far), "-o", str(tmp_path / "x.svg"))
    assert result.exit_code == 0
    assert f"molviz: warning: {far}: the atoms extend over 2e+08 Å" in result.stderr
    assert "extend" not in run("draw", PROTEIN, "-o", str(tmp_path / "y.svg")).stderr


def test_a_name_too_long_for_a_file_is_told() -> None:
    result = run("draw", CAFFEINE, "-o", "x" * 300 + ".svg")
    assert result.exit_code == 1 and "cannot be written" in result.stderr


@pytest.mark.parametrize("words", ["draw - -o - --to svg --format xyz", "info - --format xyz", "draw --help"])
@pytest.mark.parametrize("ends", ["<&-", ">&- ", "2>&-", "> /dev/full"])
def test_closed_or_full_ends_leave_no_traceback(words: str, ends: str) -> None:
    shell = f"exec 0< '{CAFFEINE}'; '{sys.executable}' -m molviz {words} {ends}"
    done = subprocess.run(["sh", "-c", shell], capture_output=True, text=True, check=False)
    assert done.returncode in (0, 1)
    assert "Traceback" not in done.stderr and "Exception" not in done.stderr
    if ends == "> /dev/full":
        assert done.returncode == 1 and "cannot be written" in done.stderr


@pytest.mark.parametrize("scheme", ["element", "chain"])
def test_names_that_mean_something_to_a_format_stay_names(tmp_path: Path, scheme: str) -> None:
    rows = [
        f"HETATM{number:5d} {name:<4} {residue} {chain}   1{insertion}   {number * 2.5:8.3f}   0.000   0.000"
        f"  1.00  0.00           C"
        for number, (name, residue, chain, insertion) in enumerate(
            [("<&>", 'A">', "<", " "), ("C)(\\", 'A">', "<", "A"), ("--", "]]>", "&", " "), ("--", "]]>", "&", "A"),
             ("CA", "%()", "'", " "), ("CA", "%()", "(", " ")]
        )
    ]  # fmt: skip
    odd = tmp_path / "odd<&>.pdb"
    odd.write_text("\n".join(rows) + "\n", encoding="ascii")
    root = ElementTree.fromstring(drawn(tmp_path, str(odd), "--color-by", scheme, suffix=".svg"))
    ids = [element.get("id") for element in root.iter() if element.get("id")]
    assert len(ids) == len(set(ids)) > len(rows)
    assert drawn(tmp_path, str(odd), suffix=".pdf").startswith(b"%PDF")
    assert all(32 <= byte < 127 or byte == 10 for byte in drawn(tmp_path, str(odd), suffix=".ps"))
