"""Lens errors carry a code and a surface, in Python and in their text."""

from __future__ import annotations

import pytest

from daguerre.errors import InputError
from daguerre.lenses.errors import CODES, LensError, from_core, reported


def test_a_code_stands_in_the_message_once() -> None:
    error = LensError("a.json: no stop", "lens-no-stop", 3)
    assert str(error) == "a.json: no stop [lens-no-stop]"
    assert (error.code, error.surface, error.exit_code) == ("lens-no-stop", 3, 3)
    assert str(LensError(str(error), "lens-no-stop")) == str(error)


def test_what_the_core_says_keeps_its_code_and_surface() -> None:
    text = "Tessar: surface 7: thickness: wanted 0 mm, got -1 [lens-overlap]"
    with pytest.raises(LensError) as caught, reported("a.json"):
        raise ValueError(text)
    assert str(caught.value) == f"a.json: {text}"
    assert (caught.value.code, caught.value.surface) == ("lens-overlap", 7)
    assert caught.value.code in CODES


def test_other_errors_stay_what_they_are() -> None:
    plain = from_core(ValueError("lens: glass: wanted n"), "a.json")
    assert type(plain) is InputError
    mine = InputError("b.json: x")
    assert from_core(mine, "a.json") is mine
