"""The language of selections: words become atoms, by recursive descent.

    expression = both { ("or" | "|") both }            both = near { ("and" | "&") near }
    near       = simple { "around" NUMBER | "within" NUMBER "of" simple }
    simple     = ("not" | "!") near | "byres" near | "same" WORD "as" near | "(" expression ")" | KIND | SPEC
               | "within" NUMBER "of" simple | "around" NUMBER simple
               | COLUMN VALUES | COLUMN COMPARISON NUMBER
"""

import re
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats
from molviz.errors import OptionError, expected_instead
from molviz.model.molecule import Molecule
from molviz.model.selection.near import within
from molviz.model.selection.specs import BEGINS, Spec
from molviz.model.selection.values import BETWEEN, is_name, is_number, names_test, numbers_test, parts_of
from molviz.model.selection.words import (
    ALIASES,
    COMPARISONS,
    KINDS,
    MEASURED,
    NUMBERED,
    SAME,
    TEXTS,
    alike,
    mapped,
    named,
)

DEPTH = 100  # far from what the stack of the interpreter bears
SHOWN = 60  # letters of an expression or a word that a message repeats
AND, OR, NOT = ("and", "&"), ("or", "|"), ("not", "!")
COLUMNS = {*TEXTS, *NUMBERED, *MEASURED, *ALIASES}
STARTS = {*KINDS, *COLUMNS, "not", "within", "around", "byres", "same"}
SINGLE = {word for word in COLUMNS if len(word) == 1}  # x y z b: also names of chains, where no comparison follows
RESERVED = {*STARTS, *AND, *OR, *NOT, "of", "as", "to"}
USUAL = "a word such as protein, chain A, resi 10-20 or '(' (molviz help selections lists all)"
TOKEN = re.compile(
    rf'"(?P<quoted>[^"]*)"|(?P<sign><=|>=|==|!=|[()<>=!&|,])'
    rf"|(?P<spec>[{BEGINS}][^\s()&|\"<>]*(?:\([^()\s]*\)[^\s()&|\"<>]*)*)"
    r'|(?P<word>[^\s(),<>=!&|"]+)|(?P<other>\S)'
)


class Token(NamedTuple):
    """A word of the expression."""

    text: str  # empty at the end
    start: int  # place in the expression
    kind: str  # quoted, sign, spec, word or other; end


def tokens_of(expression: str) -> list[Token]:
    """Return the words of an expression, and its end."""
    found = [
        Token(str(match[str(match.lastgroup)]), match.start(), str(match.lastgroup))
        for match in TOKEN.finditer(expression)
    ]
    return [*found, Token("", len(expression), "end")]


def parsed(molecule: Molecule, expression: str, model: int) -> Bools:
    """Return the atoms (n,) that an expression means; raises OptionError where it is none."""
    return _Parser(molecule, expression, model).whole()


