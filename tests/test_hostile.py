"""Names, labels and titles that mean something to a format, through the whole command line: they stay texts."""

import json
import re
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from click.testing import CliRunner

from molviz.cli import main
from tests.pdb_lines import atom
from tests.render import needs_ghostscript, render_ps
from tests.test_text import commands, needs_qpdf

SVG = "{http://www.w3.org/2000/svg}"
LETTERS = "<>&\"'()\\%{}/;[]#~`$"  # chains
RESIDUES = ["<b>", "](:", "%%E", "\\))", "}{ ", "&#;", "'\"<", "-->", "\x7f;", "é"]
NAMES = ["<C> ", "C)(\\", "C%%E", "C\"'&", " C{}", "C;IN", "C\x7f[]"]
TEXTS = [
    "</text><script>alert(1)</script>", "]]>", ") show showpage 0 0 999 999 rectfill (", "\\", "%%EOF\n%%Page: 9 9\n",
    "> Tj ET 0 0 999 999 re f BT <", "\nendstream endobj\ntrailer << >>\n", "\x03;SP2;PU0,0;PD9999,9999;IN;LB\x1b.R",
]  # fmt: skip


def hostile_pdb(folder: Path) -> Path:
    """One atom for each chain letter, residue and atom names in turn, 4 Å apart; a title as bad."""
    lines = ["TITLE     <x>&)(\\%%EOF;IN; ]]></title>"]
    for k, chain in enumerate(LETTERS):
        lines.append(atom(
            name=NAMES[k % len(NAMES)].ljust(4)[:4], residue=RESIDUES[k % len(RESIDUES)].ljust(3)[:3],
            chain=chain, number=f"{k:>4} ", xyz=f"{4.0 * k:8.3f}{0:8.3f}{0:8.3f}", record="HETATM    1 ",
        ))  # fmt: skip
    path = folder / "<&>'%.pdb"
    path.write_bytes("\n".join(lines).encode("latin-1") + b"\n")
    return path


def draw(folder: Path, suffix: str, style: str, *more: str) -> bytes:
    target = folder / f"x{suffix}"
    words = ["draw", str(hostile_pdb(folder)), "-o", str(target), "--style", style, "--color-by", "chain", *more]
    result = CliRunner().invoke(main, [*words, "--quiet"])
    assert result.exit_code == 0, result.output
    return target.read_bytes()


def furnished(text: str) -> list[str]:
    return ["--legend", "--title", text, "--label", f"all={{chain}} {{resn}} {{name}} {text}", "--scale-bar"]


EVERY = " ".join(TEXTS)
STYLES = ["flat", "goodsell", "cel", "shaded"]


@pytest.mark.parametrize("style", STYLES)
@pytest.mark.parametrize("parts", ["atoms", "merged"])
def test_svg_holds_texts_and_drawn_things_only(style: str, parts: str, tmp_path: Path) -> None:
    root = ElementTree.fromstring(draw(tmp_path, ".svg", style, "--parts", parts, *furnished(EVERY)))
    names = {element.tag.split("}")[1] for element in root.iter()}
    drawn = {"svg", "title", "desc", "metadata", "RDF", "Description", "creator", "source", "defs", "style", "g"}
    assert names <= drawn | {"path", "text", "use", "clipPath", "radialGradient", "stop", "circle", "rect"}
    for element in root.iter():
        for key, value in element.attrib.items():
            assert not key.startswith("on")
            if "href" in key:
                assert re.fullmatch(r"#[\w.-]+", value), value
    found = [element.get("id") for element in root.iter() if element.get("id") is not None]
    assert len(set(found)) == len(found) and all(re.fullmatch(r"[\w.:-]+", one) for one in found), found
    assert any("<script>alert(1)</script>" in (one.text or "") for one in root.iter(f"{SVG}text"))
    assert not any("<" in (one.text or "") for one in root.iter(f"{SVG}style"))


