"""The display list of small scenes: layers, shapes, loops and arcs, how wide, in which colours, under which names."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from molviz.curves import PlaneArcs
from molviz.picture.chains import linked, merged_arcs
from molviz.picture.coloring import by_index, on_ramp
from molviz.picture.colors import parse_color
from molviz.picture.page import Page, parse_length
from molviz.picture.palette import load_palette
from molviz.picture.picture import SPREAD, FillLayer, Picture, StackedLayer, StrokeLayer, TextLayer
from molviz.picture.style import load_style
from molviz.pipeline.views import ViewOptions
from tests.oracle import random_spheres
from tests.pages import balls, named, page, residues, shapes

STYLE = load_style("flat")
SCALE = 40.0  # points per ångström of drawings that are small enough
ONE = balls((0, 0, 0, 1))
FUSED = balls((-0.5, 0, 0, 1), (0.5, 0, 0, 1))
BEFORE = balls((0, 0, 5, 1), (0, 0, 0, 2))
BESIDE = balls((0, 0, 5, 1), (1.5, 0, 0, 1))
THREE = balls((-0.6, 0, 0, 1), (0.6, 0, 0, 1), (0, 1, 0, 1))
GAP = balls((-0.8, 0, 3, 1), (0.8, 0, 7, 1), (0, 0, 0, 1.3))  # the rear ball shows above and below
OVER_CREASE = balls((0, 0, 5, 0.3), (-0.5, 0, 0, 1), (0.5, 0, 0, 1))
MIXED = residues(
    ("B", "CYS", "1", "N", 0.0, 10.0), ("A", "GLY", "1", "C", 2.5, 30.0), ("B", "ALA", "2", "O", 5.0, 50.0),
    ("B", "CYS", "1", "S", 7.5, 20.0), ("A", "GLY", "1", "Fe", 10.0, 40.0),
)  # fmt: skip
LENS = 2 * math.acos(0.5)  # radians of a unit circle inside the one a radius away
HALF = math.acos(0.75) / math.pi  # half turns: of a unit circle inside one 1.5 away, twice this


def turns(layer: FillLayer | StrokeLayer) -> list[list[float]]:
    """Of each loop the sweeps in half turns, without arcs so short that displacing the balls made them."""
    return [[sweep for sweep in loop if abs(sweep) > 1e-2] for shape in shapes(layer) for loop in shape.sweeps()]


def total(layer: StrokeLayer) -> float:
    return float(np.abs(layer.paths.arcs.sweep).sum() / math.pi)


def test_a_ball_is_a_disc_and_a_circle_in_one_turn_each() -> None:
    picture = page(ONE)
    assert [layer.name for layer in picture.layers] == ["atoms", "silhouette"]
    for layer in picture.layers:
        assert [shape.sweeps() for shape in shapes(layer)] == [[[2.0]]]
    assert shapes(picture.layers[0])[0].area() == pytest.approx(math.pi * SCALE**2, rel=1e-3)


def test_a_fused_pair_meets_in_one_crease() -> None:
    layers = named(page(FUSED))
    assert list(layers) == ["atoms", "crease", "outline", "silhouette"]
    assert turns(layers["crease"]) == [[pytest.approx(1, abs=1e-3)]]
    assert total(layers["outline"]) < 0.01  # of the ball that is displaced to the front
    assert [len(loop) for loop in turns(layers["silhouette"])] == [2]  # one closed path
    assert total(layers["silhouette"]) == pytest.approx(2 * (2 - LENS / math.pi), abs=1e-3)
    (left, right) = shapes(layers["atoms"])
    lens = LENS - math.sin(LENS)
    assert left.area() == pytest.approx((math.pi - lens / 2) * SCALE**2, rel=1e-3)
    assert right.area() == pytest.approx(left.area(), rel=1e-3)
    assert len(left.loops) == len(right.loops) == 1


def test_a_ball_before_a_larger_one_leaves_a_ring_with_its_outline_inside() -> None:
    layers = named(page(BEFORE))
    assert list(layers) == ["atoms", "outline", "silhouette"]
    front, ring = shapes(layers["atoms"])
    assert front.sweeps() == [[2.0]] and sorted(ring.sweeps()) == [[-2.0], [2.0]]
    assert ring.area() == pytest.approx(3 * front.area(), rel=1e-3)
    for name, radius in (("outline", 1), ("silhouette", 2)):
        assert turns(layers[name]) == [[2.0]]
        assert layers[name].paths.arcs.major() == pytest.approx([radius * SCALE], rel=1e-3)


def test_outlines_lie_before_another_ball_and_silhouettes_before_nothing() -> None:
    layers = named(page(BESIDE))
    assert turns(layers["outline"]) == [[pytest.approx(2 * HALF, abs=1e-3)]]
    assert turns(layers["silhouette"]) == [[pytest.approx(2 - 2 * HALF, abs=1e-3)] * 2]
    middle = layers["outline"].paths.arcs
    (x, _) = middle.at(middle.start + middle.sweep / 2)[0]
    centre = layers["silhouette"].paths.arcs.c[:, 0]
    assert x == pytest.approx(centre.min() + SCALE, abs=0.1)  # it is the front ball's, towards the other
    rear = [pytest.approx(sweep, abs=1e-3) for sweep in (-2 * HALF, 2 - 2 * HALF)]
    assert turns(layers["atoms"]) == [[2.0], rear]


def test_three_fused_balls_meet_in_three_creases_and_a_point() -> None:
    layers = named(page(THREE))
    assert [len(loop) for loop in turns(layers["crease"])] == [1, 1, 1]
    assert [len(loop) for loop in turns(layers["silhouette"])] == [3]
    assert total(layers["outline"]) < 0.01
    assert [len(loop) for loop in turns(layers["atoms"])] == [3, 3, 3]  # one loop each
    ends = np.concatenate([curves.at(t) for curves in [layers["crease"].paths.arcs]
                           for t in (curves.start, curves.start + curves.sweep)])  # fmt: skip
    near = np.linalg.norm(ends[:, None] - ends, axis=2) < 0.1
    assert sorted(near.sum(axis=1).tolist()) == [1, 1, 1, 3, 3, 3]


def test_a_ball_behind_a_gap_is_one_shape_of_two_loops() -> None:
    layers = named(page(GAP))
    assert list(layers) == ["atoms", "outline", "silhouette"]
    assert [len(shape.loops) for shape in shapes(layers["atoms"])] == [1, 1, 2]
    areas = np.array([1, 1, 1.3]) ** 2 * math.pi * SCALE**2
    shown = np.array([shape.area() for shape in shapes(layers["atoms"])])
    assert shown[1] == pytest.approx(areas[1], rel=1e-3)  # the nearest
    assert (shown[[0, 2]] < 0.95 * areas[[0, 2]]).all() and (shown > 0).all()
    assert [len(loop) for loop in turns(layers["silhouette"])] == [4]
    assert [len(loop) for loop in turns(layers["outline"])] == [1, 1, 1]  # the nearest ball's, two of the next


@pytest.mark.parametrize("method", ["visible", "painter"])
def test_arcs_of_one_circle_are_merged_into_one(method: str) -> None:
    """The small ball's outline crosses the crease behind it twice, and yet it is one turn."""
    picture = page(OVER_CREASE, method)
    if method == "visible":
        layers = named(picture)
        assert [loop for loop in turns(layers["outline"]) if loop] == [[2.0]]
        assert shapes(layers["atoms"])[0].sweeps() == [[2.0]]
        assert [len(loop) for loop in turns(layers["crease"])] == [1, 1]
    else:
        (stack,) = picture.layers
        assert [shape.sweeps() for shape in shapes(stack.fills)][-1] == [[2.0]]
        assert [shape.sweeps() for shape in shapes(stack.strokes[1])][-1] == [[2.0]]


