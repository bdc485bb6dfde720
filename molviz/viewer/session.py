"""What a page asks, and what it is answered: options in, pictures and numbers out, whatever carries them.

A question is a table with ``ask``, the number of the ``input``, and ``options`` by name; an answer has a head that is
JSON and a body of bytes. Questions come from outside: they may name options of the panel alone, and no file but those
that the session began with.
"""

import threading
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import PurePath
from typing import Any, NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.errors import InputError, InternalError, OptionError
from molviz.geometry.rows import expand
from molviz.geometry.solids import BallsAndSticks
from molviz.model.entities import entities_of
from molviz.model.selection import select
from molviz.model.spheres import Spheres
from molviz.pipeline.draw import Drawing, DrawRequest, draw_request_from, subject_of
from molviz.pipeline.inputs import InputOptions, Loaded, loaded_from, means_several, only_model
from molviz.pipeline.outputs import stem_of
from molviz.pipeline.sets import SetOptions, drawn
from molviz.pipeline.solids import shown, solids_for
from molviz.pipeline.state import USUAL, checked_state, state_of_text, state_text
from molviz.pipeline.values import Options, chosen, given, input_options_from, parse_model, view_options_from
from molviz.pipeline.views import view_of
from molviz.readers import Reading, read
from molviz.viewer.command import call_of, command_of, drawn_by
from molviz.viewer.panel import NAMES, choices_of, panel

MOST_LOADED = 4  # models kept ready: those of the last selections
BEAD_STEP = 0.7  # of a stick's radius, from bead to bead
MOST_BEADS = 150_000  # of all sticks
MOST_PAGES = 64  # whose newest questions are remembered
FORMATS = ("svg", "pdf", "eps", "ps", "hpgl")
FILES = ("style", "palette")  # options that may name a file


class AbandonedError(Exception):
    """A newer question came from the same page."""


class Answer(NamedTuple):
    """What a question is answered; the head holds ``error`` where it could not be."""

    head: dict[str, Any]
    body: bytes = b""


@dataclass(frozen=True)
class Input:
    """One thing to look at; ``expression`` is what Python calls it, "" where it is a file for the command line."""

    name: str
    path: str
    reading: Reading
    expression: str = ""


