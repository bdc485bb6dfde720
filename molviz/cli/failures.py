"""Failures of molviz itself: one line that asks for a report, and an exit status of their own."""

from molviz.errors import InternalError

STATUS = 70  # EX_SOFTWARE of sysexits.h


def line_about(failure: Exception) -> str:
    """Return what a user is told of an exception that nobody expected."""
    if isinstance(failure, InternalError):
        return f"molviz: {failure}"
    text = " ".join(str(failure).split())
    return f"molviz: {InternalError(f'{type(failure).__name__}: {text}')}"
