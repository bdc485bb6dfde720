"""Texts from files in every format: they can be read again, are where they should be, and do nothing else."""

import json
import re
import subprocess
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from pathlib import Path
from shutil import which

import numpy as np
import pytest
from click.testing import CliRunner
from fontTools.ttLib import TTFont
from hypothesis import given
from hypothesis import strategies as st

from molviz.cli import main
from molviz.picture.furniture.metrics import UNITS, text_width
from molviz.picture.picture import Picture, Text, TextLayer
from molviz.write import WRITERS
from molviz.write.font import FILE, font_of
from molviz.write.text import plotter_text
from molviz.write.type42 import type42
from tests.render import needs_ghostscript, needs_pdftotext, render_ps, text_of_pdf, write
from tests.write_pictures import fills, picture

SVG, DC = "{http://www.w3.org/2000/svg}", "{http://purl.org/dc/elements/1.1/}"
FONT = Path(__file__).parent.parent / "molviz" / "write" / "fonts" / FILE
WINDING = "Åα₂β′ – “½” Ω ≤ ŐšŻ €"
HOSTILE = [
    "<script>alert(1)</script>",
    "]]><image href='http://example.org/x'/><!--",
    '"/></text></svg><svg onload="alert(1)">',
    "</title></desc></metadata>&bogus;&#0;",
    ") show 0 0 200 200 rectfill showpage (",
    "\\) (x) print flush quit \\",
    "\n%%EOF\n%%Page: 2 2\n0 0 300 300 rectfill showpage\n",
    "> Tj ET 0 0 999 999 re f BT <",
    "\nendstream endobj\ntrailer << /Root 1 0 R >>\n",
    "\x03;SP2;PU0,0;PD9999,9999;IN;LB",
    "\x1b.(;\x1b.K;IN;\x0e\x0f",
    "\x00\x08\x7f\x9f\ud800\ufffe\u202e",
    "漢字 🧬 \u0301\u200b",
    "x" * 700,
]
needs_qpdf = pytest.mark.skipif(which("qpdf") is None, reason="qpdf is not installed")


def page(*texts: str, name: str = "") -> Picture:
    """A page with a line of text in a narrow band across its middle, the names of everything else hostile too."""
    lines = [Text(20, 50, text, 4.0) for text in texts]
    return Picture(400, 100, (0, 0, 400, 100), [TextLayer(name or "text", lines)], name, description=name)


def all_hostile() -> Picture:
    shapes = replace(fills(), name=HOSTILE[0], mark=[replace(mark, title=HOSTILE[4]) for mark in fills().mark])
    layer = TextLayer(HOSTILE[1], [Text(20, 50, text, 4.0, "end") for text in HOSTILE])
    return replace(picture(shapes, layer), title=HOSTILE[2], description="".join(HOSTILE))


@pytest.mark.parametrize("suffix", sorted(WRITERS))
@given(st.text(st.characters(), max_size=80))
def test_any_text_can_be_written(suffix: str, text: str) -> None:
    assert write(page(text, name=text), suffix)


def test_svg_stays_the_elements_it_is_made_of() -> None:
    root = ElementTree.fromstring(write(all_hostile(), ".svg"))
    names = {element.tag.split("}")[1] for element in root.iter()}
    assert names <= {"svg", "title", "desc", "metadata", "RDF", "Description", "creator", "source"} | {
        "defs", "style", "g", "path", "text"
    }  # fmt: skip
    assert not [key for element in root.iter() for key in element.attrib if key.startswith("on") or "href" in key]
    assert [one.text for one in root.iter(f"{SVG}text")][:6] == [text.replace("\n", " ") for text in HOSTILE[:6]]


def test_svg_is_named_and_says_what_drew_it() -> None:
    drawn = replace(page("5 Å", "Cα"), title="Crambin", description="molviz draw 1crn.pdb <x>")
    root = ElementTree.fromstring(write(drawn, ".svg"))
    assert root.get("role") == "img" and root.findtext(f"{SVG}title") == "Crambin"
    assert root.findtext(f"{SVG}desc") == "Drawn by molviz; 5 Å; Cα"
    assert root.findtext(f".//{DC}source") == "molviz draw 1crn.pdb <x>"
    assert list(root)[0].tag == f"{SVG}title" and b"metadata" not in write(page("x"), ".svg")


@needs_ghostscript
@pytest.mark.parametrize("suffix", [".ps", ".eps", ".pdf"])
@pytest.mark.parametrize("text", HOSTILE, ids=range(len(HOSTILE)))
def test_nothing_is_painted_but_the_line_itself(suffix: str, text: str) -> None:
    image = render_ps(write(page(text, name=text), suffix), 288)  # fails when anything is printed
    height = 100 - np.flatnonzero((image < 250).any(axis=(1, 2))) / 4
    assert image.shape[:2] == (400, 1600) and height.size and height.min() >= 49 and height.max() <= 54


@pytest.mark.parametrize("suffix", [".ps", ".eps"])
def test_postscript_has_one_page_and_one_end(suffix: str) -> None:
    lines = write(all_hostile(), suffix).decode("ascii").splitlines()
    assert max(map(len, lines)) <= 255
    for word in ("showpage", "%%EOF"):
        assert lines.count(word) == 1
    assert sum(line.startswith("%%Page:") for line in lines) == 1 and lines[-1] == "%%EOF"


@needs_qpdf
def test_pdf_is_sound(tmp_path: Path) -> None:
    (tmp_path / "x.pdf").write_bytes(write(all_hostile(), ".pdf"))
    done = subprocess.run(["qpdf", "--check", tmp_path / "x.pdf"], capture_output=True, text=True, check=False)
    assert done.returncode == 0 and not done.stderr, done.stdout + done.stderr
    data = json.loads(subprocess.check_output(["qpdf", "--json", tmp_path / "x.pdf"]))
    assert len(data["pages"]) == 1


