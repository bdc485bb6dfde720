"""A short fixed part of `make fuzz`."""

import random
import warnings

import pytest

from tests import fuzz

COUNT = 700  # for each target


@pytest.mark.parametrize("target", fuzz.TARGETS)
def test_whatever_is_given_is_answered_or_refused(target: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        wrong = [(number, what) for number in range(COUNT) if (what := fuzz.attempt(12, number, target)[2])]
    assert not wrong


def test_what_is_wrong_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """A reader that divides by nought, and a message in two lines."""
    monkeypatch.setattr(fuzz, "read", lambda *args: 1 / 0)
    assert fuzz.attempt(12, 0, "readers")[2] == "ZeroDivisionError: division by zero"

    def refuse(*args: object) -> None:
        raise fuzz.InputError("no\nexpected")

    monkeypatch.setattr(fuzz, "select", refuse)
    assert fuzz.attempt(12, 0, "selections")[2].startswith("message")


def test_cases_are_the_same_every_time() -> None:
    again = [[fuzz.attempt(5, number)[:2] for number in range(30)] for _ in range(2)]
    assert again[0] == again[1] and len({data for _, data in again[0]}) > 25
    assert fuzz.varied(random.Random(1), b"a b\nc 1") == fuzz.varied(random.Random(1), b"a b\nc 1")