class Session:
    """Inputs and the options to begin with; answers questions, those of one page in the order of their numbers."""

    def __init__(self, inputs: Sequence[Input], options: Options) -> None:
        self.inputs, self.options = inputs, {**USUAL, **options}
        self._loaded: OrderedDict[tuple[int, InputOptions], Loaded] = OrderedDict()
        self._newest: OrderedDict[str, int] = OrderedDict()
        self._lock = threading.Lock()
        self._answers: dict[str, Callable[[Mapping[str, Any]], Answer]] = {
            "start": self._start, "scene": self._scene, "picture": self._picture, "count": self._count,
            "save": self._save, "state": self._state, "load": self._load,
        }  # fmt: skip

    def __repr__(self) -> str:
        return f"<Session: {', '.join(one.name for one in self.inputs)}>"

    def begun(self, number: int) -> tuple[str, ...]:
        """Return what is odd about an input; raises InputError where it cannot be drawn with the options begun with."""
        draw_request_from(self.options)
        view_options_from(self.options)
        return self._load_model(number, self.options).warnings

    def heard(self, question: object) -> None:
        """Note that a page has a newer question, so that older ones of its kind need no answer any more."""
        if isinstance(question, Mapping) and isinstance(question.get("number"), int):
            page = f"{question.get('page')}"[:64]
            with self._lock:
                self._newest[page] = max(question["number"], self._newest.pop(page, 0))
                if len(self._newest) > MOST_PAGES:
                    self._newest.popitem(last=False)

    def answer(self, question: object) -> Answer:
        """Return the answer; what is wrong with a question, or with the data, is told in its head."""
        try:
            if not isinstance(question, Mapping) or question.get("ask") not in self._answers:
                raise OptionError(f"no such question; expected one of {', '.join(self._answers)}")
            self._refuse_old(question)
            return self._answers[question["ask"]](question)
        except AbandonedError:
            return Answer({"abandoned": True})
        except InputError as wrong:
            return Answer({"error": str(wrong)})
        except Exception as failure:  # the page goes on, whatever happened to one question
            return Answer({"error": str(InternalError(f"{type(failure).__name__}: {failure}"))})

    def _refuse_old(self, question: Mapping[str, Any]) -> None:
        number = question.get("number")
        if isinstance(number, int) and number < self._newest.get(f"{question.get('page')}"[:64], 0):
            raise AbandonedError

    # ---- the questions

    def _start(self, question: Mapping[str, Any]) -> Answer:
        """What the page needs before anything else."""
        options = {name: self.options[name] for name in NAMES}
        inputs = [{"name": one.name, "models": len(one.reading.models)} for one in self.inputs]
        return Answer({"inputs": inputs, "options": options, "panel": self._panel(), "formats": FORMATS})

    def _panel(self) -> list[dict[str, Any]]:
        """The panel, which offers the file that the session began with too."""
        groups = panel()
        for field in (field for group in groups for field in group["fields"]):
            if field["name"] in FILES and self.options[field["name"]] not in field["choices"]:
                field["choices"].append(self.options[field["name"]])
        return groups

    def _scene(self, question: Mapping[str, Any]) -> Answer:
        """Spheres, names and colours of what is drawn: enough to turn it without asking again."""
        number, options = self._asked(question)
        request = draw_request_from(options)
        loaded, representation = shown(self._load_model(number, options), request.solids)
        solids = solids_for(loaded, representation, request.solids)
        view, molecule = view_of(loaded.spheres, view_options_from(options)), loaded.molecule
        residue, residues = _numbered([
            " ".join(part for part in parts if part)
            for parts in zip(molecule.residue_name.tolist(), molecule.residue.tolist(), molecule.chain.tolist(),
                             strict=True)
        ])  # fmt: skip
        name, names = _numbered(molecule.atom_name.tolist())
        balls, atom = _with_beads(solids)
        head = {
            "atoms": len(molecule), "balls": len(atom), "read": loaded.read, "residues": residues, "names": names,
            "selections": _selections(loaded, residue), "rotation": view.rotation.tolist(),
            "center": view.center.tolist(), "distance": view.distance,
            "warnings": [
                one.removeprefix(f"{loaded.source}: ") for one in dict.fromkeys((*loaded.warnings, *solids.notes))
            ],
        }  # fmt: skip
        numbers = np.column_stack([balls.center - view.center, balls.radius]).astype("<f4")
        body = [numbers.tobytes(), *(column.astype("<u4").tobytes() for column in (atom, residue, name))]
        return Answer(head, b"".join([*body, _bytes_of(_first_colors(loaded, request, options["method"]))]))

    def _picture(self, question: Mapping[str, Any]) -> Answer:
        """The exact picture as SVG, and before it the colours of its atoms."""
        number, options = self._asked(question)
        drawing = self._drawing(number, options)
        self._refuse_old(question)
        placement, colors = drawing.placed_and_colored()
        svg = drawing.to("svg")
        head = {
            "scale": placement.scale, "shift": placement.shift.tolist(), "width": placement.width,
            "height": placement.height, "rotation": drawing.view.rotation.tolist(), "visible": drawing.visible,
            "atoms": drawing.atoms_drawn, "arcs": drawing.arcs, "notes": drawing.notes, "colors": 4 * len(colors),
            "command": self._command(number, options, "svg"),
        }  # fmt: skip
        return Answer(head, _bytes_of(colors) + svg)

    def _count(self, question: Mapping[str, Any]) -> Answer:
        """How many atoms of the model a selection means."""
        number, options = self._asked({**question, "options": {**question.get("options", {}), "select": None}})
        loaded = self._load_model(number, {**options, "water": True})
        return Answer({"count": int(select(loaded.molecule, str(question.get("select"))).sum()),
                       "of": len(loaded.molecule)})  # fmt: skip

    def _save(self, question: Mapping[str, Any]) -> Answer:
        """The file that the command writes, its name and the command."""
        number, options = self._asked(question)
        suffix = question.get("format")
        if suffix not in FORMATS:
            raise OptionError(f"format: {suffix!r}; expected one of {', '.join(FORMATS)}")
        head = {"name": self._name(number, suffix), "command": self._command(number, options, suffix)}
        return Answer(head, self._drawing(number, options).to(suffix))

    def _state(self, question: Mapping[str, Any]) -> Answer:
        """The options as a state file."""
        number, options = self._asked(question)
        return Answer({"name": self._name(number, "toml")}, state_text(options).encode())

    def _load(self, question: Mapping[str, Any]) -> Answer:
        """The options that a state file means; those that the page has no field for are not the page's to change."""
        text = question.get("text")
        if not isinstance(text, str):
            raise OptionError("text: expected the content of a state file")
        stated = state_of_text(text)
        for name, value in stated.items():
            if name not in NAMES and value != self.options[name]:
                raise OptionError(f"{name}: the page has no field for it; molviz view --{name.replace('_', '-')} has")
        usual = {name: USUAL[name] for name in NAMES}
        wanted = {**usual, **{name: value for name, value in stated.items() if name in NAMES}}
        self._asked({**question, "options": wanted})
        return Answer({"options": wanted})

    # ---- what they have in common

    def _asked(self, question: Mapping[str, Any]) -> tuple[int, dict[str, Any]]:
        """The number of the input and all options; raises OptionError for what a page may not ask for."""
        number, asked = question.get("input", 0), question.get("options", {})
        if type(number) is not int or not 0 <= number < len(self.inputs):
            raise OptionError(f"input: {number!r}; expected a number below {len(self.inputs)}")
        if not isinstance(asked, Mapping) or not set(asked) <= set(NAMES):
            raise OptionError(f"options: expected some of {', '.join(NAMES)}")
        _refuse_no_text(asked)
        options = {**self.options, **checked_state(dict(asked))}
        for name in FILES:
            if options[name] != self.options[name] and options[name] not in choices_of(name):
                raise OptionError(f"{name}: {options[name]!r}; expected one of {', '.join(choices_of(name))}")
        return number, options

    def _load_model(self, number: int, options: Options) -> Loaded:
        """The model that is drawn; those of the last few selections are kept."""
        if means_several(str(given(options, "model", parse_model))):
            raise OptionError(f"model: {options['model']!r}; expected a number from 1")
        key = number, input_options_from(options)
        with self._lock:
            kept = self._loaded.get(key)
        loaded = kept or only_model(loaded_from(self.inputs[number].reading, key[1]))
        with self._lock:
            self._loaded[key] = loaded
            self._loaded.move_to_end(key)
            while len(self._loaded) > MOST_LOADED:
                self._loaded.popitem(last=False)
        return loaded

    def _drawing(self, number: int, options: Options) -> Drawing:
        request = draw_request_from(options)
        described = replace(request, description=self._description(number, options))
        loaded, eye = self._load_model(number, options), view_options_from(options)
        drawing = drawn([loaded], described, eye, SetOptions(), chosen(options, "method"), bool(options["check"]))
        assert isinstance(drawing, Drawing)  # one model, one view
        return drawing

    def _description(self, number: int, options: Options) -> str:
        one = self.inputs[number]
        return "" if one.expression else drawn_by(one.path, options)

    def _command(self, number: int, options: Options, suffix: str) -> str:
        one = self.inputs[number]
        if one.expression:
            return call_of(one.expression, options)
        return command_of(one.path, options, self._name(number, suffix))

    def _name(self, number: int, suffix: str) -> str:
        """What a saved file is called."""
        return f"{stem_of(self.inputs[number].path) or 'molecule'}.{suffix}"


