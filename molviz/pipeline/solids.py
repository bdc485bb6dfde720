"""What stands for the atoms: options become representations, and a model balls and sticks."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from molviz.arrays import Strings
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
from molviz.model.spheres import Spheres
from molviz.model.sticks import NO_STICKS
from molviz.pipeline.inputs import Loaded
from molviz.pipeline.values import Options, chosen, given, parse_positive, parse_text

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


def representations_of(loaded: Loaded, options: SolidOptions) -> Strings:
    """Return the representation (n,) of every atom; raises InputError where all are hidden."""
    names = np.full(len(loaded.molecule), SPACEFILL, dtype=f"<U{max(map(len, REPRESENTATIONS))}")
    for selection, name in options.representations:
        names[select(loaded.molecule, selection)] = name
    if (names == HIDE).all():
        raise InputError("all atoms are hidden; expected one at least to draw", loaded.source)
    return names


def shown_spheres(loaded: Loaded, options: SolidOptions) -> Spheres:
    """Return the space-filling spheres of the atoms that are not hidden: they say how a picture is turned."""
    return loaded.spheres.take(np.flatnonzero(representations_of(loaded, options) != HIDE))


def solids_for(loaded: Loaded, options: SolidOptions) -> BallsAndSticks:
    """Return the balls and sticks of a model; bonds are looked for where there are sticks alone."""
    names = representations_of(loaded, options)
    if not np.isin(names, (BALL_AND_STICK, STICKS)).any():
        atom = np.flatnonzero(names != HIDE)
        return BallsAndSticks(loaded.spheres.take(atom), NO_STICKS, atom, ())
    solids = solids_of(loaded.spheres, names, bonds_of(loaded.molecule, options.bonds), options.sizes)
    return solids._replace(notes=tuple(f"{loaded.source}: {note}" for note in solids.notes))
