"""Clashes against all distances: the geometry, ``Index.clashes`` and ``molviz clash``."""

import csv
import io
import json
import warnings
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result
from hypothesis import given
from hypothesis import strategies as st

import molviz
from molviz.cli import main
from molviz.errors import InputError
from molviz.geometry.clashes import Clashes, Placements, clashes
from molviz.geometry.cubes import BallIndex
from molviz.model.spheres import Spheres
from molviz.pipeline import clash as pipeline
from tests.oracle import random_spheres

SAMPLES, FOUND = Path(__file__).parent.parent / "samples", Path(__file__).parent / "found"
CAFFEINE, PROTEASE = str(SAMPLES / "caffeine.xyz"), str(SAMPLES / "1hpv.pdb.gz")
APART = "1 0 0 50  0 1 0 0  0 0 1 0"


def random_placements(seed: int, count: int, far: float) -> Placements:
    """Rotations by the QR decomposition, reflections among them, and shifts."""
    random = np.random.default_rng(seed)
    rotation = np.linalg.qr(random.normal(size=(count, 3, 3)))[0]
    return Placements(rotation, random.uniform(-far, far, (count, 3)))


def expected(a: Spheres, b: Spheres, placements: Placements, tolerance: float) -> list[tuple[int, int, int]]:
    pairs = []
    for number, (rotation, translation) in enumerate(zip(*placements, strict=True)):
        moved = b.center @ rotation.T + translation
        gap = np.linalg.norm(moved[:, None] - a.center, axis=2)
        deep = b.radius[:, None] + a.radius - gap > tolerance
        pairs += [(number, int(i), int(j)) for j, i in np.argwhere(deep)]
    return pairs


def found(result: Clashes) -> list[tuple[int, int, int]]:
    return list(zip(result.placement.tolist(), result.a.tolist(), result.b.tolist(), strict=True))


@given(st.integers(0, 10_000), st.integers(1, 40), st.integers(1, 40), st.integers(0, 5), st.floats(-6, 4),
       st.floats(1, 20))  # fmt: skip
def test_pairs_equal_all_distances(
    seed: int, count: int, others: int, placed: int, tolerance: float, spread: float
) -> None:
    a, b = random_spheres(seed, count, 8.0), random_spheres(seed + 1, others, 5.0, spread)
    placements = random_placements(seed, placed, 6.0)
    result = clashes(BallIndex(a), b, placements, tolerance)
    assert found(result) == expected(a, b, placements, tolerance)
    for number in range(placed):
        rows = slice(result.start[number], result.start[number + 1])
        assert (result.placement[rows] == number).all() and result.count[number] == len(result.a[rows])
        assert result.deepest[number] == result.overlap[rows].max(initial=-np.inf)
    gap = a.radius[result.a] + b.radius[result.b] - result.distance
    assert np.array_equal(gap, result.overlap) and (result.overlap > tolerance).all()


@pytest.mark.parametrize("shift", [0.0, 1e6, 1e12])
def test_balls_that_touch_overlap_by_nothing(shift: float) -> None:
    """Whole numbers: two balls beside each other, one upon the other, one that only touches by the tolerance."""
    a = BallIndex(Spheres(np.array([[shift, 0, 0]]), np.array([2.0])))
    b = Spheres(np.array([[4.0, 0, 0], [0, 0, 0], [5, 0, 0], [3, 0, 0]]) + [shift, 0, 0], np.array([2.0, 1, 2, 2]))
    assert found(clashes(a, b)) == [(0, 0, 1), (0, 0, 3)]
    assert clashes(a, b).overlap.tolist() == [3.0, 1.0]
    assert found(clashes(a, b, tolerance=1.0)) == [(0, 0, 1)]
    assert found(clashes(a, b, tolerance=-1.0)) == [(0, 0, 0), (0, 0, 1), (0, 0, 3)]
    assert found(clashes(a, b, tolerance=-1.5)) == [(0, 0, 0), (0, 0, 1), (0, 0, 2), (0, 0, 3)]


def test_many_placements_go_through_several_blocks() -> None:
    a, b = random_spheres(1, 50, 8.0), random_spheres(2, 600, 8.0)
    placements = random_placements(3, 900, 20.0)
    result = clashes(BallIndex(a), b, placements)
    assert len(result.count) == 900 and 0 < np.count_nonzero(result.count) < 900
    for number in (0, 450, 899):
        alone = clashes(BallIndex(a), b, Placements(*(column[number : number + 1] for column in placements)))
        rows = slice(result.start[number], result.start[number + 1])
        assert np.array_equal(alone.a, result.a[rows]) and np.allclose(alone.overlap, result.overlap[rows], atol=1e-12)


