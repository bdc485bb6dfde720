"""Balls one a line: whole texts at once and word by word give the same numbers and the same refusals."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from molviz.errors import InputError
from molviz.readers import read, xyzr
from molviz.readers.atoms import coinciding_rows

WORDS = ["1", "-2.5", "+3", "1e3", "4E-2", ".5", "5.", "0", "-0"]
ODD = [*WORDS, "1-2", "1.2.3", "e", ".", "+", "1e", "nan", "inf", "1d2", "1_0", "1e999", "1" + "0" * 510, "#", "\x0b"]
lines = st.lists(st.sampled_from(WORDS), min_size=4, max_size=4) | st.lists(st.sampled_from(ODD), max_size=6)
texts = st.lists(lines.map(" ".join), max_size=4)


def outcome(text: str) -> object:
    try:
        reading = read("t.xyzr", text.encode(), "xyzr")
    except InputError as wrong:
        return str(wrong)
    return reading.models[0].position.tolist(), reading.models[0].radius.tolist(), reading.warnings


@given(texts, st.sampled_from(["\n", "\r\n", "\n\n", " \n\t"]), st.sampled_from(["", "\n", " \n\n"]))
def test_at_once_is_as_word_by_word(rows: list[str], between: str, around: str) -> None:
    text = around + between.join(rows) + around
    at_once = outcome(text)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(xyzr, "_table", lambda data: None)
        assert outcome(text) == at_once


def test_plain_texts_are_read_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(xyzr, "_checked_table", lambda data, source: pytest.fail("word by word"))
    assert outcome("\n1 2 3 1.5\n4 5 6\t1e0 \n") == ([[1, 2, 3], [4, 5, 6]], [1.5, 1.0], ())
    with pytest.raises(InputError, match=r"^t\.xyzr:3: the radius is -1"):
        read("t.xyzr", b"\n1 2 3 1\n4 5 6 -1\n")


@given(st.lists(st.tuples(*[st.sampled_from([0.0, -0.0, 0.1, -1e308, 1e308])] * 3), min_size=1, max_size=9))
def test_coinciding_rows_are_those_met_before(rows: list[tuple[float, ...]]) -> None:
    expected = [k for k, row in enumerate(rows) if row in rows[:k]]
    assert coinciding_rows(np.array(rows, dtype=float).reshape(-1, 3)).tolist() == expected


@pytest.mark.filterwarnings("error")
def test_a_number_beyond_doubles_is_refused_without_a_warning() -> None:
    rows = [f"{k} 0 0 1" for k in range(20)]
    rows[5] = "5 0 5.78626660773e324 1"
    with pytest.raises(InputError, match=r"t\.xyzr:6: z is '5\.78626660773e324'; expected a finite number"):
        read("t.xyzr", "\n".join(rows).encode(), "xyzr")
