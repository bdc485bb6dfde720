"""``molviz surface``: options become values, surfaces become a table, CSV or JSON."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import click

from molviz.cli.batch import for_each, where_from
from molviz.cli.draw import refuse_shared_targets
from molviz.cli.options import NOT_NEGATIVE, POSITIVE, batch_options, input_options_with, load_and_warn, shared
from molviz.cli.telling import say, tell_csv, tell_json, visible
from molviz.errors import OptionError
from molviz.model.radii import TABLES
from molviz.pipeline.inputs import WATER_RADIUS, InputOptions
from molviz.pipeline.outputs import makes_folder, save, target_of
from molviz.pipeline.surface import (
    EDGE,
    MESHES,
    PER,
    Component,
    Surface,
    atom_rows,
    suffix_of_mesh,
    surface_as_data,
    surface_of,
)
from molviz.pipeline.values import input_options_from

Row = dict[str, Any]

probe_option = click.option(
    "--probe", type=NOT_NEGATIVE, default=WATER_RADIUS, show_default=True, metavar="R", help="The probe's radius, in Å."
)


@click.command("surface")
@click.argument("inputs", nargs=-1, required=True, metavar="INPUT...")
@click.option("--per", type=click.Choice(PER), default=PER[0], show_default=True, help="Rows of --csv; atoms besides.")
@click.option("-o", "--output", metavar="FILE", help="A mesh: .ply .obj .stl .glb; many: '{stem}.ply'.")
@click.option("--mesh", type=click.Choice(MESHES), default=MESHES[0], show_default=True, help="Which surface -o holds.")
@click.option("--edge", type=POSITIVE, default=EDGE, show_default=True, metavar="LENGTH", help="Of its edges, in Å.")
@click.option("--outer-only", is_flag=True, default=False, help="Roll over what the probe reaches from outside.")
@shared("check", help="Verify that the surface is closed, and its area the slope of its volume.")
@click.option("--json", "as_json", is_flag=True, help="One JSON object on standard output.")
@click.option("--csv", "as_csv", is_flag=True, help="Comma-separated values, to the last digit.")
@input_options_with(probe_option)
@batch_options
def surface_command(inputs: tuple[str, ...], per: str, as_json: bool, as_csv: bool, **options: Any) -> None:
    """Tell components, cavities and faces of the boundary, and the exact smooth surface.

    The boundary is that of the balls enlarged by the probe, a graph of faces, arcs and vertices. The smooth surface
    (solvent-excluded surface) is the one over which the probe rolls: convex on atoms, saddles between two, concave
    between three, everywhere cut where it meets itself. Of an atom are its convex part, its side of each saddle, and a
    third of each concave triangle.

    \b
    Examples:
      molviz surface 4hhb.pdb --no-water
      molviz surface 4hhb.pdb --probe 1.2 --per atom --csv
      molviz surface 4hhb.pdb --probe 0 --json
      molviz surface 4hhb.pdb --no-water -o 4hhb.glb --edge 0.4
    """
    output = options["output"]
    if output:
        suffix_of_mesh(output)
        refuse_shared_targets(inputs, output, suffix_of_mesh(output), options)
    if as_json and as_csv:
        raise click.UsageError("--json and --csv exclude each other")
    wanted = input_options_from(options)
    surfaces: list[Surface] = []
    about = (options["outer_only"], options["check"], options["quiet"], options["strict"])
    task = SurfaceTask(wanted, *about, output or "", options["mesh"], options["edge"])
    try:
        for_each(inputs, task, surfaces.extend, where_from(options), options["quiet"])
    finally:
        _tell(surfaces, wanted.radii, per, as_json, as_csv)


@dataclass(frozen=True)
class SurfaceTask:
    """What is to be done for each input; other processes can do it."""

    wanted: InputOptions
    outer_only: bool
    check: bool
    quiet: bool
    strict: bool
    output: str  # of meshes, "" for none
    mesh: str
    edge: float

    def __call__(self, source: str) -> list[Surface]:
        """Return the surface of each model of one input, and write its mesh; the probe enlarges no ball before."""
        models = load_and_warn(source, replace(self.wanted, probe=0.0), self.quiet, self.strict)
        found = [surface_of(loaded, self.wanted.probe, self.outer_only, self.check) for loaded in models]
        if self.output:
            self.write(found, target_of(source, self.output, suffix_of_mesh(self.output)))
        return found

    def write(self, surfaces: list[Surface], target: str) -> None:
        """Write the mesh of the one surface of an input, and say so; raises OptionError for several."""
        if len(surfaces) > 1:
            told = f"has {len(surfaces)} models, and a mesh holds one; expected --model NUMBER"
            raise OptionError(told, surfaces[0].source)
        data = surfaces[0].to(suffix_of_mesh(target), self.mesh, self.edge)
        size = save(target, [data], makes_folder(self.output))
        if not self.quiet:
            say(f"{surfaces[0].source} -> {target}: {self.mesh} surface, {size} bytes")


def _tell(surfaces: list[Surface], radii: str, per: str, as_json: bool, as_csv: bool) -> None:
    if as_json:
        tell_json({"results": [surface_as_data(surface, radii, per) for surface in surfaces]})
    elif as_csv:
        tell_csv(row for surface in surfaces for row in _rows(surface, per))
    elif surfaces:
        title = f" ({TABLES[radii]})" if radii in TABLES else ""
        click.echo(f"radii {visible(radii)}{title}, probe {surfaces[0].probe:g} Å; areas in Å², volumes in Å³")
        click.echo("\n".join(line for surface in surfaces for line in _table(surface, per)))


def _rows(surface: Surface, per: str) -> Iterator[Row]:
    """One row per shell, or per atom."""
    about = {"file": surface.source, "model": surface.model, "probe": surface.probe}
    if per == "atom":
        yield from (about | row for row in atom_rows(surface))
        return
    for number, one in enumerate(surface.components):
        yield about | {"shell": number} | one._asdict() | {"atoms": len(one.atoms)}


def _table(surface: Surface, per: str) -> Iterator[str]:
    shells, graph, smooth = surface.shells, surface.graph, surface.smooth
    yield (
        f"{visible(surface.source)}  model {surface.model}  {len(surface.molecule)} atoms  "
        f"{_counted(int(shells.outer.sum()), 'component')}  {_counted(surface.cavities, 'cavity', 'cavities')}"
    )
    yield (
        f"  boundary: area {shells.area.sum():.3f}, volume {shells.volume.sum():.3f}; {len(graph.vertex)} vertices, "
        f"{len(graph.boundary.arcs.circle)} arcs ({shells.whole_circles.sum()} whole circles), "
        f"{len(graph.faces.sphere)} faces, genus {shells.genus.sum()}"
    )
    if smooth is not None:
        kinds = ", ".join(f"{kind} {getattr(smooth, kind).sum():.3f}" for kind in ("convex", "saddle", "concave"))
        yield f"  smooth surface: area {smooth.area():.3f} ({kinds}), volume {smooth.volume:.3f}"
        spindles = _counted(len(smooth.spindles), "saddle")
        yield f"  it meets itself at {spindles} and {_counted(len(smooth.cut_triangles), 'concave triangle')}"
    yield from (_line(number, one) for number, one in enumerate(surface.components))
    if per == "atom":
        yield from map(_atom_line, atom_rows(surface))


def _counted(count: int, one: str, many: str = "") -> str:
    return f"{count} {one if count == 1 else many or one + 's'}"


def _line(number: int, one: Component) -> str:
    inside = "" if one.inside is None else f"  inside {one.inside}"
    return (
        f"  {number:>4} {one.kind:<6}  area {one.area:.3f}  volume {one.volume:.3f}  {_counted(one.faces, 'face')}, "
        f"{_counted(one.arcs, 'arc')}, {_counted(one.vertices, 'vertex', 'vertices')}, genus {one.genus}, "
        f"lined by {_counted(len(one.atoms), 'atom')}{inside}"
    )


def _atom_line(row: Row) -> str:
    areas = "  ".join(f"{kind} {row[kind]:.3f}" for kind in ("accessible", "convex", "saddle", "concave"))
    cuts = f"  meets itself {row['self_intersections']} times" if row["self_intersections"] else ""
    return f"  {visible(row['id'])}  {areas}{cuts}"