def test_more_pairs_than_there_is_room_for_are_refused() -> None:
    spheres = random_spheres(1, 50, 2.0)
    with pytest.raises(InputError, match="more than 100 pairs; expected a larger one"):
        clashes(BallIndex(spheres), spheres, tolerance=-1e9, most=100)


# ---- from Python


def matrices(placements: Placements) -> np.ndarray:
    matrix = np.tile(np.eye(4), (len(placements.rotation), 1, 1))
    matrix[:, :3, :3], matrix[:, :3, 3] = placements
    return matrix


def test_placements_are_matrices_or_rotations_and_translations() -> None:
    a, b = (random_spheres(seed, 30, 6.0) for seed in (1, 2))
    placements = random_placements(3, 7, 5.0)
    index, other = molviz.Index((a.center, a.radius)), molviz.Index((b.center, b.radius))
    result = index.clashes(other, matrices(placements))
    assert found(result) == expected(a, b, placements, 0.0) == found(index.clashes(other, tuple(placements)))
    assert found(result) == found(index.clashes((b.center, b.radius), list(matrices(placements))))
    assert found(index.clashes(other, list(matrices(placements)[:2]))) == expected(
        a, b, Placements(placements.rotation[:2], placements.translation[:2]), 0.0
    )
    one = index.clashes(other, matrices(placements)[4])
    assert found(one) == [(0, i, j) for number, i, j in found(result) if number == 4]
    assert found(one) == found(index.clashes(other, (placements.rotation[4], placements.translation[4])))
    assert found(index.clashes(other)) == found(index.clashes(other, np.eye(4)))
    assert len(index.clashes(other, np.empty((0, 4, 4))).count) == 0
    assert repr(result) == f"<Clashes: {len(result.a)} pairs in 7 placements>"


@pytest.mark.parametrize(
    ("placements", "told"),
    [(np.eye(3), "shape"), (2 * np.eye(4), "last row"), (np.diag([1, 1, 2, 1]), "more than turn"), ("x", "not a table"),
     (np.full((4, 4), np.nan), "not finite"), ((np.eye(3)[None], np.zeros((2, 3))), "1 rotations and 2 translations"),
     ((np.eye(3), [1, 2]), "shape"), ((np.eye(3), [1e61, 0, 0]), "above"), (([[1, 2], [3]], 0), "not a table"),
     ([[1e60, 0, 0, 0], *np.eye(4)[1:]], "more than turn")],
)  # fmt: skip
def test_what_is_no_rigid_motion_is_refused(placements: object, told: str) -> None:
    index = molviz.Index(([[0, 0, 0]], [1]))
    with pytest.raises(InputError, match=f"placements: .*{told}"):
        index.clashes(index, placements)


@pytest.mark.parametrize("tolerance", [np.nan, np.inf, "1", None, 1e61])
def test_what_is_no_tolerance_is_refused(tolerance: object) -> None:
    index = molviz.Index(([[0, 0, 0]], [1]))
    with pytest.raises(InputError, match="tolerance: .*expected a finite number"):
        index.clashes(index, tolerance=tolerance)


# ---- the command


def run(*words: str, stdin: bytes = b"") -> Result:
    return CliRunner().invoke(main, ["clash", *words], input=stdin)


def told(*words: str) -> dict:
    done = run(*words, "--json", "--quiet")
    assert done.exit_code == 0, done.output
    result: dict = json.loads(done.stdout)
    assert result["count"] == len(result["pairs"])
    assert result["deepest"] == max((pair["overlap"] for pair in result["pairs"]), default=None)
    return result


def test_a_drug_in_its_pocket() -> None:
    """Amprenavir in HIV-1 protease: rows are those of the file, names those of the atoms, the deepest pair first."""
    result = told(PROTEASE, PROTEASE, "--select", "protein", "--select-b", "resn 478", "--no-hydrogens")
    whole = molviz.read(PROTEASE).models[0]
    deep = [pair["overlap"] for pair in result["pairs"]]
    assert 5 < len(deep) < 50 and deep == sorted(deep, reverse=True)
    for pair in result["pairs"]:
        a, b = pair["a"], pair["b"]
        assert pair["distance"] == pytest.approx(np.linalg.norm(whole.position[a] - whole.position[b]), abs=1e-12)
        assert pair["a_id"].endswith(f"/{whole.residue_name[a]}{whole.residue[a]}/{whole.atom_name[a]}")
        assert whole.residue_name[b] == "478"
    assert result["pairs"][0]["a_id"] == "A/ASP25/OD1"  # of the catalytic pair, which binds the drug's hydroxyl


