"""Where a molecule is put: matrices as text, in TOML files and as arrays become rigid motions."""

import os
import re
from pathlib import Path
from typing import Any

import numpy as np

from molviz import toml
from molviz.arrays import Floats
from molviz.errors import InputError
from molviz.geometry.clashes import STAYS, Placements
from molviz.pipeline.inputs import LONGEST

RIGID = 1e-3  # by which products of a rotation's rows may miss 0 and 1: matrices are often printed with few digits
EXPECTED = "3 or 4 rows of 4 numbers, turn and shift"
LAST_ROW = (0.0, 0.0, 0.0, 1.0)


def parse_transform(value: str) -> Placements:
    """Return the motion that a text means: 12 or 16 numbers row by row, or the name of a TOML file.

    The file has ``matrix`` (3 or 4 rows of 4 numbers), or ``rotation`` (3 rows of 3), ``translation`` (3) or both.
    Raises InputError for anything else.
    """
    numbers = _numbers(value)
    return _from_table(_table(value)) if numbers is None else _from_rows(numbers)


def placements_from(value: Any) -> Placements:
    """Return m motions: None for one that moves nothing, (m, 4, 4) or (4, 4), or rotations and translations.

    The last are a tuple of shapes (m, 3, 3) and (m, 3), or (3, 3) and (3,). Raises InputError for what is no rigid
    motion; reflections are, as they keep all distances.
    """
    if value is None:
        return STAYS
    if isinstance(value, tuple) and len(value) == 2:
        rotation, translation = _array(value[0], (3, 3)), _array(value[1], (3,))
    else:
        matrix = _array(value, (4, 4))
        rotation, translation = matrix[:, :3, :3], matrix[:, :3, 3]
        if not (matrix[:, 3] == LAST_ROW).all():
            raise InputError("the last row of a matrix is not 0 0 0 1")
    if len(rotation) != len(translation):
        raise InputError(f"{len(rotation)} rotations and {len(translation)} translations; expected as many")
    _refuse_bent(rotation)
    return Placements(rotation, translation)


def _array(value: Any, shape: tuple[int, ...]) -> Floats:
    """Numbers of the shape, or many of them."""
    try:
        array = np.asarray(value)
        if array.dtype.kind not in "fiu":
            raise ValueError
    except ValueError:
        raise InputError("not a table of numbers") from None
    if array.shape == shape:
        array = array[None]
    if array.shape[1:] != shape:
        rows = ", ".join(map(str, shape))
        raise InputError(f"numbers of shape {array.shape}; expected ({rows.rstrip(',')}) or (m, {rows})")
    numbers = array.astype(np.float64)
    if not (np.abs(numbers) <= LONGEST).all():
        raise InputError(f"a number is not finite, or above {LONGEST:g}")
    return numbers


def _refuse_bent(rotation: Floats) -> None:
    small = np.clip(rotation, -2.0, 2.0)  # larger ones are none, and their squares might not be numbers
    product = small @ small.transpose(0, 2, 1)
    wrong = np.flatnonzero((np.abs(product - np.eye(3)) > RIGID).any(axis=(1, 2)))
    if len(wrong):
        raise InputError(f"placement {wrong[0]} does more than turn; expected unit rows at right angles")


def _numbers(text: str) -> list[float] | None:
    try:
        return [float(word) for word in re.split(r"[\s,;]+", text.strip(" \t\r\n,;[]"))]
    except ValueError:
        return None


def _from_rows(numbers: list[float]) -> Placements:
    if len(numbers) not in (12, 16):
        raise InputError(f"{len(numbers)} numbers; expected {EXPECTED}")
    return placements_from(np.reshape([*numbers, *LAST_ROW][:16], (4, 4)))


def _table(path: str) -> dict[str, Any]:
    if not os.path.isfile(path):  # noqa: PTH113 (Path.is_file raises for names too long)
        raise InputError(f"{path!r} is neither numbers nor a file; expected {EXPECTED}, or a TOML file")
    try:
        table = toml.read(Path(path))
    except OSError as wrong:
        raise InputError(f"cannot be read: {wrong.strerror}; expected a TOML file", path) from None
    except ValueError as wrong:
        raise InputError(f"is no TOML: {wrong}", path) from None
    if set(table) != {"matrix"} and not (table and set(table) <= {"rotation", "translation"}):
        keys = ", ".join(map(repr, table)) or "no keys"
        raise InputError(f"{keys}; expected matrix, or rotation and translation or one of them", path)
    return table


def _from_table(table: dict[str, Any]) -> Placements:
    if "matrix" in table:
        rows = table["matrix"]
        return _from_rows(_array(rows, (len(rows) if isinstance(rows, list) else 4, 4)).ravel().tolist())
    return placements_from((table.get("rotation", np.eye(3)), table.get("translation", np.zeros(3))))
