"""Lens errors carry a code and a surface, in Python and in their text."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from daguerre import lenses
from daguerre.errors import InputError
from daguerre.lenses import library
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


def test_members_that_no_one_reads_are_told(tmp_path: Path) -> None:
    data = json.loads((library.FOLDER / "tessar-50mm-f2.8.json").read_text())
    assert lenses.load("tessar-50mm-f2.8").notes == ()
    data["surfaces"][2]["conicc"] = -1
    data["coatings"] = "mgf2"
    data["nominal"] |= {f"x{i}": 0 for i in range(20)}
    path = tmp_path / "tessar.json"
    path.write_text(json.dumps(data))
    notes = lenses.load(path).notes
    assert notes[0].startswith("coatings: not known")
    assert "'coating'" in notes[0]
    assert notes[-1] == "14 more members are not known"
    del data["nominal"]
    path.write_text(json.dumps(data))
    assert "surfaces[2].conicc: not known, and not read" in lenses.load(path).notes[1]
    assert "'conic'" in lenses.load(path).notes[1]
