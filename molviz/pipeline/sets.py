"""Sets of pictures: a turntable, the frames of a trajectory, the two views of a stereo pair, all framed alike."""

import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from pathlib import PurePath

import numpy as np

from molviz.errors import InputError, OptionError
from molviz.model.entities import entities_of
from molviz.picture.options import Alike, Depth
from molviz.picture.page import Margins
from molviz.picture.picture import Picture
from molviz.picture.stereo import beside, page_of_half
from molviz.pipeline.draw import JSON, Drawing, DrawRequest, drawing_of, drawings_of, suffixes
from molviz.pipeline.inputs import Loaded, means_several
from molviz.pipeline.outputs import NUMBER, makes_folder, pieces_of, refuse_inputs, save
from molviz.pipeline.solids import shown
from molviz.pipeline.units import unit_of
from molviz.pipeline.values import Options, chosen, given, parse_count
from molviz.pipeline.views import ViewOptions, view_of
from molviz.visibility.view import View
from molviz.write import MANY, write_many

EYE_TURN = 3.0  # degrees to either side of the view: eyes 65 mm apart, 62 cm from what they look at
ROUNDS = 4  # of looking for margins that serve all pictures: another scale may place labels anew


@dataclass(frozen=True)
class SetOptions:
    """Which pictures belong to the set."""

    models: bool = False  # one of each model
    turntable: int | None = None  # views around the page's y axis
    stereo: str | None = None  # "wall" or "cross"

    @property
    def many(self) -> bool:
        """Whether there may be more than one picture."""
        return self.models or self.turntable is not None


@dataclass(frozen=True, repr=False, eq=False)
class DrawingSet:
    """Several pictures framed and coloured alike; a notebook shows them as one animated SVG.

    ``numbers`` are those of the models, or from 1 around a turntable. ``atoms_read`` and ``atoms_drawn`` count those of
    the first picture's molecule, ``visible`` and ``arcs`` those of all drawings.
    """

    numbers: tuple[int, ...]
    _views: tuple[tuple[Drawing, ...], ...]  # of each picture: one, or for a stereo pair what is left and what is right

    def __len__(self) -> int:
        return len(self.numbers)

    def __repr__(self) -> str:
        kind = "stereo pairs" if len(self._views[0]) > 1 else "pictures"
        name = self._views[0][0].subject.molecule.name
        return f"<DrawingSet of {name!r}: {len(self)} {kind}, {self.atoms_drawn} atoms drawn, {self.arcs} arcs>"

    def _repr_svg_(self) -> str:
        return self.svg()

    @property
    def notes(self) -> tuple[str, ...]:
        """What is odd about every picture: what is hidden in some may be seen in others."""
        first, *others = (drawing.notes for views in self._views for drawing in views)
        return tuple(note for note in first if all(note in notes for notes in others))

    @property
    def atoms_read(self) -> int:
        """Atoms of the first model."""
        return self._views[0][0].atoms_read

    @property
    def atoms_drawn(self) -> int:
        """Atoms of the first model that the options left."""
        return self._views[0][0].atoms_drawn

    @property
    def visible(self) -> int:
        """Atoms of which something is seen, summed over all drawings."""
        return sum(drawing.visible for views in self._views for drawing in views)

    @property
    def arcs(self) -> int:
        """Pieces of all lines of all drawings."""
        return sum(drawing.arcs for views in self._views for drawing in views)

    def svg(self) -> str:
        """Return the pictures as the text of one SVG file, which shows them in turn."""
        return self.to("svg").decode("utf-8")

    def to(self, format: str, plotter: str = "", paper: str = "") -> bytes:
        """Return all pictures in one file: ``"pdf"`` and ``"ps"`` of many pages, ``"svg"`` and ``"svgz"`` animated.

        A set of one picture has the formats of a ``Drawing``. Raises InputError for a format that nobody knows or that
        cannot hold so many.
        """
        return b"".join(self.pieces(format, plotter, paper))

    def pieces(self, format: str, plotter: str = "", paper: str = "") -> Iterable[bytes]:
        """Return the same in pieces that are made one by one; raises as ``to`` does."""
        suffix = _known(f".{str(format).removeprefix('.')}")
        if len(self) == 1:
            return self._one(0, suffix, plotter, paper)
        if suffix not in MANY:
            raise InputError(f"{suffix} holds one picture; {ONE_EACH}")
        return write_many([self._picture(row, suffix) for row in range(len(self))], suffix)

    def save(self, path: str | os.PathLike[str], plotter: str = "", paper: str = "") -> None:
        """Write one file, or for a path with ``{n}`` one for each picture, named by its number.

        The suffix of the path names the format. Raises InputError as ``to`` does, and where a file cannot be written.
        """
        made = makes_folder(os.fspath(path))
        for target, data in self.files(os.fspath(path), PurePath(path).suffix, plotter, paper):
            refuse_inputs(target, [self._views[0][0].source])
            save(target, data, made)

    def files(
        self, path: str, format: str, plotter: str = "", paper: str = ""
    ) -> Iterator[tuple[str, Iterable[bytes]]]:
        """Yield the name and the content of each file that ``path`` means; raises InputError as ``to`` does."""
        if NUMBER not in path:
            yield path, self.pieces(format, plotter, paper)
            return
        suffix, digits = _known(format), len(str(max(self.numbers)))
        for row, number in enumerate(self.numbers):
            yield path.replace(NUMBER, str(number).zfill(digits)), self._one(row, suffix, plotter, paper)

    def _one(self, row: int, suffix: str, plotter: str, paper: str) -> Iterable[bytes]:
        views = self._views[row]
        if len(views) == 1:
            return views[0].pieces(suffix, plotter, paper)
        if suffix == JSON:
            raise InputError("a stereo pair has two maps; expected a format for pictures")
        return pieces_of(self._picture(row, suffix), suffix, plotter, paper)

    def _picture(self, row: int, suffix: str) -> Picture:
        return reduce(beside, (drawing.picture(suffix) for drawing in self._views[row]))


