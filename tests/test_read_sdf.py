"""MOL and SDF: V2000 and V3000, atoms, bonds with orders, many records."""

import numpy as np
import pytest

from molviz.errors import InputError
from molviz.readers import Reading, read

V2000 = """formaldehyde
  by hand

  4  3  0  0  0  0  0  0  0  0999 V2000
    0.0000    0.0000    0.0000 C   0  0  0  0  0  0
    0.0000    0.0000    1.2050 O   0  0  0  0  0  0
    0.9400    0.0000   -0.5900 H   0  0  0  0  0  0
   -0.9400    0.0000   -0.5900 H   0  0  0  0  0  0
  1  2  2  0
  4  1  1  0
  1  3  1  0
M  ISO  1   4   2
M  END
> <DATA>
anything

$$$$
"""
V3000 = """formaldehyde
  by hand

  0  0  0     0  0            999 V3000
M  V30 BEGIN CTAB
M  V30 COUNTS 4 3 0 0 0
M  V30 BEGIN ATOM
M  V30 11 C 0 0 0 0
M  V30 12 O 0 0 1.205 0
M  V30 13 H 0.94 0 -0.59 0
M  V30 14 H -0.94 0 -
M  V30 -0.59 0 MASS=2
M  V30 END ATOM
M  V30 BEGIN BOND
M  V30 1 2 11 12
M  V30 2 1 14 11
M  V30 3 1 11 13
M  V30 END BOND
M  V30 END CTAB
M  END
"""


def sdf(text: str) -> Reading:
    return read("t.sdf", text.encode())


@pytest.mark.parametrize("text", [V2000, V3000])
def test_atoms_and_bonds(text: str) -> None:
    molecule = sdf(text).models[0]
    assert molecule.name == "formaldehyde" and molecule.element.tolist() == ["C", "O", "H", "D"]
    assert molecule.position[3].tolist() == [-0.94, 0, -0.59]
    bonds = molecule.stated_bonds
    assert bonds.complete and bonds.atoms.tolist() == [[0, 1], [0, 2], [0, 3]] and bonds.order.tolist() == [2, 1, 1]


def test_records_are_models_whatever_their_version() -> None:
    reading = sdf(V2000 + V3000 + "$$$$\n" + V2000.replace("formaldehyde", "") + "\n\n")
    assert [model.name for model in reading.models] == ["formaldehyde", "formaldehyde", "t"] and not reading.warnings


def test_a_selection_keeps_the_bonds_within_it() -> None:
    taken = sdf(V2000).models[0].take(np.array([3, 1, 0]))
    assert taken.stated_bonds.atoms.tolist() == [[0, 2], [1, 2]] and taken.stated_bonds.order.tolist() == [1, 2]


@pytest.mark.parametrize(
    ("type", "order"), [("  1", [1.0, 1, 1]), ("  4", [1.5, 1, 1]), ("  9", [1.0, 1, 1]), (" 10", [1, 1])]
)
def test_types_of_bonds(type: str, order: list[float]) -> None:
    reading = sdf(V2000.replace("  1  2  2", "  1  2" + type))
    assert reading.models[0].stated_bonds.order.tolist() == order and not reading.warnings


def test_what_is_odd_is_told() -> None:
    odd = V2000.replace("  1  2  2", "  1  2  8").replace(" O  ", " R# ").replace("  by hand\n", f"{'':20}2D\n")
    reading = sdf(odd)
    assert reading.models[0].element[1] == "X"
    assert reading.warnings == (
        "t.sdf:2: the coordinates are of a flat drawing (2D), not in ångström",
        "t.sdf:6: the symbol 'R#' is no element; its atoms are of unknown element",
        "t.sdf:9: a bond of type 8 has no one order; taken as single",
    )


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("  4  3  0", "  5  3  0", 9, "the row is too short"),
        ("  4  3  0", "  4  x  0", 4, "'4  x  0"),
        ("V2000", "V4000", 4, "'4  3  0"),
        ("  4  3  0", "  0  0  0", 1, "no atoms"),
        ("    1.2050", "       nan", 6, "z coordinate is 'nan'"),
        ("    1.2050", "          ", 6, "z coordinate is blank"),
        ("    1.2050 O   0  0  0  0  0  0", "    1.2050", 6, "the row is too short"),
        ("  1  2  2", "  1  5  2", 9, "a bond of atoms 1 and 5"),
        ("  1  2  2", "  1  1  2", 9, "a bond of atoms 1 and 1"),
        ("  1  2  2", "  1  2 77", 9, "a bond of type '77'"),
        ("  1  2  2", "  1  2   ", 9, "'1  2"),
        ("M  END\n", "", 12, "the counts say 4 atoms and 3 bonds; expected so many lines and M  END"),
    ],
)
def test_v2000_that_is_refused(old: str, new: str, line: int, message: str) -> None:
    with pytest.raises(InputError, match=rf"^t\.sdf:{line}: {message}"):
        sdf(V2000.replace(old, new, 1))


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("COUNTS 4 3", "COUNTS 5 3", 6, "the counts say 5 atoms, but 4 are listed"),
        ("COUNTS 4 3", "COUNTS 4 2", 6, "the counts say 2 bonds, but 3 are listed"),
        ("M  V30 COUNTS 4 3 0 0 0\n", "", 4, "no M  V30 COUNTS"),
        ("12 O 0 0 1.205 0", "12 O 0 0", 9, "4 words"),
        ("12 O 0 0 1.205", "12 O 0 0 inf", 9, "z coordinate is 'inf'"),
        ("12 O", "11 O", 6, "an atom number comes twice"),
        ("1 2 11 12", "1 2 11", 15, "3 words"),
        ("1 2 11 12", "1 2 11 15", 15, "a bond of atoms 11 and 15"),
        ("M  V30 END BOND\n", "", 14, "the block BOND that begins here has no end"),
    ],
)
def test_v3000_that_is_refused(old: str, new: str, line: int, message: str) -> None:
    with pytest.raises(InputError, match=rf"^t\.sdf:{line}: {message}"):
        sdf(V3000.replace(old, new, 1))


def test_a_record_cut_short_is_refused() -> None:
    with pytest.raises(InputError, match=r"^t\.sdf:2: the record ends after 2 lines"):
        sdf("a\nb")


@pytest.mark.parametrize("v3000", [False, True])
def test_what_another_program_writes(v3000: bool) -> None:
    chem, geometry = pytest.importorskip("rdkit.Chem"), pytest.importorskip("rdkit.Chem.rdDistGeom")
    mol = chem.AddHs(chem.MolFromSmiles("Cn1c(=O)c2c(ncn2C)n(C)c1=O"))
    geometry.EmbedMolecule(mol, randomSeed=1)
    molecule = sdf(chem.MolToMolBlock(mol, forceV3000=v3000, kekulize=False)).models[0]
    assert molecule.element.tolist() == [atom.GetSymbol() for atom in mol.GetAtoms()]
    assert abs(molecule.position - mol.GetConformer().GetPositions()).max() < 1e-4
    expected = {
        (*sorted((bond.GetBeginAtomIdx(), bond.GetEndAtomIdx())), bond.GetBondTypeAsDouble()) for bond in mol.GetBonds()
    }
    found = molecule.stated_bonds
    assert {(*pair, order) for pair, order in zip(found.atoms.tolist(), found.order.tolist(), strict=True)} == expected
