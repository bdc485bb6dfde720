"""Inputs that nobody would write, to readers, selections, styles, palettes and tables of radii.

    python -m tests.fuzz [--seed 0] [--start 0] [--count 100000] [--only readers|selections|styles]

Case k of a seed is always the same. An answer, or InputError with a reason in one line, is right; everything else,
warnings of numpy, more than ``SECONDS`` and more than ``MEMORY`` are wrong, and are kept in ``out/fuzz``.
"""

import argparse
import random
import re
import resource
import signal
import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import numpy as np

from molviz.errors import InputError
from molviz.model.molecule import Molecule
from molviz.model.radii import load_table
from molviz.model.selection import select
from molviz.picture.palette import load_palette
from molviz.picture.style import load_style
from molviz.pipeline.info import info
from molviz.pipeline.inputs import InputOptions, loaded_from
from molviz.pipeline.measure import measurement
from molviz.readers import FORMATS, read

ROOT = Path(__file__).parent
SECONDS, MEMORY = 5.0, 1 << 30
USED = 0.1  # of what was read is measured too
LONGEST_MESSAGE = 7000  # letters
LONGEST_SEED = 4000  # bytes of a file that is varied; a small one is tried often

NASTY = [
    "nan", "inf", "-inf", "1e400", "-1e-400", "1e308", "1e-308", "1e60", "0", "-0", "9" * 19, "9" * 400, "9" * 5000,
    "", "1D+00", "0x10", "1_000", "١", "é", "\u2028", "\x00", "\x1b[2J", "\x7f", "\t", "'", '"', ";", "?", ".", "*",
    "-", "_", "loop_", "data_", "save_", "#", "$$$$", "M END", "M V30", "END", "ENDMDL", "MODEL 1", "TER",
    "(1-900000000)", "Properties=species:S:1:pos:R:3", "Properties=pos:R:99999999:species:S:1", "V2000", "V3000",
    "999999", "-1", "2147483648", "1 2 3 4 5", "X", "Fe", "Qq", "ATOM ", "HETATM", "CONECT", "REMARK 350", "BIOMT1",
    "A" * 300,
]  # fmt: skip
WORDS = [
    "chain", "segid", "resn", "resi", "resid", "name", "elem", "index", "b", "x", "y", "z", "and", "or", "not",
    "within", "around", "of", "byres", "same", "residue", "as", "to", "protein", "water", "ligand", "polymer",
    "hetatm", "all", "none", "(", ")", "<", "<=", ">", "=", "!=", "!", "&", "|", ",", "+", "-", ":", "10", "-3",
    "10-20", "10:20", "5.5", "1e300", "A", "CA", "C*", "[", "]", "?", "/A:10@CA", "//A/10-20(ALA)/CA[C]", "/1/A",
    ":HOH", "@CA", "#1", '"', '"and"', "9" * 5000, "é", "nan", "/", "//", "::", "@@", "\x1b",
]  # fmt: skip


