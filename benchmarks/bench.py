"""All figures in one table: whole processes, their time, memory and bytes, and peers of the same run beside them.

    python benchmarks/bench.py [--repeat 3] [--quick] [FILE...] [--assembly FILE...] > benchmarks/RESULTS.md

Every row is the best of some runs: seconds on the wall and of the processors (all threads), how often the latter holds
``import numpy`` of the same run, and the peak of memory. Files are drawn and measured besides the samples; RasMol
(Debian) draws PDB files, voronota-lt measures the same balls, xyzrender, cinemol and hofmann draw small molecules with
their bonds (``pip install 'molviz[bench]'``). ``--quick`` leaves out what takes minutes. On a busy machine compare the
processors' seconds, not those on the wall.
"""

import argparse
import gzip
import importlib.metadata
import importlib.util
import os
import platform
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np

SAMPLES = Path(__file__).parent.parent / "samples"
RASMOL = Path("/usr/lib/rasmol/rasmol.32")  # of Debian's package: the program without a window, if asked so
PEERS = ("numpy", "click", "svgwrite", "gemmi", "voronotalt", "xyzrender", "cinemol", "hofmann")
SIZES = [1000, 10_000, 100_000, 1_000_000]  # atoms, of which exponents are told
VORONOTA = """
import sys, numpy, voronotalt
rows = numpy.loadtxt(sys.argv[1])
balls = [voronotalt.Ball(*row) for row in rows.tolist()]
result = voronotalt.RadicalTessellation(balls=balls, probe=float(sys.argv[2]))
print(sum(cell.sas_area for cell in result.cells))
"""
BALLS = """
import sys, numpy
from molviz.pipeline.inputs import InputOptions, load
spheres = load(sys.argv[1], InputOptions())[0].spheres
numpy.savetxt(sys.argv[2], numpy.column_stack([spheres.center, spheres.radius]), "%.4f")
"""  # in a process of its own: what starts others must stay small, as their peak of memory is at least its own
GLOBULE = """
import sys, numpy
sys.path.insert(0, sys.argv[3])
from globule import globule
spheres = globule(int(sys.argv[1]))
numpy.savetxt(sys.argv[2], numpy.column_stack([spheres.center, spheres.radius]), "%.4f")
"""
HOFMANN = """
import sys, numpy
from hofmann import Frame, StructureScene, default_atom_style, default_bond_specs
rows = [line.split() for line in open(sys.argv[1]).read().splitlines()[2:]]
kinds, places = [row[0] for row in rows], numpy.array([row[1:4] for row in rows], dtype=float)
styles = {kind: default_atom_style(kind) for kind in kinds}
StructureScene(kinds, [Frame(places)], styles, default_bond_specs(kinds)).render_mpl(sys.argv[2])
"""
MOL = """
import sys, molviz
molecule = molviz.read(sys.argv[1]).models[0]
lines = ["", "", "", f"{len(molecule):3}{len(molecule.bonds):3}  0  0  0  0  0  0  0  0999 V2000"]
for (x, y, z), element in zip(molecule.position, molecule.element):
    lines.append(f"{x:10.4f}{y:10.4f}{z:10.4f} {element:<3} 0  0  0  0  0  0  0  0  0  0  0  0")
lines += [f"{first + 1:3}{second + 1:3}  1  0" for first, second in molecule.bonds.tolist()]
open(sys.argv[2], "w").write(chr(10).join([*lines, "M  END", "$$$$", ""]))
"""  # cinemol reads nothing else


class Run(NamedTuple):
    """What one process took: seconds on the wall and of processors, and the peak of memory in MB."""

    wall: float
    cpu: float
    memory: float


