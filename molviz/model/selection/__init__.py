"""Keeping part of a molecule: the words that people in the field use for atoms; ``grammar.txt`` lists them."""

from pathlib import Path

import numpy as np

from molviz.arrays import Bools
from molviz.model.molecule import Molecule
from molviz.model.selection.parser import parsed
from molviz.model.selection.words import is_hydrogen, is_water

__all__ = ["NO_ATOMS", "check_selection", "grammar", "is_hydrogen", "is_water", "select"]

NO_ATOMS = Molecule.of("", np.empty((0, 3)), np.empty(0, dtype=str))


def select(molecule: Molecule, expression: str, model: int = 1) -> Bools:
    """Return which atoms (n,) the expression means; ``model`` is the number that ``/1/A`` and ``#1`` ask for.

    Raises OptionError, naming the place in the expression and what was expected there.
    """
    return parsed(molecule, expression, model)


def check_selection(expression: str) -> None:
    """Raise OptionError, as ``select`` does, for an expression that no molecule has a meaning for."""
    select(NO_ATOMS, expression)


def grammar() -> str:
    """Return the page on how atoms are selected."""
    return Path(__file__).with_name("grammar.txt").read_text(encoding="utf-8")
