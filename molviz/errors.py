"""What can go wrong: with a user's data, with what they ask for, and with molviz itself."""

from collections.abc import Iterable, Sequence

MOST_LETTERS = 6000  # of a message: more than the longest path has
MOST_LISTED = 12  # names in a message: who needs the others asks the file


class InputError(ValueError):
    """An input that could not be used; its text reads ``FILE:LINE: what is wrong and what was expected``.

    In Python it begins with the name of the argument that is wrong.
    """

    def __init__(self, message: str, source: str = "", line: int | None = None) -> None:
        if len(message) > MOST_LETTERS:
            message = f"{message[: MOST_LETTERS // 2]} … {message[-MOST_LETTERS // 2 :]}"
        self.line = line
        where = "".join(f"{part}:" for part in (source, line) if part not in ("", None))
        super().__init__(f"{where} {message}" if where else message)


class OptionError(InputError):
    """An option that could not be used, whatever the input: a selection, a style, a palette, radii, a model."""


class InternalError(Exception):
    """A failure of molviz, whatever the input was."""

    def __init__(self, message: str) -> None:
        super().__init__(f"{message}; this is a failure of molviz: please report it together with the input")


def listed(names: Sequence[str]) -> str:
    """Return names for a message, a long list cut."""
    more = len(names) - MOST_LISTED
    return ", ".join(names) if more <= 0 else f"{', '.join(names[:MOST_LISTED])} … and {more} more"


def expected_instead(wrong: str, known: Iterable[str], otherwise: str) -> str:
    """Return what a message ends with: the word that was meant, if one of the known is near, else what is expected."""
    import difflib  # here: importing it takes as long as reading a small file

    hint = difflib.get_close_matches(wrong.lower(), list(known), 1)
    return f"did you mean {hint[0]!r}?" if hint else f"expected {otherwise}"