class Bench:
    """Runs processes and prints the rows of the table."""

    def __init__(self, folder: Path, repeat: int) -> None:
        self.folder, self.repeat = folder, repeat
        self.numpy = self.best([sys.executable, "-c", "import numpy"])

    def once(self, command: list[str], stdin: str = "") -> Run:
        """Run a process; raises SystemExit where it fails."""
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
        return Run(time.perf_counter() - began, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024)

    def best(self, command: list[str], stdin: str = "") -> Run:
        """Return the least of each figure, and of memory the most."""
        runs = [self.once(command, stdin) for _ in range(self.repeat)]
        wall, cpu, memory = zip(*runs, strict=True)
        return Run(min(wall), min(cpu), max(memory))

    def row(self, what: str, command: list[str], target: Path | None = None, peer: Run | None = None) -> Run:
        """Run and print one row; ``peer`` is what the time is divided by in the last column."""
        run = self.best(command)
        self.tell(what, run, target, peer)
        return run

    def tell(self, what: str, run: Run, target: Path | None = None, peer: Run | None = None) -> None:
        """Print one row."""
        size = f"{target.stat().st_size:,}" if target else ""
        ratio = f"{run.cpu / peer.cpu:.2f}" if peer else ""
        times = f"{run.wall:.2f} | {run.cpu:.2f} | {run.cpu / self.numpy.cpu:.1f}"
        print(f"| {what} | {times} | {run.memory:.0f} | {size} | {ratio} |", flush=True)

    def drawn(self, what: str, source: Path, suffix: str, *options: str, peer: Run | None = None) -> Run:
        """Draw a file, water included, and print the row."""
        target = self.folder / f"picture.{suffix}"
        command = [sys.executable, "-m", "molviz", "draw", str(source), "-o", str(target), "--water", "--quiet"]
        return self.row(what, [*command, *options], target, peer)


def start(bench: Bench) -> None:
    """What costs the same for every input."""
    bench.tell("`import numpy`", bench.numpy)
    bench.row("`molviz --help`", [sys.executable, "-m", "molviz", "--help"])
    bench.drawn("caffeine, flat, SVG", SAMPLES / "caffeine.xyz", "svg", "--style", "flat")
    bench.drawn("caffeine, flat, PS", SAMPLES / "caffeine.xyz", "ps", "--style", "flat")


def bonds(bench: Bench, name: str) -> None:
    """A small molecule as balls and sticks, by its peers as well."""
    source, mol, target = SAMPLES / f"{name}.xyz", bench.folder / f"{name}.sdf", bench.folder / "peer.svg"
    subprocess.run([sys.executable, "-c", MOL, str(source), str(mol)], check=True)
    scripts = Path(sys.executable).parent
    peers = {
        "xyzrender": [str(scripts / "xyzrender"), str(source), "-o", str(target)],
        "cinemol": [str(scripts / "cinemol"), "-hs", str(mol), str(target)],
        "hofmann": [sys.executable, "-c", HOFMANN, str(source), str(target)],
    }
    there = {peer: command for peer, command in peers.items() if importlib.util.find_spec(peer)}
    runs = [bench.row(f"{name}, {peer}, balls and sticks, SVG", command, target) for peer, command in there.items()]
    fastest = min(runs, key=lambda run: run.cpu, default=None)
    what = f"{name}, flat, balls and sticks, SVG" + (" (by the fastest's)" if fastest else "")
    bench.drawn(what, source, "svg", "--rep", "ball-and-stick", "--style", "flat", peer=fastest)


def file(bench: Bench, source: Path) -> None:
    """One molecule drawn and measured, with its peers."""
    name = source.name.split(".")[0]
    for style in ("goodsell", "flat"):
        bench.drawn(f"{name}, {style}, SVG", source, "svg", "--style", style)
    bench.drawn(f"{name}, flat, painter, SVG", source, "svg", "--style", "flat", "--method", "painter")
    for style in ("goodsell", "flat"):
        bench.drawn(f"{name}, {style}, sticks, SVG", source, "svg", "--style", style, "--rep", "sticks")
    peer = rasmol(bench, source) if RASMOL.exists() and ".pdb" in source.suffixes else None
    bench.drawn(f"{name}, flat, PS (by RasMol's)", source, "ps", "--style", "flat", peer=peer)
    balls = bench.folder / "balls.xyzr"
    as_balls(source, balls)
    for probe in ("0", "1.4"):
        measured(bench, name, balls, probe)


def assembly(bench: Bench, source: Path) -> None:
    """The biological assembly of a file drawn and measured, once: it takes long where it is large."""
    name, bench.repeat = f"{source.name.split('.')[0]}, assembly", 1
    for style in ("flat", "goodsell"):
        bench.drawn(f"{name}, {style}, SVG", source, "svg", "--style", style, "--assembly", "1")
    for probe in ("0", "1.4"):
        command = [sys.executable, "-m", "molviz", "measure", str(source), "--assembly", "1", "--probe", probe]
        bench.row(f"{name}, measure, probe {probe}", [*command, "--quiet"])


