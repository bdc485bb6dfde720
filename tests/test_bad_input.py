"""Files that are broken in part, or hold less than they seem to: what is sound is read with a warning."""

import re
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from molviz import InputError
from molviz.cli import main
from molviz.readers import read
from tests.pdb_lines import atom

XYZ = "2\na\nC 0 0 0\nO 1.2 0 0\n"
GRO = "t\n1\n    1ALA     CA    1   0.000   0.000   0.000\n 1 1 1\n"
ATOM = atom(xyz="   0.000   0.000   0.000") + "\n"
PDB = f"MODEL        1\n{ATOM}ENDMDL\n"
BEADS = "".join(atom(name=name)[:60] + "\n" for name in (" BB ", " SC1"))
BROKEN = {  # a second frame that is: line, what is wrong
    "cut.xyz": (XYZ * 2 + "2\na\nC 0 0 0\n", 9, "the count says 2 atoms, but only 1 follow"),
    "word.xyz": (XYZ * 2 + XYZ.replace("1.2", "nan"), 12, "x coordinate is 'nan'"),
    "count.xyz": (XYZ * 2 + "garbage\n", 9, "'garbage'; expected the number of atoms"),
    "short.xyz": (XYZ * 2 + "1\na\nC 0 0\n", 11, "3 words; expected a symbol and x y z"),
    "cut.gro": (GRO * 2 + "t\n1\n    1ALA     CA    1   0.000\n", 10, "the count says 1 atoms"),
    "word.gro": (GRO * 2 + GRO.replace("0.000\n", "0.0x0\n"), 11, "z coordinate is '0.0x0'"),
    "cut.pdb": (PDB * 2 + f"MODEL        3\n{ATOM[:40]}\n", 8, "the record ends at column 40"),
    "word.pdb": (PDB * 2 + PDB.replace("0.000", "  nan", 1), 8, "x coordinate"),
}


def run(*words: str) -> Result:
    return CliRunner().invoke(main, list(words))


@pytest.mark.parametrize("name", BROKEN)
def test_a_trajectory_is_read_up_to_its_first_broken_frame(name: str, tmp_path: Path) -> None:
    text, line, what = BROKEN[name]
    path = tmp_path / name
    path.write_text(text, encoding="ascii")
    reading = read(path)
    (told,) = (warning for warning in reading.warnings if "left out" in warning)
    assert told.startswith(f"{path}:{line}: ") and what in told
    assert re.search(r"; (frame|model) 3 and all behind it are left out$", told) and len(reading.models) == 2
    assert run("info", str(path)).exit_code == 0 and run("info", str(path), "--strict").exit_code == 1
    assert run("info", str(path), "--model", "3").exit_code == 2


@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_first_frame_is_refused(name: str, tmp_path: Path) -> None:
    text, line, what = BROKEN[name]
    sound = {".xyz": XYZ, ".gro": GRO, ".pdb": PDB}[path.suffix] if (path := tmp_path / name) else ""
    path.write_text(text.removeprefix(sound * 2), encoding="ascii")
    with pytest.raises(InputError, match=re.escape(what)) as error:
        read(path, format=path.suffix[1:])
    assert error.value.line == line - 2 * sound.count("\n")


def test_more_atoms_than_counted_are_no_second_frame(tmp_path: Path) -> None:
    path = tmp_path / "x.xyz"
    path.write_text(XYZ + "H 3 0 0\n", encoding="ascii")
    with pytest.raises(InputError, match=r":5: 'H 3 0 0'; expected the number of atoms"):
        read(path)


@pytest.mark.parametrize(
    ("text", "line"),
    [(f"{ATOM}ENDMDL\n", 2), (f"{PDB}ENDMDL\n{ATOM}", 4), (f"{PDB}{ATOM}ENDMDL\n", 5), (f"ENDMDL\n{ATOM}", 1)],
)
def test_a_stray_endmdl_is_told(text: str, line: int, tmp_path: Path) -> None:
    path = tmp_path / "x.pdb"
    path.write_text(text, encoding="ascii")
    assert f"{path}:{line}: ENDMDL without a MODEL above it" in read(path).warnings
    path.write_text(PDB * 3, encoding="ascii")
    assert not any("ENDMDL" in warning for warning in read(path).warnings)


@pytest.mark.parametrize("command", [["info"], ["measure"], ["draw", "-o", "x.svg"]])
def test_a_model_without_any_known_element_is_refused_as_such(
    command: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("beads.pdb").write_text(BEADS, encoding="ascii")
    Path("names.toml").write_text("[names]\nBB = 2.6\nsc1 = 2.3\n", encoding="ascii")
    Path("residues.toml").write_text('[types]\nb = 2.6\n[residues.ALA]\nb = "BB SC1"\n', encoding="ascii")
    Path("others.toml").write_text("[names]\nQA = 2.6\n", encoding="ascii")
    for more in ([], ["--radii", "alvarez"], ["--radii", "others.toml"]):
        result = run(*command, "beads.pdb", *more)
        assert result.exit_code == 1 and "the names are BB, SC1; expected --radii FILE" in result.stderr
        assert "molviz: beads.pdb: no atom's element is known" in result.stderr
    for more in (["--radii", "names.toml"], ["--radii", "residues.toml"]):
        assert run(*command, "beads.pdb", *more).exit_code == 0


def test_beads_have_the_radii_of_their_names(tmp_path: Path) -> None:
    path, table = tmp_path / "beads.pdb", tmp_path / "r.toml"
    path.write_text(BEADS.replace("1.000", "9.000", 1), encoding="ascii")
    table.write_text("[names]\nBB = 2\nSC1 = 1\n", encoding="ascii")
    assert '"k": 2.0' in run("info", str(path), "--json", "--radii", str(table)).stdout
