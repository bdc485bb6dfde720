"""``molviz surface`` and ``molviz.surface``, and the surfaces and cavities that ``molviz draw`` shows."""

import csv
import io
import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

import molviz
from molviz.cli.main import main
from molviz.errors import InternalError
from molviz.pipeline.surface import check_surface
from tests.test_shells import together, wall

SAMPLES = Path(__file__).parent.parent / "samples"
CAFFEINE, C60 = str(SAMPLES / "caffeine.xyz"), str(SAMPLES / "c60.xyz")


def run(*words: str) -> Result:
    return CliRunner().invoke(main, list(words))


def result(*words: str) -> dict:
    done = run("surface", *words, "--json")
    assert done.exit_code == 0, done.output
    (found,) = json.loads(done.stdout)["results"]
    return dict(found)


def rows(*words: str) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(run("surface", *words, "--csv").stdout)))


def test_the_hollow_of_c60() -> None:
    found = result(C60, "--probe", "0", "--check")
    outer, cavity = found["components"]
    assert (outer["kind"], outer["inside"], cavity["kind"], cavity["inside"]) == ("outer", None, "cavity", 0)
    assert outer["genus"] == cavity["genus"] == found["genus"] == 0 and found["cavities"] == 1
    assert outer["atoms"] == cavity["atoms"] == list(range(60))
    assert found["vertices"] - found["arcs"] + found["faces"] == 4 and found["whole_circles"] == 0
    assert found["smooth"] is None
    whole = molviz.measure(C60)
    assert outer["area"] + cavity["area"] == pytest.approx(whole.area.sum(), rel=1e-6)
    assert outer["volume"] - cavity["volume"] == pytest.approx(whole.volume, rel=1e-6)


def test_the_smooth_surface_by_kind_and_by_atom() -> None:
    found = result(CAFFEINE, "--per", "atom", "--check")
    per, smooth = found["per"], found["smooth"]
    assert len(per) == 24 and found["displaced"] == []
    for kind in ("convex", "saddle", "concave"):
        assert sum(row[kind] for row in per) == pytest.approx(smooth["area"][kind], rel=1e-12)
    assert sum(row["accessible"] for row in per) == pytest.approx(found["components"][0]["area"], rel=1e-12)
    accessible, bare = molviz.measure(CAFFEINE, probe=1.4), molviz.measure(CAFFEINE)
    assert bare.volume < smooth["volume"] < accessible.volume
    assert sum(row["smooth"] for row in per) < bare.area.sum()


def test_atoms_where_the_surface_meets_itself_are_named(tmp_path: Path) -> None:
    path = tmp_path / "pair.xyzr"
    path.write_text("0 0 0 1\n2.4 0 0 1\n9 9 9 1\n", encoding="ascii")
    cuts = result(str(path), "--probe", "0.21")["smooth"]["self_intersections"]
    assert cuts == {"spindles": 1, "cut_triangles": 0, "spindle_atoms": [[0, 1]], "cut_triangle_atoms": []}
    assert [row["self_intersections"] for row in rows(str(path), "--probe", "0.21", "--per", "atom")] == ["1", "1", "0"]
    assert "meets itself at 1 saddle and 0 concave triangles" in run("surface", str(path), "--probe", "0.21").stdout


def test_shells_as_csv_to_the_last_digit() -> None:
    found = result(C60)
    for row, one in zip(rows(C60), found["components"], strict=True):
        assert (float(row["area"]), float(row["volume"])) == (one["area"], one["volume"])
        assert (row["kind"], row["inside"]) == (one["kind"], "" if one["inside"] is None else str(one["inside"]))
        assert int(row["atoms"]) == len(one["atoms"])


def test_the_table_tells_all_of_it() -> None:
    text = run("surface", C60).stdout
    assert "Bondi 1964" in text and "1 component  1 cavity" in text and "lined by 60 atoms  inside 0" in text


def test_from_python() -> None:
    hollow = wall(5, 1.2)
    both = molviz.surface((hollow.center, hollow.radius), probe=1.0, check=True)
    outer = molviz.surface((hollow.center, hollow.radius), probe=1.0, outer_only=True, check=True)
    assert both.cavities == outer.cavities == 1 and both.smooth is not None and outer.smooth is not None
    assert both.smooth.area() > outer.smooth.area() and both.smooth.volume < outer.smooth.volume
    assert both.accessible().sum() == pytest.approx(both.shells.area.sum(), rel=1e-12)
    assert "1 components, 1 cavities" in repr(both) and molviz.surface(CAFFEINE, 0).smooth is None


def test_islands_are_outside_of_what_the_outer_surface_reaches() -> None:
    scene = together(wall(6, 1.4), wall(0.5, 0.3))
    found = molviz.surface((scene.center, scene.radius), probe=0.5)
    assert [one.inside for one in found.components if one.kind == "outer"] == [None, 1 + found.cavities]


def test_a_surface_that_leaks_fails_the_check() -> None:
    found = molviz.surface(CAFFEINE)
    leaky = found.smooth._replace(leak=np.array([1e-3, 0, 0]))
    with pytest.raises(InternalError, match="not closed"):
        check_surface(found.graph, found.shells, found.probe, found.kept, leaky)
    larger = found.smooth._replace(convex=1.001 * found.smooth.convex)
    with pytest.raises(InternalError, match="slope"):
        check_surface(found.graph, found.shells, found.probe, found.kept, larger)


def test_what_cannot_be_is_refused() -> None:
    assert run("surface", C60, "--json", "--csv").exit_code == 2
    assert run("surface", C60, "--probe", "-1").exit_code == 2
    with pytest.raises(molviz.InputError, match="probe"):
        molviz.surface(CAFFEINE, probe=-1)


# ---- in pictures


def test_cavities_and_surfaces_are_drawn() -> None:
    pair = together(wall(5, 1.4), wall(0.0, 0.3))
    balls = (pair.center[:201], pair.radius[:201])
    assert molviz.draw(balls, cavities=True, surface="vdw").atoms_drawn == 200
    vdw, accessible = (molviz.draw(CAFFEINE, surface=surface).svg() for surface in ("vdw", "accessible"))
    assert vdw == molviz.draw(CAFFEINE).svg() and accessible == molviz.draw(CAFFEINE, probe=1.4).svg()
    assert molviz.draw(CAFFEINE, surface="accessible", probe=0.5).svg() == molviz.draw(CAFFEINE, probe=0.5).svg()


@pytest.mark.parametrize(("options", "probe"), [({}, "1.4"), ({"surface": "vdw"}, "0"), ({"probe": 0.3}, "0.3")])
def test_without_cavities_there_is_nothing_to_draw(options: dict, probe: str) -> None:
    with pytest.raises(molviz.InputError, match=f"no cavity with a probe of {probe} Å"):
        molviz.draw(CAFFEINE, cavities=True, **options)
    assert run("draw", CAFFEINE, "--cavities", "-o", "x.svg").exit_code == 1


def test_the_van_der_waals_surface_has_no_probe() -> None:
    with pytest.raises(molviz.InputError, match="expected accessible"):
        molviz.draw(CAFFEINE, surface="vdw", probe=1.0)
