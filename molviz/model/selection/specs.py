"""Short forms that name atoms in one word: gemmi's ``/1/A/10(ALA)/CA[C]`` and ChimeraX's ``#1/A:10-20@CA``.

gemmi documentation, "Selections" (after the MMDB library's coordinate IDs); ChimeraX User Guide, "Command-Line Target
Specification". Both are read without their conditions on other things (``;q<0.5``, ``::attribute``, zones).
"""

import re

import numpy as np

from molviz.arrays import Bools
from molviz.model.molecule import Molecule
from molviz.model.selection.values import is_name, is_number, names_test, numbers_test
from molviz.model.selection.words import NUMBERED, TEXTS, Test, mapped

BEGINS = "/#:@"  # what the first letter of such a word is
_LIST = r"[^/:@\[\]();]*"
_CID = re.compile(rf"/({_LIST})/({_LIST})(?:/({_LIST})(?:\(({_LIST})\))?(?:/({_LIST})(?:\[({_LIST})\])?)?)?")
_CHIMERA = re.compile(rf"(?:#({_LIST}))?(?:/({_LIST}))?(?::({_LIST}))?(?:@({_LIST}))?")
_CID_FORM, _CHIMERA_FORM = "/model/chain/residues(names)/atoms[elements]", "#model/chain:residues@atoms"


class Spec:
    """The atoms that one word names; ``wrong`` of a part raises ValueError that says what was expected."""

    def __init__(self, molecule: Molecule, model: int) -> None:
        self.molecule, self.model = molecule, model

    def atoms(self, word: str) -> Bools:
        """Return the atoms (n,); raises ValueError, saying what was expected, where the word is neither form."""
        return self._cid(word) if word.count("/") > 1 else self._chimera(word)

    def _cid(self, word: str) -> Bools:
        match = _CID.fullmatch(word)
        if not match:
            raise ValueError(f"{_CID_FORM} (gemmi)")
        model, chain, residues, names, atoms, elements = match.groups()
        chosen = self._of_model(model) & self._named("chain", chain) & self._numbered(residues)
        return chosen & self._named("resn", names) & self._named("name", atoms) & self._named("elem", elements)

    def _chimera(self, word: str) -> Bools:
        match = _CHIMERA.fullmatch(word)
        if not match or "" in match.groups():
            raise ValueError(f"{_CHIMERA_FORM} (ChimeraX)")
        model, chain, residues, atoms = match.groups()
        chosen = self._of_model(model) & self._named("chain", chain) & self._named("name", atoms)
        return chosen if residues is None else chosen & self._residues(residues)

    def _of_model(self, text: str | None) -> Bools:
        if text and text != "*" and not re.fullmatch("[0-9]{1,18}", text):
            raise ValueError("the number of a model")
        right = text in (None, "", "*") or int(str(text)) == self.model
        return np.full(len(self.molecule), right)

    def _named(self, column: str, text: str | None) -> Bools:
        """Return the atoms with one of the listed names; none or ``*``: all, and behind ``!`` all but these."""
        if text in (None, "", "*"):
            return np.ones(len(self.molecule), dtype=bool)
        names = str(text).removeprefix("!").split(",")
        wrong = [name for name in names if not name or not is_name(column, name)]
        if wrong:
            raise ValueError(f"a name in each place of the list {text!r}")
        chosen = mapped(TEXTS[column](self.molecule), names_test(column, [(name, False) for name in names]))
        return ~chosen if str(text).startswith("!") else chosen

    def _numbered(self, text: str | None) -> Bools:
        """Return the atoms of the listed residues of a CID; gemmi parts an insertion code by a dot."""
        if text in (None, "", "*"):
            return np.ones(len(self.molecule), dtype=bool)
        values = [re.sub(r"(\d)\.(?=[A-Za-z])", r"\1", value) for value in str(text).split(",")]
        if not all(is_number("resi", value) for value in values):
            raise ValueError("numbers of residues or ranges such as 10-20")
        return self._mapped_residues(numbers_test(values))

    def _residues(self, text: str) -> Bools:
        """Return the atoms of the residues that ChimeraX lists by number, range or name."""
        values = text.split(",")
        if not all(values) or any(value[0] in "-0123456789" and not is_number("resi", value) for value in values):
            raise ValueError("numbers, ranges such as 10-20 or names of residues")
        numbers = [value for value in values if is_number("resi", value)]
        names = [(value, False) for value in values if not is_number("resi", value)]
        by_name = mapped(TEXTS["resn"](self.molecule), names_test("resn", names))
        return by_name | self._mapped_residues(numbers_test(numbers))

    def _mapped_residues(self, test: Test) -> Bools:
        return mapped(NUMBERED["resi"](self.molecule), test)
