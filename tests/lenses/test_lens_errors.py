"""Lens errors carry a code and a surface, in Python and in their text."""

from __future__ import annotations

import json
import pickle
from pathlib import Path
from typing import Any

import pytest

from daguerre import _core, lenses
from daguerre.errors import CoreError, InputError, core_errors
from daguerre.lenses import library
from daguerre.lenses.errors import CODES, LensError, from_core, reported
from daguerre.lenses.focus import closest_focus_m
from daguerre.lenses.json_lens import lens_of
from daguerre.lenses.projections import PROJECTIONS


def test_a_code_stands_in_the_message_once() -> None:
    error = LensError("a.json: no stop", "lens-no-stop", 3)
    assert str(error) == "a.json: no stop [lens-no-stop]"
    assert (error.code, error.surface, error.exit_code) == ("lens-no-stop", 3, 3)
    assert str(LensError(str(error), "lens-no-stop")) == str(error)


def overlapping(name: str = "Tessar") -> _core.Prescription:
    """A lens whose surface 1 lies ahead of surface 0."""
    glass = _core.Glass.constant(1.5)
    stop = _core.Surface(0.01, -1.0, 5.0, glass, True, "spherical")
    return _core.Prescription(
        name,
        [_core.Surface(0.01, 1.0, 5.0, glass, False, "spherical"), stop, stop],
        _core.Glass.constant(1.0),
        "mgf2",
        0.0,
    )


def test_the_core_says_code_and_surface_in_fields() -> None:
    with pytest.raises(_core.LensError) as caught:
        overlapping()
    error = caught.value
    sentence = "Tessar: surface 1: thickness: wanted 0 to 1e5 mm, got -1"
    assert (error.message, error.code, error.surface) == (sentence, "lens-overlap", 1)
    assert str(error) == f"{sentence} [lens-overlap]"
    assert isinstance(error, _core.Error)
    assert isinstance(error, ValueError)
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), str(again), vars(again)) == (type(error), str(error), vars(error))


def test_an_error_of_no_lens_has_neither() -> None:
    with pytest.raises(_core.Error) as caught:
        _core.Filter("triangle")
    assert not isinstance(caught.value, _core.LensError)
    assert caught.value.message == str(caught.value)
    assert (caught.value.code, caught.value.surface) == (None, None)


def test_what_the_core_says_keeps_its_code_and_surface() -> None:
    # A name that looks like code and surface: nothing is read out of the message.
    name = "surface 42 [lens-edge]"
    with pytest.raises(LensError) as caught, reported("a.json"):
        overlapping(name)
    assert str(caught.value).startswith(f"a.json: {name}: surface 1: thickness: ")
    assert str(caught.value).endswith(" [lens-overlap]")
    assert (caught.value.code, caught.value.surface) == ("lens-overlap", 1)
    assert caught.value.code in CODES


def test_other_errors_stay_what_they_are() -> None:
    plain = from_core(CoreError("lens: surface 3: wanted n [lens-glass]"), "a.json")
    assert type(plain) is InputError
    mine = InputError("b.json: x")
    assert from_core(mine, "a.json") is mine
    coded = from_core(mine, "a.json", "lens-format", 4)
    assert isinstance(coded, LensError)
    assert (str(coded), coded.surface) == ("b.json: x [lens-format]", 4)


def test_a_fault_of_our_own_is_not_taken_for_bad_input() -> None:
    for context in (reported("a.json", "lens-format"), core_errors(InputError, "a.json")):
        with pytest.raises(ValueError, match=r"^a fault$") as caught, context:
            raise ValueError("a fault")
        assert type(caught.value) is ValueError


def test_a_surface_of_a_file_is_named_by_its_place() -> None:
    data = json.loads((library.FOLDER / "tessar-50mm-f2.8.json").read_text())
    data["surfaces"][2]["radius"] = 0
    with pytest.raises(
        LensError, match=r"^a\.json: surfaces\[2\]\.radius: .* \[lens-format\]$"
    ) as caught:
        lens_of(data, "a.json")
    assert (caught.value.code, caught.value.surface) == ("lens-format", 2)


def test_a_projection_is_one_of_the_table() -> None:
    data = json.loads((library.FOLDER / "tessar-50mm-f2.8.json").read_text())
    for name in PROJECTIONS:
        data["nominal"]["projection"] = name
        assert lens_of(data, "a.json").nominal.projection == name
    data["nominal"]["projection"] = "fisheye-equisolid"
    assert lens_of(data, "a.json").nominal.projection == "equisolid"
    data["nominal"]["projection"] = "fisheye"
    with pytest.raises(
        LensError, match=r"^a\.json: nominal\.projection: .*'equisolid'.*got 'fisheye'"
    ):
        lens_of(data, "a.json")


def test_a_lens_error_goes_to_another_process() -> None:
    error = LensError("a.json: no stop", "lens-no-stop", 3)
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.code, again.surface) == (str(error), error.code, error.surface)


def test_members_that_no_one_reads_are_told(tmp_path: Path) -> None:
    data = json.loads((library.FOLDER / "tessar-50mm-f2.8.json").read_text())
    assert lenses.load("tessar-50mm-f2.8").notes == ()
    data["surfaces"][2]["conicc"] = -1
    data["coatings"] = "mgf2"
    data["nominal"] |= {f"x{i}": 0 for i in range(20)}
    path = tmp_path / "tessar.json"
    path.write_text(json.dumps(data))
    notes = lenses.load(path).notes
    assert notes[0].startswith("coatings: unknown member")
    assert "'coating'" in notes[0]
    assert notes[-1] == "14 more unknown members are ignored"
    del data["nominal"]
    path.write_text(json.dumps(data))
    assert "surfaces[2].conicc: unknown member, ignored" in lenses.load(path).notes[1]
    assert "'conic'" in lenses.load(path).notes[1]


def _library(name: str) -> dict[str, Any]:
    folder = Path(lenses.__file__).parent / "library"
    found: dict[str, Any] = json.loads((folder / f"{name}.json").read_text())
    return found


def test_a_thickness_that_configurations_replace_must_be_a_number_too() -> None:
    data = _library("double-gauss-50mm-f2")
    gap = len(data["surfaces"]) - 1
    thickness, data["surfaces"][gap]["thickness"] = data["surfaces"][gap].get("thickness"), "flat"
    data["configurations"] = [{"name": "infinity", "gaps": {str(gap): thickness or 30.0}}]
    with pytest.raises(LensError, match=rf"surfaces\[{gap}\]\.thickness: wrong type"):
        lens_of(data, "a.json")


def test_the_nearest_focus_of_a_lens_that_diverges_is_an_error_of_its_file() -> None:
    data = _library("rodenstock-geronar-210mm-f6.8")
    del data["surfaces"][0]
    lens = lens_of(data, "a.json")
    with pytest.raises(LensError, match=r"a\.json: .*wanted a converging lens"):
        closest_focus_m(lens)
