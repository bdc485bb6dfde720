"""The one exception that a user's data can raise."""


class InputError(Exception):
    """An input that could not be used; its text reads ``FILE:LINE: what is wrong and what was expected``."""

    def __init__(self, message: str, source: str = "", line: int | None = None) -> None:
        where = "".join(f"{part}:" for part in (source, line) if part not in ("", None))
        super().__init__(f"{where} {message}" if where else message)