def test_an_outline_past_a_junction_is_one_arc() -> None:
    """The front ball's outline lies before the second, then before the third: a junction that it passes."""
    arcs = named(page(balls((0, 0, 9, 1), (1.5, 0, 5, 1), (0.75, 0.9, 0, 0.6))))["outline"].paths.arcs
    assert len({tuple(row) for row in np.round(arcs.c, 3).tolist()}) == len(arcs.c) == 2  # each ball's is one arc


def test_a_line_that_leaves_a_circle_and_comes_back_to_it_begins_at_its_loose_end() -> None:
    """Of four arcs, in two pieces on circle 7, one on 8 and one on 7 again, only the first two become one."""
    origin, curve = np.array([3, 0, 2, 1]), np.array([7, 7, 8, 7])  # from 0 by 1, 2 and 3 to 4
    turn = np.array([0.5, 0.25, 1.0, 0.75])
    arcs = PlaneArcs(np.zeros((4, 2)), np.tile([1.0, 0], (4, 1)), np.tile([0, 1.0], (4, 1)), np.arange(4.0), turn)
    chains = linked(origin, origin + 1, curve, np.arange(4))
    assert chains.closed.tolist() == [False] and (chains.half_edge >> 1).tolist() in ([1, 3, 2, 0], [0, 2, 3, 1])
    line, start = merged_arcs(arcs, curve, chains)
    forwards = chains.half_edge[0] == 2
    assert start.tolist() == [0, 3] and line.sweep.tolist() == ([1, 1, 0.5] if forwards else [-0.5, -1, -1])
    assert line.start[0] == (1.0 if forwards else 0.5)