def test_the_json_holds_what_was_agreed() -> None:
    result = told(CAFFEINE, CAFFEINE, "--probe", "0.5", "--tolerance", "-0.25")
    assert list(result) == ["files", "models", "radii", "probe", "tolerance", "pairs", "count", "deepest"]
    assert (result["files"], result["models"]) == ([CAFFEINE, CAFFEINE], [1, 1])
    assert (result["radii"], result["probe"], result["tolerance"]) == ("bondi", 0.5, -0.25)
    assert list(result["pairs"][0]) == ["a", "a_id", "b", "b_id", "distance", "overlap"]
    assert result["pairs"][0] == {"a": 0, "a_id": "C1", "b": 0, "b_id": "C1", "distance": 0.0, "overlap": 4.4}


def test_csv_is_the_json_to_the_last_digit() -> None:
    done = run(CAFFEINE, CAFFEINE, "--csv")
    rows = list(csv.DictReader(io.StringIO(done.stdout)))
    pairs = told(CAFFEINE, CAFFEINE)["pairs"]
    assert [{name: str(value) for name, value in pair.items()} for pair in pairs] == rows


def test_nothing_overlaps_where_the_other_is_far() -> None:
    assert told(CAFFEINE, CAFFEINE, "--transform", APART)["pairs"] == []
    assert run(CAFFEINE, CAFFEINE, "--transform", APART, "--csv").stdout == "a,a_id,b,b_id,distance,overlap\n"
    table = run(CAFFEINE, CAFFEINE, "--transform", APART).stdout.splitlines()
    assert "24 atoms, moved" in table[2] and table[3:] == ["0 pairs overlap by more than 0 Å"]


def test_the_table_names_atoms_and_the_deepest() -> None:
    lines = run(CAFFEINE, CAFFEINE, "--tolerance", "3.39").stdout.splitlines()
    assert "Bondi 1964" in lines[0] and "moved" not in "".join(lines)
    assert lines[3] == "8 pairs overlap by more than 3.39 Å, the deepest by 3.400" and len(lines) == 12
    assert lines[4] == "  C1   C1   distance    0.000  overlap    3.400"


TURNED = "0 -1 0 1\n1 0 0 2\n0 0 1 3"


@pytest.mark.parametrize(
    "toml",
    ["matrix = [[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3]]",
     "matrix = [[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]",
     "rotation = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]\ntranslation = [1, 2, 3.0]"],
)  # fmt: skip
def test_a_transform_moves_b(toml: str, tmp_path: Path) -> None:
    path, shifted = tmp_path / "x.toml", tmp_path / "moved.xyz"
    path.write_text(toml, encoding="ascii")
    molecule = molviz.read(CAFFEINE).models[0]
    x, y, z = molecule.position.T
    rows = zip(molecule.element, 1 - y, 2 + x, 3 + z, strict=True)
    shifted.write_text("24\n\n" + "".join(f"{e} {x!r} {y!r} {z!r}\n" for e, x, y, z in rows).replace("np.float64", "")
                       .replace("(", "").replace(")", ""), encoding="ascii")  # fmt: skip
    results = [told(CAFFEINE, CAFFEINE, "--transform", text) for text in (str(path), TURNED, TURNED + "\n0, 0, 0, 1")]
    plain = told(CAFFEINE, str(shifted))
    assert results[0]["pairs"] == results[1]["pairs"] == results[2]["pairs"] == plain["pairs"]
    assert 0 < plain["count"] < 24 * 24


def test_a_part_of_a_rotation_or_a_translation_is_enough(tmp_path: Path) -> None:
    path = tmp_path / "x.toml"
    for text, same in [("translation = [50, 0, 0]", APART), ("rotation = [[1, 0, 0], [0, -1, 0], [0, 0, -1]]",
                       "1 0 0 0 0 -1 0 0 0 0 -1 0")]:  # fmt: skip
        path.write_text(text, encoding="ascii")
        pairs = told(CAFFEINE, CAFFEINE, "--transform", str(path))["pairs"]
        assert pairs == told(CAFFEINE, CAFFEINE, "--transform", same)["pairs"]


