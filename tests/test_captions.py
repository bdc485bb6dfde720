"""Legends and labels: which names, in which colours and order, at which atoms; what is chosen if nothing is asked."""

from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

import molviz
from molviz.model.entities import entities_of
from molviz.picture.captions import labels_of, legend_of
from molviz.picture.furniture import Ramp, Swatches
from molviz.picture.furniture.metrics import text_width
from molviz.picture.options import MOST_CEL, DrawOptions, Labelled, Painted, Subject
from molviz.picture.palette import load_palette
from molviz.picture.picture import TextLayer
from molviz.picture.style import load_style
from molviz.picture.tints import tinted
from molviz.pipeline.draw import DrawRequest, color_values, drawing_of, labelled_of
from molviz.pipeline.inputs import InputOptions, Loaded, load
from molviz.pipeline.views import ViewOptions
from tests.pdb_lines import atom
from tests.render import needs_pdftotext, text_of_pdf

pytestmark = pytest.mark.filterwarnings("ignore:.*without element")
SAMPLES = Path(__file__).parent.parent / "samples"
TIDE = load_palette("tide")
PEPTIDE = [("N", " N  "), ("C", " CA "), ("C", " C  "), ("O", " O  ")]


def scene() -> Loaded:
    """Chains B and A of one sequence, D of another, a ligand, an ion and water; all apart, the later the nearer."""
    lines, number = [], 0

    def add(chain: str, residue: str, place: int, name: str, element: str, record: str = "ATOM  ") -> None:
        nonlocal number
        number += 1
        lines.append(atom(
            name=name, residue=residue, number=f"{place:>4} ", chain=chain, element=f"{element:>2}",
            xyz=f"{4.0 * number:8.3f}{0:8.3f}{0.1 * number:8.3f}", bfactor=f"{number:6.2f}",
            record=f"{record}{number:>5} "))  # fmt: skip

    for chain, sequence in (("B", "ALA GLY SER"), ("A", "ALA GLY SER"), ("D", "TRP TRP LYS")):
        for place, residue in enumerate(sequence.split(), 1):
            for element, name in PEPTIDE:
                add(chain, residue, place, name, element)
    add("A", "HEM", 9, "FE  ", "FE", "HETATM")
    add("A", "HEM", 9, " NA ", "N", "HETATM")
    add("B", " ZN", 10, "ZN  ", "ZN", "HETATM")
    add("A", "HOH", 11, " O  ", "O", "HETATM")
    return load("scene.pdb", InputOptions(), "\n".join(lines).encode() + b"\n")[0]


SCENE = scene()


def subject(painted: tuple[Painted, ...] = (), labelled: tuple[Labelled, ...] = (), scheme: str = "") -> Subject:
    every = np.arange(len(SCENE.molecule))
    corner = np.zeros(2)
    entities, values = entities_of(SCENE.molecule), color_values(SCENE, scheme)
    return Subject(SCENE.molecule, entities, every, corner, corner, values, painted, labelled)


def settled(scheme: str | None, style: str | None = None) -> DrawOptions:
    options = DrawOptions(TIDE, load_style(style) if style else None, scheme, legend=True)
    return options.settled(entities_of(SCENE.molecule))


def legend(scheme: str, painted: tuple[Painted, ...] = ()) -> Swatches | Ramp:
    about, options = subject(painted, scheme=scheme), settled(scheme)
    fill = about.colors(options, np.zeros(len(about.entities.chain), dtype=int)).fill
    return legend_of(about, options, fill)


@pytest.mark.parametrize(
    ("scheme", "names"),
    [
        ("element", ["N", "C", "O", "Fe", "Zn"]),
        ("chain", ["B", "A", "D"]),
        ("residue", ["ALA", "GLY", "SER", "TRP", "LYS", "HEM", "ZN", "HOH"]),
        ("entity", ["chains B, A", "chain D", "HEM", "Zn", "water"]),
    ],
)
def test_legends_name_what_there_is_in_order_of_appearance(scheme: str, names: list[str]) -> None:
    found = legend(scheme)
    assert isinstance(found, Swatches) and [name for name, _ in found.entries] == names