def rasmol(bench: Bench, source: Path) -> Run:
    """RasMol's vector PostScript of the same atoms."""
    plain, target = bench.folder / "peer.pdb", bench.folder / "peer.ps"
    data = source.read_bytes()
    plain.write_bytes(gzip.decompress(data) if source.suffix == ".gz" else data)
    script = f"load pdb {plain}\nspacefill\nwrite vectps {target}\nexit\n"
    run = bench.once([str(RASMOL), "-nodisplay"], script)
    bench.tell(f"{source.name.split('.')[0]}, RasMol, vector PS", run, target)
    return run


def as_balls(source: Path, target: Path) -> None:
    """Write a molecule's balls as .xyzr."""
    subprocess.run([sys.executable, "-c", BALLS, str(source), str(target)], check=True)


def measured(bench: Bench, name: str, balls: Path, probe: str) -> None:
    """Exact area and volume of balls, beside voronota-lt's where it is installed."""
    peer = None
    if importlib.util.find_spec("voronotalt"):
        peer = bench.best([sys.executable, "-c", VORONOTA, str(balls), probe])
        bench.tell(f"{name}, voronota-lt, probe {probe}", peer)
    command = [sys.executable, "-m", "molviz", "measure", str(balls), "--radii", "file", "--probe", probe, "--quiet"]
    bench.row(f"{name}, measure, probe {probe} (by voronota-lt's)", command, peer=peer)


def scenes(bench: Bench, quick: bool) -> None:
    """Franklin's scenes."""
    for count, suffix in ((10_000, "svg"), (10_000, "ps"), *([] if quick else [(1_000_000, "ps")])):
        target = bench.folder / f"scene.{suffix}"
        command = [sys.executable, "-m", "molviz", "hidden-lines", "--random", str(count), "-o", str(target), "--quiet"]
        bench.row(f"{count:,} random spheres, {suffix.upper()}", command, target)


def scaling(bench: Bench, sizes: list[int]) -> None:
    """Draw and measure globules as dense as proteins, and print the exponents of the processors' time."""
    spent: dict[str, list[float]] = {"draw": [], "measure": []}
    for count in sizes:
        source = bench.folder / "globule.xyzr"
        subprocess.run([sys.executable, "-c", GLOBULE, str(count), str(source), str(Path(__file__).parent)], check=True)
        run = bench.drawn(f"globule of {count:,}, flat, PS", source, "ps", "--style", "flat", "--radii", "file")
        spent["draw"].append(run.cpu - bench.numpy.cpu)
        command = [sys.executable, "-m", "molviz", "measure", str(source), "--radii", "file", "--quiet"]
        spent["measure"].append(bench.row(f"globule of {count:,}, measure", command).cpu - bench.numpy.cpu)
    for what, seconds in spent.items():
        slope = np.polyfit(np.log(sizes[1:]), np.log(np.maximum(seconds[1:], 1e-3)), 1)[0]
        print(f"\nExponent of {what} from {sizes[1]:,} to {sizes[-1]:,} atoms, start taken off: {slope:.2f}.")


def machine() -> str:
    """Say what ran: processor, system and versions."""
    info = Path("/proc/cpuinfo")
    models = [line.partition(":")[2].strip() for line in info.read_text().splitlines() if line.startswith("model name")]
    found = [name for name in PEERS if importlib.util.find_spec(name)]
    versions = ", ".join(f"{name} {importlib.metadata.version(name)}" for name in found)
    cores, load = len(os.sched_getaffinity(0)), os.getloadavg()[0]
    return (
        f"{models[0] if models else platform.processor()}, {cores} processors, load {load:.1f} at the start; "
        f"Python {platform.python_version()}, {versions}."
    )


def main() -> None:
    """Print the table as Markdown."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--assembly", nargs="*", type=Path, default=[], help="files whose assembly 1 is drawn too")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # a user's modules are compiled once, not with every start
    print(f"# Measured by `make bench`\n\n{machine()}\n")
    print("| what | wall, s | processors, s | × numpy | MB | bytes | by the peer's |\n|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(Path(folder), options.repeat)
        start(bench)
        for name in ("caffeine", "c60"):
            bonds(bench, name)
        for source in options.files or [SAMPLES / "1tii.pdb.gz"]:
            file(bench, source)
        scenes(bench, options.quick)
        scaling(bench, SIZES[:3] if options.quick else SIZES)
        for source in options.assembly:
            assembly(bench, source)


if __name__ == "__main__":
    main()
