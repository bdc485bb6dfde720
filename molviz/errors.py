"""What can go wrong: with a user's data, and with molviz itself."""


class InputError(ValueError):
    """An input that could not be used; its text reads ``FILE:LINE: what is wrong and what was expected``.

    In Python it begins with the name of the argument that is wrong.
    """

    def __init__(self, message: str, source: str = "", line: int | None = None) -> None:
        where = "".join(f"{part}:" for part in (source, line) if part not in ("", None))
        super().__init__(f"{where} {message}" if where else message)


class InternalError(Exception):
    """A failure of molviz, whatever the input was."""

    def __init__(self, message: str) -> None:
        super().__init__(f"{message}; this is a failure of molviz: please report it together with the input")
