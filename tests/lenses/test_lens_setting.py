"""Settings of lenses: one record from whoever asks to the lens."""

from __future__ import annotations

import copy
import math
import pickle
from typing import Any

import pytest

import daguerre as dg
from daguerre import analysis, lenses
from daguerre.analysis.bench import on_bench
from daguerre.lenses import LensSetting
from daguerre.lenses.focus import focused

ZOOM = "canon-ef-24-70mm-f2.8"


def test_settings_travel_and_compare() -> None:
    setting = LensSetting(4.0, 2.5, 35.0, "best", "sensor")
    assert pickle.loads(pickle.dumps(setting)) == copy.deepcopy(setting) == setting
    assert setting != LensSetting(4.0, 2.5, 35.0, "best")
    assert "focus_m=2.5" in repr(setting)
    assert LensSetting().focus_m == math.inf


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"focus_by": "eye"}, "focus_by: wanted paraxial or best, got 'eye'"),
        ({"focus_from": "floor"}, "focus_from: wanted pupil or sensor, got 'floor'"),
        ({"focus_m": "near"}, "focus_m: wanted a number, got 'near'"),
        ({"f_stop": True}, "f_stop: wanted a number, got True"),
        ({"zoom_mm": (24, 70)}, r"zoom_mm: wanted a number, got \(24, 70\)"),
    ],
)
def test_what_no_lens_has_is_refused(given: dict[str, Any], message: str) -> None:
    with pytest.raises(dg.UsageError, match=message):
        LensSetting(**given)


def test_the_public_keywords_are_the_record() -> None:
    lens = lenses.load(ZOOM)
    setting = LensSetting(4.0, 2.5, 35.0, "best", "sensor")
    given = lens.focused(2.5, zoom_mm=35.0, f_stop=4.0, by="best", measured_from="sensor")
    found = focused(lens, setting)
    assert (found.film_z_mm, found.efl_mm) == (given.film_z_mm, given.efl_mm)
    plain = focused(lens, LensSetting(4.0, 2.5, 35.0))
    assert plain.film_z_mm != pytest.approx(given.film_z_mm, abs=1e-6)
    bench = on_bench(lens, LensSetting(4.0, 2.5, 35.0, "best"))
    same = analysis.set_up(lens, f_stop=4.0, focus_m=2.5, zoom_mm=35.0)
    assert (bench.film_z, bench.iris_radius) == (same.film_z, same.iris_radius)
