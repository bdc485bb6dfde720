"""Keeping part of a molecule: an expression language in the manner of molecular viewers.

    expression = both { "or" both }            both = simple { "and" simple }
    simple     = "not" simple | "(" expression ")" | "within" NUMBER "of" simple
               | "all" | "none" | "water" | "hydrogens" | "protein" | "nucleic" | "backbone" | "sidechain"
               | ("chain" | "resn" | "resi" | "name" | "element" | "index") VALUE { VALUE }
               | ("bfactor" | "index" | "x" | "y" | "z") COMPARISON NUMBER

Values are parted by blanks or commas; ``*`` and ``?`` stand for any letters and one; ``10-20`` is a range.
"""

import re
from collections.abc import Callable, Iterable
from fnmatch import fnmatchcase
from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints, Strings
from molviz.errors import OptionError, expected_instead
from molviz.model.molecule import Molecule
from molviz.model.residues import AMINO_ACIDS, NUCLEIC_BACKBONE, NUCLEOTIDES, PROTEIN_BACKBONE, WATERS

NO_ATOMS = Molecule.of("", np.empty((0, 3)), np.empty(0, dtype=str))


def is_water(molecule: Molecule) -> Bools:
    """Return which atoms (n,) belong to water, by residue name."""
    return _member(molecule.residue_name, WATERS)


def is_hydrogen(molecule: Molecule) -> Bools:
    """Return which atoms (n,) are hydrogen or deuterium."""
    return _member(molecule.element, frozenset(("H", "D")))


def select(molecule: Molecule, expression: str) -> Bools:
    """Return which atoms (n,) the expression means.

    Raises OptionError, naming the place in the expression and what was expected there.
    """
    parser = _Parser(molecule, expression)
    chosen = parser.expression()
    if parser.token.text:
        raise parser.error("'and', 'or' or the end")
    return chosen


def check_selection(expression: str) -> None:
    """Raise OptionError, as ``select`` does, for an expression that no molecule has a meaning for."""
    select(NO_ATOMS, expression)


# ---- what the words mean


def _member(column: Strings, names: frozenset[str]) -> Bools:
    return _mapped(column, lambda text: text in names)


def _mapped(column: Strings, test: Callable[[str], bool]) -> Bools:
    """Return the test of every text (n,), made once for each different one."""
    texts, which = np.unique(column, return_inverse=True)
    return np.array([test(text) for text in texts.tolist()], dtype=bool)[which]


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


_PROPERTIES: dict[str, Callable[[Molecule], Bools]] = {
    "all": lambda molecule: np.ones(len(molecule), dtype=bool),
    "none": lambda molecule: np.zeros(len(molecule), dtype=bool),
    "water": is_water,
    "hydrogens": is_hydrogen,
    "hydrogen": is_hydrogen,
    "protein": _is_protein,
    "nucleic": _is_nucleic,
    "backbone": _is_backbone,
    "sidechain": _is_sidechain,
}
_TEXTS: dict[str, Callable[[Molecule], Strings]] = {
    "chain": lambda molecule: molecule.chain,
    "resn": lambda molecule: np.char.upper(molecule.residue_name),
    "resname": lambda molecule: np.char.upper(molecule.residue_name),
    "name": lambda molecule: np.char.upper(molecule.atom_name),
    "element": lambda molecule: np.char.upper(molecule.element),
}
_RANGES: dict[str, Callable[[Molecule], Strings]] = {
    "resi": lambda molecule: molecule.residue,
    "resid": lambda molecule: molecule.residue,
    "index": lambda molecule: molecule.row.astype(str),
}
_NUMBERS: dict[str, Callable[[Molecule], Floats]] = {
    "bfactor": lambda molecule: molecule.bfactor,
    "index": lambda molecule: molecule.row.astype(float),
    "x": lambda molecule: molecule.position[:, 0],
    "y": lambda molecule: molecule.position[:, 1],
    "z": lambda molecule: molecule.position[:, 2],
}
_COMPARISONS: dict[str, Callable[[Floats, float], Bools]] = {
    "<": np.less,
    "<=": np.less_equal,
    ">": np.greater,
    ">=": np.greater_equal,
    "=": np.equal,
    "==": np.equal,
    "!=": np.not_equal,
}
_RANGE = re.compile(r"(-?\d+)[-:](-?\d+)$")
_LEADING_NUMBER = re.compile(r"-?\d+")
FARTHEST = 1e100  # ångström: everything is nearer, and the square is a number
_DEPTH = 100  # far from what the stack of the interpreter bears
_STARTS = {*_PROPERTIES, *_TEXTS, *_RANGES, *_NUMBERS, "not", "within"}
_RESERVED = {"and", "or", "of", *_STARTS, ""}


def _matches(text: str, patterns: list[str]) -> bool:
    return any(fnmatchcase(text, pattern) for pattern in patterns)


def _in_ranges(text: str, values: list[str]) -> bool:
    """Tell whether a number with its insertion code is one of the values or its number within one of the ranges."""
    leading = _LEADING_NUMBER.match(text)
    for value in values:
        span = _RANGE.match(value)
        if text == value or (span and leading and float(span[1]) <= float(leading[0]) <= float(span[2])):
            return True
    return False


# ---- the grammar


class _Token(NamedTuple):
    text: str  # empty at the end
    start: int  # place in the expression
    quoted: bool


