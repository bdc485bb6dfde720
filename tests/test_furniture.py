"""What stands beside the molecule: labels apart and uncrossed, round lengths, legends in columns, room for all."""

import re
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from molviz.errors import InputError
from molviz.picture.furniture import ROUND, Box, Furnished, Furniture, Label, Ramp, Swatches, furnish
from molviz.picture.furniture.label_places import Slots, label_places, outline_around
from molviz.picture.furniture.labels import BESIDE, HEIGHT
from molviz.picture.furniture.legend import MOST, ROW
from molviz.picture.furniture.metrics import ELLIPSIS, shortened, text_width, wrapped
from molviz.picture.furniture.scale_bar import length_text, round_length
from molviz.picture.page import Margins, Page, place
from molviz.picture.picture import FillLayer, StrokeLayer, Text, TextLayer

SIZE = np.array([40.0, HEIGHT])
LOW, HIGH = np.array([-10.0, -8.0]), np.array([10.0, 8.0])
DISC = np.array([[0.0, 0.0, 8.0]])


def cloud(count: int, seed: int, flat: float = 1.0) -> np.ndarray:
    """Discs x y r, in points."""
    random = np.random.default_rng(seed)
    return np.column_stack([random.normal(0, 70, (count, 2)) * [1, flat], random.uniform(8, 14, count)])


def crossings(start: np.ndarray, end: np.ndarray) -> int:
    """How many pairs of segments cross, one pair at a time by signs of determinants."""

    def side(p: np.ndarray, q: np.ndarray, r: np.ndarray) -> float:
        return float(np.linalg.det(np.array([q - p, r - p])))

    count = 0
    for i in range(len(start)):
        for j in range(i):
            a, b, c, d = start[i], end[i], start[j], end[j]
            count += side(a, b, c) * side(a, b, d) < -1e-6 and side(c, d, a) * side(c, d, b) < -1e-6
    return count


def overlaps(boxes: np.ndarray) -> int:
    """How many pairs of boxes have a common inner point."""
    low = np.maximum(boxes[:, None, :2], boxes[None, :, :2])
    high = np.minimum(boxes[:, None, 2:], boxes[None, :, 2:])
    return int((np.triu((high - low).min(axis=2), 1) > 1e-9).sum())


def struck(start: np.ndarray, end: np.ndarray, boxes: np.ndarray) -> int:
    """How many texts, boxes without what is kept free before them, a leader runs through at one of 500 points."""
    along = start + (end - start) * np.linspace(0, 1, 500)[:, None, None]
    inner = boxes + [BESIDE, 1.0, -BESIDE, -1.0]
    inside = (along[:, :, None] > inner[:, :2]) & (along[:, :, None] < inner[:, 2:])
    return int(inside.all(axis=3).any(axis=0).sum())


def assert_tidy(anchor: np.ndarray, slots: Slots, discs: np.ndarray) -> None:
    boxes = slots.boxes(SIZE)
    assert crossings(anchor, slots.end) == overlaps(boxes) == struck(anchor, slots.end, boxes) == 0
    nearest = np.clip(discs[:, None, :2], boxes[:, :2], boxes[:, 2:])
    assert (np.hypot(*(nearest - discs[:, None, :2]).transpose(2, 0, 1)) > discs[:, 2:]).all()


@pytest.mark.parametrize("count", [1, 2, 20, 60, 200])
@pytest.mark.parametrize("flat", [1.0, 0.1])
def test_labels_of_atoms_anywhere_in_a_molecule_are_apart_and_their_leaders_uncrossed(count: int, flat: float) -> None:
    discs = cloud(400, count, flat)
    anchor = discs[np.random.default_rng(count).choice(400, count, replace=False), :2]
    assert_tidy(anchor, label_places(anchor, SIZE, discs), discs)


@given(st.lists(st.integers(0, 359), min_size=1, max_size=60, unique=True))
def test_leaders_of_anchors_on_a_circle_do_not_cross(degrees: list[int]) -> None:
    turns = np.radians(degrees)
    anchor = 100 * np.column_stack([np.cos(turns), np.sin(turns)])
    discs = np.array([[0.0, 0.0, 110.0]])
    assert_tidy(anchor, label_places(anchor, SIZE, discs), discs)


