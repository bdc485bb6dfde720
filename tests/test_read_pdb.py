"""PDB: fixed columns, and every way in which files leave them."""

import gzip

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz.errors import InputError
from molviz.read import read


def atom(
    name: str = " CA ", residue: str = "ALA", number: str = "   1 ", xyz: str = "   1.000   2.000   3.000",
    alternate: str = " ", chain: str = "A", occupancy: str = "  1.00", bfactor: str = " 10.00", element: str = " C",
    record: str = "ATOM      1 ",
) -> str:  # fmt: skip
    head = f"{record}{name}{alternate}{residue:>3} {chain}{number}   {xyz}"
    return f"{head}{occupancy}{bfactor}          {element}"


def pdb(*lines: str, name: str = "t.pdb") -> object:
    return read(name, "\n".join(lines).encode())


def first(*lines: str) -> object:
    return read("t.pdb", "\n".join(lines).encode()).models[0]


def test_columns() -> None:
    molecule = first("TITLE     A SMALL", "TITLE    2 MOLECULE", atom(number=" 56A"), atom(name=" N  ", element=" N"))
    assert molecule.name == "A SMALL MOLECULE"
    assert molecule.position.tolist() == [[1, 2, 3], [1, 2, 3]]
    assert molecule.element.tolist() == ["C", "N"] and molecule.atom_name.tolist() == ["CA", "N"]
    assert molecule.residue_name.tolist() == ["ALA", "ALA"] and molecule.chain.tolist() == ["A", "A"]
    assert molecule.bfactor.tolist() == [10, 10] and np.isnan(molecule.radius).all()


coordinate = st.integers(-999_999, 9_999_999).map(lambda k: k / 1000)


@settings(max_examples=50, deadline=None)
@given(
    st.lists(st.tuples(coordinate, coordinate, coordinate), min_size=1, max_size=20), st.sampled_from(["\n", "\r\n"])
)
def test_written_coordinates_come_back(points: list[tuple[float, float, float]], end: str) -> None:
    text = end.join(atom(xyz="".join(f"{value:8.3f}" for value in point)) for point in points).encode()
    for data in (text, gzip.compress(text), b"\xef\xbb\xbf" + text):
        assert np.array_equal(read("t.pdb", data).models[0].position, points)


@pytest.mark.parametrize(
    "bad", [" " * 8, "     abc", "********", "  15,268", "     nan", "     inf", "   1 2.0", "  1_0.00"]
)
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_what_is_no_number_is_refused(bad: str, axis: int) -> None:
    fields = ["   1.000"] * 3
    fields[axis] = bad
    with pytest.raises(InputError, match=rf"^t\.pdb:2: {'xyz'[axis]} coordinate .*expected a finite number"):
        pdb(atom(), atom(xyz="".join(fields)))