def test_a_closed_line_begins_where_no_arc_is_cut_in_two() -> None:
    """Three arcs around: the first and the last are one arc of circle 7, the second is one of circle 8."""
    origin, target, curve = np.arange(3), np.array([1, 2, 0]), np.array([7, 8, 7])
    turn = np.array([0.5, 1.0, 0.25])
    arcs = PlaneArcs(np.zeros((3, 2)), np.tile([1.0, 0], (3, 1)), np.tile([0, 1.0], (3, 1)), np.arange(3.0), turn)
    line, start = merged_arcs(arcs, curve, linked(origin, target, curve, np.arange(3)))
    assert start.tolist() == [0, 2] and sorted(np.abs(line.sweep).tolist()) == [0.75, 1.0]


@given(st.integers(1, 8).flatmap(lambda count: st.permutations(range(count))), st.lists(st.tuples(
    st.booleans(), st.integers(0, 1)), min_size=8, max_size=8), st.booleans(), st.booleans())  # fmt: skip
def test_arcs_that_meet_end_to_end_become_one_chain_in_whatever_order_they_are(
    order: list[int], ways: list[tuple[bool, int]], closed: bool, touched: bool
) -> None:
    """Arc ``order[k]`` lies between places k and k + 1, in either direction; a loose end of another curve may touch."""
    count = len(order)
    back, curve = np.array(ways[:count]).T
    first, last = np.empty(count, dtype=np.int64), np.empty(count, dtype=np.int64)
    first[order], last[order] = np.arange(count), (np.arange(count) + 1) % (count if closed else count + 1)
    origin, target = np.where(back, last, first), np.where(back, first, last)
    lines = np.zeros(count, dtype=np.int64) if touched else curve
    if touched:  # by an arc of another curve that ends in the middle of the path
        origin, target, lines = np.append(origin, 99), np.append(target, 1), np.append(lines, 5)
    chains = linked(origin, target, lines, np.arange(len(origin)))
    lone = touched and (count > 1 or closed)
    assert len(chains.closed) == 1 + lone and sorted(chains.half_edge >> 1) == list(range(len(origin)))
    assert chains.closed.sum() == closed
    begin = np.where(chains.half_edge & 1, target[chains.half_edge >> 1], origin[chains.half_edge >> 1])
    end = np.where(chains.half_edge & 1, origin[chains.half_edge >> 1], target[chains.half_edge >> 1])
    for a, b, ring in zip(chains.start[:-1], chains.start[1:], chains.closed, strict=True):
        assert end[a : b - 1].tolist() == begin[a + 1 : b].tolist() and (not ring or end[b - 1] == begin[a])


