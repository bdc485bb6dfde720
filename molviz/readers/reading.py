"""What a file held: its models and the assemblies that its own operators make of them."""

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Strings
from molviz.errors import InputError, listed
from molviz.model.assembled import Assembled, Copy
from molviz.model.molecule import Molecule


class AssemblyPart(NamedTuple):
    """Chains that are copied by the same operators ``x → R x + t``."""

    chains: frozenset[str]  # as the file's operators call them; empty for all
    operators: Floats  # (k, 3, 4), R in the first three columns, t in the last, ångström


@dataclass(frozen=True, repr=False)
class Reading:
    """Everything that one file held.

    ``models`` are models or frames in the order of the file, less alternate locations. ``warnings`` read
    ``FILE:LINE: what is odd``, one of a kind. ``operator_chain`` holds for every model the names (n,) by which the
    operators of ``assemblies`` call the chains.
    """

    source: str
    format: str
    models: tuple[Molecule, ...]
    assemblies: Mapping[str, tuple[AssemblyPart, ...]] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    operator_chain: tuple[Strings, ...] = ()

    def __repr__(self) -> str:
        atoms, s = sum(map(len, self.models)), "" if len(self.models) == 1 else "s"
        return f"<Reading of {self.source!r}: {self.format}, {len(self.models)} model{s}, {atoms} atoms>"

    def warned(self, warnings: list[str]) -> "Reading":
        """Return the reading with more warnings, put first."""
        return replace(self, warnings=(*warnings, *self.warnings))

    def assembly(self, id: str, model: int = 0) -> Molecule:
        """Return a biological assembly of one model: all its copies, the n-th copy of chain A named ``A-n``.

        Raises InputError, naming the assemblies there are, where the file has no such operators.
        """
        if id not in self.assemblies:
            known = listed(list(self.assemblies)) or "none"
            raise InputError(f"no assembly {id!r}; the file has operators for: {known}", self.source)
        molecule, chain = self.models[model], self.operator_chain[model]
        copies: list[Copy] = []
        made: Counter[str] = Counter()
        for part in self.assemblies[id]:
            rows = np.flatnonzero(np.isin(chain, list(part.chains))) if part.chains else np.arange(len(molecule))
            first = 1 + max((made[name] for name in part.chains), default=0)
            copies += [Copy(rows, move, _suffix(number)) for number, move in enumerate(part.operators, first)]
            made.update({name: len(part.operators) for name in part.chains})
        if not sum(len(copy.rows) for copy in copies):
            raise InputError(f"assembly {id!r} is made of chains that are not in the file", self.source)
        return Assembled.of_copies(molecule, copies)


def _suffix(number: int) -> str:
    """Return what the name of a chain's n-th copy ends in."""
    return f"-{number}" if number > 1 else ""


class BeyondCountError(InputError):
    """More atoms than the count of a frame says: that frame is in doubt, not the next."""


def sound_frames(frames: Iterable[Molecule]) -> tuple[tuple[Molecule, ...], list[str]]:
    """Return the frames of a trajectory before the first whose making raises InputError, and a warning about that.

    Raises what the first frame raises, and BeyondCountError.
    """
    sound: list[Molecule] = []
    try:
        for frame in frames:
            sound.append(frame)
    except InputError as wrong:
        if not sound or isinstance(wrong, BeyondCountError):
            raise
        return tuple(sound), [left_out(wrong, len(sound), "frame")]
    return tuple(sound), []


def left_out(wrong: InputError, sound: int, what: str) -> str:
    """Return the warning that a file is read up to its first broken frame or model."""
    return f"{wrong}; {what} {sound + 1} and all behind it are left out"
