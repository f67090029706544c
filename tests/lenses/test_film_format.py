"""Formats of lens files: sizes, names and words, and the film of a lens without one."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import Any

import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.lenses.image_circle import film_mm, format_mm
from daguerre.lenses.index import FOLDER

GAUSS = "double-gauss-50mm-f2"
FORMATS = {
    "36x24": (36, 24),
    "43.8x32.9": (43.8, 32.9),
    "44 x 33 mm": (44, 33),
    "135-full-frame": (36, 24),
    "135 full frame (36x24 mm)": (36, 24),
    "Full frame": (36, 24),
    "Super 35 (31.1 mm circle)": (24.9, 18.7),
    "aps-c": (23.6, 15.7),
    "four-thirds": (17.3, 13),
    "645": (56, 41.5),
    "6x7": (69.5, 56),
    "4x5": (121, 97),
    "8\u00d710 inch": (246, 195),
    "0x5": None,
    "1e9x3": None,
    "99999x3": None,
    "large format cine": None,
    "35 mm": None,
    "": None,
}


def _with(text: Any) -> dg.lenses.Lens:
    lens = dg.lenses.load(GAUSS)
    return dataclasses.replace(lens, data={**lens.data, "format": text})


@pytest.mark.parametrize("text", FORMATS)
def test_formats_in_words(text: str) -> None:
    assert format_mm(_with(text)) == FORMATS[text]


def test_film_without_a_format() -> None:
    lens = _with("large format cine")
    nominal = dataclasses.replace(lens.nominal, image_circle_mm=21.6333, full_field_deg=None)
    small = dataclasses.replace(lens, nominal=nominal)
    assert film_mm(small) == pytest.approx((18, 12), rel=1e-4)
    assert film_mm(small, 5.40833) == pytest.approx((9, 6), rel=1e-4)


@pytest.mark.parametrize("text", ["135-full-frame", "Super 35 (31.1 mm circle)", "any words", None])
def test_lens_as_code(tmp_path: Path, text: str | None) -> None:
    """A file without source and with a format in words becomes code."""
    data = json.loads((FOLDER / f"{GAUSS}.json").read_text("utf-8"))
    (tmp_path / "l.json").write_text(json.dumps({**data, "format": text, "patent": None}))
    out = tmp_path / "x.osl"
    assert main(["lens", str(tmp_path / "l.json"), "--export", str(out), "--degree", "3"]) == 0
    assert "Prescription: source not named." in out.read_text("utf-8")