def test_displaced_copies_of_one_outline_are_not_drawn() -> None:
    """A crescent of two equal balls is 2 d / π wide in the mean when one is d beside the other."""
    for beside, shown in ((0.0, 1), (0.004, 1), (0.009, 2), (0.05, 2)):
        layers = named(page(balls((0, 0, 9, 1), (beside, 0, 0, 1))))
        assert len(shapes(layers["atoms"])) == shown, beside
        drawn = sum(total(layer) for layer in layers.values() if isinstance(layer, StrokeLayer))
        assert drawn == pytest.approx(2 if shown == 1 else 3, abs=0.02), beside


@pytest.mark.parametrize(("outline", "crease"), [(None, None), (2.0, 0.25), (0.0, None), (None, 0.0), (0.0, 0.0)])
@pytest.mark.parametrize("method", ["visible", "painter"])
def test_widths_are_the_styles_unless_asked_for_and_nought_draws_nothing(
    method: str, outline: float | None, crease: float | None
) -> None:
    widths = {"outline": 0.85 if outline is None else outline, "crease": 0.55 if crease is None else crease}
    if method == "visible":
        widths["silhouette"] = widths["outline"]
    (*others,) = page(FUSED, method, outline=outline, crease=crease).layers
    strokes = others[1:] if method == "visible" else others[0].strokes
    assert {layer.name: layer.width for layer in strokes} == {name: width for name, width in widths.items() if width}
    assert all(layer.color == STYLE.lines.color == (0x1A, 0x1A, 0x1A) for layer in strokes)


def test_lines_of_small_drawings_are_thinner() -> None:
    layers = named(page(FUSED, page=Page(scale=2.0)))
    assert layers["silhouette"].width == pytest.approx(0.3) and layers["crease"].width == pytest.approx(0.2)
    layers = named(page(FUSED, style="print"))
    assert layers["crease"].width == 0.5 and layers["crease"].color == (0, 0, 0)


def test_colours_of_names_are_the_styles() -> None:
    """Shapes stand by chain and residue in order of appearance: rows 0, 3, 2 of chain B, then 1, 4 of A."""
    look, elements = STYLE.colors, ["N", "S", "O", "C", "Fe"]
    tide = load_palette("tide")
    expected = {
        "element": [look.element[symbol] for symbol in elements],
        "residue": [look.residue[name] for name in ("CYS", "CYS", "ALA", "GLY", "GLY")],
        "chain": [tide.chain[0]] * 3 + [tide.chain[1]] * 2,
        "index": [(0, 0, 1), (0, 0, 4), (0, 0, 3), (0, 0, 2), (0, 0, 5)],
    }
    for scheme, colors in expected.items():
        fills = page(MIXED, color_by=scheme).layers[0]
        assert list(fills.paint) == colors, scheme
        assert fills.spread == (0.0 if scheme == "index" else SPREAD)


def test_numbers_are_coloured_between_the_least_and_the_greatest() -> None:
    fills = page(MIXED, color_by="bfactor").layers[0]
    assert list(fills.paint) == [STYLE.colors.ramp[k] for k in (0, 1, 4, 2, 3)]
    inner = page(balls((-1.8, 0, 0, 1), (0, 0, 0, 1), (1.8, 0, 0, 1)), color_by="exposure").layers[0]
    assert list(inner.paint)[1] == STYLE.colors.ramp[0] and STYLE.colors.ramp[-1] in inner.paint


def test_an_unknown_element_and_a_missing_number_have_the_unknown_colour() -> None:
    assert page(ONE).layers[0].paint == [STYLE.colors.unknown]
    assert page(ONE, color_by="bfactor").layers[0].paint == [STYLE.colors.unknown]