def test_legends_show_the_colours_of_the_scheme() -> None:
    colors = dict(legend("chain").entries)
    assert [colors[name] for name in "BAD"] == [(color,) for color in TIDE.chain[:3]]
    assert dict(legend("element").entries)["Fe"] == (load_style("flat").colors.element["Fe"],)
    assert dict(legend("residue").entries)["TRP"] == (load_style("flat").colors.residue["TRP"],)
    entities = dict(legend("entity").entries)
    assert entities["chains B, A"] == (TIDE.entity[0].carbon,) and entities["chain D"] == (TIDE.entity[1].carbon,)
    assert entities["Zn"] == (TIDE.metal,)


def test_an_entity_in_several_tints_has_them_all_in_order_of_its_chains() -> None:
    about, options = subject(scheme="entity"), settled("entity")
    fill = about.colors(options, np.array([1, 0, 0])).fill
    found = legend_of(about, options, fill)
    assert isinstance(found, Swatches)
    lighter = tuple(tinted(TIDE.entity[0], TIDE.tint)[1, 0].tolist())
    assert dict(found.entries)["chains B, A"] == (lighter, TIDE.entity[0].carbon)


def test_legends_of_numbers_are_ramps() -> None:
    found = legend("bfactor")
    assert isinstance(found, Ramp)
    assert (found.least, found.greatest) == (1.0, len(SCENE.molecule))


def test_an_override_is_shown_by_its_selection_and_wins_over_the_scheme() -> None:
    resn = SCENE.molecule.residue_name
    painted = (Painted(resn == "HEM", (1, 2, 3), "resn HEM"), Painted(resn == "HOH", (4, 5, 6), "water"))
    found = legend("entity", painted)
    assert isinstance(found, Swatches)
    assert [name for name, _ in found.entries] == ["chains B, A", "chain D", "Zn", "resn HEM", "water"]
    assert found.entries[-2:] == [("resn HEM", ((1, 2, 3),)), ("water", ((4, 5, 6),))]


def test_the_last_override_wins() -> None:
    resn = SCENE.molecule.residue_name
    painted = (Painted(resn != "", (1, 2, 3), "all"), Painted(resn == "HEM", (4, 5, 6), "resn HEM"))
    fill = subject(painted).colors(settled("chain"), np.zeros(3, dtype=int)).fill
    assert np.all(fill[resn == "HEM"] == (4, 5, 6)) and np.all(fill[resn != "HEM"] == (1, 2, 3))


# ---- labels


def labels(*texts: str, seen: np.ndarray | None = None) -> list[tuple[float, str]]:
    about = subject(labelled=tuple(labelled_of(SCENE.molecule, text) for text in texts))
    seen = about.atom if seen is None else seen
    page, area = SCENE.spheres.center[:, :2], SCENE.spheres.center[:, 2]
    return [(round(label.x / 4.0), label.text) for label in labels_of(about, seen, area, lambda row: page[row])]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("resn HEM", [(38, "HEM 9")]),
        ("resn HEM={name}", [(37, "FE"), (38, "NA")]),
        ("resn HEM={element} of {resn}", [(37, "Fe of HEM"), (38, "N of HEM")]),
        ("chain D and name CA", [(26, "TRP 1"), (30, "TRP 2"), (34, "LYS 3")]),
        ("chain D", [(28, "TRP 1"), (32, "TRP 2"), (36, "LYS 3")]),
        ("name CA={chain}", [(10, "B"), (22, "A"), (34, "D")]),
        ("not water=the whole", [(39, "the whole")]),
        ("resn HEM=a=b", [(38, "a=b")]),
        ("resn XYZ=nobody", []),
    ],
)
def test_labels_stand_at_the_atom_of_which_most_is_seen(text: str, expected: list[tuple[float, str]]) -> None:
    assert labels(text) == expected


def test_labels_stand_at_atoms_that_are_seen_only() -> None:
    iron = np.flatnonzero(SCENE.molecule.element == "Fe")
    assert labels("resn HEM", seen=iron) == [(37, "HEM 9")]
    assert labels("chain D", "resn HEM={element}", seen=iron) == [(37, "Fe")]


# ---- all of it, drawn


def texts(data: str) -> list[str]:
    return [str(one.text) for one in ElementTree.fromstring(data).iter("{http://www.w3.org/2000/svg}text")]


