"""Metering: what each way takes for grey, in cd/m2, EV and ISO."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.camera.exposure import ideal_h0
from daguerre.exposure.metering import K, meter
from daguerre.frame.frame import Frame

FACTS = {"expTime": 1 / 100, "aperture": 4.0, "h0": ideal_h0(4.0)}


def frame(y: np.ndarray, **facts: Any) -> Frame:
    xyz = np.zeros((*y.shape, 3), np.float32)
    xyz[..., 1] = y
    return Frame(np.zeros_like(xyz), xyz=xyz, metadata={**FACTS, **facts})


def circle(diameter: float, shape: tuple[int, int] = (240, 360)) -> np.ndarray:
    """Inside of a circle in the middle."""
    rows, columns = np.mgrid[: shape[0], : shape[1]] + 0.5
    return np.hypot(rows - shape[0] / 2, columns - shape[1] / 2) < diameter / 2


@pytest.mark.parametrize("mode", ["centre", "center", "spot", "matrix"])
def test_even_light_is_itself(mode: str) -> None:
    read = meter(frame(np.full((60, 90), 50.0)), mode)
    assert read.luminance == pytest.approx(50)
    assert read.ev100 == pytest.approx(math.log2(50 * 100 / 12.5))  # N^2 / t = L S / K
    # The ISO that ISO 2720's equation has for K, at f/4 and 1/100 s: within 2 %.
    assert read.iso == pytest.approx(K * 16 * 100 / 50, rel=0.02)
    assert read.iso == pytest.approx(10 / (50 * ideal_h0(4.0) / 100))


def test_iso_goes_with_time_and_stop() -> None:
    y = np.full((20, 30), 8.0)
    base = meter(frame(y)).iso
    assert meter(frame(y, expTime=1 / 200)).iso == pytest.approx(2 * base)
    assert meter(frame(y, h0=ideal_h0(8.0))).iso == pytest.approx(4 * base)
    assert meter(frame(2 * y)).iso == pytest.approx(base / 2)


def test_centre_has_three_quarters_in_the_middle() -> None:
    inside = circle(120)  # half the height
    assert meter(frame(1.0 * inside), "centre").luminance == pytest.approx(0.75, abs=0.005)
    assert meter(frame(1.0 * ~inside), "centre").luminance == pytest.approx(0.25, abs=0.005)


def test_spot_is_a_fortieth_of_the_area_where_it_is_put() -> None:
    diameter = 2 * math.sqrt(0.025 * 240 * 360 / math.pi)
    assert meter(frame(1.0 + circle(diameter + 3)), "spot").luminance == pytest.approx(2)
    outside = frame(1.0 + ~circle(diameter - 3))
    assert meter(outside, "spot").luminance < 1.15
    assert meter(outside, "spot", at=(40, 40)).luminance == pytest.approx(2)
    tiny = frame(np.ones((1, 1)))
    assert meter(tiny, "spot").luminance == 1


def test_spot_of_a_crop_is_that_of_the_frame() -> None:
    whole = np.random.default_rng(2).random((120, 180))
    place = {"resolution": (180, 120), "crop": (60, 30, 130, 100)}
    part = frame(whole[30:100, 60:130], **place)
    for at in (None, (80.0, 70.0)):
        expected = meter(frame(whole), "spot", at=at).luminance
        assert meter(part, "spot", at=at).luminance == pytest.approx(expected)
    with pytest.raises(
        dg.UsageError, match=r"meter: spot at \(10.0, 10.0\): wanted a point inside"
    ):
        meter(part, "spot", at=(10, 10))


def test_matrix_thinks_in_stops_and_sees_highlights() -> None:
    half = np.where(np.arange(90) < 45, 1.0, 4.0) * np.ones((63, 1))
    dull = meter(frame(half), "matrix").luminance
    assert 1.7 < dull < 2.3  # the mean of the stops
    window = np.full((63, 90), 1.0)
    window[:9, :10] = 1000.0  # one zone of 63
    bright = meter(frame(window), "matrix").luminance
    plain = 1000 ** (1 / 63)  # of even zones
    assert 1.5 * plain < bright < 2 * plain * 1.02  # a stop, no more
    assert meter(frame(window), "centre").luminance > 2 * bright
    dark = np.zeros((63, 90))
    dark[20:43, 30:60] = 3.0
    assert meter(frame(dark), "matrix").luminance > 0.02


def test_matrix_follows_the_focus() -> None:
    y = np.where(np.arange(90) < 45, 1.0, 4.0) * np.ones((63, 1))
    left, right = (meter(frame(y), "matrix", at=(x, 31.5)).luminance for x in (20, 70))
    assert left < 0.9 * right


def test_fireflies_of_no_number_are_left_out() -> None:
    y = np.full((20, 30), 3.0)
    y[10, 15], y[0, 0] = np.nan, -5.0
    assert meter(frame(y), "centre").luminance == pytest.approx(3.0, rel=0.02)
    plain = Frame(np.full((4, 4, 3), 0.5, np.float32), metadata=dict(FACTS))
    assert meter(plain).luminance == pytest.approx(0.5, rel=1e-4)


def test_what_cannot_be_metered() -> None:
    with pytest.raises(
        dg.UsageError, match=r"meter: wanted centre, spot, matrix, highlight, got 'spto'.*spot"
    ):
        meter(frame(np.ones((4, 4))), "spto")
    for mode in ("centre", "spot", "matrix", "highlight"):
        with pytest.raises(dg.InputError, match=f"meter: {mode}: the metered area is black"):
            meter(frame(np.zeros((4, 4))), mode)
    with pytest.raises(dg.InputError, match="expTime"):
        meter(Frame(np.ones((4, 4, 3), np.float32)))


def test_a_grey_world_metered_through_glass_is_middle_grey() -> None:
    """End to end: the ISO that is read makes what was metered 0.18."""
    scene = dg.Scene()
    scene.set_environment(color=(300.0, 300.0, 300.0))
    eye = dg.Camera(lens="double-gauss-50mm-f2", f_stop=5.6, focus_distance=5.0, shutter_time=0.002)
    eye = eye.with_(exposure="manual")
    drawn = dg.render(scene, eye, resolution=(30, 20), spp=16)
    read = meter(drawn, "spot")
    assert read.luminance == pytest.approx(300, rel=0.03)
    from daguerre.development import develop

    shot = Frame(drawn.rgb, drawn.xyz, metadata={**drawn.metadata, "isoSpeed": read.iso})
    linear = develop(shot).linear()
    assert linear[10, 15].mean() == pytest.approx(0.18, rel=0.03)