def test_numbers_that_are_known_are_coloured_among_those_that_are_known() -> None:
    ramp, unknown = STYLE.colors.ramp, STYLE.colors.unknown
    middle = ramp[len(ramp) // 2]
    assert len(ramp) % 2
    colors = on_ramp(np.array([20.0, np.nan, 10.0, 15.0]), ramp, unknown)
    assert colors == [ramp[-1], unknown, ramp[0], middle]
    assert on_ramp(np.full(4, 7.0), ramp, unknown) == [ramp[0]] * 4


def test_the_colour_of_an_index_is_that_number_in_base_256() -> None:
    count = 66_000
    colors = by_index(np.arange(count))
    assert np.array_equal(colors @ [256**2, 256, 1], np.arange(1, count + 1)) and colors.max() == 255


def test_colours_are_names_or_digits() -> None:
    names = {"white": (255, 255, 255), "BLACK": (0, 0, 0), "grey": (128, 128, 128), "gray": (128, 128, 128)}
    for text, color in {**names, "#0af": (0, 170, 255), "#12aBf0": (18, 171, 240)}.items():
        assert parse_color(text) == color, text
    for text in ("0af", "12abf0", "#", "#0", "#0afa", "#12abf", "#12abf0f", "#12abg0", "pinkish", ""):
        with pytest.raises(ValueError):
            parse_color(text)


def test_shapes_are_grouped_by_chain_and_residue_in_order_of_appearance() -> None:
    marks = page(MIXED).layers[0].mark
    assert [mark.id for mark in marks] == ["B_CYS_1_N", "B_CYS_1_S", "B_ALA_2_O", "A_GLY_1_C", "A_GLY_1_Fe"]
    assert [mark.title for mark in marks] == ["CYS 1 N", "CYS 1 S", "ALA 2 O", "GLY 1 C", "GLY 1 Fe"]
    assert [mark.classes for mark in marks] == [("N",), ("S",), ("O",), ("C",), ("Fe",)]
    chain_a, chain_b = ("A", "chain chain-A"), ("B", "chain chain-B")
    cysteine, alanine = (chain_b, ("CYS 1", "residue CYS")), (chain_b, ("ALA 2", "residue ALA"))
    glycine = (chain_a, ("GLY 1", "residue GLY"))
    assert [mark.groups for mark in marks] == [cysteine, cysteine, alanine, glycine, glycine]


def test_residues_of_a_chain_are_in_the_order_of_the_file_whatever_other_chains_have() -> None:
    atoms = [("A", "GLY", "9", "C", 0.0, 0.0), ("B", "SER", "1", "C", 9.0, 0.0), ("B", "GLY", "9", "C", 18.0, 0.0)]
    assert [mark.id for mark in page(residues(*atoms)).layers[0].mark] == ["A_GLY_9_C", "B_SER_1_C", "B_GLY_9_C"]


def test_painted_atoms_carry_their_residues_as_classes() -> None:
    (stack,) = page(MIXED, "painter").layers
    marks = {mark.id: mark for mark in stack.fills.mark}
    assert marks["B_CYS_1_S"].classes == ("S", "CYS", "chain-B")
    assert marks["A_GLY_1_C"].classes == ("C", "GLY", "chain-A")
    assert all(mark.groups == () for mark in marks.values()) and len(marks) == 5


def test_balls_are_called_by_their_numbers() -> None:
    marks = page(BEFORE).layers[0].mark
    assert [(mark.id, mark.title, mark.classes, mark.groups) for mark in marks] == [
        ("X1", "X 1", ("X",), ()), ("X2", "X 2", ("X",), ()),
    ]  # fmt: skip


def test_a_chain_without_a_name_is_a_dash() -> None:
    (mark,) = page(residues((" ", "HOH", "7", "O", 0.0, 1.0))).layers[0].mark
    assert mark.groups[0][0] == "-" and mark.groups[1] == ("HOH 7", "residue HOH")
    (stack,) = page(residues((" ", "HOH", "7", "O", 0.0, 1.0)), "painter").layers
    assert stack.fills.mark[0].classes == ("O", "HOH", "chain")


def test_a_page_is_a_whole_number_of_points_and_the_box_holds_the_lines() -> None:
    """40 points per Å, 4 points of margin and half a line: 2 · 40 + 2 (4 + 0.425) = 88.85."""
    picture = page(ONE)
    assert (picture.width, picture.height) == (89, 89)
    assert picture.box == pytest.approx((44.5 - 40.425, 44.5 - 40.425, 44.5 + 40.425, 44.5 + 40.425))
    arc = named(picture)["silhouette"].paths.arcs
    assert arc.c[0] == pytest.approx([44.5, 44.5], abs=0.01) and arc.major() == pytest.approx([40], rel=1e-3)


@pytest.mark.parametrize("method", ["visible", "painter"])
@pytest.mark.parametrize(("outline", "crease", "half"), [(3.0, 0.0, 1.5), (0.0, 3.0, 1.5), (0.0, 0.0, SPREAD / 2)])
def test_the_box_holds_half_the_widest_line_around_all_images(
    method: str, outline: float, crease: float, half: float
) -> None:
    """3 Å wide and 2 Å high at 10 points per Å; nothing is wider than the box, and the page is margin and box."""
    picture = page(FUSED, method, page=Page(scale=10.0, margin=2.0), outline=outline, crease=crease)
    x0, y0, x1, y1 = picture.box
    assert (x1 - x0, y1 - y0) == pytest.approx((30 + 2 * half, 20 + 2 * half))
    assert (x0 + x1, y0 + y1) == pytest.approx((picture.width, picture.height))
    line = max(outline, crease)
    assert (picture.width, picture.height) == (math.ceil(34 + line), math.ceil(24 + line))


def test_the_box_of_a_drawing_without_lines_ends_where_the_fills_do() -> None:
    """Fills are as wide as half the stroke in their own colour, a mask is not."""
    for scheme, wide in (("element", 80 + SPREAD), ("index", 80.0)):
        x0, y0, x1, y1 = page(ONE, color_by=scheme, outline=0.0, crease=0.0).box
        assert (x1 - x0, y1 - y0) == pytest.approx((wide, wide))


@pytest.mark.parametrize(
    ("wanted", "scale", "size"),
    [
        (Page(scale=10.0), 10, (29, 29)),
        (Page(width=100.0), 50, (109, 109)),
        (Page(scale=10.0, margin=0.0), 10, (21, 21)),
        (Page("a4"), (210 * 72 / 25.4 - 2 * 36.425) / 2, (210 * 72 / 25.4, 297 * 72 / 25.4)),
        (Page("letter", margin=10.0, scale=5.0), 5, (612, 792)),
        (Page("letter"), (612 - 2 * 36.425) / 2, (612, 792)),
        (Page(), SCALE, (89, 89)),
    ],
)
def test_a_drawing_lies_in_the_middle_of_its_page(wanted: Page, scale: float, size: tuple[float, float]) -> None:
    picture = page(ONE, page=wanted)
    arc = named(picture)["silhouette"].paths.arcs
    assert (picture.width, picture.height) == pytest.approx(size)
    assert arc.c[0] == pytest.approx(np.array(size) / 2, abs=0.01) and arc.major()[0] == pytest.approx(scale, rel=1e-3)


def test_a_large_drawing_is_fourteen_centimetres_long() -> None:
    picture = page(balls((0, -9, 0, 1), (0, 9, 0, 1)), page=Page(margin=0.0), outline=0.0)
    assert (picture.width, picture.height) == (math.ceil(14 / 2.54 * 7.2), math.ceil(14 / 2.54 * 72))


@pytest.mark.parametrize(
    ("text", "points"),
    [("2.54cm", 72), ("25.4mm", 72), ("1in", 72), ("96px", 72), ("72pt", 72), ("72", 72), (".5in", 36), ("7", 7),
     ("999999", 999_999)],
)  # fmt: skip
def test_lengths_are_in_points(text: str, points: float) -> None:
    assert parse_length(text) == pytest.approx(points, rel=1e-12)


@pytest.mark.parametrize("text", ["", "cm", "x", "3 feet", "-1", "0", "0mm", "nan", "inf", "1e6", "40e3cm"])
def test_what_is_no_length_of_a_page_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="is not a length"):
        parse_length(text)


