"""PDB: fixed columns, and every way in which files leave them."""

import gzip

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz.errors import InputError
from molviz.model.molecule import Molecule
from molviz.readers import Reading, read
from tests.pdb_lines import atom


def pdb(*lines: str) -> Reading:
    return read("t.pdb", "\n".join(lines).encode())


def first(*lines: str) -> Molecule:
    return pdb(*lines).models[0]


def at(x: float) -> str:
    return f"{x:8.3f}   0.000   0.000"


def test_columns() -> None:
    molecule = first("TITLE     A SMALL", "TITLE    2 MOLECULE", atom(number=" 56A"), atom(" N  ", element=" N"))
    assert molecule.name == "A SMALL MOLECULE"
    assert molecule.position.tolist() == [[1, 2, 3], [1, 2, 3]]
    assert molecule.element.tolist() == ["C", "N"] and molecule.atom_name.tolist() == ["CA", "N"]
    assert molecule.residue_name.tolist() == ["ALA", "ALA"] and molecule.chain.tolist() == ["A", "A"]
    assert molecule.residue.tolist() == ["56A", "1"] and molecule.row.tolist() == [0, 1]
    assert molecule.bfactor.tolist() == [10, 10] and np.isnan(molecule.radius).all()


coordinate = st.integers(-999_999, 9_999_999).map(lambda k: k / 1000)
points = st.lists(st.tuples(coordinate, coordinate, coordinate), min_size=1, max_size=20)


@settings(max_examples=50)
@given(points, st.sampled_from(["\n", "\r\n", "\r"]))
def test_written_coordinates_come_back(position: list[tuple[float, float, float]], end: str) -> None:
    text = end.join(atom(xyz="".join(f"{value:8.3f}" for value in point)) for point in position).encode()
    for data in (text, gzip.compress(text), b"\xef\xbb\xbf" + text):
        assert np.array_equal(read("t.pdb", data).models[0].position, position)


NO_NUMBERS = [" " * 8, "     abc", "********", "  15,268", "     nan", "     inf", "   1 2.0", "  1_0.00", "  1e9999"]


@pytest.mark.parametrize("bad", NO_NUMBERS)
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_what_is_no_number_is_refused(bad: str, axis: int) -> None:
    numbers = ["   1.000"] * 3
    numbers[axis] = bad
    with pytest.raises(InputError, match=rf"^t\.pdb:2: {'xyz'[axis]} coordinate .*expected a finite number"):
        pdb(atom(), atom(xyz="".join(numbers)))


def test_a_line_shifted_by_a_column_is_refused() -> None:
    with pytest.raises(InputError, match=r"^t\.pdb:1: "):
        pdb(atom(xyz="    1.000   2.000   3.000"))


def test_a_record_that_ends_in_the_coordinates_is_refused() -> None:
    with pytest.raises(InputError, match=r"^t\.pdb:2: the record ends at column 50"):
        pdb(atom(), atom()[:50])


def test_tabs_are_refused() -> None:
    with pytest.raises(InputError, match=r"^t\.pdb:1: tabs"):
        pdb("ATOM\t1\tN\tTHR\tA\t1\t17.047\t14.099\t3.625")


def test_an_atom_behind_a_byte_order_mark_is_read() -> None:
    assert len(read("t.pdb", b"\xef\xbb\xbf" + atom().encode()).models[0]) == 1


def test_a_record_may_end_after_z_and_serials_may_overflow() -> None:
    molecule = first(atom(" N  ", record="ATOM 111757 ")[:54], atom(record="HETATM100000"), atom(" CB ", xyz=at(5)))
    assert molecule.element.tolist() == ["N", "C", "C"] and np.isnan(molecule.bfactor[0])


def test_latin_1_in_a_remark_is_no_matter() -> None:
    assert not read("t.pdb", b"REMARK \xe9\xfc\n" + atom().encode()).warnings


def test_a_file_without_atoms_is_refused() -> None:
    with pytest.raises(InputError, match=r"^t\.pdb: no ATOM"):
        pdb("MODEL        1", "ENDMDL")


def test_an_odd_occupancy_or_bfactor_is_told() -> None:
    reading = pdb(atom(bfactor="******", occupancy="   abc"))
    assert np.isnan(reading.models[0].bfactor[0])
    assert [warning.split(":")[:2] for warning in reading.warnings] == [["t.pdb", "1"]] * 2


def test_fortran_exponents_are_read_in_every_column() -> None:
    molecule = first(atom(xyz=" 1.0D+00   2.000   3.0d0", occupancy="  1.D0", bfactor=" 2.5D1"))
    assert molecule.position.tolist() == [[1, 2, 3]] and molecule.bfactor.tolist() == [25]


# ---- residues


@pytest.mark.parametrize(
    ("number", "residue"),
    [
        ("9999 ", "9999"),
        ("10000", "10000"),  # runs into the column of the insertion code
        ("A000 ", "10000"),  # hybrid-36
        ("A00AB", "10010B"),
        ("ZZZZ ", "1223055"),
        ("a000 ", "1223056"),
        ("  -5 ", "-5"),
        ("  56A", "56A"),
    ],
)
def test_residue_numbers(number: str, residue: str) -> None:
    assert first(atom(number=number)).residue.tolist() == [residue]


def test_insertion_codes_keep_residues_apart() -> None:
    assert not pdb(*(atom(number=f"   1{code}", xyz=at(ord(code))) for code in " AB")).warnings


# ---- elements


