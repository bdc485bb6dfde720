"""The command line: options become values, then one call each."""

from molviz.cli.main import main, run

__all__ = ["main", "run"]
