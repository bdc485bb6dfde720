"""Numbers as columns of words: the texts that ``number`` writes, in whatever blocks."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from molviz.curves import Paths
from molviz.write import columns, pdf_path, postscript_path, svg_path
from molviz.write.text import number
from tests.write_pictures import paths

whole = st.integers(-(10**13), 10**13) | st.integers(-1200, 1200) | st.sampled_from([0, 10**6, 10**7 - 1, -(10**9)])


@given(st.lists(st.tuples(whole, st.booleans()), min_size=1, max_size=9), st.sampled_from([2, 3]))
def test_words_are_the_texts_of_numbers(rows: list[tuple[int, bool]], places: int) -> None:
    steps, spaced = np.array([step for step, _ in rows]), np.array([space for _, space in rows])
    text, stop = columns.packed(columns.number_words(steps, places, spaced))
    start = [0, *stop.tolist()]
    expected = [" " * space + number(step / 10**places, places) for step, space in rows]
    assert [text[first:last] for first, last in zip(start, start[1:], strict=False)] == expected


def copies(count: int) -> Paths:
    """The tiny picture's paths again and again, moved, with a loop without arcs between them."""
    one = paths()
    arcs, loops = len(one.arcs.start), len(one.loop_start)
    shift = np.repeat(np.arange(count), arcs)[:, None] * [31.37, -2.41]
    many = one.arcs.take(np.tile(np.arange(arcs), count))
    start = (one.loop_start + arcs * np.arange(count)[:, None]).ravel()
    return Paths(many._replace(c=many.c + shift), np.append(start, arcs * count), np.arange(0, loops * count + 1, 4))


@pytest.mark.parametrize("block", [1, 7, 100])
def test_blocks_do_not_show(block: int, monkeypatch: pytest.MonkeyPatch) -> None:
    many = copies(20)
    ways = [
        lambda: svg_path.path_data(many, 100.0),
        lambda: list(postscript_path.shape_texts(many, True)),
        lambda: list(postscript_path.shape_texts(many, False)),
        lambda: list(pdf_path.shape_texts(many)),
    ]
    whole = [way() for way in ways]
    for size in ("BLOCK", "STREAMED"):
        monkeypatch.setattr(columns, size, block)
        assert [way() for way in ways] == whole and all(map(any, whole))


def test_no_loops_have_no_text() -> None:
    none = Paths(paths().arcs.take(np.empty(0, dtype=int)), np.zeros(1, dtype=int), np.zeros(3, dtype=int))
    assert svg_path.path_data(none, 1.0) == list(pdf_path.shape_texts(none)) == ["", ""]
    assert list(postscript_path.shape_texts(none, False)) == ["", ""]
