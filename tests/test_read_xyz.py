"""XYZ, extended XYZ and xyzr."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz.errors import InputError
from molviz.readers import Reading, read


def xyz(text: str) -> Reading:
    return read("t.xyz", text.encode())


number = st.floats(allow_nan=False, allow_infinity=False, width=64)
frame = st.lists(st.tuples(number, number, number), min_size=1, max_size=6)


@settings(max_examples=100)
@given(st.lists(frame, min_size=1, max_size=4), st.text("abc =0123456789", max_size=9), st.booleans())
def test_written_frames_come_back(frames: list[list[tuple[float, float, float]]], comment: str, blank: bool) -> None:
    text = "".join(
        f"{len(rows)}\n{comment}\n" + "".join(f"C {x!r} {y!r} {z!r}\n" for x, y, z in rows) + "\n" * blank
        for rows in frames
    )
    reading = xyz(text)
    assert len(reading.models) == len(frames)
    for molecule, rows in zip(reading.models, frames, strict=True):
        assert np.array_equal(molecule.position, rows)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("10\n\nO 0 0 0\nH 1 0 0\n", "1: the count says 10 atoms, but only 2 follow"),
        ("2\n\nO 0 0 0\nH 1 0 0\nH 2 0 0\n", "5: 'H 2 0 0'; expected the number of atoms"),
        ("3\nO 0 0 0\nH 1 0 0\nH 2 0 0\n", "1: .*line 2, where the comment stands, looks like an atom"),
        ("-3\n\nO 0 0 0\n", "1: the count is -3"),
        ("0\n\n", "1: the count is 0"),
        ("1_0\n\nC 0 0 0\n", "1: '1_0'; expected the number"),
        ("1\n\nC 0 0\n", "3: 3 words"),
        ("2\n\nC 0 0 0\nC 0 nan 0\n", "4: y coordinate is 'nan'"),
        ("1\n\nC inf 0 0\n", "3: x coordinate is 'inf'"),
        ("1\n\nC 0 0 15,268\n", "3: z coordinate is '15,268'"),
        ("1\n\nC 0 0 1_0\n", "3: z coordinate is '1_0'"),
        ("1\n\nC 0 0 ***\n", "3: z coordinate is"),
        ("\n \n", " the file is empty"),
        ("\x89PNG\r\n\x1a\n\0\0", "3: binary data"),
    ],
)
def test_refused(text: str, message: str) -> None:
    with pytest.raises(InputError, match=rf"^t\.xyz:{message}"):
        read("t.xyz", text.encode("latin-1"))


def test_fortran_exponents_are_read() -> None:
    assert xyz("1\n\nC 0.0D+00 1.5d+00 -2.0D-01").models[0].position.tolist() == [[0, 1.5, -0.2]]


def test_labels_and_unknown_symbols() -> None:
    reading = xyz("7\n\nC1 0 0 0\nH2a 1 0 0\nFe2+ 4 0 0\n26 6 0 0\nD 8 0 0\nDu 9 0 0\nLP 10 0 0")
    assert reading.models[0].element.tolist() == ["C", "H", "Fe", "Fe", "D", "X", "X"]
    assert reading.warnings == (
        "t.xyz:8: 2 atoms whose element is unknown, the first is 'Du'",
        "t.xyz:3: 3 atoms whose element is taken from the leading letters, the first is 'C1'",
    )


def test_atoms_that_coincide_are_told_once() -> None:
    reading = xyz("2\n\nC 0 0 0\nC 0 0 0\n" * 3)
    assert reading.warnings == ("t.xyz:4: 1 atoms at exactly the place of an earlier atom, the first here",)


def test_columns_of_extended_xyz() -> None:
    text = '1\nLattice="1 0 0 0 1 0 0 0 1" Properties=id:I:1:pos:R:3:species:S:1\n7 1 2 3 Fe\n'
    reading = xyz(text)
    assert reading.format == "extxyz" and not reading.warnings
    assert reading.models[0].element.tolist() == ["Fe"] and reading.models[0].position.tolist() == [[1, 2, 3]]


@pytest.mark.parametrize(
    "properties",
    [
        "pos:R:3:species:S:1",
        "species:S:1:pos:R:3:bad:R:",
        "species:S:1:pos:R:3:q:F:1",
        "species:S:1:pos:R:0",
        "pos:R:3",
    ],
)
def test_properties_that_do_not_fit_are_told(properties: str) -> None:
    reading = xyz(f"1\nProperties={properties}\nH 1.0 4.0 2.3\n")
    assert reading.models[0].position.tolist() == [[1.0, 4.0, 2.3]]
    assert reading.warnings == ("t.xyz:2: Properties= does not fit the rows; read as symbol x y z",)


# ---- xyzr


def test_balls() -> None:
    molecule = read("t.xyzr", b"# a comment\n0 0 0 1.5\n\n1 2 3 0.5 # another\n").models[0]
    assert molecule.position.tolist() == [[0, 0, 0], [1, 2, 3]] and molecule.radius.tolist() == [1.5, 0.5]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("1 2 3", "3 words"),
        ("1 2 3 4 5", "5 words"),
        ("1 2 3 0", "the radius is 0"),
        ("1 2 3 -1", "the radius is -1"),
        ("1 2 3 nan", "r is 'nan'"),
        ("1 x 3 1", "y is 'x'"),
    ],
)
def test_balls_that_are_refused(line: str, message: str) -> None:
    with pytest.raises(InputError, match=rf"^t\.xyzr:3: {message}"):
        read("t.xyzr", f"#\n0 0 0 1\n{line}\n".encode())


def test_no_balls_are_refused() -> None:
    with pytest.raises(InputError, match=r"^t\.xyzr: no balls"):
        read("t.xyzr", b"# nothing\n")
