"""The language of selections, against plain sentences of Python."""

from pathlib import Path

import gemmi
import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st

from molviz.cli import main
from molviz.errors import InputError
from molviz.model.molecule import Molecule
from molviz.model.selection import grammar, is_hydrogen, is_water, select
from molviz.pipeline.inputs import InputOptions, load
from tests.pdb_lines import atom

MOLECULE = Molecule.of(
    "m",
    np.array([[0, 0, 0], [3, 0, 0], [6, 0, 0], [0, 8, 0], [0, 0, 20], [0, 1, 20]], dtype=float),
    np.array(["N", "C", "H", "O", "Fe", "D"]),
    atom_name=np.array(["N", "CB", "HB1", "O5'", "FE", "D1"]),
    residue_name=np.array(["ALA", "ALA", "ALA", "DG", "HEM", "HOH"]),
    residue=np.array(["-3", "-3", "-3", "56A", "60", "9"]),
    chain=np.array(["A", "A", "A", "b", "", ""]),
    segment=np.array(["S1", "S1", "S1", "S2", "", ""]),
    hetero=np.array([False, False, False, False, True, True]),
    bfactor=np.array([10, 20, 30, 40, np.nan, 50.0]),
)


@pytest.mark.parametrize(
    ("expression", "rows"),
    [
        ("all", [0, 1, 2, 3, 4, 5]),
        ("none", []),
        ("chain A", [0, 1, 2]),
        ("chain A,b", [0, 1, 2, 3]),
        ("chain B", []),
        ('chain ""', [4, 5]),
        ("resn ala HEM", [0, 1, 2, 4]),
        ("resi 56A", [3]),
        ("resi 56", []),
        ("resid 50-60", [3, 4]),
        ("resi -5--3", [0, 1, 2]),
        ("name c* o5'", [1, 3]),
        ("name ?", [0]),
        ("element FE, n", [0, 4]),
        ("index 1-2 5", [1, 2, 5]),
        ("index >= 4", [4, 5]),
        ("bfactor < 30", [0, 1]),
        ("bfactor != 30", [0, 1, 3, 4, 5]),
        ("x > 2.5 and y <= 0", [1, 2]),
        ("water", [5]),
        ("not water", [0, 1, 2, 3, 4]),
        ("hydrogens", [2, 5]),
        ("protein", [0, 1, 2]),
        ("nucleic", [3]),
        ("backbone", [0, 3]),
        ("sidechain", [1]),
        ("water or chain A and element C", [1, 5]),
        ("(water or chain A) and hydrogens", [2, 5]),
        ("not not water", [5]),
        ("NOT (chain A OR water)", [3, 4]),
        ("within 3 of index 0", [0, 1]),
        ("within 3.5 of name CB", [0, 1, 2]),
        ("within 2 of water and resn HEM", [4]),
        ("within 5 of none", []),
        ('resn "ALA"', [0, 1, 2]),
        ("resid 50 to 60", [3, 4]),
        ("resi 50:60", [3, 4]),
        ("resi 50 : 60", [3, 4]),
        ("resi -5 to -1 60", [0, 1, 2, 4]),
        ("resi -5:-1+60", [0, 1, 2, 4]),
        ("resi 9, 55 to 57,60", [3, 4, 5]),
        ("resi > 9 and resi <= 60", [3, 4]),
        ("resn ALA+HEM", [0, 1, 2, 4]),
        ("resname ALA and elem C", [1]),
        ("elem C+Fe", [1, 4]),
        ("segid S1", [0, 1, 2]),
        ("segi s1", []),
        ("hetatm", [4, 5]),
        ("polymer", [0, 1, 2, 3]),
        ("ions", [4]),
        ("b < 30 & !name N", [1]),
        ("beta < 30 | water", [0, 1, 5]),
        ("byres name CB", [0, 1, 2]),
        ("byres water", [5]),
        ("same residue as name N", [0, 1, 2]),
        ("same chain as name FE", [4, 5]),
        ("same elem as index 5 4", [4, 5]),
        ("index 0 around 3", [1]),
        ("around 3 index 0", [1]),
        ("byres index 0 around 8 and nucleic", [3]),
        ("all within 3 of index 0", [0, 1]),
        ("protein and within 3 of index 0 or water", [0, 1, 5]),
        ("water around 2 and resn HEM", [4]),
        ("/1/A", [0, 1, 2]),
        ("/2/A", []),
        ("//A/-3/CB", [1]),
        ("/*/*/56A", [3]),
        ("/1//50-60", [3, 4]),
        ("/1//56.A", [3]),
        ("/1//(!ALA,HOH)", [3, 4]),
        ("/1//-3(ALA)/N,CB", [0, 1]),
        ("/1///*[C,Fe]", [1, 4]),
        ("/1/A/*/*[!H]", [0, 1]),
        ("/A", [0, 1, 2]),
        ("/A,b:-3,50-60", [0, 1, 2, 3]),
        ("/A:-5--1@CB", [1]),
        (":ALA,60", [0, 1, 2, 4]),
        ("@C*,N", [0, 1]),
        ("#1/A@N", [0]),
        ("#2", []),
        ("not (/A:-3@CB or @N)", [2, 3, 4, 5]),
        ("chain x", []),
        ("chain X or index 1", [1]),
        ("chain b x y and all", [3]),
        ('chain A "and"', [0, 1, 2]),
        ("chain within", []),
        ("resn NA+", []),
        ("name [C]B", []),
    ],
)
def test_meaning(expression: str, rows: list[int]) -> None:
    assert np.flatnonzero(select(MOLECULE, expression)).tolist() == rows