def test_a_page_is_as_large_as_all_balls_hidden_ones_too() -> None:
    """So a turntable does not jump: the box is that of all images."""
    apart = page(balls((0, 0, 0, 2), (0.5, 0, -9, 2.2), (0, 0, -20, 2.1)), page=Page(scale=10.0))
    assert apart.width == math.ceil(10 * (2.7 + 2.1) + 8.85) and apart.height == math.ceil(44 + 8.85)


def test_background_and_title_are_handed_on() -> None:
    picture = page(ONE, background=(1, 2, 3))
    assert picture.background == (1, 2, 3) and picture.title == "balls" and page(ONE).background is None


def test_without_fill_the_map_has_lines_only_and_the_painter_paints_the_background() -> None:
    assert list(named(page(FUSED, fill="none"))) == ["crease", "outline", "silhouette"]
    for background, color in ((None, (255, 255, 255)), ((9, 8, 7), (9, 8, 7))):
        (stack,) = page(FUSED, "painter", fill="none", background=background).layers
        assert stack.fills.paint == [color] * 2


def test_a_legend_stands_beside_the_drawing() -> None:
    plain, picture = page(MIXED, color_by="bfactor"), page(MIXED, color_by="bfactor", legend=True)
    assert [layer.name for layer in picture.layers] == [*named(plain), "legend", "legend text"]
    bar, text = picture.layers[-2:]
    assert isinstance(bar, FillLayer) and isinstance(text, TextLayer)
    assert picture.width > plain.width + 40 and picture.box[2] > plain.box[2] + 40
    assert bar.paint[0] == STYLE.colors.ramp[0] and bar.paint[-1] == STYLE.colors.ramp[-1]
    boxes = shapes(bar)
    assert len(boxes) == len(bar.paint) == len({mark.id for mark in bar.mark}) and all(b.area() > 0 for b in boxes)
    assert len({round(b.area(), 6) for b in boxes}) == 1
    assert [line.text for line in text.texts] == ["10", "30", "50", "B factor, Å²"]
    corner = bar.paths.arcs.c
    assert corner[:, 0].min() > plain.box[2] and text.texts[0].x > corner[:, 0].max()
    low, middle, high = (line.y for line in text.texts[:3])
    assert middle == pytest.approx((low + high) / 2) and high > middle and text.color == STYLE.lines.color


