"""Profiles for lensfun: fits, the file as lensfun reads it, and its errors."""

from __future__ import annotations

import itertools
import json
import math
import re
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.polynomial.polynomial import polyval

from daguerre import export, lenses
from daguerre.analysis import distortion, lateral_colour, relative_illumination, set_up
from daguerre.cli import main
from daguerre.errors import InputError, UsageError
from daguerre.export.lensfun import fitting, models, traced
from daguerre.export.lensfun.frame import Frame
from daguerre.export.lensfun.traced import BANDS_NM, GRID, STOP, channels
from daguerre.export.lensfun.xml import as_xml
from daguerre.lenses import library
from daguerre.lenses.json_lens import lens_of
from daguerre.lenses.lens import Lens
from tests.support.lenses import lensfun

FULL = Frame(36.0, 24.0)


def test_a_frame_has_the_units_of_lensfun() -> None:
    small = Frame(17.3, 13.0)
    assert (FULL.unit_mm, FULL.crop_factor, FULL.pixel_mm) == (12.0, 1.0, 0.006)
    assert small.crop_factor == pytest.approx(2.0, rel=1e-3)
    r, area = small.rings(2000)
    assert (r[0], r[-1]) == (0, pytest.approx(0.5 * math.hypot(17.3, 13.0)))
    assert (area * r**2).sum() == pytest.approx((17.3**2 + 13.0**2) / 12, rel=1e-4)  # its moment


@pytest.mark.parametrize(
    ("model", "terms", "rule"),
    [
        ("poly5", {"k1": -0.03, "k2": 0.004}, [1, 0, -0.03, 0, 0.004]),
        ("ptlens", {"a": 0.01, "b": -0.04, "c": 0.02}, [1.01, 0.02, -0.04, 0.01]),
    ],
)
@pytest.mark.parametrize("scale", [1.0, 0.7])
def test_distortion_is_found_at_any_scale(
    model: str, terms: dict[str, float], rule: list[float], scale: float
) -> None:
    corrected = np.linspace(0.05, 1.8, 24)
    real = corrected * polyval(corrected, rule)
    fit = models.fit_distortion(model, corrected / scale, real, np.ones(24))
    assert fit.terms == pytest.approx(terms, abs=1e-6)
    assert fit.largest < 1e-9


def test_colour_and_vignetting_are_found() -> None:
    r = np.linspace(0, 1, 24)
    red = r * polyval(r, [1.0004, -0.0003, 0.0002])
    fit = models.fit_colour("r", r, red, np.ones(24))
    assert fit.terms == pytest.approx({"vr": 1.0004, "cr": -0.0003, "br": 0.0002}, abs=1e-6)
    light = polyval(r, [1, 0, -0.5, 0, 0.1, 0, -0.05])
    fit = models.fit_vignetting(light, r, np.ones(24))
    assert fit.terms == pytest.approx({"k1": -0.5, "k2": 0.1, "k3": -0.05}, abs=1e-6)


def test_a_black_corner_stays_correctable() -> None:
    """Light that ends before the corner: the polynomial must not reach 0, by which is divided."""
    r, area = np.linspace(0, 1, 13), FULL.rings(12)[1]
    fit = models.fit_vignetting(np.where(r < 0.85, 1 - 0.3 * r**2, 0), r, area)
    k1, k2, k3 = fit.terms.values()
    assert polyval(np.linspace(0, 1, 200), [1, 0, k1, 0, k2, 0, k3]).min() > 0.03


@cache
def profile(name: str) -> export.LensfunProfile:
    return export.lensfun_profile(name)


def at(lens: Lens, focal_mm: float) -> Lens:
    ends = lens.zoom_range_mm
    return lens.at_zoom(float(np.clip(focal_mm, *ends))) if ends else lens


@pytest.mark.parametrize(
    "name",
    [
        "nikon-ai-s-50mm-f1.8",
        "fujifilm-gf-110mm-f2",
        pytest.param("nikon-af-s-70-200mm-f2.8", marks=pytest.mark.slow),
        pytest.param("sigma-17-40mm-f1.8", marks=pytest.mark.slow),
    ],
)
def test_lensfun_corrects_what_rays_show(name: str) -> None:
    """Chief rays in the corrected picture: one scale of the tangent, and colours together."""
    made = profile(name)
    read = lensfun.read(made)
    focal = [one.focal_mm for one in made.geometry]
    stated = dict(zip(focal, (fit.rms for fit in made.distortion), strict=True))
    between = [math.sqrt(a * b) for a, b in itertools.pairwise(focal)]
    for mm in (*focal[::4], *between[::4]):
        lens = at(lenses.load(name), mm)
        bench = set_up(lens, f_stop=max(STOP, lens.first_order().f_number))
        heights, area = (v[1:] for v in made.frame.rings(24))
        shown = heights + channels() @ lateral_colour(bench, heights, [*BANDS_NM]).T
        red, green, blue = read.corrected(shown, mm)
        ideal = distortion(bench, heights).ideal_mm
        ideal *= (area * green * ideal).sum() / (area * ideal**2).sum()
        misses = np.array([green - ideal, red - green, blue - green]) / made.frame.pixel_mm
        distortion_px, red_px, blue_px = np.sqrt((area * misses**2).sum(axis=1))
        assert distortion_px < stated.get(mm, 0.25) + 0.05
        assert max(red_px, blue_px) < 0.1


