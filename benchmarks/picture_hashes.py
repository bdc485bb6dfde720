"""One line for every picture of every sample: what drew it and a hash of its bytes.

Run it before and after a change that should change no picture, and compare::

    python benchmarks/picture_hashes.py > before.txt
    python benchmarks/picture_hashes.py > after.txt
    diff before.txt after.txt

All samples × formats × methods × three views, and scenes of discs. Options go to every ``draw``
(``picture_hashes.py --style print``).
"""

import contextlib
import hashlib
import io
import sys
from pathlib import Path

from molviz.cli import main

FOLDER = Path(__file__).parent.parent / "samples"
SAMPLES = sorted(path for path in FOLDER.iterdir() if path.suffix not in {".md", ".py"})
VIEWS = {
    "principal": [],
    "turned": ["--orient", "file", "--rotate", "x,30", "--rotate", "y,50"],
    "central": ["--rotate", "z,20", "--perspective", "200"],
}
FORMATS = ["svg", "svgz", "ps", "eps", "pdf", "hpgl", "json"]
PAINTED = ["svg", "svgz", "ps", "eps", "pdf"]
SCENES = {
    "random": ["--random", "2000"],
    "shrunk": ["--random", "1000", "--shrink", "--radius", "0.135"],
    "seeded": ["--random", "500", "--depth", "3", "--seed", "7"],
    "text": ["--text", "CSE"],
}


def drawn(arguments: list[str]) -> bytes:
    """Return what a command line writes to standard output, or the message it ends with."""
    output = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")
    errors = io.StringIO()
    with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
        try:
            main([*arguments, "-o", "-"], standalone_mode=True)
        except SystemExit as done:
            if done.code:
                return errors.getvalue().encode()
    return output.buffer.getvalue()  # type: ignore[attr-defined]


def told(name: str, arguments: list[str]) -> None:
    """Print the line of one picture."""
    print(hashlib.sha256(drawn(arguments)).hexdigest()[:16], name, flush=True)


def pictures(more: list[str]) -> None:
    """Print the lines of all samples."""
    for sample in SAMPLES:
        for view, turns in VIEWS.items():
            for method, formats in (("visible", FORMATS), ("painter", PAINTED)):
                for suffix in formats:
                    command = ["draw", str(sample), "--to", suffix, "--method", method, "--quiet", *turns, *more]
                    told(f"{sample.name} {view} {method} {suffix}", command)


def scenes() -> None:
    """Print the lines of Franklin's scenes, drawn as lines and as regions."""
    for name, options in SCENES.items():
        for fill in ("none", "flat"):
            for suffix in FORMATS:
                told(f"{name} {fill} {suffix}", ["hidden-lines", *options, "--to", suffix, "--fill", fill, "--quiet"])


if __name__ == "__main__":
    pictures(sys.argv[1:])
    scenes()