def protease(**options: Any) -> molviz.Drawing:
    with pytest.warns(UserWarning, match="water"):
        return molviz.draw(SAMPLES / "1hpv.pdb.gz", **options)


def test_what_is_asked_for_is_written() -> None:
    data = protease(legend=True, color="resn 478=crimson", label="resn 478", title="Protease", scale_bar=10)
    found = texts(data.svg())
    assert set(found) >= {"Protease", "10 Å", "resn 478", "478 200"} and "#dc143c" in data.svg()
    assert "water" not in found


@needs_pdftotext
def test_legends_are_in_all_formats() -> None:
    drawing = protease(legend=True, color="resn 478=crimson", outline=1.0)
    found = [text for text in texts(drawing.svg()) if text]
    assert "resn 478" in found and "chains A, B" in found
    for suffix in ("eps", "ps", "hpgl"):
        assert b"resn 478" in drawing.to(suffix), suffix
    assert "resn 478" in text_of_pdf(drawing.to("pdf"))


def test_water_is_left_out_and_that_is_said() -> None:
    with pytest.warns(UserWarning, match="88 atoms of water are left out; --water"):
        without = molviz.draw(SAMPLES / "1a8o.pdb")
    water = molviz.draw(SAMPLES / "1a8o.pdb", water=True)
    assert water.atoms_drawn - without.atoms_drawn == 88
    only = load("w.pdb", InputOptions(water=None), (atom(residue="HOH", element=" O") + "\n").encode())[0]
    assert len(only.molecule) == 1 and not only.warnings


@pytest.mark.parametrize(
    ("name", "style", "scheme"),
    [("1hpv.pdb.gz", "goodsell", "entity"), ("1lcd.cif.gz", "goodsell", "entity"), ("caffeine.xyz", "cel", "element")],
)
def test_style_and_scheme_go_by_what_there_is(name: str, style: str, scheme: str) -> None:
    loaded = load(str(SAMPLES / name), InputOptions())[0]
    options = DrawOptions(TIDE).settled(entities_of(loaded.molecule))
    assert (options.style, options.color_by) == (load_style(style), scheme)


def test_what_is_large_and_no_polymer_is_flat() -> None:
    for count, style in ((MOST_CEL, "cel"), (MOST_CEL + 1, "flat")):
        text = "".join(f"{4 * k} 0 0 1\n" for k in range(count))
        molecule = load("x.xyzr", InputOptions(), text.encode())[0].molecule
        assert DrawOptions(TIDE).settled(entities_of(molecule)).style == load_style(style)


def test_entities_without_polymers_are_elements() -> None:
    loaded = load(str(SAMPLES / "caffeine.xyz"), InputOptions())[0]
    assert DrawOptions(TIDE, load_style("goodsell")).settled(entities_of(loaded.molecule)).color_by == "element"


def test_a_label_stays_on_the_page() -> None:
    loaded = load("one.xyz", InputOptions(), b"1\n\nFe 0 0 0\n")[0]
    request = DrawRequest(DrawOptions(TIDE), labels=("all={element} in the middle of it all",))
    picture = drawing_of(loaded, request, ViewOptions())._picture
    (text,) = [one for layer in picture.layers if isinstance(layer, TextLayer) for one in layer.texts]
    left = text.x - {"start": 0.0, "middle": 0.5, "end": 1.0}[text.anchor] * text_width(text.text, text.size)
    assert left >= 0 and left + text_width(text.text, text.size) <= picture.width and 0 < text.y < picture.height
    assert text.text == "Fe in the middle of it all"


def test_what_means_nothing_or_is_hidden_is_told() -> None:
    balls = b"3\n\nC 0 0 0\nFe 0 0 -1\nO 9 0 0\n"
    loaded = load("three.xyz", InputOptions(), balls)[0]
    asked = ("element Zn=gone", "element Fe", "element O=seen")
    request = DrawRequest(DrawOptions(TIDE), (("element N", (9, 9, 9)), ("element C", (8, 8, 8))), asked)
    wide = replace(loaded, radius=np.array([3.0, 1.0, 1.0]))
    assert drawing_of(wide, request, ViewOptions("file")).notes == (
        "three.xyz: color 'element N' means no atom that is drawn",
        "three.xyz: label 'element Zn' means no atom that is drawn",
        "three.xyz: label 'element Fe' means atoms that are hidden",
    )
