"""The language of selections, against plain sentences of Python."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from molviz.errors import InputError
from molviz.model.molecule import Molecule
from molviz.model.selection import is_hydrogen, is_water, select

MOLECULE = Molecule.of(
    "m",
    np.array([[0, 0, 0], [3, 0, 0], [6, 0, 0], [0, 8, 0], [0, 0, 20], [0, 1, 20]], dtype=float),
    np.array(["N", "C", "H", "O", "Fe", "D"]),
    atom_name=np.array(["N", "CB", "HB1", "O5'", "FE", "D1"]),
    residue_name=np.array(["ALA", "ALA", "ALA", "DG", "HEM", "HOH"]),
    residue=np.array(["-3", "-3", "-3", "56A", "60", "9"]),
    chain=np.array(["A", "A", "A", "b", "", ""]),
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
        ("(" * 5000, 101),
        ("not " * 5000, 401),
    ],
)
def test_errors_name_the_place(expression: str, place: int) -> None:
    with pytest.raises(InputError, match=rf"position {place}: .*expected "):
        select(MOLECULE, expression)


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


@given(st.text('()"<>=!,.-* abcdefghinorstw0123456789', max_size=30))
def test_any_text_is_understood_or_refused(expression: str) -> None:
    try:
        assert select(MOLECULE, expression).shape == (6,)
    except InputError as error:
        assert "expected" in str(error) or "did you mean" in str(error)


def test_helpers() -> None:
    assert is_water(MOLECULE).tolist() == [False] * 5 + [True]
    assert np.flatnonzero(is_hydrogen(MOLECULE)).tolist() == [2, 5]
