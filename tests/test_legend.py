"""The legend says what the colours mean, in every format."""

from pathlib import Path

import pytest
from click.testing import CliRunner

from molviz.cli import main
from tests.render import needs_pdftotext, text_of_pdf

PROTEIN = str(Path(__file__).parent.parent / "samples" / "1a8o.pdb")


@pytest.mark.parametrize("scheme", ["bfactor", "exposure"])
def test_the_least_and_the_greatest_value_are_named(tmp_path: Path, scheme: str) -> None:
    target = tmp_path / "x.svg"
    result = CliRunner().invoke(main, ["draw", PROTEIN, "--color-by", scheme, "--legend", "-o", str(target)])
    assert result.exit_code == 0, result.output
    text = target.read_text(encoding="utf-8")
    assert ("B factor, Å²" if scheme == "bfactor" else "exposed area, Å²") in text
    if scheme == "bfactor":
        lines = Path(PROTEIN).read_text(encoding="ascii").splitlines()
        factors = [float(line[60:66]) for line in lines if line.startswith(("ATOM", "HETATM")) and "HOH" not in line]
        for value in (min(factors), max(factors)):
            assert f">{value:.4g}<" in text


@needs_pdftotext
def test_text_can_be_read_out_of_a_pdf(tmp_path: Path) -> None:
    target = tmp_path / "x.pdf"
    words = ["draw", PROTEIN, "--color-by", "bfactor", "--legend", "-o", str(target)]
    assert CliRunner().invoke(main, words).exit_code == 0
    assert "B factor, Å²" in text_of_pdf(target.read_bytes())


def test_a_legend_of_names_shows_each_colour_once(tmp_path: Path) -> None:
    target = tmp_path / "x.svg"
    words = ["draw", PROTEIN, "--legend", "--color-by", "element", "--color", "resn MSE=crimson", "-o", str(target)]
    assert CliRunner().invoke(main, words).exit_code == 0
    text = target.read_text(encoding="utf-8")
    for name in ("C", "N", "O", "S", "resn MSE"):
        assert text.count(f">{name}</text>") == 1
    assert "#dc143c" in text


def test_more_chains_than_colours_are_told(tmp_path: Path) -> None:
    lines = [
        f"ATOM  {k + 1:>5}  CA  GLY {chr(65 + k)}{1:>4}    {4.0 * k:8.3f}{0:8.3f}{0:8.3f}  1.00  0.00           C  \n"
        for k in range(26)
    ]
    source = tmp_path / "many.pdb"
    source.write_text("".join(lines), encoding="ascii")
    words = ["draw", str(source), "-o", str(tmp_path / "x.svg"), "--color-by", "chain"]
    assert "26 chains share 24 colours" in CliRunner().invoke(main, words).stderr
    assert "share" not in CliRunner().invoke(main, [*words, "--chain", "A,B"]).stderr
