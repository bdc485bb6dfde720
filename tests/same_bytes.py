"""Prints a digest of every format of some drawings and numbers: run elsewhere, it must print the same.

    python -m tests.same_bytes
"""

import hashlib
import io
import warnings
from contextlib import redirect_stderr, redirect_stdout, suppress
from pathlib import Path
from typing import Any

import molviz
from molviz.cli import main

SAMPLES = Path(__file__).parent.parent / "samples"
PICTURES: list[tuple[str, dict[str, Any]]] = [
    ("1a8o.pdb", {"style": "goodsell"}), ("1a8o.pdb", {"style": "flat", "color_by": "exposure", "legend": True}),
    ("1a1f.pdb", {"style": "goodsell", "perspective": 200, "rotate": "x,31.4"}),
    ("caffeine.xyz", {"style": "cel", "rotate": "y,-12.5"}), ("caffeine.xyz", {"style": "shaded", "perspective": 40}),
    ("c60.xyz", {"style": "hatch", "perspective": 15}), ("nacl.extxyz", {"style": "flat", "method": "painter"}),
]  # fmt: skip
FORMATS = ("svg", "svgz", "ps", "eps", "pdf", "hpgl", "json")
COMMANDS = [["measure", "--per", "atom", "--json"], ["measure", "--csv", "--probe", "1.4"], ["info", "--json"]]


def printed(words: list[str]) -> str:
    text = io.StringIO()
    with redirect_stdout(text), redirect_stderr(io.StringIO()), suppress(SystemExit):
        main(words)
    return text.getvalue()


def digests() -> list[str]:
    lines = []
    for name, options in PICTURES:
        drawing = molviz.draw(SAMPLES / name, **options)
        for suffix in FORMATS:
            if options.get("method") != "painter" or suffix not in ("hpgl", "json"):
                lines.append(f"{name} {options} {suffix} {hashlib.sha256(drawing.to(suffix)).hexdigest()}")
    for words in COMMANDS:
        for name in ("1a8o.pdb", "caffeine.xyz", "c60.xyz"):
            text = printed([*words, str(SAMPLES / name)]).replace(str(SAMPLES), "")
            lines.append(f"{name} {words} {hashlib.sha256(text.encode()).hexdigest()}")
    return lines


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    print("\n".join(digests()))