@cache
def seeds() -> dict[str, list[bytes]]:
    """Small files of every format to start from."""
    pdb = [f"ATOM  {k:>5}  {n:<3} ALA A{k:>4}    {k * 1.5:8.3f}   0.000   1.000  1.00 10.00           {n[0]}\n"
           for k, n in enumerate(("N", "CA", "C", "O", "CB"), 1)]  # fmt: skip
    names = ["id", "type_symbol", "label_atom_id", "label_comp_id", "label_asym_id", "auth_seq_id", "Cartn_x",
             "Cartn_y", "Cartn_z", "occupancy", "B_iso_or_equiv", "label_alt_id", "pdbx_PDB_model_num"]  # fmt: skip
    cif = "data_x\nloop_\n" + "".join(f"_atom_site.{name}\n" for name in names)
    cif += "".join(f"{k} C CA ALA A {k} {k}.5 0 1 1.0 10 . 1\n" for k in range(1, 5))
    small = "data_s\n_cell_length_a 5\n_cell_length_b 5\n_cell_length_c 5\n_cell_angle_alpha 90\n_cell_angle_beta 90\n"
    small += "_cell_angle_gamma 90\n_symmetry_space_group_name_H-M 'P 21'\nloop_\n_atom_site_label\n"
    small += "_atom_site_fract_x\n_atom_site_fract_y\n_atom_site_fract_z\nNa1 0 0 0\nCl1 0.5 0.5(1) 0.5\n"
    sdf = "m\n  x\n\n  2  1  0  0  0  0            999 V2000\n" + "".join(
        f"{k:10.4f}{0:10.4f}{0:10.4f} C   0  0\n" for k in range(2)) + "  1  2  1  0\nM  END\n$$$$\n"  # fmt: skip
    v3 = "m\n  x\n\n  0  0  0     0  0            999 V3000\nM  V30 BEGIN CTAB\nM  V30 COUNTS 1 0 0 0 0\n" \
         "M  V30 BEGIN ATOM\nM  V30 1 C 0 0 0 0\nM  V30 END ATOM\nM  V30 END CTAB\nM  END\n"  # fmt: skip
    gro = "t\n2\n    1ALA      N    1   0.000   0.000   0.000\n    1ALA     CA    2   0.150   0.000   0.000\n 1 1 1\n"
    pqr = "ATOM 1 N ALA A 1 0.0 0.0 0.0 -0.3 1.8\nATOM 2 CA ALA A 1 1.5 0.0 0.0 0.1 1.9\n"
    ext = '2\nLattice="5 0 0 0 5 0 0 0 5" Properties=species:S:1:pos:R:3:q:R:1\nC 0 0 0 1\nO 1.2 0 0 -1\n'
    model = f"MODEL        1\n{pdb[0]}ENDMDL\nMODEL        2\n{pdb[1]}ENDMDL\nCONECT    1    2\nEND\n"
    texts = {
        "pdb": ["".join(pdb), model], "mmcif": [cif, small], "xyz": ["2\nc\nC 0 0 0\nO 1.2 0 0\n1\n\nH 0 0 0\n"],
        "extxyz": [ext], "xyzr": ["0 0 0 1 # a\n1 0 0 0.5\n"], "sdf": [sdf, v3], "gro": [gro], "pqr": [pqr],
    }  # fmt: skip
    found = {path.suffix[1:]: path.read_bytes()[:LONGEST_SEED] for path in sorted((ROOT / "found").glob("*.*"))}
    many = {name: [text.encode() for text in several] for name, several in texts.items()}
    for suffix, data in found.items():
        many.get(suffix, many["xyz"]).append(data)
    return many


@cache
def tables() -> list[tuple[Callable[[str], object], list[str]]]:
    """What loads the user's files of taste and of physics, and files to start from."""
    package = ROOT.parent / "molviz"
    own = ['base = "goodsell"\n[ink]\nsilhouette = 4.5\n[fog]\nstrength = 0.6\n',
           'base = "cel"\n[shade]\nsteps = [[1, 2, 0.1]]\n']  # fmt: skip
    styles, palettes = (
        [path.read_text("utf-8")[:LONGEST_SEED] for path in sorted((package / "picture" / kind).glob("*.toml"))]
        for kind in ("styles", "palettes")
    )
    radii = ["[elements]\nC = 1.7\nH = 1.2\n", "[types]\na = 1.7\n[residues.ALA]\na = 'CA CB'\n[elements]\nC = 1.7\n"]
    return [(load_style, [*own, *styles]), (load_palette, palettes), (load_table, radii)]


MOLECULE = Molecule.of(
    "m", np.arange(60, dtype=float).reshape(20, 3) % 11, np.array(list("NCHOCNCHOC") * 2),
    atom_name=["N", "CA", "H", "O", "CB"] * 4, residue_name=["ALA"] * 10 + ["HOH"] * 5 + ["HEM"] * 5,
    residue=["1"] * 5 + ["2A"] * 5 + ["-3"] * 5 + ["9" * 40] * 5,
    chain=["A"] * 10 + ["b"] * 5 + [""] * 5, bfactor=[1.0, np.nan] * 10,
)  # fmt: skip


def varied(rng: random.Random, data: bytes) -> bytes:
    """The data after a few changes: of bytes, of words, of lines."""
    for _ in range(rng.choice([1, 1, 2, 3, 8])):
        data = rng.choice(CHANGES)(rng, data)
    return data


def _bytes_changed(rng: random.Random, data: bytes) -> bytes:
    at, size = rng.randrange(len(data) + 1), rng.choice([0, 1, 1, 2, 10])
    return data[:at] + rng.randbytes(rng.choice([0, 1, 1, 4])) + data[at + size :]


def _word_changed(rng: random.Random, data: bytes) -> bytes:
    words = re.split(rb"(\s+)", data)
    words[rng.randrange(len(words))] = rng.choice(NASTY).encode("utf-8", "surrogateescape")
    return b"".join(words)


def _digit_changed(rng: random.Random, data: bytes) -> bytes:
    places = [match.start() for match in re.finditer(rb"[0-9]", data)]
    at = rng.choice(places) if places else 0
    return data[:at] + rng.choice(b"0123456789.-eE*").to_bytes(1, "big") + data[at + 1 :]