@pytest.mark.parametrize("name", ["nikon-ai-s-50mm-f1.8", "fujifilm-gf-110mm-f2"])
def test_lensfun_evens_out_the_light(name: str) -> None:
    made = profile(name)
    read = lensfun.read(made)
    heights, area = made.frame.rings(12)
    darkest = 0.0
    for light in made.vignetting[::3]:
        focus_m = light.distance_m if light.distance_m < 1000 else math.inf
        bench = set_up(lenses.load(name), f_stop=light.f_stop, focus_m=focus_m)
        relative = relative_illumination(bench, heights, grid=GRID).relative
        evened = np.log2(relative * read.gain(heights, light))
        assert math.sqrt((area * evened**2).sum()) == pytest.approx(light.fit.rms, abs=0.01)
        darkest = min(darkest, np.log2(relative)[-1])
    assert darkest < -1


def test_a_profile_states_its_residuals(tmp_path: Path, capsys: Any) -> None:
    out = tmp_path / "lens.xml"
    assert main(["export-lens", "tessar-50mm-f2.8", "-o", str(out)]) == 0
    shown = capsys.readouterr().out.splitlines()
    remarks = re.findall(r"<!-- (.*) -->", out.read_text())
    assert shown == remarks
    assert re.fullmatch(r"50 mm: distortion 0\.0\d \(0\.\d\d\) px, red .* px, blue .* px", shown[1])
    assert "no model" not in shown[0]


def test_a_lens_that_no_model_fits_says_so() -> None:
    made = export.lensfun_profile("leica-apo-summicron-m-35mm-f2")
    assert not made.fits
    assert made.residual_px == max(fit.rms for fit in made.distortion) > 0.3
    assert "no model of lensfun fits this lens to 0.3 px" in as_xml(made)


@pytest.mark.slow
def test_four_of_five_lenses_of_the_library_fit() -> None:
    """At the first position of a zoom; fisheyes and the anamorphic lens are refused."""
    fits, refused = [], []
    for name in lenses.names():
        lens = lenses.load(name)
        try:
            fitting._check(lens)
        except InputError:
            refused.append(name)
            continue
        found = traced.geometry(lens, fitting._frame(lens, None))
        fits.append(min(fit.rms for fit in found.distortion.values()) < 0.3)
    assert np.mean(fits) > 0.8
    assert len(refused) == 9


def test_the_frame_is_the_lenses_format_or_as_given() -> None:
    assert profile("fujifilm-gf-110mm-f2").frame == Frame(43.8, 32.9)
    given = export.lensfun_profile("tessar-50mm-f2.8", sensor_size=(24.0, 36.0))
    assert given.frame == FULL


@pytest.mark.parametrize(
    ("text", "frame"),
    [("17.3x13", Frame(17.3, 13.0)), ("35 mm film", FULL), (36, FULL), (None, FULL), ("0x0", FULL)],
)
def test_a_format_that_is_no_size_is_a_remark(text: Any, frame: Frame) -> None:
    """The lens's image circle is that of 36 x 24 mm."""
    data = json.loads((library.FOLDER / "tessar-50mm-f2.8.json").read_text())
    made = fitting._frame(lens_of(data | {"format": text}, "a.json"), None)
    assert (made.long_mm, made.short_mm) == pytest.approx((frame.long_mm, frame.short_mm), rel=1e-3)


@pytest.mark.parametrize(
    ("name", "error"),
    [
        ("canon-ef-15mm-f2.8-fisheye", r"wanted a rectilinear lens, got a fisheye \(equisolid\)"),
        ("schneider-anamorphic-60mm", "wanted an axially symmetric lens"),
    ],
)
def test_a_lens_that_lensfun_cannot_describe_is_an_error(name: str, error: str) -> None:
    with pytest.raises(InputError, match=f": lensfun: {error}$"):
        export.lensfun_profile(name)


def test_a_lens_without_a_focal_length_is_an_error(tmp_path: Path) -> None:
    surface = {"kind": "spherical", "radius": None, "semi_diameter": 10.0}
    plate = tmp_path / "plate.json"
    data = {
        "schema": "daguerre-lens/0.1",
        "name": "plate",
        "surfaces": [
            surface | {"thickness": 5.0, "glass": {"nd": 1.5168, "vd": 64.17}},
            surface | {"thickness": 5.0, "glass": None},
            surface | {"kind": "stop", "thickness": 50.0, "glass": None},
        ],
    }
    plate.write_text(json.dumps(data))
    with pytest.raises(InputError, match="afocal"):
        export.lensfun_profile(plate)


@pytest.mark.parametrize(
    ("flags", "error"),
    [
        ([], "wanted LENS -o FILE.xml, got no -o"),
        (["-o", "lens.json"], "wanted a name ending in .xml, got '.json'"),
        (["-o", "lens.xml", "--sensor", "36"], "--sensor"),
    ],
)
def test_wrong_flags_are_errors(flags: list[str], error: str, capsys: Any) -> None:
    assert main(["export-lens", "tessar-50mm-f2.8", *flags]) == 2
    assert error in capsys.readouterr().err


def test_a_wrong_sensor_is_an_error() -> None:
    with pytest.raises(UsageError, match="sensor_size: wanted width and height above 0"):
        export.lensfun_profile("tessar-50mm-f2.8", sensor_size=(36.0, 0.0))
