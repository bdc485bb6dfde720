"""What stands for the atoms: options become representations, and a model balls and sticks."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from molviz.arrays import Bools, Strings
from molviz.errors import InputError, expected_instead
from molviz.geometry.bonds import bonds_of
from molviz.geometry.solids import BallsAndSticks, solids_of
from molviz.model.representations import (
    BALL_AND_STICK,
    BALL_SCALE,
    HIDE,
    REPRESENTATIONS,
    SPACEFILL,
    STICKS,
    USUAL,
    Sizes,
)
from molviz.model.selection import check_selection, select
from molviz.model.sticks import NO_STICKS
from molviz.pipeline.inputs import Loaded
from molviz.pipeline.values import Options, chosen, given, parse_positive, parse_text
from molviz.readers.atoms import coinciding_rows

EVERYTHING = "all"


class SolidOptions(NamedTuple):
    """How the user wants atoms to be shown; the last representation whose selection an atom is in is the atom's."""

    representations: tuple[tuple[str, str], ...] = ()  # selection, representation
    bonds: str = "file"
    sizes: Sizes = USUAL


def solid_options_from(options: Options) -> SolidOptions:
    """Return how atoms are to be shown; raises OptionError naming the option that is wrong."""
    pairs = given(options, "rep", parse_representations) or ()
    for selection, _ in pairs:
        check_selection(selection)
    scale = given(options, "ball_scale", parse_positive) or BALL_SCALE
    sizes = Sizes(scale, given(options, "stick_radius", parse_positive))
    return SolidOptions(pairs, chosen(options, "bonds"), sizes)


def parse_representations(value: Any) -> tuple[tuple[str, str], ...]:
    """Return selection and representation of ``"sticks"``, ``"resn HEM=sticks"``, such a pair, or several of these."""
    is_pair = isinstance(value, tuple) and len(value) == 2 and value[0] not in REPRESENTATIONS
    one = isinstance(value, str) or (is_pair and value[1] in REPRESENTATIONS)
    return tuple(map(_representation, [value] if one else value))


def _representation(value: Any) -> tuple[str, str]:
    """Return the pair that a text means, split at the last =; raises ValueError for a name that is none."""
    if isinstance(value, Sequence) and not isinstance(value, str) and len(value) == 2:
        selection, name = map(parse_text, value)
    else:
        selection, sign, name = parse_text(value).rpartition("=")
        selection = selection if sign else EVERYTHING
    name = name.strip().lower()
    if name not in REPRESENTATIONS:
        instead = expected_instead(name, REPRESENTATIONS, f"one of {', '.join(REPRESENTATIONS)}")
        raise ValueError(f"no representation {name!r}; {instead}")
    return selection, name


def shown(loaded: Loaded, options: SolidOptions) -> tuple[Loaded, Strings]:
    """Return a model less its hidden atoms, and the representation (n,) of each of the others.

    Where elements share a site of a crystal, the first of them has the ball to which the sticks lead. Raises InputError
    where all are hidden.
    """
    if not options.representations:
        return loaded, np.broadcast_to(np.array(SPACEFILL), len(loaded.molecule))
    names = np.full(len(loaded.molecule), SPACEFILL, dtype=f"<U{max(map(len, REPRESENTATIONS))}")
    for selection, name in options.representations:
        names[select(loaded.molecule, selection, loaded.model)] = name
    joined = np.flatnonzero(_has_sticks(names))
    names[joined[coinciding_rows(loaded.molecule.position[joined])]] = HIDE
    keep = names != HIDE
    if keep.all():
        return loaded, names
    if not keep.any():
        raise InputError("all atoms are hidden; expected one at least to draw", loaded.source)
    return loaded.filtered(keep), names[keep]


def _has_sticks(representation: Strings) -> Bools:
    return np.asarray((representation == BALL_AND_STICK) | (representation == STICKS))


def solids_for(loaded: Loaded, representation: Strings, options: SolidOptions) -> BallsAndSticks:
    """Return what stands for the atoms of a model without hidden ones; bonds are looked for where any are drawn."""
    if not _has_sticks(representation).any():
        return BallsAndSticks(loaded.balls, NO_STICKS, ())
    solids = solids_of(loaded.spheres, representation, bonds_of(loaded.molecule, options.bonds), options.sizes)
    return solids._replace(notes=tuple(f"{loaded.source}: {note}" for note in solids.notes))