def _lines_changed(rng: random.Random, data: bytes) -> bytes:
    lines = data.split(b"\n")
    at, to = rng.randrange(len(lines)), rng.randrange(len(lines))
    what = rng.choice(["drop", "again", "swap", "cut", "many"])
    if what == "drop":
        del lines[at]
    elif what == "swap":
        lines[at], lines[to] = lines[to], lines[at]
    elif what == "cut":
        lines[at] = lines[at][: rng.randrange(len(lines[at]) + 1)]
    else:
        lines[at:at] = [lines[to]] * (1 if what == "again" else rng.choice([2, 50]))
    return b"\n".join(lines)


def _ended(rng: random.Random, data: bytes) -> bytes:
    return data[: rng.randrange(len(data) + 1)]


CHANGES = [_bytes_changed, _word_changed, _word_changed, _digit_changed, _lines_changed, _ended]


def try_reader(rng: random.Random) -> Iterator[bytes]:
    name = rng.choice(list(FORMATS))
    data = varied(rng, rng.choice(seeds()[name])) if rng.random() < 0.97 else rng.randbytes(rng.randrange(300))
    stated = rng.choice([name, name, None])
    yield data
    reading = read(f"x.{name}", data, stated)
    if rng.random() < USED:
        for loaded in loaded_from(reading, InputOptions())[:1]:
            info(loaded)
            measurement(loaded, rng.choice([None, None, "all"]), "atom")


def try_selection(rng: random.Random) -> Iterator[bytes]:
    words = [rng.choice(WORDS) for _ in range(rng.choice([1, 2, 3, 5, 8, 20]))]
    text = rng.choice(["", " ", " ", " "]).join(words)
    yield text.encode("utf-8")
    assert select(MOLECULE, text).shape == (len(MOLECULE),)


def try_style(rng: random.Random) -> Iterator[bytes]:
    load, several = rng.choice(tables())
    data = varied(rng, rng.choice(several).encode())
    yield data
    path = Path(FOLDER.name) / rng.choice(["x.toml", "x.toml", "x.txt"])
    path.write_bytes(data)
    load(str(path))


class Late(Exception):  # noqa: N818 - not an error of the program
    """The answer takes too long."""


def attempt(seed: int, number: int, only: str = "") -> tuple[str, bytes, str]:
    """Try one case; return its target, its input and what is wrong with the answer, "" for nothing."""
    rng = random.Random(f"{seed}:{number}")
    target = only or rng.choice(list(TARGETS))
    steps = TARGETS[target](rng)
    data = next(steps)
    signal.signal(signal.SIGALRM, _late)
    signal.setitimer(signal.ITIMER_REAL, SECONDS)
    try:
        next(steps, None)
        return target, data, ""
    except InputError as wrong:
        text = str(wrong)
        return target, data, "" if 0 < len(text) < LONGEST_MESSAGE and "\n" not in text else f"message {text[:200]!r}"
    except Exception as wrong:
        return target, data, f"{type(wrong).__name__}: {wrong}"
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)


def _late(signal_number: int, frame: object) -> None:
    raise Late(f"not done after {SECONDS:g} s")


def limits() -> None:
    """Let what takes too long, too much memory or warns of numbers fail."""
    warnings.simplefilter("error")
    signal.signal(signal.SIGALRM, _late)
    resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, resource.getrlimit(resource.RLIMIT_DATA)[1]))


def main() -> None:
    parser = argparse.ArgumentParser(description="Fuzz molviz; prints seed and number of each case that is wrong.")
    parser.add_argument("--seed", type=int, default=int(time.time()))
    parser.add_argument("--start", type=int, default=0)
    parser.add_argument("--count", type=int, default=100_000)
    parser.add_argument("--seconds", type=float, default=float("inf"), help="stop after so long")
    parser.add_argument("--only", choices=list(TARGETS), default="")
    asked = parser.parse_args()
    print(f"seed {asked.seed}", flush=True)
    limits()
    failed, began, number = 0, time.monotonic(), asked.start
    for number in range(asked.start, asked.start + asked.count):
        target, data, wrong = attempt(asked.seed, number, asked.only)
        if wrong:
            failed += 1
            kept = ROOT.parent / "out" / "fuzz" / f"{asked.seed}-{number}.{target}"
            kept.parent.mkdir(parents=True, exist_ok=True)
            kept.write_bytes(data)
            print(f"--seed {asked.seed} --start {number} --count 1: {target}: {wrong[:300]}", flush=True)
        if time.monotonic() - began > asked.seconds:
            break
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss >> 10
    FOLDER.cleanup()
    print(f"{number + 1 - asked.start} inputs, {failed} wrong, {time.monotonic() - began:.0f} s, {most} MB at most")
    sys.exit(bool(failed))


FOLDER = tempfile.TemporaryDirectory()
TARGETS = {"readers": try_reader, "selections": try_selection, "styles": try_style}


if __name__ == "__main__":
    main()