@needs_ghostscript
@pytest.mark.parametrize("suffix", [".ps", ".eps", ".pdf"])
@pytest.mark.parametrize("style", STYLES)
def test_names_paint_nothing_and_print_nothing(style: str, suffix: str, tmp_path: Path) -> None:
    """The same picture to the pixel as of a file with harmless names: what names mean to a format is not done."""
    bad = render_ps(draw(tmp_path, suffix, style), 72)  # fails if anything is printed
    harmless = hostile_pdb(tmp_path).read_bytes().splitlines()[1:]
    plain = b"\n".join(b"HETATM    1  C   LIG " + b"%c" % (65 + k) + row[22:] for k, row in enumerate(harmless))
    (tmp_path / "plain.pdb").write_bytes(plain + b"\n")
    target = tmp_path / f"plain{suffix}"
    words = ["draw", str(tmp_path / "plain.pdb"), "-o", str(target), "--style", style, "--color-by", "chain", "--quiet"]
    assert CliRunner().invoke(main, words).exit_code == 0
    assert np.array_equal(bad, render_ps(target.read_bytes(), 72))


@needs_ghostscript
@pytest.mark.parametrize("suffix", [".ps", ".eps", ".pdf"])
def test_texts_paint_within_their_lines_and_print_nothing(suffix: str, tmp_path: Path) -> None:
    """A rectangle over the page, which some of the texts ask for, would blacken it."""
    image = render_ps(draw(tmp_path, suffix, "goodsell", *furnished(EVERY)), 72)
    assert 0.5 < (image > 250).all(axis=2).mean() < 1


@pytest.mark.parametrize("suffix", [".ps", ".eps"])
def test_postscript_has_one_page_and_one_end(suffix: str, tmp_path: Path) -> None:
    lines = draw(tmp_path, suffix, "goodsell", *furnished(EVERY)).decode("ascii").splitlines()
    assert lines.count("showpage") == 1 and lines.count("%%EOF") == 1 and lines[-1] == "%%EOF"
    assert sum(line.startswith("%%Page:") for line in lines) == 1 and max(map(len, lines)) <= 255


@needs_qpdf
@pytest.mark.parametrize("style", STYLES)
def test_pdf_is_sound(style: str, tmp_path: Path) -> None:
    draw(tmp_path, ".pdf", style, *furnished(EVERY))
    done = subprocess.run(["qpdf", "--check", tmp_path / "x.pdf"], capture_output=True, text=True, check=False)
    assert done.returncode == 0 and not done.stderr, done.stdout + done.stderr
    assert len(json.loads(subprocess.check_output(["qpdf", "--json", tmp_path / "x.pdf"]))["pages"]) == 1


@pytest.mark.parametrize("style", ["flat", "hatch", "goodsell"])
def test_no_command_leaves_a_label_of_a_plotter(style: str, tmp_path: Path) -> None:
    hpgl = draw(tmp_path, ".hpgl", style, *furnished(EVERY)).decode("ascii")
    found = commands(hpgl)
    assert "".join(found) == hpgl.replace("\n", "")
    assert {command[:2] for command in found} <= {"IN", "SP", "PU", "PD", "PA", "AA", "SI", "LB"}
    assert [command[:2] for command in found].count("IN") == 1 and found[0] == "IN;"
    assert not re.search("[;\x00-\x02\x04-\x1f\x7f]", "".join(one for one in found if one[:2] == "LB"))


def test_json_is_json(tmp_path: Path) -> None:
    assert len(json.loads(draw(tmp_path, ".json", "flat"))["spheres"]) == len(LETTERS)


@pytest.mark.parametrize("letter", ["\x00", "\x03", "\x07", "\x1b"])
def test_control_characters_are_no_names(letter: str, tmp_path: Path) -> None:
    (tmp_path / "x.pdb").write_text(atom(chain=letter) + "\n", encoding="ascii")
    result = CliRunner().invoke(main, ["draw", str(tmp_path / "x.pdb"), "-o", str(tmp_path / "x.svg")])
    assert result.exit_code == 1 and "binary data" in result.output and letter not in result.output


@pytest.mark.parametrize("text", TEXTS, ids=range(len(TEXTS)))
def test_selections_of_overrides_are_texts_too(text: str, tmp_path: Path) -> None:
    """What is no selection is an error that quotes it on one line; nothing is written."""
    target = tmp_path / "y.svg"
    words = ["draw", str(hostile_pdb(tmp_path)), "-o", str(target), "--color", f"{text}=red", "--legend"]
    result = CliRunner().invoke(main, words)
    assert result.exit_code in (1, 2) and not target.exists() and isinstance(result.exception, SystemExit)
