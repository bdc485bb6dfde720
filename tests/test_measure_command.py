"""``molviz measure`` and ``molviz.measure``: what adds up, what is exposed, how it is written."""

import csv
import io
import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from molviz.cli.measure import measure_command
from molviz.model.molecule import Molecule
from molviz.pipeline.door import measure
from molviz.pipeline.inputs import InputOptions, loaded_from
from molviz.pipeline.measure import PER, measurement
from molviz.pipeline.subject import reading_of

LINE = "ATOM  {:5d}  {:<3s} {:3s} {:1s}{:4d}    {:8.3f}{:8.3f}{:8.3f}  1.00 10.00          {:>2s}\n"
ATOMS = [
    ("N", "GLY", "A", 1, 0.0, 0.0, 0.0, "N"),
    ("CA", "GLY", "A", 1, 1.45, 0.0, 0.0, "C"),
    ("C", "GLY", "A", 1, 2.0, 1.4, 0.0, "C"),
    ("N", "ALA", "A", 2, 3.3, 1.5, 0.2, "N"),
    ("CA", "ALA", "A", 2, 3.9, 2.8, 0.3, "C"),
    ("O", "SER", "B", 1, 5.0, 4.5, 2.0, "O"),
]
PDB = "".join(LINE.format(row + 1, *atom) for row, atom in enumerate(ATOMS)) + "END\n"


@pytest.fixture
def peptide(tmp_path: Path) -> str:
    path = tmp_path / "peptide.pdb"
    path.write_text(PDB, encoding="ascii")
    return str(path)


def run(*words: str) -> Result:
    return CliRunner().invoke(measure_command, list(words))


def results(*words: str) -> list[dict]:
    done = run(*words, "--json")
    assert done.exit_code == 0, done.output
    found: list[dict] = json.loads(done.stdout)["results"]
    return found


@pytest.mark.parametrize(("per", "rows"), [("atom", 6), ("residue", 3), ("chain", 2)])
def test_parts_add_up_to_the_total(peptide: str, per: str, rows: int) -> None:
    (found,) = results(peptide, "--probe", "1.4", "--per", per)
    assert len(found["per"]) == rows
    assert abs(sum(row["area"] for row in found["per"]) - found["area"]) < 1e-9
    assert (found["model"], found["atoms"], found["radii"], found["probe"]) == (1, 6, "bondi", 1.4)


def test_names_of_parts(peptide: str) -> None:
    ids = {per: [row["id"] for row in results(peptide, "--per", per)[0]["per"]] for per in ("atom", "residue", "chain")}
    assert ids["chain"] == ["A", "B"]
    assert ids["residue"] == ["A/GLY1", "A/ALA2", "B/SER1"]
    assert ids["atom"][1] == "A/GLY1/CA"


def test_names_without_residues(tmp_path: Path) -> None:
    path = tmp_path / "two.xyz"
    path.write_text("2\n\nC 0 0 0\nO 1.2 0 0\n", encoding="ascii")
    assert [row["id"] for row in results(str(path), "--per", "atom")[0]["per"]] == ["C1", "O2"]
    assert [row["id"] for row in results(str(path), "--per", "chain")[0]["per"]] == ["-"]


def test_a_residue_without_a_number_keeps_its_name() -> None:
    columns = {"residue_name": ["LIG", "", ""], "residue": ["", "5", ""], "atom_name": ["CA", "CB", "CC"]}
    molecule = Molecule.of("odd", np.diag([3.0, 6, 9]), ["C", "C", "O"], chain=["A", "", "A"], **columns)
    (loaded,) = loaded_from(reading_of(molecule), InputOptions())
    names = {per: [part.id for part in measurement(loaded, per=per).parts] for per in PER}
    assert names == {"atom": ["A/LIG/CA", "-/5/CB", "O3"], "residue": ["A/LIG", "-/5", "A/"], "chain": ["A", "-"]}
    assert measurement(loaded).parts == () and measurement(loaded, "element C", "atom").atoms == 2


def test_atoms_of_one_name_have_rows_of_their_own_and_residues_one() -> None:
    twice = Molecule.of("twice", [[0, 0, 0], [9, 0, 0]], ["C", "C"], radius=[1, 2], residue_name=["X", "X"],
                        residue=["1", "1"], atom_name=["C", "C"])  # fmt: skip
    (loaded,) = loaded_from(reading_of(twice), InputOptions())
    areas = {per: [part.area for part in measurement(loaded, per=per).parts] for per in PER}
    assert areas["atom"] == pytest.approx([4 * np.pi, 16 * np.pi])
    assert areas["residue"] == areas["chain"] == pytest.approx([20 * np.pi])


def test_a_selection_is_measured_alone_and_among_the_rest(peptide: str) -> None:
    (part,) = results(peptide, "--select", "chain A", "--per", "residue")
    (chain,) = results(peptide, "--chain", "A")
    (whole,) = results(peptide, "--per", "chain")
    assert part["atoms"] == 5
    assert (part["area"], part["volume"]) == pytest.approx((chain["area"], chain["volume"]), rel=1e-12)
    assert part["exposed"] == pytest.approx(whole["per"][0]["area"], rel=1e-12)
    assert part["buried"] == pytest.approx(part["area"] - part["exposed"])
    assert part["buried"] > 0.1
    assert sum(row["buried"] for row in part["per"]) == pytest.approx(part["buried"])


def test_csv_holds_every_digit(peptide: str) -> None:
    (found,) = results(peptide, "--per", "residue")
    rows = list(csv.DictReader(io.StringIO(run(peptide, "--per", "residue", "--csv").stdout)))
    assert [float(row["area"]) for row in rows] == [row["area"] for row in found["per"]]
    (total,) = csv.DictReader(io.StringIO(run(peptide, "--csv").stdout))
    assert (float(total["area"]), float(total["volume"])) == (found["area"], found["volume"])


def test_the_table_tells_the_source_of_the_radii(peptide: str) -> None:
    text = run(peptide, "--per", "chain").stdout
    (found,) = results(peptide)
    assert "Bondi 1964" in text
    assert f"area {found['area']:.3f}" in text


def test_all_models_of_many_files(peptide: str, tmp_path: Path) -> None:
    path = tmp_path / "frames.xyz"
    path.write_text("1\n\nC 0 0 0\n2\n\nC 0 0 0\nC 9 0 0\n", encoding="ascii")
    found = results(str(path), peptide, "--model", "all")
    assert [(one["model"], one["atoms"]) for one in found] == [(1, 1), (2, 2), (1, 6)]
    assert found[1]["area"] == pytest.approx(2 * found[0]["area"])


def test_one_bad_file_does_not_stop_the_rest(peptide: str) -> None:
    done = run("missing.pdb", peptide, "--json")
    assert done.exit_code == 1
    assert len(json.loads(done.stdout)["results"]) == 1
    assert "missing.pdb" in done.stderr


def test_what_cannot_be_is_refused(peptide: str) -> None:
    empty = run(peptide, "--select", "resi 77")
    assert (empty.exit_code, "means no atom" in empty.stderr) == (1, True)
    assert run(peptide, "--json", "--csv").exit_code == 2


def test_from_python_with_warnings_for_guessed_radii() -> None:
    molecule = Molecule.of("pair", np.array([[0.0, 0, 0], [9, 0, 0]]), np.array(["C", "X"]))
    with pytest.warns(UserWarning, match="guessed"):
        found = measure(molecule, probe=0.0)
    assert np.allclose(found.area, 4 * np.pi * np.array([1.7, 2.0]) ** 2)