def test_labels_of_one_point_without_a_molecule_find_places() -> None:
    anchor = np.zeros((30, 2))
    boxes = label_places(anchor, SIZE, np.empty((0, 3))).boxes(SIZE)
    assert overlaps(boxes) == 0


def test_a_few_labels_are_as_near_as_their_slots_allow() -> None:
    anchor = np.array([[0.0, 90.0], [90.0, 0.0], [-90.0, 0.0]])
    slots = label_places(anchor, SIZE, np.array([[0.0, 0.0, 100.0]]))
    assert (np.hypot(*(slots.end - anchor).T) < [15 + SIZE[0], 15 + HEIGHT, 15 + HEIGHT]).all()


def test_the_outline_holds_every_disc_and_touches_some() -> None:
    discs = cloud(50, 3)
    corners = outline_around(discs, 5.0)
    side = np.roll(corners, -1, axis=0) - corners
    normal = np.column_stack([side[:, 1], -side[:, 0]]) / np.hypot(*side.T)[:, None]
    gap = ((corners[:, None] - discs[:, :2]) * normal[:, None]).sum(axis=2) - discs[:, 2]
    assert gap.min(axis=1) == pytest.approx(5.0, abs=1e-6)


def furnished(furniture: Furniture, page: Page | None = None) -> Furnished:
    return furnish(page or Page(), LOW, HIGH, 0.5, furniture)


def drawing(found: Furnished) -> Box:
    low, high = (found.placement.scale * corner + found.placement.shift for corner in (LOW, HIGH))
    return Box(*low.tolist(), *high.tolist())


EVERYTHING = Furniture(
    title="Crambin",
    scale_bar=ROUND,
    legend=Swatches([(f"chain {k}", [(k, 0, 0)]) for k in range(40)], "chains"),
    labels=[Label(8 * np.cos(t), 8 * np.sin(t), f"Cα {t:.0f}") for t in range(50)],
    discs=DISC,
)


@pytest.mark.parametrize("page", [Page(), Page("a4"), Page("letter", margin=20), Page(width=120), Page(scale=3)])
def test_everything_is_on_the_page_and_nothing_on_anything_else(page: Page) -> None:
    found = furnished(EVERYTHING, page)
    assert found.box is not None
    x0, y0, x1, y1 = found.box
    assert min(x0, y0) >= 0 and x1 <= found.placement.width and y1 <= found.placement.height
    names = [layer.name for layer in found.layers]
    expected = ["leader halos", "leaders", "labels", "legend", "legend text", "scale bar", "scale bar text", "title"]
    assert names == expected
    boxes = [box_of_text(text) for layer in found.layers if isinstance(layer, TextLayer) for text in layer.texts]
    assert overlaps(np.array(boxes)) == 0 and len(boxes) == 50 + 41 + 1 + 1
    assert (np.array(boxes)[:, :2] >= 0).all() and (np.array(boxes)[:, 2] <= found.placement.width).all()


def box_of_text(text: Text) -> Box:
    width = text_width(text.text, text.size)
    x = text.x - {"start": 0.0, "middle": 0.5, "end": 1.0}[text.anchor] * width
    return Box(x, text.y, x + width, text.y + 0.7 * text.size)


def test_a_page_smaller_than_its_furniture_is_told() -> None:
    many = [Label(0.0, 0.0, f"label {k}") for k in range(400)]
    with pytest.raises(InputError, match="no room"):
        furnished(Furniture(labels=many), Page("a4"))


def test_without_furniture_nothing_changes() -> None:
    found, plain = furnished(Furniture()), place(Page(), LOW, HIGH, 0.5)
    assert found.layers == [] and found.box is None and found.free == Margins()
    assert found.placement.shift.tolist() == plain.shift.tolist() and found.placement.width == plain.width


def test_pictures_of_a_set_are_framed_alike() -> None:
    wide = furnished(EVERYTHING)
    plain = furnish(Page(), LOW, HIGH, 0.5, Furniture(title="Crambin"), wide.free)
    assert drawing(plain) == drawing(wide) and plain.placement.height == wide.placement.height


