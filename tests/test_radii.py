"""Radii tables: published figures, united atoms, files of the user."""

from pathlib import Path

import numpy as np
import pytest

from molviz.errors import InputError
from molviz.model.elements import SYMBOLS
from molviz.model.molecule import Molecule
from molviz.model.radii import TABLES, load_table, radii
from molviz.model.spheres import Spheres


def molecule(*elements: str, **columns: list[str]) -> Molecule:
    arrays = {name: np.array(column) for name, column in columns.items()}
    return Molecule.of("m", np.arange(3.0 * len(elements)).reshape(-1, 3), np.array(elements), **arrays)


@pytest.mark.parametrize(
    ("table", "figures"),
    [
        ("bondi", "H 1.20 D 1.20 He 1.40 C 1.70 N 1.55 O 1.52 F 1.47 P 1.80 S 1.80 Cl 1.75 Br 1.85 I 1.98 Li 1.82"),
        ("bondi", "Al 1.84 B 1.92 Ca 2.31 Cs 3.43"),  # from Mantina et al.
        ("bondi", "Fe 2.05 Mn 2.05 Co 2.00 Mo 2.10 W 2.10"),  # from Batsanov
        ("mantina", "H 1.10 Br 1.83 Li 1.81 C 1.70 Ba 2.68"),
        ("alvarez", "H 1.20 C 1.77 N 1.66 O 1.50 Fe 2.44 Zn 2.39"),
        ("covalent", "H 0.31 C 0.76 N 0.71 O 0.66 Fe 1.32 U 1.96"),
    ],
)
def test_published_figures(table: str, figures: str) -> None:
    words = figures.split()
    radius, warnings = radii(molecule(*words[::2]), table)
    assert radius.tolist() == [float(word) for word in words[1::2]] and not warnings


@pytest.mark.parametrize("name", TABLES)
def test_every_table_states_its_source_and_holds_plausible_radii(name: str) -> None:
    table = load_table(name)
    assert any(str(year) in table.source for year in range(1964, 2014))
    assert set(table.elements) <= set(SYMBOLS) and {"H", "C", "N", "O", "S"} <= set(table.elements)
    assert all(0.2 < radius < 3.6 for radius in [*table.elements.values(), *table.atoms.values()])


def test_united_atoms_go_by_residue_and_name() -> None:
    atoms = molecule(
        *"CCCNNO", residue_name=["ALA", "PHE", "LIG", "LYS", "LYS", "HOH"], atom_name=["CA", "CG", "CA", "N", "NZ", "O"]
    )
    assert radii(atoms, "chothia")[0].tolist() == [1.87, 1.76, 1.70, 1.65, 1.50, 1.52]
    assert radii(atoms, "protor")[0].tolist() == [1.88, 1.61, 1.70, 1.64, 1.64, 1.52]
    assert "hydrogens" in radii(molecule("H"), "protor")[1][0]


def test_every_heavy_atom_of_the_twenty_residues_has_a_united_radius() -> None:
    for name in ("protor", "chothia"):
        atoms = load_table(name).atoms
        assert len({residue for residue, _ in atoms}) == 20 and len(atoms) == 187


def test_guesses_are_told() -> None:
    radius, warnings = radii(molecule("X", "C", "Gd", "X"))
    assert radius.tolist() == [2.0, 1.7, 2.0, 2.0]
    assert warnings == ("radius guessed as 2.00 Å, for table bondi has none: Gd (1), X (2)",)


def test_radii_of_the_file_go_first() -> None:
    own = Molecule.of("m", np.zeros((2, 3)), np.array(["X", "C"]), radius=np.array([0.5, np.nan]))
    assert radii(own)[0].tolist() == [0.5, 1.7] and not radii(own)[1]


def test_scale_and_probe() -> None:
    spheres = Spheres(molecule("C").position, radii(molecule("C"))[0]).enlarged(0.5, 1.4)
    assert spheres.radius.tolist() == [0.5 * 1.7 + 1.4]


def test_files_of_the_user(tmp_path: Path) -> None:
    columns, toml = tmp_path / "r.txt", tmp_path / "r.toml"
    columns.write_text("# mine\nC 2.5\nFE 1 # iron\n")
    toml.write_text('completed_by = "bondi"\n[elements]\nC = 2.5\n[types]\nbig = 3\n[residues]\nALA = { big = "CB" }\n')
    assert radii(molecule("C", "Fe"), str(columns))[0].tolist() == [2.5, 1.0]
    ala = molecule("C", "C", "N", residue_name=["ALA"] * 3, atom_name=["CA", "CB", "N"])
    assert radii(ala, str(toml))[0].tolist() == [2.5, 3.0, 1.55]


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("r.txt", "C 1\nC\n", ":2: 1 words"),
        ("r.txt", "C -1\n", ":1: radius of C is '-1'"),
        ("r.txt", "C nan\n", ":1: radius of C"),
        ("r.txt", "Qq 1\n", ": 'Qq' is no element"),
        ("r.txt", "\n", ": the radii table is empty"),
        ("r.toml", "[elements\n", ": no radii table"),
        ("r.toml", "[elements]\nC = true\n", ": radius of C is True"),
        ("r.toml", "elements = 3\n", ": elements is 3"),
        ("r.toml", "[elements]\nC = 1\n[residues]\nALA = 3\n", ": residue ALA is 3"),
        ("r.toml", "[elements]\nC = 1\n[residues]\nALA = { a = 'CB' }\n", ": residue ALA has atoms of type a"),
        ("r.toml", "completed_by = 'r.toml'\n", ": completed_by is 'r.toml'"),
    ],
)
def test_files_that_are_refused(tmp_path: Path, name: str, text: str, message: str) -> None:
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        load_table(str(path))
    assert str(caught.value).startswith(f"{path}{message}")


def test_a_table_that_is_not_there_is_refused() -> None:
    with pytest.raises(InputError, match="no radii table 'no'; expected one of bondi, "):
        load_table("no")
