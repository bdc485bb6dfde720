"""What the words of a selection mean, each as the atoms (n,) or the column (n,) of a molecule."""

from collections.abc import Callable

import numpy as np

from molviz.arrays import Bools, Floats, Ints, Strings
from molviz.model.elements import UNKNOWN, symbol_of
from molviz.model.entities import ION, LIGAND, POLYMER, entities_of
from molviz.model.molecule import Molecule
from molviz.model.residues import AMINO_ACIDS, NUCLEIC_BACKBONE, NUCLEOTIDES, PROTEIN_BACKBONE, WATERS

Test = Callable[[str], bool]


def mapped(column: Strings, test: Test) -> Bools:
    """Return the test of every text (n,), made once for each different one."""
    texts, which = np.unique(column, return_inverse=True)
    return np.array([test(text) for text in texts.tolist()], dtype=bool)[which]


def is_water(molecule: Molecule) -> Bools:
    """Return which atoms (n,) belong to water, by residue name."""
    return molecule.by_atom(lambda one: _member(one.residue_name, WATERS))


def is_hydrogen(molecule: Molecule) -> Bools:
    """Return which atoms (n,) are hydrogen or deuterium."""
    return molecule.by_atom(lambda one: _member(one.element, frozenset(("H", "D"))))


def _member(column: Strings, names: frozenset[str]) -> Bools:
    return mapped(column, lambda text: text in names)


def _is_protein(molecule: Molecule) -> Bools:
    return _member(molecule.residue_name, AMINO_ACIDS)


def _is_nucleic(molecule: Molecule) -> Bools:
    return _member(molecule.residue_name, NUCLEOTIDES)


def _is_backbone(molecule: Molecule) -> Bools:
    """Return the heavy atoms of the main chains of proteins and nucleic acids."""
    protein = _is_protein(molecule) & _member(molecule.atom_name, PROTEIN_BACKBONE)
    return protein | (_is_nucleic(molecule) & _member(molecule.atom_name, NUCLEIC_BACKBONE))


def _is_sidechain(molecule: Molecule) -> Bools:
    return (_is_protein(molecule) | _is_nucleic(molecule)) & ~_is_backbone(molecule) & ~is_hydrogen(molecule)


def _is_of_kind(kind: int) -> Callable[[Molecule], Bools]:
    """Return the test for atoms of a kind of entity."""
    return lambda molecule: np.asarray(entities_of(molecule).kind == kind, dtype=bool)


KINDS: dict[str, Callable[[Molecule], Bools]] = {
    "all": lambda molecule: np.ones(len(molecule), dtype=bool),
    "none": lambda molecule: np.zeros(len(molecule), dtype=bool),
    "protein": _is_protein,
    "nucleic": _is_nucleic,
    "polymer": _is_of_kind(POLYMER),
    "ligand": _is_of_kind(LIGAND),
    "ion": _is_of_kind(ION),
    "ions": _is_of_kind(ION),
    "water": is_water,
    "hydrogens": is_hydrogen,
    "hydrogen": is_hydrogen,
    "hetatm": lambda molecule: molecule.hetero,
    "backbone": _is_backbone,
    "sidechain": _is_sidechain,
}
TEXTS: dict[str, Callable[[Molecule], Strings]] = {
    "chain": lambda molecule: molecule.chain,
    "segid": lambda molecule: molecule.segment,
    "resn": lambda molecule: np.char.upper(molecule.residue_name),
    "name": lambda molecule: np.char.upper(molecule.atom_name),
    "elem": lambda molecule: np.char.upper(molecule.element),
}
NUMBERED: dict[str, Callable[[Molecule], Strings]] = {
    "resi": lambda molecule: molecule.residue,
    "index": lambda molecule: molecule.row.astype(str),
}
MEASURED: dict[str, Callable[[Molecule], Floats]] = {
    "resi": lambda molecule: _leading_numbers(molecule.residue),
    "index": lambda molecule: molecule.row.astype(float),
    "bfactor": lambda molecule: molecule.bfactor,
    "x": lambda molecule: molecule.position[:, 0],
    "y": lambda molecule: molecule.position[:, 1],
    "z": lambda molecule: molecule.position[:, 2],
}
ALIASES = {
    "segi": "segid", "resname": "resn", "element": "elem", "resid": "resi", "residue": "resi", "b": "bfactor",
    "beta": "bfactor",
}  # fmt: skip
WITH_CAPITALS = ("chain", "segid")  # whose capital letters matter
COMPARISONS: dict[str, Callable[[Floats, float], Bools]] = {
    "<": np.less,
    "<=": np.less_equal,
    ">": np.greater,
    ">=": np.greater_equal,
    "=": np.equal,
    "==": np.equal,
    "!=": np.not_equal,
}
SAME = ("residue", "chain", "segid", "resn", "resi", "name", "elem")  # what atoms may have in common


def named(word: str) -> str:
    """Return the name of a column that a word means."""
    return ALIASES.get(word, word)


def is_element(text: str) -> bool:
    """Tell whether a text is a chemical symbol, or what stands for an unknown one."""
    return bool(symbol_of(text)) or text.upper() == UNKNOWN


def leading_number(text: str) -> float:
    """Return the whole number that a residue's name begins with, of any number of digits; NaN where there is none."""
    digits = text[:1] if text[:1] == "-" else ""
    for letter in text[len(digits) :]:
        if not "0" <= letter <= "9":
            break
        digits += letter
    return float(digits) if digits.strip("-") else np.nan


def _leading_numbers(column: Strings) -> Floats:
    texts, which = np.unique(column, return_inverse=True)
    return np.array([leading_number(text) for text in texts.tolist()], dtype=float)[which]


def alike(molecule: Molecule, word: str, chosen: Bools) -> Bools:
    """Return the atoms (n,) that have something (``SAME``) in common with one of those chosen (n,)."""
    number = _residue_numbers(molecule) if word == "residue" else _numbers(_column(molecule, word))
    return np.isin(number, number[chosen])


def _column(molecule: Molecule, word: str) -> Strings:
    name = named(word)
    return (TEXTS | NUMBERED)[name](molecule)


def _numbers(column: Strings) -> Ints:
    return np.unique(column, return_inverse=True)[1].ravel()


def _residue_numbers(molecule: Molecule) -> Ints:
    """Return a number (n,) that atoms of one residue share: chain, segment, number with insertion code, and name."""
    columns = (molecule.chain, molecule.segment, molecule.residue, molecule.residue_name)
    number = np.zeros(len(molecule), dtype=np.int64)
    for column in columns:
        texts, which = np.unique(column, return_inverse=True)
        number = np.unique(number * max(len(texts), 1) + which.ravel(), return_inverse=True)[1].ravel()
    return number
