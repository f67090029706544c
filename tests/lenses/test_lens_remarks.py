"""Remarks of lens files that cannot be used are notes, and no rays depend on them."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import pytest

from daguerre.lenses.errors import LensError
from daguerre.lenses.index import FOLDER
from daguerre.lenses.json_lens import lens_of

GAUSS: dict[str, Any] = json.loads((FOLDER / "double-gauss-50mm-f2.json").read_text("utf-8"))


def _lens(change: dict[str, Any], place: str = "") -> Any:
    data = copy.deepcopy(GAUSS)
    (data[place] if place else data).update(change)
    return lens_of(data, "a.json")


@pytest.mark.parametrize(
    ("key", "value", "used", "said"),
    [
        ("full_field_deg", [46.0, 30.0], 46.0, "got [46.0, 30.0]: 46, the first, is used"),
        ("full_field_deg", "about 46", None, "got 'about 46': ignored"),
        ("full_field_deg", [], None, "got []: ignored"),
        ("image_circle_mm", {"mm": 43}, None, "got an object: ignored"),
        ("efl_mm", [None, 3], None, "got [None, 3]: ignored"),
        ("full_field_deg", True, None, "got True: ignored"),
    ],
)
def test_stated_values(key: str, value: Any, used: float | None, said: str) -> None:
    lens = _lens({key: value}, "nominal")
    assert f"nominal.{key}: wanted one number, {said}" in lens.notes
    if key != "efl_mm":  # the configuration has its own
        assert getattr(lens.nominal, key) == used


def test_texts() -> None:
    lens = _lens({"note": ["a", "b"], "patent": 2854890, "maker": {"name": "x"}})
    assert lens.patent == "2854890"
    assert lens.note is None
    assert "note: wanted a string, got ['a', 'b']: ignored" in lens.notes
    assert any(note.startswith("maker: wanted a string") for note in lens.notes)
    assert lens.first_order() == lens_of(GAUSS, "a.json").first_order()


@pytest.mark.parametrize("conic", [0.0, 0.44])
def test_diameters_of_two_digits(conic: float) -> None:
    """A number of two digits may be beyond its sphere; one that is far beyond is an error."""
    data = copy.deepcopy(GAUSS)
    bent = data["surfaces"][0]
    bent["conic"] = conic
    limit = abs(bent["radius"]) / (1 + conic) ** 0.5
    bent["semi_diameter"] = 1.0066 * limit
    lens = lens_of(data, "a.json")
    assert lens.surfaces[0].semi_diameter == pytest.approx(0.998 * limit)
    assert any(note.startswith("surfaces[0].semi_diameter: ") for note in lens.notes)
    bent["semi_diameter"] = 1.06 * limit
    with pytest.raises(LensError, match=r"semi.diameter"):
        _ = lens_of(data, "a.json").prescription


def test_good_files_have_no_such_notes() -> None:
    for path in sorted(Path(FOLDER).glob("*.json"))[::7]:
        lens = lens_of(json.loads(path.read_text("utf-8")), str(path))
        assert not [note for note in lens.notes if "wanted" in note or "cut to" in note]
