"""``molviz view``: a page in the browser."""

import threading
import webbrowser
from functools import partial
from typing import Any

import click

from molviz.cli.draw import look_options, stated
from molviz.cli.options import input_options, shared, warn
from molviz.pipeline.state import KEPT, with_state

NEEDED = "molviz view needs a web server; expected: pip install 'molviz[view]'"


@click.command("view")
@click.argument("inputs", nargs=-1, required=True, metavar="INPUT...")
@look_options
@shared("fill", help="Regions filled or not (default: the style's).")
@shared("view_from", metavar="FILE", help="Options that the page saved; those typed beside it win.")
@input_options
@click.option("--no-browser", is_flag=True, help="Only print the page's address.")
def view_command(inputs: tuple[str, ...], no_browser: bool, **options: Any) -> None:
    """Turn molecules in the browser, and save the drawing.

    The page is served to this machine only, at the address that is printed, and ends with the page or with Ctrl-C.
    Everything it saves is what molviz draw writes, by a command that it shows.

    \b
    Examples:
      molviz view 4hhb.cif
      molviz view caffeine.xyz --style shaded
      molviz view 4hhb.cif --view-from 4hhb.toml
    """
    try:
        from molviz.viewer.server import serve
    except ModuleNotFoundError:
        raise click.ClickException(NEEDED) from None
    from molviz.viewer.session import Session, input_of

    options = with_state(options, stated())
    found = [input_of(path, options["format_"], options["unpack_all"]) for path in inputs]
    session = Session(found, {name: options[name] for name in KEPT if name in options})
    for number in range(len(found)):
        warn(session.begun(number), options["quiet"], options["strict"])
    serve(session, partial(_tell, browser=not no_browser))


def _tell(address: str, browser: bool) -> None:
    """Print the page's address, and open it: in a thread, for a browser in the terminal returns when it is left."""
    click.echo(address)
    if browser:
        threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()