class _Parser:
    """Every method consumes what it names and returns which atoms (n,) it means."""

    def __init__(self, molecule: Molecule, expression: str, model: int) -> None:
        self.molecule, self.text, self.model = molecule, expression, model
        self.tokens = tokens_of(expression)
        self.at = self.depth = 0

    @property
    def token(self) -> Token:
        """The word that comes next."""
        return self.tokens[self.at]

    @property
    def word(self) -> str:
        """The word that comes next in small letters; none for what is quoted."""
        return "" if self.token.kind == "quoted" else self.token.text.lower()

    def error(self, expected: str, known: Iterable[str] = ()) -> OptionError:
        """Return the exception that says what was expected at the current token, or which known word was meant."""
        shown = repr(_cut(self.token.text)) if self.token.text else "the end"
        instead = expected_instead(self.token.text[:SHOWN], () if self.word in RESERVED else known, expected)
        return OptionError(f"selection {_cut(self.text)!r}, position {self.token.start + 1}: {shown}; {instead}")

    def take(self) -> str:
        """Consume the current token and return its text."""
        self.at += 1
        return self.tokens[self.at - 1].text

    def demand(self, word: str) -> None:
        """Consume one certain word."""
        if self.word != word:
            raise self.error(repr(word))
        self.take()

    def whole(self) -> Bools:
        """Return the atoms that the whole expression means."""
        chosen = self.expression()
        if self.token.kind != "end":
            raise self.error("'and', 'or' or the end", ("and", "or", "around", "within"))
        return chosen

    def expression(self) -> Bools:
        chosen = self.both()
        while self.word in OR:
            self.take()
            chosen = self.both() | chosen
        return chosen

    def both(self) -> Bools:
        chosen = self.near()
        while self.word in AND:
            self.take()
            chosen = self.near() & chosen
        return chosen

    def near(self) -> Bools:
        """Consume a simple selection and what is said behind it of distances; counts how deep it stands in others."""
        if self.depth >= DEPTH:
            raise self.error(f"at most {DEPTH} selections within each other")
        self.depth += 1
        chosen = self.simple()
        while self.word in ("around", "within"):
            chosen = self.around(self.number(), chosen) if self.take() == "around" else chosen & self.within()
        self.depth -= 1
        return chosen

    def simple(self) -> Bools:
        word = self.word
        if self.token.kind == "spec":
            return self.spec()
        if word not in STARTS and word not in ("(", "!"):
            raise self.error(USUAL, STARTS)
        self.take()
        if word in KINDS:
            return KINDS[word](self.molecule)
        if word in COLUMNS:
            return self.column(named(word))
        return self.operator(word)

    def operator(self, word: str) -> Bools:
        """Return what an operator, consumed already, makes of that which follows."""
        if word == "(":
            chosen = self.expression()
            self.demand(")")
            return chosen
        if word == "within":
            return self.within()
        if word == "around":
            return self.around(self.number(), self.near())
        if word == "byres":
            return alike(self.molecule, "residue", self.near())
        return self.same() if word == "same" else ~self.near()

    def same(self) -> Bools:
        word = self.word
        if word not in SAME and named(word) not in SAME:
            raise self.error(f"one of {', '.join(SAME)}", SAME)
        self.take()
        self.demand("as")
        return alike(self.molecule, word, self.near())

    def within(self) -> Bools:
        distance = self.number()
        self.demand("of")
        return within(self.molecule.position, np.flatnonzero(self.near()), distance)

    def around(self, distance: float, chosen: Bools) -> Bools:
        return within(self.molecule.position, np.flatnonzero(chosen), distance) & ~chosen

    def spec(self) -> Bools:
        try:
            chosen = Spec(self.molecule, self.model).atoms(self.token.text)
        except ValueError as wrong:
            raise self.error(str(wrong)) from None
        self.take()
        return chosen

    # ---- columns

    def column(self, word: str) -> Bools:
        if word in MEASURED and (self.word in COMPARISONS or word not in NUMBERED):
            return self.comparison(MEASURED[word](self.molecule))
        if word in NUMBERED:
            return mapped(NUMBERED[word](self.molecule), numbers_test(self.numbers(word)))
        return mapped(TEXTS[word](self.molecule), names_test(word, self.names(word)))

    def comparison(self, column: Floats) -> Bools:
        if self.word not in COMPARISONS:
            raise self.error(f"one of {' '.join(COMPARISONS)}")
        compare = COMPARISONS[self.take()]
        return compare(column, self.number())

    def number(self) -> float:
        try:
            value = float(self.token.text)
        except ValueError:
            raise self.error("a number") from None
        if not np.isfinite(value):
            raise self.error("a finite number")
        self.take()
        return value

    def names(self, column: str) -> list[tuple[str, bool]]:
        """Consume a list of names and return each with whether it is quoted."""
        names: list[tuple[str, bool]] = []
        listed = True  # a name has to follow
        while listed or self.goes_on():
            quoted = self.token.kind == "quoted"
            if not quoted and (self.token.kind != "word" or self.word in (*AND, *OR, *NOT, "to")):
                raise self.error("a value (in double quotes if it is a word of the language)")
            parts = [self.token.text] if quoted else parts_of(self.token.text)
            if not quoted and not all(is_name(column, part) for part in parts):
                raise self.error("a chemical symbol")
            names += [(part, quoted) for part in parts]
            self.take()
            listed = self.comma()
        return names

    def goes_on(self) -> bool:
        """Tell whether the next word belongs to a list of names that has begun."""
        if self.token.kind == "quoted":
            return True
        if self.token.kind != "word" or (self.word in RESERVED and self.word not in SINGLE):
            return False
        return self.word not in SINGLE or self.tokens[self.at + 1].text not in COMPARISONS

    def comma(self) -> bool:
        """Consume a comma and tell whether there was one."""
        if self.token.kind == "sign" and self.token.text == ",":
            self.take()
            return True
        return False

    def numbers(self, column: str) -> list[str]:
        """Consume a list of numbers and ranges; each is returned as one text, ``10-20`` for a range."""
        values: list[str] = []
        listed = True  # a number has to follow
        while listed or self.token.kind == "quoted" or self.word[:1] in tuple("-0123456789"):
            quoted = self.token.kind == "quoted"
            parts = [self.token.text] if quoted else parts_of(self.token.text)
            if not quoted and not all(is_number(column, part) for part in parts):
                raise self.error("a number or a range such as 10-20")
            self.take()
            if self.word in BETWEEN:
                parts[-1] = self.range_from(parts[-1])
            values += parts
            listed = self.comma()
        return values

    def range_from(self, low: str) -> str:
        """Consume the second half of a range whose words stand apart."""
        self.take()
        if not all(re.fullmatch(r"-?\d+", end, re.ASCII) for end in (low, self.token.text)):
            raise self.error("whole numbers at both ends of a range")
        return f"{low}:{self.take()}"


def _cut(text: str) -> str:
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}…"
