"""A progress bar for work that lasts, on a terminal and nowhere else."""

import sys
import time

import click

from molviz.cli.telling import visible

PATIENCE = 2.0  # seconds before anything shows


class Progress:
    """Told the name of each stage as it begins; shows how many of ``stages`` are done once work lasts, if any."""

    def __init__(self, stages: int) -> None:
        self.stages, self.done, self.began = stages, 0, time.monotonic()
        self.shown = False

    def __call__(self, stage: str) -> None:
        """Note that a stage begins."""
        if self.stages and sys.stderr is not None and sys.stderr.isatty() and time.monotonic() - self.began > PATIENCE:
            filled = 30 * self.done // self.stages
            click.echo(f"\r[{'#' * filled}{'-' * (30 - filled)}] {visible(stage)[:24]:<24}", err=True, nl=False)
            self.shown = True
        self.done = min(self.done + 1, self.stages)

    def close(self) -> None:
        """Wipe the bar."""
        if self.shown:
            click.echo(f"\r{' ' * 60}\r", err=True, nl=False)
