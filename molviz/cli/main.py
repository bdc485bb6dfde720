"""The group of all commands, and what a user sees when something is wrong."""

import gc
import importlib
import io
import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import click

from molviz.cli import failures
from molviz.cli.telling import say
from molviz.errors import InputError

COMMANDS = {  # name → module:object, imported when first used, and the first line of its help, told without it
    "draw": ("molviz.cli.draw:draw_command", "Draw molecules as exact vector pictures."),
    "hidden-lines": ("molviz.cli.hidden_lines:hidden_lines_command", "Remove the hidden lines of spheres, exactly."),
    "measure": ("molviz.cli.measure:measure_command", "Tell the exact area and volume of the union of balls."),
    "surface": ("molviz.cli.surface:surface_command", "Tell components, cavities and faces of the boundary."),
    "clash": ("molviz.cli.clash:clash_command", "Tell which atoms of A overlap which of B, and by how much."),
    "info": ("molviz.cli.info:info_command", "Tell what was read, and whether the hard sphere model holds."),
    "view": ("molviz.cli.view:view_command", "Turn molecules in the browser, and save the drawing."),
    "styles": ("molviz.cli.styles:styles_command", "List the styles and palettes, with a line on each."),
    "radii": ("molviz.cli.radii:radii_command", "List the tables of radii, with their publications."),
    "help": ("molviz.cli.help:help_command", "Explain the language of selections, or a command."),
}
SEARCHED_EVERY = 100_000  # new objects: a search for cycles among fewer finds none, and takes a tenth of the time

TYPED = "molviz.typed"  # where a context holds the words after the program's name


class Commands(click.Group):
    """Commands are imported one by one; errors end in one line and exit status 1 (input), 2 (options) or 70."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of all commands."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return one command."""
        if cmd_name not in COMMANDS:
            return None
        module, name = COMMANDS[cmd_name][0].split(":")
        command: click.Command = getattr(importlib.import_module(module), name)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list of all commands, none of which is imported for it."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, told) for name, (_, told) in COMMANDS.items()])

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Keep what was typed, for files that say what drew them."""
        ctx.meta[TYPED] = list(args)
        return super().parse_args(ctx, args)

    def main(self, *args: Any, **kwargs: Any) -> Any:
        """Run; no traceback reaches the user."""
        try:
            with _ended_by_sigterm():
                sys.exit(super().main(*args, **{**kwargs, "standalone_mode": False}))
        except click.ClickException as wrong:
            shown = io.StringIO()
            wrong.show(shown)
            say(*shown.getvalue().rstrip("\n").split("\n"))
            sys.exit(wrong.exit_code)
        except click.Abort:
            sys.exit(failures.INTERRUPTED)
        except InputError as wrong:
            say(f"molviz: {wrong}")
            sys.exit(failures.status_of(wrong))
        except OSError as wrong:
            say(f"molviz: standard output cannot be written: {wrong.strerror}")
            _forget_output()
        except MemoryError:
            say("molviz: not enough memory for this input")
        except Exception as failure:
            say(failures.line_about(failure))
            sys.exit(failures.STATUS)
        sys.exit(1)


@contextmanager
def _ended_by_sigterm() -> Iterator[None]:
    """Let SIGTERM end the process as Ctrl-C does, by an exception on whose way files that are half written vanish."""
    if threading.current_thread() is not threading.main_thread():
        yield  # signals are none of this thread's business
        return

    def end(number: int, frame: object) -> None:
        sys.exit(failures.TERMINATED)

    before = signal.signal(signal.SIGTERM, end)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _forget_output() -> None:
    """Let what is left in the buffer go nowhere: Python would try to write it once more at its end, and complain."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def run() -> None:
    """Run the command line as a process of its own: its memory goes back as a whole, not searched for cycles."""
    gc.set_threshold(SEARCHED_EVERY)
    try:
        main()
    finally:
        gc.freeze()


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="molviz")
def main() -> None:
    """Exact vector drawings and exact numbers of molecules, and of anything else made of spheres."""
