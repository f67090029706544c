"""Quantities as people type them, and the photographer's formulas."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from daguerre import units as q
from daguerre.camera.camera import Camera
from daguerre.errors import UsageError
from daguerre.setup import camera_facts as info

GOOD: list[tuple[Callable[[str, str], object], str, object]] = [
    (q.length_mm, "50", 50.0),
    (q.length_mm, "50mm", 50.0),
    (q.length_mm, "5cm", 50.0),
    (q.length_mm, "2in", 50.8),
    (q.length_mm, "0.05 m", 50.0),
    (q.distance_m, "2.5", 2.5),
    (q.distance_m, "250cm", 2.5),
    (q.distance_m, "8ft", 2.4384),
    (q.distance_m, "inf", math.inf),
    (q.time_s, "1/48", 1 / 48),
    (q.time_s, "16.6ms", 0.0166),
    (q.time_s, "1/8000s", 1 / 8000),
    (q.time_s, "2min", 120.0),
    (q.angle_deg, "30", 30.0),
    (q.angle_deg, "-30deg", -30.0),
    (q.f_number, "2.8", 2.8),
    (q.f_number, "f/2.8", 2.8),
    (q.f_number, "f2", 2.0),
    (q.sensor_mm, "36x24", (36.0, 24.0)),
    (q.sensor_mm, "FF", (36.0, 24.0)),
    (q.sensor_mm, "s35", (24.89, 18.66)),
    (q.sensor_mm, "1inch", (13.2, 8.8)),
    (q.sample_range, "32:64", (32, 64)),
    (lambda f, t: q.resolution(f, t, (960, 540)), "1280x720", (1280, 720)),
    (lambda f, t: q.resolution(f, t, (960, 540)), "50%", (480, 270)),
    (lambda f, t: q.numbers(f, t, 2, "1,2"), "-1,2.5e1", (-1.0, 25.0)),
]

BAD: list[tuple[Callable[[str, str], object], str]] = [
    (q.length_mm, "fifty"),
    (q.length_mm, "50 kg"),
    (q.length_mm, ""),
    (q.distance_m, "1/0"),
    (q.distance_m, "nan"),
    (q.time_s, "inf"),
    (q.time_s, "1/2/3"),
    (q.f_number, "t2"),
    (q.sensor_mm, "36"),
    (q.sensor_mm, "36x"),
    (q.sensor_mm, "0x24"),
    (q.sensor_mm, "apcs"),
    (q.sample_range, "5"),
    (q.sample_range, "5:4"),
    (q.sample_range, "-1:4"),
    (lambda f, t: q.resolution(f, t, (960, 540)), "0%"),
    (lambda f, t: q.resolution(f, t, (960, 540)), "1e3x5"),
    (q.t_number, "f/2"),
    (q.white, "warm"),
    (q.white, "5600m"),
    (q.white, "0.3,0.3,0.3"),
    (q.decenter, "3-5"),
    (q.decenter, "3-5:1"),
    (q.decenter, "3-5:1,2,3"),
    (q.decenter, "-1:1,2"),
    (q.decenter, "2-3:inf,0"),
    (lambda f, t: q.integers(f, t, 4, "1,2,3,4"), "1,2,3"),
    (lambda f, t: q.integers(f, t, 4, "1,2,3,4"), "1,2,3,4.5"),
    (lambda f, t: q.numbers(f, t, 2, "1,2"), "inf,1"),
]


@pytest.mark.parametrize(("parse", "text", "value"), GOOD)
def test_good(parse: Callable[[str, str], object], text: str, value: object) -> None:
    assert parse("--flag", text) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(("parse", "text"), BAD)
def test_bad_names_flag_and_value(parse: Callable[[str, str], object], text: str) -> None:
    with pytest.raises(UsageError) as caught:
        parse("--flag", text)
    assert "--flag" in str(caught.value)
    assert repr(text) in str(caught.value) or text.split(",")[-1] in str(caught.value)


def test_milliseconds_are_the_nearest_float() -> None:
    assert q.time_s("--shutter", "16.6ms") == 0.0166


def test_hyperfocal_distance_of_the_textbook() -> None:
    # Ray, Applied Photographic Optics, ch. 22: f = 50 mm, N = 8, c = 0.03 mm gives 10.4 m.
    hyper = info.hyperfocal_m(50, 8, 0.03)
    assert hyper == pytest.approx(10.4667, abs=1e-4)
    # Focused there, half of it to infinity is sharp.
    near, far = info.depth_of_field_m(50, 8, 0.03, hyper)
    assert near == pytest.approx(hyper / 2, rel=1e-9)
    assert math.isinf(far)
    assert info.depth_of_field_m(50, 8, 0.03, math.inf) == (hyper - 0.05, math.inf)


def test_depth_of_field_limits_have_the_allowed_blur() -> None:
    f, n, c, s = 50.0, 2.0, 0.0288, 1.5
    for limit in info.depth_of_field_m(f, n, c, s):
        # Thin lens: image distances by 1/f = 1/s + 1/s', blur by similar triangles of the pupil.
        sharp, other = (f * 1e3 * d / (1e3 * d - f) for d in (s, limit))
        blur = f / n * abs(sharp - other) / other
        assert blur == pytest.approx(c, rel=1e-9)


def test_field_of_view() -> None:
    assert info.field_of_view_deg(50, (36, 24)) == pytest.approx(
        (39.5978, 26.9915, 46.7930), abs=1e-3
    )


def test_suspicious_units_are_named() -> None:
    assert info.camera_warnings(Camera()) == []
    assert "1.8e+03" not in info.camera_warnings(Camera(focal_length=2800.0))[0]
    assert "2.8 m" in info.camera_warnings(Camera(focal_length=2800.0))[0]
    assert "0.036 mm" in info.camera_warnings(Camera(sensor_size=(0.036, 0.024)))[0]
    assert info.camera_warnings(Camera(focal_length=0.5))
