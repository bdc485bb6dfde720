"""``molviz styles``: what pictures can look like."""

from typing import Any

import click

from molviz.cli.telling import tell_json
from molviz.pipeline import catalogue


@click.command("styles")
@click.option("--show", metavar="NAME", help="Print the TOML of a style or palette, to start a file of your own from.")
@click.option("--json", "as_json", is_flag=True, help="One JSON object on standard output.")
def styles_command(show: str | None, as_json: bool) -> None:
    """List the styles and palettes, with a line on each.

    A file of your own states only what differs from its base; "flat" is the style that explains every key, "tide"
    the palette that does.

    \b
    Examples:
      molviz styles
      molviz styles --show goodsell > mine.toml
      molviz draw 4hhb.pdb --style mine.toml --palette clay -o 4hhb.svg
    """
    if show is not None:
        shown = catalogue.text_of(show)
        if as_json:
            tell_json(shown)
        else:
            click.echo(shown["toml"], nl=False)
        return
    styles, palettes = catalogue.styles(), catalogue.palettes()
    if as_json:
        tell_json({"styles": styles, "palettes": palettes})
    else:
        click.echo(f"{listed('--style', styles)}\n\n{listed('--palette', palettes)}")


def listed(option: str, rows: list[dict[str, Any]]) -> str:
    """Return an option and, below it, a line on each of its values."""
    lines = [f"  {row['name']:<10} {row['title']}{' (default)' if row.get('default') else ''}" for row in rows]
    return "\n".join([option, *lines])
