"""Time and error of ``molviz measure`` beside freesasa and rust-sasa-python, in one run.

    pip install .[bench]
    python benchmarks/measure_bench.py [1tim.pdb ribosome.cif.gz ...] [--probe 1.4] [--repeat 3]

Without files, a globule as dense as a protein is measured. All programs get the same balls, already read. Each is
timed alone, the best of ``--repeat`` runs; the errors are that of the total area and the worst of an atom's.
"""

import argparse
import time
from collections.abc import Callable
from typing import NamedTuple

import freesasa
import numpy as np
import rust_sasa_python
from globule import globule

from molviz.geometry.measure import measure_spheres
from molviz.model.spheres import Spheres
from molviz.pipeline.inputs import InputOptions, load


class Run(NamedTuple):
    """What one program took and found."""

    program: str
    seconds: float
    area: np.ndarray


def lee_richards(spheres: Spheres, probe: float, slices: int) -> np.ndarray:
    """Return the area (n,) that freesasa finds by slices."""
    freesasa.setVerbosity(freesasa.silent)
    parameters = freesasa.Parameters(
        {"algorithm": freesasa.LeeRichards, "probe-radius": probe, "n-slices": slices, "n-threads": 1}
    )
    result = freesasa.calcCoord(spheres.center.ravel().tolist(), spheres.radius.tolist(), parameters)
    return np.array([result.atomArea(row) for row in range(len(spheres.radius))])


def shrake_rupley(spheres: Spheres, probe: float, points: int) -> np.ndarray:
    """Return the area (n,) that rust-sasa finds by points."""
    rows = zip(spheres.center.tolist(), spheres.radius.tolist(), strict=True)
    atoms = [(tuple(center), radius, row) for row, (center, radius) in enumerate(rows)]
    return np.array(rust_sasa_python.calculate_sasa_internal(atoms, probe, points, 1))


def exact(spheres: Spheres, probe: float) -> np.ndarray:
    """Return the exact area (n,)."""
    return measure_spheres(Spheres(spheres.center, spheres.radius + probe)).area


PROGRAMS: dict[str, Callable[[Spheres, float], np.ndarray]] = {
    "molviz (exact)": exact,
    "freesasa, 20 slices": lambda spheres, probe: lee_richards(spheres, probe, 20),
    "freesasa, 1000 slices": lambda spheres, probe: lee_richards(spheres, probe, 1000),
    "rust-sasa, 100 points": lambda spheres, probe: shrake_rupley(spheres, probe, 100),
    "rust-sasa, 1000 points": lambda spheres, probe: shrake_rupley(spheres, probe, 1000),
}


def timed(program: str, spheres: Spheres, probe: float, repeat: int) -> Run:
    """Return the best of some runs of a program."""
    seconds = np.inf
    for _ in range(repeat):
        begin = time.perf_counter()
        area = PROGRAMS[program](spheres, probe)
        seconds = min(seconds, time.perf_counter() - begin)
    return Run(program, seconds, area)


def report(source: str, spheres: Spheres, probe: float, repeat: int) -> None:
    """Print time and error of every program for some balls."""
    runs = [timed(program, spheres, probe, repeat) for program in PROGRAMS]
    truth = runs[0]
    print(f"{source}: {len(truth.area)} atoms, probe {probe:g} Å, area {truth.area.sum():.6f} Å²")
    for run in runs:
        total = run.area.sum() / truth.area.sum() - 1
        worst = np.abs(run.area - truth.area).max()
        print(
            f"  {run.program:<24}{run.seconds:9.3f} s  ×{run.seconds / truth.seconds:7.2f}"
            f"   total {total:+.1e}   worst atom {worst:.1e} Å²"
        )


def main() -> None:
    """Measure the files of the command line, or a globule."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("inputs", nargs="*")
    parser.add_argument("--probe", type=float, default=1.4)
    parser.add_argument("--repeat", type=int, default=3)
    options = parser.parse_args()
    for source in options.inputs:
        report(source, load(source, InputOptions())[0].spheres, options.probe, options.repeat)
    if not options.inputs:
        report("globule", globule(4000), options.probe, options.repeat)


if __name__ == "__main__":
    main()