def test_the_layout_is_the_same_every_time() -> None:
    assert repr(furnished(EVERYTHING)) == repr(furnished(EVERYTHING))


@pytest.mark.parametrize(
    ("length", "rounded", "text"),
    [(0.9, 1.0, "1 Å"), (3.5, 5.0, "5 Å"), (14.0, 10.0, "10 Å"), (75.0, 100.0, "10 nm"), (33.0, 50.0, "50 Å")],
)
def test_scale_bars_are_round_and_told_in_nanometres_from_ten_on(length: float, rounded: float, text: str) -> None:
    assert round_length(length) == pytest.approx(rounded) and length_text(round_length(length)) == text


@given(st.floats(1e-3, 1e6))
def test_round_lengths_are_one_two_or_five_times_a_power_of_ten_and_near(length: float) -> None:
    rounded = round_length(length)
    assert re.fullmatch(r"[125]\.0+e[+-]\d+", f"{rounded:.6e}") and 0.6 < rounded / length < 1.6


def test_the_bar_is_as_long_as_it_says() -> None:
    found = furnished(Furniture(scale_bar=7.0))
    (bar,) = (layer for layer in found.layers if isinstance(layer, StrokeLayer))
    assert 2 * bar.paths.arcs.u[0, 0] == pytest.approx(7.0 * found.placement.scale)
    assert found.box is not None and found.box.y1 < drawing(found).y0


def test_a_bar_longer_than_the_drawing_stays_on_the_page() -> None:
    found = furnished(Furniture(scale_bar=100.0))
    assert found.box is not None and found.box.x0 >= 0 and found.box.x1 <= found.placement.width


def test_swatches_stand_in_columns_no_taller_than_the_drawing() -> None:
    found = furnished(Furniture(legend=Swatches([(f"n{k}", [(k, k, k)]) for k in range(70)])))
    (fills,) = (layer for layer in found.layers if isinstance(layer, FillLayer))
    corner = fills.paths.arcs.c.reshape(-1, 4, 2).min(axis=1)
    columns = np.unique(np.round(corner[:, 0], 6), return_counts=True)[1]
    height = drawing(found).y1 - drawing(found).y0
    assert columns.max() * ROW <= height < (columns.max() + 2) * ROW * len(columns)
    assert columns.sum() == 70 and columns[:-1].min() == columns.max() and fills.paint[5] == (5, 5, 5)


def test_long_names_are_cut_and_too_many_are_counted() -> None:
    found = furnished(Furniture(legend=Swatches([("W" * 300, [(1, 2, 3)])] * (MOST + 7))))
    (texts,) = (layer.texts for layer in found.layers if isinstance(layer, TextLayer))
    assert len(texts) == MOST + 1 and texts[-1].text == "and 7 more" and texts[0].text.endswith(ELLIPSIS)


def test_a_ramp_names_least_middle_and_greatest_in_order() -> None:
    found = furnished(Furniture(legend=Ramp("B", 2.0, 6.0, [(0, 0, 255), (255, 0, 0)])))
    fills, texts = found.layers
    assert [text.text for text in texts.texts] == ["2", "4", "6", "B"]
    assert all(a.y < b.y for a, b in pairwise(texts.texts))
    assert fills.paint[0] == (0, 0, 255) and fills.paint[-1] == (255, 0, 0)
    height = fills.paths.arcs.c[:, 1]
    assert height[:4].mean() < height[-4:].mean()


def test_empty_legends_and_titles_take_no_room_to_speak_of() -> None:
    found = furnished(Furniture(title=" \n", legend=Swatches([])))
    assert not any(layer.texts for layer in found.layers if isinstance(layer, TextLayer))


@given(st.text(max_size=60), st.floats(20, 200))
def test_texts_are_cut_and_broken_to_their_width(text: str, width: float) -> None:
    assert text_width(shortened(text, 8, width), 8) <= width
    lines = wrapped(text, 8, width, 3)
    assert len(lines) <= 3 and all(text_width(line, 8) <= width for line in lines)
    if text_width(" ".join(text.split()), 8) <= width:
        assert lines == [" ".join(text.split())] * bool(text.split())