@pytest.mark.parametrize(
    ("expression", "place"),
    [
        ("", 1),
        ("frog", 1),
        ("chain", 6),
        ("chain and", 7),
        ("chain A and", 12),
        ("(chain A", 9),
        ("chain A)", 8),
        ("bfactor 3", 9),
        ("bfactor < many", 11),
        ("bfactor < nan", 11),
        ("within 5 chain A", 10),
        ("within chain A", 8),
        ("water water", 7),
        ("name ! CA", 6),
        ('chain "A', 7),
        ("and", 1),
        ("resid 160 to", 13),
        ("resid to 160", 7),
        ("chain A to C", 9),
        ("resi 10-", 6),
        ("resi 10 - x", 11),
        ("resi 10:20:2", 6),
        ("resi 10-20A", 6),
        ("resi ten", 6),
        ("resi 5 xyz name CA", 8),
        ("index 1.5", 7),
        ("elem Carbon", 6),
        ("chain A,", 9),
        ("chain A, and water", 10),
        ("chain A, , B", 10),
        ("water, protein", 6),
        ("chain A resi 5", 9),
        ("chain A water", 9),
        ("same as water", 6),
        ("same residue water", 14),
        ("around water", 8),
        ("water around", 13),
        ("chain /A", 7),
        ("/A:10@CA:3", 1),
        ("/A:", 1),
        ("/A:10-", 1),
        ("/A:<5", 1),
        ("/1/A/ten", 1),
        ("/x/A", 1),
        ("/1/A/10;q", 1),
        ("/1/A/10/CA:A", 1),
        ("/1/A/10/CA[Q]", 1),
        ("(" * 5000, 101),
        ("not " * 5000, 401),
    ],
)
def test_errors_name_the_place(expression: str, place: int) -> None:
    with pytest.raises(InputError, match=rf"position {place}: .*expected "):
        select(MOLECULE, expression)


def test_the_page_is_printed_and_stands_in_the_readme() -> None:
    result = CliRunner().invoke(main, ["help", "selections"])
    assert result.exit_code == 0 and result.stdout == grammar()
    readme = (Path(__file__).parent.parent / "README.md").read_text(encoding="utf-8")
    assert f"```text\n{grammar()}```" in readme


def test_help_knows_the_commands_too() -> None:
    assert CliRunner().invoke(main, ["help", "info"]).stdout.startswith("Usage: main info")
    assert "hidden-lines" in CliRunner().invoke(main, ["help"]).stdout
    wrong = CliRunner().invoke(main, ["help", "selection"])
    assert wrong.exit_code == 2 and "did you mean 'selections'?" in wrong.stderr


def test_words_that_were_meant_are_named() -> None:
    for wrong, meant in (("watr", "water"), ("protien", "protein"), ("chian A", "chain"), ("rezi 5", "resi")):
        with pytest.raises(InputError, match=f"did you mean '{meant}'"):
            select(MOLECULE, wrong)
    with pytest.raises(InputError, match="molviz help selections") as error:
        select(MOLECULE, "frog" * 1000)
    assert len(str(error.value)) < 400


def test_every_example_of_the_page_is_understood() -> None:
    """Lines of the page begin with a word and blanks; examples stand three blanks apart."""
    text = grammar()
    examples = [part for line in text.splitlines()[-4:] for part in line.strip().split("   ") if part.strip()]
    named = ["chain A", "segid PROA", "resi 52A", "resi 10 to 20", "resi -5--1", "resn ALA+GLY", "resi 5 10-20,30",
             'chain A "and"', "/1/A/10-20(ALA,GLY)/CA,CB[C]", "/*/A,B/10", "//A", "/1//(!HOH)",
             "/A,B:10-20,HEM@CA,CB", ":ALA", "@C*", "#1/A", "/A"]  # fmt: skip
    assert len(examples) == 6 and all(one in text for one in named)
    for example in [*examples, *named]:
        assert select(MOLECULE, example.strip()).shape == (6,)
    assert max(map(len, text.splitlines())) <= 120 and len(text.splitlines()) < 60