def test_the_painter_stacks_every_ball_with_its_own_lines_from_back_to_front() -> None:
    (stack,) = page(balls((0, 0, 5, 1), (0, 0, 0, 1), (1, 0, 0.5, 1)), "painter", color_by="index").layers
    assert isinstance(stack, StackedLayer) and stack.name == "atoms"
    assert [layer.name for layer in stack.strokes] == ["crease", "outline"]
    assert [mark.id for mark in stack.fills.mark] == ["X2", "X3", "X1"] and stack.fills.paint[-1] == (0, 0, 1)
    fills, creases, outlines = (shapes(layer) for layer in (stack.fills, *stack.strokes))
    assert [len(rows) for rows in (fills, creases, outlines)] == [3, 3, 3]
    assert [[len(loop.sweep) for loop in shape.loops] for shape in creases] == [[1], [1], []]
    assert [[len(loop.sweep) for loop in shape.loops] for shape in outlines] == [[1], [1], [1]]
    assert fills[2].area() == pytest.approx(math.pi * SCALE**2, rel=1e-3)
    assert outlines[2].sweeps() == fills[2].sweeps() == [[2.0]]


def test_from_an_eye_nearby_a_ball_is_an_ellipse_on_the_page() -> None:
    """A ball of radius r at height z before an eye at d on the axis: r d / √((d − z)² − r²)."""
    eye = ViewOptions("file", (), 10.0)
    arc = named(page(ONE, eye=eye))["silhouette"].paths.arcs
    assert arc.sweep == pytest.approx([2 * math.pi]) and arc.major()[0] == pytest.approx(40 * 10 / 99**0.5, rel=1e-3)
    picture = page(balls((-4, 0, 0, 1), (4, 0, 0, 1)), eye=eye, page=Page(scale=SCALE))
    arc = named(picture)["silhouette"].paths.arcs
    edge = np.array([math.tan(math.atan(0.4) + sign * math.asin(1 / math.hypot(10, 4))) for sign in (-1, 1)]) * 10
    assert np.ptp(edge) / 2 * SCALE == pytest.approx(arc.half_extent()[:, 0], rel=1e-3)
    assert (arc.half_extent()[:, 0] > 1.05 * arc.half_extent()[:, 1]).all()


