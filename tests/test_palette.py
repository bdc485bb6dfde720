"""Palettes keep what they promise, and say what is wrong with a user's own."""

import itertools
from pathlib import Path

import numpy as np
import pytest

from molviz.arrays import Floats, Ints
from molviz.errors import InputError
from molviz.picture.oklab import colors_of, lightness, mix, shaded, to_oklab
from molviz.picture.palette import FOLDER, KEYS, PALETTES, TONES, Palette, load_palette
from molviz.picture.tints import tinted
from tests.color_vision import VISIONS, distances

VISION = pytest.mark.parametrize("vision", VISIONS)
NAME = pytest.mark.parametrize("name", PALETTES)


def carbon_and_hetero(palette: Palette) -> tuple[Ints, Ints]:
    return np.array([row.carbon for row in palette.entity]), np.array([row.hetero for row in palette.entity])


def between(gaps: Floats) -> Floats:
    """Those of a square table that lie between different rows."""
    return gaps[~np.eye(len(gaps), dtype=bool)]


@VISION
def test_safe_tells_six_entities_apart(vision: str) -> None:
    """The least distances are those that the comment in safe.toml states."""
    carbon, hetero = carbon_and_hetero(load_palette("safe"))
    assert between(distances(carbon, carbon, vision)).min() >= 0.122
    across = [distances(carbon, carbon, vision), distances(hetero, hetero, vision), distances(carbon, hetero, vision)]
    assert min(between(gaps).min() for gaps in across) >= 0.086
    assert distances(carbon, hetero, vision).diagonal().max() <= 0.039


@VISION
def test_safe_ligands_are_seen_before_every_entity(vision: str) -> None:
    palette = load_palette("safe")
    ligand = np.array([palette.ligand.carbon, palette.ligand.hetero])
    assert distances(ligand, np.concatenate(carbon_and_hetero(palette)), vision).min() >= 0.1


@pytest.mark.parametrize(("name", "least"), [("safe", 8.9), ("grey", 9.7)])
def test_entities_stay_apart_in_grey(name: str, least: float) -> None:
    carbon, hetero = lightness(np.array(carbon_and_hetero(load_palette(name))))
    apart = between(np.abs(carbon[:, None] - carbon))
    across = np.minimum(between(np.abs(carbon[:, None] - hetero)), between(np.abs(hetero[:, None] - hetero)))
    assert apart.min() >= least
    assert np.abs(carbon - hetero).max() < across.min()


@pytest.mark.parametrize(("name", "tints", "least"), [("safe", 2, 6.6), ("safe", 3, 4.5), ("grey", 2, 6.7)])
def test_tints_leave_entities_apart_in_grey(name: str, tints: int, least: float) -> None:
    palette = load_palette(name)
    light = [lightness(tinted(row, palette.tint)[:tints, 0]) for row in palette.entity]
    assert min(np.abs(one[:, None] - other).min() for one, other in itertools.combinations(light, 2)) >= least


@pytest.mark.parametrize("name", ["tide", "clay"])
def test_entities_differ_more_than_the_tones_of_one(name: str) -> None:
    """For six entities in normal vision, and for the first two in any."""
    carbon, hetero = carbon_and_hetero(load_palette(name))
    assert between(distances(carbon, carbon, "normal")).min() >= 0.06
    assert min(distances(carbon[:1], carbon[1:2], vision).min() for vision in VISIONS) >= 0.1


@NAME
def test_chain_colours_are_24_and_different(name: str) -> None:
    palette = load_palette(name)
    assert len(set(palette.chain)) == len(palette.chain) == 24
    least = between(distances(np.array(palette.chain), np.array(palette.chain), "normal")).min()
    assert least >= {"grey": 0.02, "safe": 0.05}.get(name, 0.06)
    assert [palette.repeats(count) for count in (0, 24, 25)] == [False, False, True]


def test_safe_chain_colours_differ_in_any_vision() -> None:
    chain = np.array(load_palette("safe").chain)
    assert min(between(distances(chain, chain, vision)).min() for vision in VISIONS) >= 0.04


@NAME
def test_shade_leaves_room_and_stays_in_its_hue(name: str) -> None:
    """Contact shade −10 L* and deep shade −22 L* exist for all tones, within 30° of the tone's own hue."""
    palette = load_palette(name)
    for row in palette.entity:
        for tone in (row.carbon, row.hetero):
            for drop in (10.0, 22.0):
                deep = shaded(tone, row.shade, drop)
                assert abs(lightness(tone) - lightness(deep) - drop) < 1.0
                before, after = to_oklab(tone)[1:], to_oklab(deep)[1:]
                norm = np.hypot(*before) * np.hypot(*after)
                assert norm < 1e-6 or before @ after / norm > np.cos(np.radians(30))