ONE_EACH = f"expected {NUMBER} in the name of the file, or one of {' '.join(MANY)}"


def holds_set(path: str, suffix: str) -> bool:
    """Return whether a path and a format have room for several pictures."""
    return NUMBER in path or suffix in MANY


def set_options_from(options: Options) -> SetOptions:
    """Return which pictures are wanted; raises InputError naming the option that is wrong."""
    models, turntable = means_several(str(options["model"])), given(options, "turntable", parse_count)
    if models and turntable is not None:
        raise OptionError("turntable: it turns one model; expected a single model")
    stereo = chosen(options, "stereo") if options["stereo"] is not None else None
    return SetOptions(models, turntable, stereo)


def drawn(
    loaded: Sequence[Loaded],
    request: DrawRequest,
    view_options: ViewOptions,
    together: SetOptions,
    method: str = "visible",
    check: bool = False,
) -> Drawing | DrawingSet:
    """Return the drawing of one model, or a set where the options mean one; ``method`` and ``check`` as there.

    All pictures have the scale, the page, the orientation and the tints of chains in common. Raises InputError where
    an eye is not in front of all atoms.
    """
    if not together.many and together.stereo is None:
        return drawing_of(loaded[0], request, view_options, method, check)
    first, _ = shown(loaded[0], request.solids)
    options = request.options.settled(entities_of(first.molecule), method == "painter")
    if together.stereo:
        options = replace(options, page=page_of_half(options.page))
    request, view = replace(request, options=options), view_of(first.balls, view_options)
    unit = unit_of(first)
    around = views_around(view, together.turntable or 1)
    views = [eye for one in around for eye in eyes(one, together.stereo)]
    drawn_models = (drawings_of(model, request, views, method, check, unit) for model in loaded)
    drawings = framed_alike([one for drawings in drawn_models for one in drawings])
    step = len(views) // len(around)
    pictures = tuple(tuple(drawings[row : row + step]) for row in range(0, len(drawings), step))
    numbers = [one.model for one in loaded] if together.models else range(1, len(around) + 1)
    return DrawingSet(tuple(numbers), pictures)


def views_around(view: View, count: int) -> list[View]:
    """Return views of a molecule that is turned about the page's y axis, once around in equal steps."""
    return [view.rotated("y", 360.0 * k / count) if k else view for k in range(count)]


def eyes(view: View, stereo: str | None) -> list[View]:
    """Return the views that stand beside each other, from left to right.

    What the left eye sees is turned to the right, so that near things lie farther to the right for it: it is on the
    left for eyes that look at a ``wall``, and on the right for eyes that ``cross``.
    """
    if stereo is None:
        return [view]
    left, right = view.rotated("y", EYE_TURN), view.rotated("y", -EYE_TURN)
    return [left, right] if stereo == "wall" else [right, left]


def framed_alike(drawings: Sequence[Drawing]) -> list[Drawing]:
    """Return drawings with one scale and one page, equal tints, and equal colours for equal depths and values."""
    low = np.min([drawing.subject.low for drawing in drawings], axis=0)
    high = np.max([drawing.subject.high for drawing in drawings], axis=0)
    shared, before = Alike(), None
    for _ in range(ROUNDS):
        drawings = [
            replace(drawing, subject=replace(drawing.subject, low=low, high=high, alike=shared)) for drawing in drawings
        ]
        if shared == before:
            break
        before, shared = shared, united([drawing.alike() for drawing in drawings])
    return list(drawings)


def united(several: Sequence[Alike]) -> Alike:
    """Return what serves all pictures; chains have the tints of the first in which they are."""
    free = reduce(Margins.or_more, (one.free for one in several))
    depths = [one.depth for one in several if one.depth is not None]
    tint = {chain: tint for one in reversed(several) for chain, tint in (one.tint or {}).items()}
    depth = (_hull([first for first, _ in depths]), _hull([second for _, second in depths])) if depths else None
    return Alike(free, depth, tint, _hull([one.values for one in several if one.values is not None]))


def _hull(intervals: Sequence[Depth]) -> Depth:
    return min(low for low, _ in intervals), max(high for _, high in intervals)


def _known(suffix: str) -> str:
    if suffix.lower() not in suffixes():
        raise InputError(f"no format {suffix!r}; expected one of {' '.join(suffixes())}")
    return suffix.lower()