def commands(hpgl: str) -> list[str]:
    """The commands as a plotter takes them: a label runs to ETX whatever is in it, all else to the semicolon."""
    return re.findall(r"LB[^\x03]*\x03|[A-Z]{2}[^;A-Z\x03]*;", hpgl)


def test_no_command_leaves_a_label() -> None:
    hpgl = write(all_hostile(), ".hpgl").decode("ascii")
    found = commands(hpgl)
    assert "".join(found) == hpgl.replace("\n", "")
    assert [command[:2] for command in found] == ["IN", "SP", *["PU", "SI", "LB"] * len(HOSTILE), "PU", "SP"]
    assert not re.search("[;\x00-\x02\x04-\x1f\x7f]", "".join(command for command in found if command[:2] == "LB"))
    assert "LB,SP2,PU0,0,PD9999,9999,IN,LB" in hpgl.replace("?", "")


def test_plotters_letter_ascii() -> None:
    assert plotter_text("5 Å – Cα′, Ωß; é²") == "5 A - Calpha', Omega?, e2"


def test_json_of_a_hostile_file_is_json(tmp_path: Path) -> None:
    (tmp_path / "x.xyz").write_text(f"1\n{HOSTILE[0]} \" \\ {HOSTILE[3]}\nC 0 0 0\n", encoding="utf-8")
    result = CliRunner().invoke(main, ["draw", str(tmp_path / "x.xyz"), "-o", str(tmp_path / "x.json")])
    assert result.exit_code == 0
    assert len(json.loads((tmp_path / "x.json").read_text(encoding="utf-8"))["spheres"]) == 1


@needs_pdftotext
def test_every_letter_can_be_read_out_of_a_pdf() -> None:
    assert text_of_pdf(write(page(WINDING), ".pdf")).strip() == WINDING


@needs_ghostscript
@needs_pdftotext
def test_every_letter_can_be_read_out_of_a_pdf_made_of_postscript(tmp_path: Path) -> None:
    (tmp_path / "x.ps").write_bytes(write(page("Haem Åα₂β′"), ".ps"))
    subprocess.run(["ps2pdf", tmp_path / "x.ps", tmp_path / "x.pdf"], check=True)
    assert text_of_pdf((tmp_path / "x.pdf").read_bytes()).strip() == "Haem Åα₂β′"


@needs_ghostscript
@pytest.mark.parametrize("suffix", [".eps", ".pdf"])
@pytest.mark.parametrize("anchor", ["start", "middle", "end"])
def test_texts_are_where_their_anchors_say_and_as_wide_as_measured(suffix: str, anchor: str) -> None:
    text = Text(200, 50, f"HH{WINDING}HH", 10.0, anchor)
    image = render_ps(write(Picture(400, 100, (0, 0, 400, 100), [TextLayer("t", [text])]), suffix), 288)
    columns = np.flatnonzero((image < 128).any(axis=(0, 2))) / 4
    width = text_width(text.text, 10.0)
    left = 200 - {"start": 0.0, "middle": 0.5, "end": 1.0}[anchor] * width
    assert columns.min() == pytest.approx(left, abs=1.2) and columns.max() == pytest.approx(left + width, abs=1.2)


def test_svg_has_the_anchors() -> None:
    texts = [Text(5, 5, "x", 8, anchor) for anchor in ("start", "middle", "end")]
    root = ElementTree.fromstring(write(Picture(50, 50, (0, 0, 50, 50), [TextLayer("t", texts)]), ".svg"))
    assert [one.get("text-anchor") for one in root.iter(f"{SVG}text")] == [None, "middle", "end"]


def test_plotters_letter_as_wide_as_other_formats() -> None:
    texts = [Text(200, 50, "HEM 142", 10.0, "middle")]
    hpgl = write(Picture(400, 100, (0, 0, 400, 100), [TextLayer("t", texts)]), ".hpgl").decode()
    x, width = (float(value) for value in re.search(r"PU(\d+),\d+;SI([\d.]+),", hpgl).groups())
    middle = float(re.search(r"PU(\d+)", write_line_at(200)).group(1))
    assert x + 1.5 * 7 * width * 400 / 2 == pytest.approx(middle, abs=3)


def write_line_at(x: float) -> str:
    """HPGL of a text that starts there."""
    texts = [Text(x, 50, "HEM 142", 10.0)]
    return write(Picture(400, 100, (0, 0, 400, 100), [TextLayer("t", texts)]), ".hpgl").decode()


def test_the_widths_that_layouts_use_are_those_of_the_font() -> None:
    font = TTFont(FONT)
    assert font["head"].unitsPerEm == UNITS
    for code, name in font.getBestCmap().items():
        assert text_width(chr(code), UNITS) == font["hmtx"][name][0]


def test_fonts_hold_the_glyphs_of_their_texts_only_and_are_the_same_every_time() -> None:
    wanted = frozenset("HEM α漢")
    font = font_of(wanted)
    assert font == font_of(wanted) and set(font.glyph) == wanted - {"漢"}
    assert len(set(font.glyph.values())) == 5 and 0 not in font.glyph.values() and len(font.data) < 1500


def test_more_letters_than_a_postscript_font_can_hold_are_no_failure() -> None:
    every = frozenset(map(chr, TTFont(FONT).getBestCmap()))
    font = type42(font_of(every))
    assert len(set(font.code.values())) == len(font.code) < 256 and font.string("A(\u03ff") == "A\\050\\000"