@pytest.mark.parametrize(
    ("words", "text"),
    [(["--transform", "1 2 3"], "3 numbers; expected 3 or 4 rows"), (["--transform", "no.toml"], "neither numbers nor"),
     (["--transform", "1 0 0 0 0 2 0 0 0 0 1 0"], "more than turn"), (["--transform", "x.toml"], "'shift'; expected"),
     (["--transform", "nan 0 0 0 0 1 0 0 0 0 1 0"], "not finite"), (["--transform", ""], "neither numbers"),
     (["--transform", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2"], "last row"), (["--transform", "bad.toml"], "is no TOML"),
     (["--transform", "flat.toml"], "shape (3,)"), (["--transform", "empty.toml"], "no keys"),
     (["--tolerance", "deep"], "not a number"), (["--tolerance", "inf"], "not a number"),
     (["--select-b", "watr"], "did you mean 'water'"), (["--model", "all"], "expected a number from 1"),
     (["--model-b", "1-2"], "expected a number from 1"), (["--model-b", "2"], "the file has 1"),
     (["--json", "--csv"], "exclude each other")],
)  # fmt: skip
def test_a_wrong_command_line_exits_2(
    words: list[str], text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name, content in [("x", "shift = [1, 2, 3]"), ("bad", "="), ("flat", "matrix = [1, 2, 3]"), ("empty", "")]:
        (tmp_path / f"{name}.toml").write_text(content, encoding="ascii")
    done = run(CAFFEINE, CAFFEINE, *words)
    assert done.exit_code == 2 and text in done.stderr and not done.stdout


def test_inputs_that_cannot_be_used_exit_1(tmp_path: Path) -> None:
    assert run(CAFFEINE, str(tmp_path / "missing.pdb")).exit_code == 1
    done = run(CAFFEINE, CAFFEINE, "--select-b", "element Fe")
    assert done.exit_code == 1 and "no atoms are left" in done.stderr and not done.stdout


def test_standard_input_is_one_of_the_two() -> None:
    data = Path(CAFFEINE).read_bytes()
    pairs = told(CAFFEINE, CAFFEINE)["pairs"]
    for words in ([CAFFEINE, "-"], ["-", CAFFEINE]):
        assert json.loads(run(*words, "--json", "--format", "xyz", stdin=data).stdout)["pairs"] == pairs
    assert run("-", PROTEASE, "--format", "xyz", "--quiet", stdin=data).exit_code == 0  # the format of - alone
    assert run("-", "-", "--format", "xyz", stdin=data).exit_code == 2


def test_models_of_both_and_of_b_alone(tmp_path: Path) -> None:
    path = tmp_path / "frames.xyz"
    path.write_text("1\n\nC 0 0 0\n2\n\nC 0 0 0\nC 3 0 0\n", encoding="ascii")
    for words, models, count in [([], [1, 1], 1), (["--model", "2"], [2, 2], 4), (["--model-b", "2"], [1, 2], 2)]:
        result = told(str(path), str(path), *words)
        assert (result["models"], result["count"]) == (models, count)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("place", ["0 0 0", "1e60 -1e60 1e60", "123456789012 0 0"])
def test_one_atom_wherever_it_is(place: str, tmp_path: Path) -> None:
    path = tmp_path / "one.xyzr"
    path.write_text(f"{place} 1.5\n", encoding="ascii")
    (pair,) = told(str(path), str(path))["pairs"]
    assert (pair["distance"], pair["overlap"]) == (0.0, 3.0)
    assert told(str(path), str(path), "--tolerance", "3")["pairs"] == []
    assert told(str(path), str(path), "--tolerance", "-5")["count"] == 1


def test_names_leave_a_terminal_alone(tmp_path: Path) -> None:
    path = tmp_path / "\x1b[31m\x9b.xyz"
    path.write_bytes(Path(CAFFEINE).read_bytes())
    for words in ([], ["--csv"], ["--json"], ["--model-b", "\x1b"], ["--select-b", "\x1b"], ["--transform", "\x1b"]):
        done = run(str(path), str(path), *words)
        assert not set("\x1b\x9b") & set(done.stdout + done.stderr), words


@pytest.mark.parametrize("name", sorted(path.name for path in FOUND.iterdir() if path.suffix != ".md"))
def test_every_odd_input_overlaps_itself_or_is_explained(name: str) -> None:
    """Warnings of numpy count as failures: they reach the user's terminal."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        done = run(str(FOUND / name), str(FOUND / name), "--json", "--quiet")
    assert done.exit_code in (0, 1) and not done.stderr.startswith("Traceback")
    if done.exit_code == 0:
        pairs = json.loads(done.stdout, parse_constant=pytest.fail)["pairs"]
        alone = {pair["a"] for pair in pairs if pair["a"] == pair["b"]}
        assert alone == set(range(len(alone))) and {(pair["b"], pair["a"]) for pair in pairs} == {
            (pair["a"], pair["b"]) for pair in pairs
        }


def test_more_pairs_than_a_table_holds_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pipeline, "MOST_PAIRS", 500)
    done = run(CAFFEINE, CAFFEINE, "--tolerance", "-1000")
    assert done.exit_code == 1 and "more than 500 pairs; expected a larger one" in done.stderr
