"""mmCIF and small-molecule CIF: what the parser of the syntax lets pass is checked here."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz.errors import InputError
from molviz.readers import Reading, read

TAGS = (
    "group_PDB id type_symbol label_atom_id label_alt_id label_comp_id label_asym_id auth_asym_id auth_seq_id "
    "pdbx_PDB_ins_code Cartn_x Cartn_y Cartn_z occupancy B_iso_or_equiv pdbx_PDB_model_num"
)
HEAD = "data_T\n_struct.title 'A title'\nloop_\n" + "".join(f"_atom_site.{tag}\n" for tag in TAGS.split())
FIRST_ROW = HEAD.count("\n") + 1


def row(
    symbol: str = "C", name: str = "CA", alternate: str = ".", chain: str = "SE0", number: str = "7", code: str = "?",
    xyz: str = "1.0 2.0 3.0", occupancy: str = "1.00", bfactor: str = "9.5", model: str = "1", asym: str = "A",
) -> str:  # fmt: skip
    return f"ATOM 1 {symbol} {name} {alternate} ALA {asym} {chain} {number} {code} {xyz} {occupancy} {bfactor} {model}"


def cif(*rows: str, tail: str = "") -> Reading:
    return read("t.cif", (HEAD + "\n".join(rows) + "\n#\n" + tail).encode())


def test_columns() -> None:
    molecule = cif(row(code="B"), row("O", '"O5\'"', xyz="4 5 6", bfactor="?")).models[0]
    assert molecule.name == "A title" and molecule.position.tolist() == [[1, 2, 3], [4, 5, 6]]
    assert molecule.atom_name.tolist() == ["CA", "O5'"] and molecule.element.tolist() == ["C", "O"]
    assert molecule.chain.tolist() == ["SE0", "SE0"] and molecule.residue.tolist() == ["7B", "7"]
    assert molecule.bfactor[0] == 9.5 and np.isnan(molecule.bfactor[1])


@settings(max_examples=30)
@given(st.lists(st.tuples(*[st.floats(-1e5, 1e5)] * 3), min_size=1, max_size=9))
def test_written_coordinates_come_back(position: list[tuple[float, float, float]]) -> None:
    reading = cif(*(row(xyz=" ".join(map(repr, point))) for point in position))
    assert np.array_equal(reading.models[0].position, position)


@pytest.mark.parametrize("bad", ["?", ".", "nan", "inf", "abc", "'1 2'", "15,268"])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_what_is_no_number_is_refused(bad: str, axis: int) -> None:
    numbers = ["1.0"] * 3
    numbers[axis] = bad
    with pytest.raises(InputError, match=rf"^t\.cif:{FIRST_ROW + 2}: _atom_site\.Cartn_{'xyz'[axis]} is "):
        cif(row(), "# a comment", row(xyz=" ".join(numbers)))


def test_standard_uncertainties_are_no_part_of_the_number() -> None:
    assert cif(row(xyz="1.25(3) -2.0(12) 3")).models[0].position.tolist() == [[1.25, -2.0, 3.0]]


def test_a_row_too_short_is_refused() -> None:
    with pytest.raises(InputError, match=rf"^t\.cif:{FIRST_ROW + 1}: Wrong number of values .* from line 3"):
        cif(row(), row()[:-2])


def test_a_missing_coordinate_column_is_refused() -> None:
    text = HEAD.replace("_atom_site.Cartn_z\n", "") + row(xyz="1.0 2.0")
    with pytest.raises(InputError, match=r"^t\.cif:\d+: _atom_site\.Cartn_z is missing"):
        read("t.cif", text.encode())


def test_an_open_text_field_is_refused() -> None:
    with pytest.raises(InputError, match=rf"^t\.cif:{FIRST_ROW + 3}: the text field that opens here"):
        cif(row(), tail="_a.b\n;open\nfor ever\n")


def test_a_file_without_atoms_is_refused() -> None:
    with pytest.raises(InputError, match=r"^t\.cif: no _atom_site"):
        read("t.cif", b"data_x\n_cell.length_a 1\n")


def test_models_and_alternates() -> None:
    reading = cif(
        row(alternate="A", occupancy="0.4"),
        row(alternate="B", occupancy="0.6", xyz="5 5 5"),
        row(model="7"),
        row("N", "N", xyz="9 9 9", model="7"),
    )
    assert [model.position[:, 0].tolist() for model in reading.models] == [[5], [1, 9]]
    assert len(reading.warnings) == 2


def test_odd_rows_are_told_with_their_line() -> None:
    reading = cif(row(), row("Q", "Q1", xyz="1 2 3", bfactor="high"))
    told = [warning.split(": ")[0] for warning in reading.warnings]
    assert told == [f"t.cif:{FIRST_ROW + 1}"] * 3  # B-factor, element, coinciding


def test_a_text_field_within_rows_does_not_confuse_lines() -> None:
    odd = row().replace("ALA", "\n;A L\nA\n;\n")
    with pytest.raises(InputError, match=rf"^t\.cif:{FIRST_ROW + 5}: "):
        cif(odd, row(xyz="1 ? 3"))


OPERATORS = """loop_
_pdbx_struct_assembly_gen.assembly_id
_pdbx_struct_assembly_gen.oper_expression
_pdbx_struct_assembly_gen.asym_id_list
1 (1-2) A
2 (X)(1,2) A,B
3 9 A
loop_
_pdbx_struct_oper_list.id
""" + "".join(
    f"_pdbx_struct_oper_list.{cell}\n"
    for i in (1, 2, 3)
    for cell in (f"matrix[{i}][1]", f"matrix[{i}][2]", f"matrix[{i}][3]", f"vector[{i}]")
)
ROWS = "1 1 0 0 0 0 1 0 0 0 0 1 0\n2 1 0 0 10 0 1 0 0 0 0 1 0\nX 0 -1 0 0 1 0 0 0 0 0 1 5\n"


def test_assemblies() -> None:
    reading = cif(row(), row(asym="B", chain="SE0", xyz="4 4 4"), tail=OPERATORS + ROWS)
    assert list(reading.assemblies) == ["1", "2"]
    assert reading.assembly("1").position.tolist() == [[1, 2, 3], [11, 2, 3]]
    assert reading.assembly("1").chain.tolist() == ["SE0", "SE0-2"]
    assert reading.assembly("2").position.tolist() == [[-2, 1, 8], [-4, 4, 9], [-2, 11, 8], [-4, 14, 9]]
    assert "assembly '3'" in reading.warnings[-1]


SMALL = """data_salt
_cell_length_a 4
_cell_length_b 4
_cell_length_c 4
_cell_angle_alpha 90
_cell_angle_beta 90
_cell_angle_gamma 90
_space_group_name_H-M_alt 'F m -3 m'
loop_
_atom_site_label
_atom_site_fract_x
_atom_site_fract_y
_atom_site_fract_z
Na1 0 0 0
Cl1 0.5 0.5 0.5
"""


def test_a_small_molecule_fills_its_unit_cell() -> None:
    molecule = read("t.cif", SMALL.encode()).models[0]
    assert sorted(molecule.element.tolist()) == ["Cl"] * 4 + ["Na"] * 4
    expected = [[0, 0, 0], [0, 2, 2], [2, 0, 2], [2, 2, 0]]
    assert np.allclose(sorted(molecule.position[molecule.element == "Na"].tolist()), expected)


def test_of_elements_that_share_a_site_the_most_occupied_is_the_first() -> None:
    text = SMALL.replace("_atom_site_fract_z\n", "_atom_site_fract_z\n_atom_site_occupancy\n")
    text = text.replace("Na1 0 0 0\nCl1 0.5 0.5 0.5", "KX1 0 0 0 .2\nCl1 .5 .5 .5 1\nNaX1 0 0 0 .7\nWatX1 0 0 0 .7")
    assert read("t.cif", text.encode()).models[0].element.tolist() == ["Na", "O", "K"] * 4 + ["Cl"] * 4


def test_a_small_molecule_with_a_missing_coordinate_or_cell_is_refused() -> None:
    with pytest.raises(InputError, match=r"^t\.cif:15: _atom_site_fract_z is '\?'"):
        read("t.cif", SMALL.replace("0.5 0.5 0.5", "0.5 0.5 ?").encode())
    with pytest.raises(InputError, match="without a unit cell"):
        read("t.cif", "\n".join(line for line in SMALL.split("\n") if not line.startswith("_cell")).encode())


def test_coordinates_of_a_small_molecule_are_those_that_were_checked() -> None:
    molecule = read("t.cif", SMALL.replace("0.5 0.5 0.5", "5.0D-1 0.5(1) +0.5").encode()).models[0]
    assert sorted(molecule.element.tolist()) == ["Cl"] * 4 + ["Na"] * 4


def test_missing_symmetry_is_told() -> None:
    assert not read("t.cif", SMALL.replace("F m -3 m", "P 1").encode()).warnings
    reading = read("t.cif", SMALL.replace("F m -3 m", "?").encode())
    assert len(reading.models[0]) == 2 and "no symmetry" in reading.warnings[0]


def test_sites_without_labels_are_refused() -> None:
    with pytest.raises(InputError, match="expected _atom_site_label"):
        read("t.cif", SMALL.replace("_atom_site_label", "_atom_site_name").encode())


@pytest.mark.parametrize("tag", ["Cartn_z", "type_symbol", "occupancy", "auth_seq_id", "pdbx_PDB_ins_code"])
@pytest.mark.parametrize("count", [1, 3])
def test_columns_of_unequal_length_are_refused(tag: str, count: int) -> None:
    tags = [name for name in ("type_symbol", "Cartn_x", "Cartn_y", "Cartn_z") if name != tag]
    rows = "".join(" ".join("C" if name == "type_symbol" else f"{k}.0" for name in tags) + "\n" for k in range(2))
    table = "data_x\nloop_\n" + "".join(f"_atom_site.{name}\n" for name in tags) + rows
    other = f"loop_\n_atom_site.{tag}\n" + "1\n" * count
    with pytest.raises(InputError, match="values for . rows; expected as many"):
        read("x.cif", (table + other).encode())
