"""Edges of elements: only light that the clear diameters pass meets them."""

from __future__ import annotations

import copy
import json
from typing import Any

import pytest

from daguerre.lenses.checking import checked
from daguerre.lenses.errors import LensError
from daguerre.lenses.index import FOLDER
from daguerre.lenses.json_lens import lens_of

GAUSS: dict[str, Any] = json.loads((FOLDER / "double-gauss-50mm-f2.json").read_text("utf-8"))


def _lens(stop: float, **thickness: float) -> Any:
    """The double Gauss with another stop, and other thicknesses of surfaces."""
    data = copy.deepcopy(GAUSS)
    data["surfaces"][5]["semi_diameter"] = stop
    for index, value in thickness.items():
        data["surfaces"][int(index[1:])]["thickness"] = value
    return lens_of(data, "a.json")


def test_edges_beyond_the_clear_diameters() -> None:
    """A stop of f/1.3 behind diameters that pass f/2: no light meets the edge of the first lens."""
    lens = checked(_lens(13.0, s0=2.5))
    assert any(note.startswith("surfaces 0 and 1 cross 14") for note in lens.notes)
    assert any("slower than the f/1.3" in note for note in lens.notes)
    assert lens.surfaces[0].semi_diameter == GAUSS["surfaces"][0]["semi_diameter"]


def test_edges_that_light_meets_are_still_errors() -> None:
    with pytest.raises(LensError, match="surfaces 0 and 1: edge: surfaces cross"):
        checked(_lens(8.607, s0=1.0))
    with pytest.raises(LensError, match="surfaces 0 and 1: edge: surfaces cross"):
        checked(_lens(13.0, s0=1.0))


def test_the_pair_that_crosses_deepest_is_named() -> None:
    with pytest.raises(LensError, match="surfaces 7 and 8: edge: surfaces cross"):
        checked(_lens(8.607, s0=1.2, s7=1.0))
    with pytest.raises(LensError, match="surfaces 0 and 1: edge: surfaces cross"):
        checked(_lens(8.607, s0=0.2, s7=2.4))
