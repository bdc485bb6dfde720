"""How a command ends that could not do what it was asked for: the exit status, and a line on failures of molviz."""

from molviz.errors import InputError, InternalError, OptionError

STATUS = 70  # EX_SOFTWARE of sysexits.h: failures of molviz itself
INTERRUPTED, TERMINATED = 130, 143  # 128 and the number of the signal, as shells have it


def status_of(wrong: InputError) -> int:
    """Return 2, as for every command line that cannot be used, where an option is wrong, and 1 where an input is."""
    return 2 if isinstance(wrong, OptionError) else 1


def line_about(failure: Exception) -> str:
    """Return what a user is told of an exception that nobody expected."""
    if isinstance(failure, InternalError):
        return f"molviz: {failure}"
    text = " ".join(str(failure).split())
    return f"molviz: {InternalError(f'{type(failure).__name__}: {text}')}"