CIDS = ["//A", "/*/A,B/10-40", "//B/*/C5',P", "//A/(ALA,GLY)/CA", "//*/(!HOH)", "//*//*[N,O]", "//A/*(!ALA)/*[C]"]


@pytest.mark.parametrize("cid", CIDS)
def test_coordinate_ids_mean_what_they_mean_to_gemmi(cid: str) -> None:
    path = Path(__file__).parent.parent / "samples" / "1a1f.pdb"
    molecule = load(str(path), InputOptions())[0].molecule
    chosen = gemmi.Selection(cid).copy_structure_selection(gemmi.read_structure(str(path)))
    theirs = {(place.chain.name, str(place.residue.seqid), place.atom.name) for place in chosen[0].all()}
    rows = np.flatnonzero(select(molecule, cid))
    ours = {(molecule.chain[row], molecule.residue[row], molecule.atom_name[row]) for row in rows}
    assert ours == theirs and ours


def test_ligands_and_ions_and_what_is_near_them() -> None:
    molecule = load(str(Path(__file__).parent.parent / "samples" / "1hpv.pdb.gz"), InputOptions())[0].molecule
    ligand = select(molecule, "ligand")
    assert set(molecule.residue_name[ligand].tolist()) == {"478"} and ligand.sum() > 30
    near = select(molecule, "byres (polymer within 4 of ligand)")
    assert set(molecule.residue[near].tolist()) >= {"25", "50"} and not (near & ligand).any() and near.mean() < 0.3
    whole = set(zip(molecule.chain[near], molecule.residue[near], strict=True))
    every = [key in whole for key in zip(molecule.chain, molecule.residue, strict=True)]
    assert (np.array(every) & select(molecule, "polymer") == near).all()


def test_the_model_in_a_word_is_the_models_number(tmp_path: Path) -> None:
    one = atom() + "\n"
    path = tmp_path / "two.pdb"
    path.write_text(f"MODEL        1\n{one}ENDMDL\nMODEL        2\n{one}ENDMDL\n", encoding="ascii")
    assert len(load(str(path), InputOptions(model="2", select="/2/*"))[0].molecule) == 1
    with pytest.raises(InputError, match="no atoms are left"):
        load(str(path), InputOptions(select="/2/*"))


def test_columns_of_files(tmp_path: Path) -> None:
    other = atom(record="HETATM    2 ", xyz=f"{9:8.3f}{0:8.3f}{0:8.3f}")
    lines = [atom()[:72].ljust(72) + "PROA", other[:72].ljust(72) + "HETA"]
    (tmp_path / "x.pdb").write_text("\n".join(lines) + "\n", encoding="ascii")
    molecule = load(str(tmp_path / "x.pdb"), InputOptions())[0].molecule
    assert molecule.segment.tolist() == ["PROA", "HETA"] and molecule.hetero.tolist() == [False, True]
    assert select(molecule, "segid PROA or hetatm").all()


points = st.lists(st.tuples(*[st.floats(-30, 30)] * 3), min_size=1, max_size=40)


@given(points, st.floats(0, 20), st.integers(1, 40))
def test_within_is_the_distance_to_the_nearest(
    position: list[tuple[float, float, float]], reach: float, n: int
) -> None:
    place = np.array(position)
    molecule = Molecule.of("m", place, np.full(len(place), "C"))
    distance = np.sqrt(((place[:, None] - place[None, :n]) ** 2).sum(axis=2)).min(axis=1)
    chosen = select(molecule, f"within {reach!r} of index < {n}")
    assert (chosen == (distance <= reach))[abs(distance - reach) > 1e-9].all()


@given(st.text('()"<>=!&|,.-+*:/#@[]; abcdefghinorstw0123456789', max_size=30))
def test_any_text_is_understood_or_refused(expression: str) -> None:
    try:
        assert select(MOLECULE, expression).shape == (6,)
    except InputError as error:
        assert "expected" in str(error) or "did you mean" in str(error)


def test_helpers() -> None:
    assert is_water(MOLECULE).tolist() == [False] * 5 + [True]
    assert np.flatnonzero(is_hydrogen(MOLECULE)).tolist() == [2, 5]
