"""Every sample is read and drawn, and its visibility map holds what it promises."""

from pathlib import Path

import pytest
from click.testing import CliRunner

from molviz.cli import main

SAMPLES = Path(__file__).parent.parent / "samples"
FILES = sorted(path for path in SAMPLES.iterdir() if path.suffix not in (".md", ".py"))
VIEWS = {
    "file": ["--orient", "file"],
    "principal": [],
    "turned": ["--rotate", "x,33", "--rotate", "y,21"],
    "central": ["--perspective", "300"],
}


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_the_map_of_every_sample_keeps_its_invariants(path: Path, view: str, tmp_path: Path) -> None:
    words = ["draw", str(path), "--check", "-o", str(tmp_path / "map.json"), "--quiet", *VIEWS[view]]
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 0, result.output
