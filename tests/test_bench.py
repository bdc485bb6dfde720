"""The bench runs: a table whose rows are whole, on one small molecule."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent


def test_the_table_has_a_row_for_every_program() -> None:
    code = (
        "import bench, sys; from pathlib import Path; from tempfile import mkdtemp; "
        "table = bench.Bench(Path(mkdtemp()), 1); bench.start(table); bench.bonds(table, 'caffeine'); "
        "bench.scaling(table, [100, 200])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        cwd=ROOT / "benchmarks",
        env=os.environ | {"PYTHONPATH": str(ROOT / "benchmarks")},
    )
    rows = [line for line in done.stdout.splitlines() if line.startswith("|")]
    assert len(rows) >= 9 and any("balls and sticks" in row for row in rows) and {row.count("|") for row in rows} == {8}
    assert done.stdout.count("Exponent of") == 2
