"""Time, memory and size of whole ``molviz draw`` runs, and their ratio to importing the packages and to a peer.

Run as ``python benchmarks/draw_bench.py [FILE...]``; without files the samples are drawn, and a large assembly made of
copies of one. Each figure is the best of ``REPEATS`` whole processes on a warm disk. RasMol's vector PostScript is the
peer, where it is installed.
"""

import gzip
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

REPEATS = 3
SAMPLES = Path(__file__).parent.parent / "samples"
IMPORTS = "import numpy, gemmi, click, svgwrite"
CASES = [  # style, method, format
    ("flat", "visible", "svg"), ("flat", "painter", "svg"), ("flat", "visible", "ps"), ("goodsell", "visible", "svg"),
    ("goodsell", "visible", "eps"),
]  # fmt: skip
RASMOL = Path("/usr/lib/rasmol/rasmol.32")  # of Debian's package: the program without a window, if asked so


def run(command: list[str], stdin: str = "") -> tuple[float, float]:
    """Return seconds and peak memory in MB of one process."""
    began = time.perf_counter()
    process = subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, text=True
    )
    assert process.stdin
    process.stdin.write(stdin)
    process.stdin.close()
    _, status, usage = os.wait4(process.pid, 0)
    if status:
        raise SystemExit(f"failed: {' '.join(command)}")
    return time.perf_counter() - began, usage.ru_maxrss / 1024


def best(command: list[str], stdin: str = "") -> tuple[float, float]:
    """Return the least time of several runs and the largest memory."""
    runs = [run(command, stdin) for _ in range(REPEATS)]
    return min(seconds for seconds, _ in runs), max(memory for _, memory in runs)


def molviz(source: Path, style: str, method: str, target: Path) -> tuple[float, float, int]:
    """Return seconds, memory in MB and bytes of one drawing; water is drawn, as the peer does."""
    options = ["--style", style, "--method", method, "--water", "--quiet"]
    command = [sys.executable, "-m", "molviz", "draw", str(source), "-o", str(target), *options]
    return *best(command), target.stat().st_size


def report(source: Path, folder: Path, imports: float) -> None:
    """Print the figures of one file."""
    times: dict[tuple[str, str, str], float] = {}
    for case in CASES:
        style, method, suffix = case
        seconds, memory, size = molviz(source, style, method, folder / f"picture.{suffix}")
        times[case] = seconds
        print(
            f"{source.name:<22}{style:<9}{method:<9}{suffix:<5}{seconds:7.2f} s {seconds / imports:7.2f} x imports"
            f"{memory:7.0f} MB{size:12,} bytes"
        )
    ratio = times["flat", "visible", "svg"] / times["flat", "painter", "svg"]
    print(f"{'':<22}visible takes {ratio:.2f} times as long as painter")
    if RASMOL.exists() and ".pdb" in source.suffixes:
        seconds, size = rasmol(source, folder)
        ratio = times["flat", "visible", "ps"] / seconds
        print(f"{'':<22}RasMol, vector PS {seconds:12.2f} s; molviz/RasMol {ratio:.2f}{size:26,} bytes")


def rasmol(source: Path, folder: Path) -> tuple[float, int]:
    """Return seconds and bytes of RasMol's vector PostScript of the same atoms, run once."""
    plain, target = folder / "peer.pdb", folder / "peer.ps"
    data = source.read_bytes()
    plain.write_bytes(gzip.decompress(data) if source.suffix == ".gz" else data)
    script = f"load pdb {plain}\nspacefill\nwrite vectps {target}\nexit\n"
    seconds, _ = run([str(RASMOL), "-nodisplay"], script)
    return seconds, target.stat().st_size


def tiled(source: Path, target: Path, copies: int) -> Path:
    """Write copies of a molecule side by side, four in a row, as XYZ."""
    from molviz import read

    molecule = read(str(source)).models[0]
    size = molecule.position.max(axis=0) - molecule.position.min(axis=0) + 3.0
    rows = []
    for copy in range(copies):
        shift = size * [copy % 4, copy // 4 % 4, copy // 16]
        rows += [
            f"{element} {x:.3f} {y:.3f} {z:.3f}"
            for element, (x, y, z) in zip(molecule.element, molecule.position + shift, strict=True)
        ]
    target.write_text("\n".join([str(len(rows)), f"{copies} copies", *rows, ""]), encoding="utf-8")
    return target


def main() -> None:
    """Print a table."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        imports, _ = best([sys.executable, "-c", IMPORTS])
        print(f"python -c '{IMPORTS}': {imports:.2f} s")
        files = [Path(word) for word in sys.argv[1:]]
        if not files:
            files = sorted(path for path in SAMPLES.iterdir() if path.suffix in (".pdb", ".xyz", ".cif", ".gz"))
            largest = max(files, key=lambda path: path.stat().st_size)
            files.append(tiled(largest, folder / "sixteen.xyz", 16))
        for source in files:
            report(source, folder, imports)


if __name__ == "__main__":
    main()
