"""The same input gives the same bytes, whatever the processor; `make numpies` compares versions of numpy."""

import gzip
import os
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

import molviz
from molviz.write.gzipped import gzipped

ROOT = Path(__file__).parent.parent
OLD = "AVX512F AVX512CD AVX512_SKX AVX512_CLX AVX512_CNL AVX512_ICL AVX2 FMA3"
PROCESSORS = [
    {"OPENBLAS_CORETYPE": "Nehalem"}, {"OPENBLAS_CORETYPE": "Haswell", "NPY_DISABLE_CPU_FEATURES": OLD},
    {"OPENBLAS_CORETYPE": "SkylakeX", "OPENBLAS_NUM_THREADS": "1", "PYTHONHASHSEED": "7"},
]  # fmt: skip


@cache
def digests(*more: tuple[str, str]) -> list[str]:
    command = [sys.executable, "-W", "ignore", "-m", "tests.same_bytes"]
    done = subprocess.run(command, cwd=ROOT, env=os.environ | dict(more), capture_output=True, text=True, check=True)
    return done.stdout.splitlines()


@pytest.mark.parametrize("processor", PROCESSORS, ids=lambda one: one["OPENBLAS_CORETYPE"])
def test_every_processor_gives_the_same_bytes(processor: dict[str, str]) -> None:
    usual = digests()
    assert len(usual) == len(set(usual)) > 50
    assert digests(*processor.items()) == usual


def test_archives_say_nothing_of_where_and_when_they_were_made() -> None:
    for pieces in ([], [b"x" * 100_000], 50 * [bytes(range(256)), b""]):
        archive, data = b"".join(gzipped(pieces)), b"".join(pieces)
        assert archive == b"".join(gzipped([data])) and gzip.decompress(archive) == data
        assert archive[:10] == b"\x1f\x8b\x08" + bytes(5) + b"\x02\xff"
    assert molviz.draw(ROOT / "samples" / "caffeine.xyz").to("svgz")[:10] == next(gzipped([]))
