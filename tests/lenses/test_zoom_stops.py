"""Zooms whose file disagrees with itself about a stop: nothing jumps, and a note says so."""

from __future__ import annotations

import copy
import json
from typing import Any

import pytest

import daguerre as dg
from daguerre.lenses.index import FOLDER
from daguerre.lenses.json_lens import lens_of
from daguerre.lenses.zoom import positions

NAME = "canon-ef-24-70mm-f2.8"
DATA: dict[str, Any] = json.loads((FOLDER / f"{NAME}.json").read_text("utf-8"))


@pytest.mark.parametrize("factor", [0.7, 1.02, 1.25, 2.0])
def test_f_numbers_are_continuous(factor: float) -> None:
    """A position's stop is of another size than its f-number says."""
    data = copy.deepcopy(DATA)
    far = [c for c in data["configurations"] if c.get("object_distance_mm") is None]
    for one in far[:1]:
        one["f_number"] = (one.get("f_number") or data["nominal"]["f_number"]) * factor
    lens = lens_of(data, "a.json")
    for place in positions(lens):
        at = lens.at_zoom(place.efl).first_order().f_number
        for mm in (place.efl * 0.9999, place.efl * 1.0001):
            if positions(lens)[0].efl < mm < positions(lens)[-1].efl:
                assert lens.at_zoom(mm).first_order().f_number == pytest.approx(at, rel=0.021)
    told = [note for note in lens.notes if note.startswith("zoom: at")]
    assert len(told) == (factor != 1.02)


def test_the_library_agrees_with_itself() -> None:
    for name in dg.lenses.names():
        assert not [note for note in dg.lenses.load(name).notes if note.startswith("zoom: at")]