def test_elements_without_their_columns() -> None:
    names = [
        ("CA  ", "CA", "Ca"), (" CA ", "ALA", "C"), ("HG  ", "HG", "Hg"), (" HG ", "SER", "H"), ("HG11", "VAL", "H"),
        ("CD  ", "CD", "Cd"), (" CD ", "GLU", "C"), (" NE ", "ARG", "N"), ("NE  ", "NE", "Ne"), ("FE  ", "HEM", "Fe"),
        ("1HB ", "ALA", "H"), ("CL  ", "CL", "Cl"), ("HE21", "GLN", "H"), ("HO5'", "G", "H"), (" D  ", "ALA", "D"),
    ]  # fmt: skip
    reading = pdb(*(atom(name, residue, xyz=at(k), element="  ") for k, (name, residue, _) in enumerate(names)))
    assert reading.models[0].element.tolist() == [element for *_, element in names]
    assert len([warning for warning in reading.warnings if "without element" in warning]) == 1


def test_serial_numbers_of_old_files_are_no_elements() -> None:
    line = atom(element="")[:66].ljust(72) + "1AKE1839"
    assert first(line).element.tolist() == ["C"]


def test_beads_have_no_element() -> None:
    reading = pdb(atom("BB1 ", "ALA", element="  "))
    assert reading.models[0].element.tolist() == ["X"] and "unknown" in reading.warnings[0]


# ---- models


def test_models_whatever_their_numbers() -> None:
    one = ["MODEL 1", atom(), "ENDMDL"]
    reading = pdb(*one, *one, "MODEL", atom(), atom(" CB ", xyz=at(9)), "ENDMDL", "MODEL", "ENDMDL")
    assert [len(model) for model in reading.models] == [1, 1, 2]
    assert reading.warnings[0].startswith("t.pdb:4: MODEL 1 again")
    assert any("differ in atoms" in warning for warning in reading.warnings)


def test_a_missing_endmdl_costs_nothing() -> None:
    reading = pdb("MODEL        1", atom(), "MODEL        2", atom(), "ENDMDL")
    assert [len(model) for model in reading.models] == [1, 1]
    assert reading.warnings == ("t.pdb:3: MODEL before the ENDMDL of the model above",)


# ---- alternate locations


def test_of_alternates_the_highest_occupancy_stays() -> None:
    reading = pdb(
        atom(" N  ", xyz=at(0), element=" N"),
        atom(alternate="A", xyz=at(1), occupancy="  0.40"),
        atom(alternate="B", xyz=at(2), occupancy="  0.60"),
    )
    assert reading.models[0].position[:, 0].tolist() == [0, 2]
    assert reading.warnings[0].startswith("t.pdb: 1 atoms at alternate locations left out")


def test_of_alternates_the_first_stays_on_a_tie() -> None:
    molecule = first(*(atom(alternate=letter, xyz=at(k), occupancy="  0.50") for k, letter in enumerate("AB")))
    assert molecule.position[:, 0].tolist() == [0]


def test_a_point_mutation_keeps_one_side_chain() -> None:
    molecule = first(
        atom(" N  ", "SER", element=" N", xyz=at(0)),
        atom(" CB ", "SER", alternate="A", occupancy="  0.30", xyz=at(1)),
        atom(" OG ", "SER", alternate="A", occupancy="  0.30", xyz=at(2), element=" O"),
        atom(" CB ", "ALA", alternate="B", occupancy="  0.70", xyz=at(3)),
    )
    assert molecule.position[:, 0].tolist() == [0, 3]


# ---- odd but clear


def test_atoms_that_coincide_and_names_that_repeat_are_told() -> None:
    told = pdb(atom(), atom(" CB "), atom(" CB ", xyz=at(9))).warnings
    assert told[0].startswith("t.pdb:2: 1 atoms at exactly the place")
    assert told[1].startswith("t.pdb:3: 1 atoms named as another atom of their residue, the first CB of ALA A 1")


def test_serials_of_conect_run_together_are_told() -> None:
    assert pdb(atom(), "CONECT100000100001100002").warnings[0].startswith("t.pdb:2: CONECT")
    assert not pdb(atom(), "CONECT1000010001" + " " * 60).warnings


# ---- assemblies

BIOMT = """REMARK 350 BIOMOLECULE: 1
REMARK 350 APPLY THE FOLLOWING TO CHAINS: A,
REMARK 350                    AND CHAINS: B
REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000
REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000
REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000
REMARK 350   BIOMT1   2  0.000000 -1.000000  0.000000       10.00000
REMARK 350   BIOMT2   2  1.000000  0.000000  0.000000       20.00000
REMARK 350   BIOMT3   2  0.000000  0.000000  1.000000       30.00000"""


def test_assembly() -> None:
    reading = pdb(BIOMT, atom(), atom(chain="B", xyz=at(4)), atom(chain="C", xyz=at(5)))
    built = reading.assembly("1")
    assert built.position.tolist() == [[1, 2, 3], [4, 0, 0], [8, 21, 33], [10, 24, 30]]
    assert built.chain.tolist() == ["A", "B", "A-2", "B-2"] and built.row.tolist() == [0, 1, 0, 1]
    with pytest.raises(InputError, match=r"^t\.pdb: no assembly '7'; the file has operators for: 1"):
        reading.assembly("7")


def test_a_broken_operator_is_refused() -> None:
    with pytest.raises(InputError, match=r"^t\.pdb:8: BIOMT without four numbers"):
        pdb(BIOMT.replace("20.00000", "   *****"), atom())