@NAME
def test_ink_is_seen_on_every_tone_and_ligands_are_dark(name: str) -> None:
    palette = load_palette(name)
    for row in (*palette.entity, palette.ligand):
        assert lightness(row.hetero) - lightness(row.ink) >= 14
    assert lightness(palette.ligand.carbon) < min(lightness(row.hetero) for row in palette.entity)
    haze = mix([row.carbon for row in palette.entity], palette.haze, 0.3)
    assert len(set(colors_of(haze))) == len(palette.entity)
    assert lightness(palette.haze) > 90 > 20 > lightness(palette.ink)


# ---- palettes of users


def written(folder: Path, text: str) -> str:
    path = folder / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return str(path)


def test_partial_palette_differs_only_where_it_says(tmp_path: Path) -> None:
    tide, clay = load_palette("tide"), load_palette("clay")
    mine = load_palette(written(tmp_path, 'base = "clay"\nink = "navy"\n[ligand]\ncarbon = "#f00"\n'))
    assert mine.ink == (0, 0, 128) and mine.ligand.carbon == (255, 0, 0)
    assert (mine.ligand.hetero, mine.entity, mine.chain) == (clay.ligand.hetero, clay.entity, clay.chain)
    assert load_palette(written(tmp_path, "")) == tide


def test_whole_files_are_their_own_palettes(tmp_path: Path) -> None:
    for name in PALETTES:
        assert load_palette(written(tmp_path, (FOLDER / f"{name}.toml").read_text("utf-8"))) == load_palette(name)


ROW = '[[entity]]\ncarbon = "#111"\nhetero = "#222"\nink = "#333"\n'


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ('inc = "navy"', "key 'inc' is unknown; expected base, title, ink, haze"),
        ('base = "tied"', "key 'base': 'tied' is no palette; expected one of clay, grey, safe, tide"),
        ("base = 3", "key 'base': 3 is no palette"),
        ("base = []", "key 'base': .* is no palette"),
        ('ink = "navi"', "key 'ink': 'navi' is not a colour, did you mean 'navy'"),
        ("ink = 7", "key 'ink': 7 is not a colour"),
        ("title = 7", "key 'title': 7 is not a text"),
        ("tint = -1", "key 'tint': -1; expected a number from 0 to 20"),
        ("tint = nan", "key 'tint': nan; expected a number"),
        ("tint = true", "key 'tint': True; expected a number"),
        ('tint = "9"', "key 'tint': '9'; expected a number"),
        ('ligand = "red"', "key 'ligand': 'red'; expected a table of carbon, hetero, ink, shade"),
        ('[ligand]\ncarbn = "red"', "key 'ligand.carbn' is unknown; expected carbon, hetero, ink, shade"),
        ("entity = []", r"key 'entity': \[\]; expected a list"),
        ("entity = 3", "key 'entity': 3; expected a list"),
        ("entity = [1]", r"key 'entity\[1\]': 1; expected a table"),
        (ROW, r"key 'entity\[1\].shade' is missing"),
        (ROW + 'shade = "x"', r"key 'entity\[1\].shade': 'x' is not a colour"),
        (ROW + 'shade = "#444"\n' + ROW + 'shade = "#444"\nmetal = "#555"', r"key 'entity\[2\].metal' is unknown"),
        ("chain = []", r"key 'chain': \[\]; expected a list"),
        ('chain = ["red", "blue", "#f00"]', r"key 'chain\[3\]' is the same colour as chain\[1\]"),
        ('chain = ["red", 3]', r"key 'chain\[2\]': 3 is not a colour"),
        ("ink = ", "not a palette: .*; expected TOML"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, text: str, told: str) -> None:
    path = written(tmp_path, text)
    with pytest.raises(InputError, match=told) as raised:
        load_palette(path)
    assert str(raised.value).startswith(f"{path}: ")


@pytest.mark.parametrize("name", ["", ".", "no/such.toml"])
def test_missing_palettes_are_answered_by_those_there_are(name: str) -> None:
    with pytest.raises(InputError, match="no such palette or file; expected one of clay, grey, safe, tide"):
        load_palette(name)


def test_no_text_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="not a palette"):
        load_palette(str(path))


def test_every_key_is_explained() -> None:
    """In tide.toml a comment stands before each key, those of tables in the comment of the table."""
    lines = (FOLDER / "tide.toml").read_text("utf-8").splitlines()
    for key in KEYS:
        opening = (f"{key} = ", f"[{key}]", f"[[{key}]]")
        first = next(number for number, line in enumerate(lines) if line.startswith(opening))
        assert lines[first - 1].startswith("# ")
    assert all(any(f"{tone}:" in line for line in lines if line.startswith("#")) for tone in TONES)