def joints(loop: PlaneArcs) -> tuple[np.ndarray, np.ndarray]:
    """Where each arc of a loop ends and where the one after it, or at the end the first, starts."""
    return loop.at(loop.start + loop.sweep), np.roll(loop.at(loop.start), -1, axis=0)


def same_circle(loop: PlaneArcs) -> np.ndarray:
    """Which arcs of a loop continue with the next one on their own circle in their own direction."""
    columns = np.column_stack([loop.c, loop.u, loop.v, np.sign(loop.sweep)])
    return (columns == np.roll(columns, -1, axis=0)).all(axis=1)


@pytest.mark.parametrize("method", ["visible", "painter"])
@given(st.integers(0, 10**6), st.integers(2, 25), st.sampled_from([None, 25.0]))
@example(422, 13, 25.0)  # a crease ends in a cusp: the arc beside it is 1e-9 points long, and no whole circle
@settings(max_examples=15)
def test_pens_run_on_and_never_begin_in_the_middle_of_an_arc(
    method: str, seed: int, count: int, distance: float | None
) -> None:
    """Arcs follow each other end to start, those of one circle are one, and whole circles are whole exactly."""
    spheres = random_spheres(seed, count, 5.0, 3.0)
    rows = np.column_stack([spheres.center, spheres.radius]).tolist()
    for top in page(balls(*rows), method, eye=ViewOptions("file", (), distance)).layers:
        for layer in [top.fills, *top.strokes] if isinstance(top, StackedLayer) else [top]:
            for loop in (loop for shape in shapes(layer) for loop in shape.loops):
                end, start = joints(loop)
                gap = np.linalg.norm(end - start, axis=1)
                closed = gap[-1] < 1e-6 < (np.abs(loop.sweep) * loop.major()).sum()
                assert (gap[:-1] < 1e-6).all() and (closed or isinstance(layer, StrokeLayer))
                assert not same_circle(loop)[: len(gap) if closed and len(gap) > 1 else -1].any()
                assert len(gap) > 1 or not closed or abs(loop.sweep[0]) == 2 * math.pi


def signature(picture: Picture) -> list[Any]:
    return [(layer.name, layer.paths.shape_start.tolist(), layer.paths.loop_start.tolist()) for layer in picture.layers]


def test_the_same_balls_elsewhere_and_in_another_unit_are_the_same_picture() -> None:
    """Moved by whole numbers and drawn twice as large at half the scale."""
    rows = [(0, 0, 4, 1), (1.5, 0, 0, 1), (0.5, 1, 0.5, 1.25)]
    one = page(balls(*rows), page=Page(scale=20.0))
    for factor, shift in ((1.0, 8.0), (2.0, 0.0), (1024.0, 0.0)):
        moved = [tuple([factor * (x + shift) for x in row[:3]] + [factor * row[3]]) for row in rows]
        other = page(balls(*moved), page=Page(scale=20.0 / factor), outline=0.85, crease=0.55)
        assert signature(one) == signature(other)
        assert np.allclose(one.layers[-1].paths.arcs.c, other.layers[-1].paths.arcs.c, atol=1e-6)
