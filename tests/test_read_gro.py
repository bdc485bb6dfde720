"""GRO: columns, nanometres, frames."""

import pytest

from molviz.errors import InputError
from molviz.readers import Reading, read

FRAME = """water and ions, t= 0.0
    4
    1SOL     OW    1   0.126   1.624   1.679  0.1227 -0.0580  0.0434
    1SOL    HW1    2   0.190   1.661   1.747  0.8085  0.3191 -0.7791
    2LIG    CL1    3  -1.000   0.000   0.000
    3CA      CA99999   0.500   0.500   0.500
   1.82060   1.82060   1.82060
"""


def gro(text: str) -> Reading:
    return read("t.gro", text.encode())


def test_atoms_in_angstrom() -> None:
    molecule = gro(FRAME).models[0]
    assert molecule.name == "water and ions, t= 0.0"
    assert molecule.position[0].tolist() == pytest.approx([1.26, 16.24, 16.79], abs=1e-12)
    assert molecule.element.tolist() == ["O", "H", "Cl", "Ca"]
    assert molecule.atom_name.tolist() == ["OW", "HW1", "CL1", "CA"]
    assert molecule.residue_name.tolist() == ["SOL", "SOL", "LIG", "CA"]
    assert molecule.residue.tolist() == ["1", "1", "2", "3"]


def test_frames_of_different_size() -> None:
    other = "next\n1\n    7ALA     CB    1   0.000   0.000   0.000\n1 1 1 0 0 0 0 0.5 0\n"
    assert list(map(len, gro(FRAME + other + FRAME).models)) == [4, 1, 4] and not gro(FRAME + other).warnings


def test_more_decimals_make_wider_columns() -> None:
    text = "fine\n1\n    1ALA     CB    1   0.123456  -0.123456  12.345678\n1 1 1\n"
    assert gro(text).models[0].position[0].tolist() == pytest.approx([1.23456, -1.23456, 123.45678], abs=1e-12)


def test_what_is_odd_is_told() -> None:
    text = "beads\n2\n    1POP    GL1    1   0.000   0.000   0.000\n"
    text += "    1POP    GL2    2   0.000   0.000   0.000\n1 1 1\n"
    assert gro(text).warnings == (
        "t.gro:3: 2 atoms whose element is unknown, the first is 'GL1'",
        "t.gro:4: 1 atoms at exactly the place of an earlier atom, the first here",
    )


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("\n    4\n", "\n    5\n", 2, "the count says 5 atoms, but 5 lines follow"),
        ("\n    4\n", "\n    3\n", 6, "5 words where the box stands"),
        ("\n    4\n", "\n    0\n", 2, "'0' below the title"),
        ("\n    4\n", "\nfour\n", 2, "'four' below the title"),
        ("   1.82060   1.82060   1.82060\n", "", 2, "the count says 4 atoms, but 4 lines follow"),
        ("   1.82060   1.82060   1.82060\n", "a b c\n", 7, "'a' where the box stands"),
        ("   1.661", "     nan", 4, "y coordinate is 'nan'"),
        ("   1.661", "        ", 4, "y coordinate is ''"),
        ("  -1.000   0.000   0.000", "  -1.000   0.000", 5, "the row ends at column 36"),
        ("  -1.000   0.000   0.000", "\t-1.000\t0.000\t0.000   ", 5, "tabs in the row"),
        ("   0.126   1.624   1.679  0.1227 -0.0580  0.0434", "   1 2 3", 3, "no coordinates with decimal points"),
    ],
)
def test_what_is_refused(old: str, new: str, line: int, message: str) -> None:
    with pytest.raises(InputError, match=rf"^t\.gro:{line}: {message}"):
        gro(FRAME.replace(old, new, 1))