def input_of(path: str, format: str | None = None, unpack_all: bool = False) -> Input:
    """Return a file that was read; raises InputError as ``molviz.read`` does."""
    return Input(PurePath(path).name, path, read(path, None, format, unpack_all))


def _refuse_no_text(value: Any) -> None:
    """Raise OptionError for texts that no file can hold: halves of characters."""
    parts = value.values() if isinstance(value, Mapping) else value if isinstance(value, list) else ()
    for part in parts:
        _refuse_no_text(part)
    if isinstance(value, str) and any("\ud800" <= letter <= "\udfff" for letter in value):
        raise OptionError("options: a text that is no Unicode; expected whole characters")


def _numbered(texts: Sequence[str]) -> tuple[Ints, list[str]]:
    """Each text's number (n,) among the distinct ones, in order of appearance, and these."""
    numbers = {text: number for number, text in enumerate(dict.fromkeys(texts))}
    return np.array([numbers[text] for text in texts], dtype=np.int64), list(numbers)


def _selections(loaded: Loaded, residue: Ints) -> list[str]:
    """The expression that selects each residue; "" where the format has none."""
    molecule = loaded.molecule
    first = np.unique(residue, return_index=True)[1]
    columns = (("resn", molecule.residue_name), ("resi", molecule.residue), ("chain", molecule.chain))
    return [
        " and ".join(f"{word} {_quoted(str(column[k]))}" for word, column in columns if column[k])
        for k in first.tolist()
    ]


def _quoted(name: str) -> str:
    """A name as selections have it: in quotes where it is more than a plain word."""
    return name if name.isalnum() else f'"{name.replace(chr(34), "?")}"'


def _with_beads(solids: BallsAndSticks) -> tuple[Spheres, Ints]:
    """Balls, then sticks as strings of beads that nearly look like them while they move; and the atom of each (b,)."""
    balls, sticks = solids.balls.whole(), solids.sticks
    begin, end = balls.center[sticks.first] + sticks.offset, balls.center[sticks.second] + sticks.offset
    length = np.linalg.norm(end - begin, axis=1)
    beads = np.maximum(np.ceil(length / (BEAD_STEP * sticks.radius)), 1).astype(np.int64)
    if beads.sum() > MOST_BEADS:
        beads = np.maximum(beads * MOST_BEADS // beads.sum(), 2)
    stick, place = expand(np.zeros(len(beads), dtype=np.int64), beads)
    part = (place + 0.5) / beads[stick]
    center = begin[stick] + part[:, None] * (end - begin)[stick]
    atom = np.where(part < 0.5, sticks.first[stick], sticks.second[stick])
    joined = Spheres(np.vstack([balls.center, center]), np.append(balls.radius, sticks.radius[stick]))
    return joined, np.append(np.arange(len(balls.radius)), atom)


def _first_colors(loaded: Loaded, request: DrawRequest, method: str) -> Ints:
    """The colours (n, 3) of all atoms before anything is known of a view: chains that touch have no tints yet."""
    entities = entities_of(loaded.molecule)
    settled = request.options.settled(entities, method == "painter")
    subject = subject_of(loaded, entities, request, settled)
    return subject.colors(settled, np.zeros(len(entities.chain), dtype=np.int64)).fill


def _bytes_of(colors: Ints) -> bytes:
    """Colours (n, 3) as four bytes each."""
    table: Floats = np.full((len(colors), 4), 255)
    table[:, :3] = colors
    return table.astype(np.uint8).tobytes()