def _tokens(expression: str) -> list[_Token]:
    pattern = re.compile(r'"([^"]*)"|(<=|>=|==|!=|[()<>=])|([^\s(),<>=!"]+)|(\S)')
    tokens = [
        _Token(next(group for group in match.groups() if group is not None), match.start(), match[1] is not None)
        for match in pattern.finditer(expression)
        if match[0] != ","
    ]
    return [*tokens, _Token("", len(expression), False)]


class _Parser:
    """Recursive descent; every method consumes what it names and returns which atoms (n,) it means."""

    def __init__(self, molecule: Molecule, expression: str) -> None:
        self.molecule, self.text = molecule, expression
        self.tokens = _tokens(expression)
        self.at = self.depth = 0

    @property
    def token(self) -> _Token:
        return self.tokens[self.at]

    @property
    def word(self) -> str:
        return "" if self.token.quoted else self.token.text.lower()

    def error(self, expected: str, known: Iterable[str] = ()) -> OptionError:
        """Return the exception that says what was expected at the current token, or which known word was meant."""
        shown = repr(self.token.text) if self.token.text else "the end"
        instead = expected_instead(self.token.text, known, expected)
        return OptionError(f"selection {self.text!r}, position {self.token.start + 1}: {shown}; {instead}")

    def take(self) -> str:
        """Consume the current token and return its text."""
        self.at += 1
        return self.tokens[self.at - 1].text

    def expression(self) -> Bools:
        chosen = self.both()
        while self.word == "or":
            self.take()
            chosen = self.both() | chosen
        return chosen

    def both(self) -> Bools:
        chosen = self.simple()
        while self.word == "and":
            self.take()
            chosen = self.simple() & chosen
        return chosen

    def simple(self) -> Bools:
        """Consume one simple selection, counting how deep it stands within others."""
        if self.depth >= _DEPTH:
            raise self.error(f"at most {_DEPTH} selections within each other")
        self.depth += 1
        chosen = self.one()
        self.depth -= 1
        return chosen

    def one(self) -> Bools:
        word = self.word
        if word == "(":
            return self.parenthesis()
        if word not in _STARTS:
            raise self.error(f"'(' or one of {', '.join(sorted(_STARTS))}", sorted(_STARTS))
        self.take()
        if word == "not":
            return ~self.simple()
        if word == "within":
            return self.within()
        if word in _PROPERTIES:
            return _PROPERTIES[word](self.molecule)
        return self.column(word)

    def parenthesis(self) -> Bools:
        self.take()
        chosen = self.expression()
        if self.word != ")":
            raise self.error("')'")
        self.take()
        return chosen

    def column(self, word: str) -> Bools:
        if word in _NUMBERS and (self.word in _COMPARISONS or word not in _RANGES):
            return self.comparison(_NUMBERS[word](self.molecule))
        values = self.values()
        if word in _RANGES:
            return _mapped(_RANGES[word](self.molecule), lambda text: _in_ranges(text, values))
        patterns = values if word == "chain" else [value.upper() for value in values]
        return _mapped(_TEXTS[word](self.molecule), lambda text: _matches(text, patterns))

    def comparison(self, column: Floats) -> Bools:
        if self.word not in _COMPARISONS:
            raise self.error(f"one of {' '.join(_COMPARISONS)}")
        compare = _COMPARISONS[self.take()]
        return compare(column, self.number())

    def values(self) -> list[str]:
        words: list[str] = []
        while self.token.quoted or (self.word not in _RESERVED and re.match(r"[^()<>=!\"]", self.word)):
            words.append(self.take())
        if not words:
            raise self.error("a value (in double quotes if it is a word of the language)")
        return words

    def number(self) -> float:
        try:
            value = float(self.token.text)
        except ValueError:
            raise self.error("a number") from None
        if not np.isfinite(value):
            raise self.error("a finite number")
        self.take()
        return value

    def within(self) -> Bools:
        distance = self.number()
        if self.word != "of":
            raise self.error("'of'")
        self.take()
        return _within(self.molecule.position, np.flatnonzero(self.simple()), distance)


def _slabs(column: Floats, side: float) -> Ints:
    """Return the slab of width ``side`` of every number (n,), from 1; rows of empty slabs are numbered as one."""
    slabs, which = np.unique(np.floor(column / side), return_inverse=True)
    return np.cumsum(np.append(1, np.minimum(np.diff(slabs), 2))).astype(np.int64)[which]


def _within(position: Floats, target: Ints, distance: float) -> Bools:
    """Return which points (n,) are at most ``distance`` from one of the targets.

    Points and targets are cast into cubes of that edge; only targets in the 27 cubes around a point's can be so near.
    """
    near = np.zeros(len(position), dtype=bool)
    if not len(target) or distance < 0:
        return near
    distance = min(distance, FARTHEST)
    cell = np.column_stack([_slabs(column, max(distance, 1e-3)) for column in position.T])
    stride = np.cumprod([1, *(cell.max(axis=0) + 2)[:2]])
    order = target[np.argsort(cell[target] @ stride)]
    key = cell[order] @ stride
    for step in np.ndindex(3, 3, 3):
        wanted = (cell + np.array(step) - 1) @ stride
        first, last = np.searchsorted(key, wanted, "left"), np.searchsorted(key, wanted, "right")
        for offset in range(int((last - first).max())):
            rows = np.flatnonzero((first + offset < last) & ~near)
            gap = position[rows] - position[order[first[rows] + offset]]
            near[rows] = (gap**2).sum(axis=1) <= distance**2
    return near
