"""Runs the command line as ``python -m molviz``."""

from molviz.cli import run

run()
