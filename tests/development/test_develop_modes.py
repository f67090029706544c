"""Exposure modes in development: the frame's, another one, compensation, old names."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.development import develop
from daguerre.exposure.retaken import retaken
from daguerre.sensors.iso_speed import GREY_LX_S

#: At ISO 200 a value of 1 gives a quarter of the exposure of white.
QUARTER = GREY_LX_S / 0.18 / 200 / 4
FACTS = {"luminance_exposure": QUARTER, "expTime": 0.01, "isoSpeed": 200.0}


def frame(value: float = 0.18, size: int = 1, **metadata: Any) -> dg.Frame:
    rgb = np.full((size, size, 3), value, np.float32)
    return dg.Frame(rgb=rgb, metadata=FACTS | metadata)


def shown(source: Any, **look: Any) -> float:
    """Linear value of the middle of a picture."""
    picture = develop(source, **look)
    return float(picture.linear()[picture.height // 2, picture.width // 2].mean())


@pytest.mark.parametrize(
    ("mode", "gain"), [("light", 1), ("manual", 0.25), ("auto", 0.25), ("P", 0.25), (None, 0.25)]
)
@pytest.mark.parametrize("ev", [0.0, 1.0, -1.5])
def test_a_frame_is_developed_in_its_mode(mode: str | None, gain: float, ev: float) -> None:
    """Display-linear value = g 2^EV H / H0, with the compensation of the frame."""
    one = frame(exposure=mode, exposure_compensation=ev or None)
    assert shown(one) == pytest.approx(0.18 * gain * 2**ev, rel=2e-3)
    assert shown(one, ev=-1) == pytest.approx(0.18 * gain * 2 ** (ev - 1), rel=2e-3)


@pytest.mark.parametrize("own", ["light", "manual", "A", None])
def test_another_mode_can_be_named(own: str | None) -> None:
    one = frame(exposure=own, exposure_compensation=1.0)
    assert shown(one, exposure="light") == pytest.approx(0.36, rel=2e-3)
    assert shown(one, exposure="manual") == pytest.approx(0.09, rel=2e-3)
    assert one.metadata["exposure"] == own


def test_iso_time_and_stop_leave_light_alone() -> None:
    plain = develop(frame(exposure="light")).pixels
    for change in ({"isoSpeed": 6400.0}, {"luminance_exposure": 1e-5}, {"expTime": 1e-6}):
        np.testing.assert_array_equal(develop(frame(exposure="light", **change)).pixels, plain)
    bare = dg.Frame(rgb=frame().rgb, metadata={"exposure": "light"})
    np.testing.assert_array_equal(develop(bare).pixels, plain)


@pytest.mark.parametrize("ev", [0.0, 1.0])
def test_auto_makes_what_the_meter_reads_grey(ev: float) -> None:
    one = frame(0.4, 16, exposure="light", exposure_compensation=-ev or None)
    assert shown(one, exposure="auto", ev=2 * ev) == pytest.approx(0.18 * 2**ev, rel=5e-3)
    shot = retaken(one, "auto", "spot:8,8", 2 * ev)
    iso = shot.frame.metadata["isoSpeed"]
    assert iso == round(GREY_LX_S / (0.4 * QUARTER) * 2**ev)
    assert shot.frame.metadata["exposure_compensation"] is None
    words = f"--exposure manual --iso {iso:g}" + (" --ev 1" if ev else "")
    assert shot.notes[0].endswith(f"the same picture: {words}")
    by_hand = retaken(one, "manual", ev=ev).frame
    by_hand.metadata["isoSpeed"] = iso
    np.testing.assert_array_equal(develop(by_hand).pixels, develop(shot.frame).pixels)


def test_a_spot_is_read_where_it_is() -> None:
    one = frame(0.02, 32, exposure="light")
    one.rgb[20:28, 4:12] = 0.5
    at, away = (retaken(one, "auto", f"spot:{x},24").frame for x in (8, 24))
    assert away.metadata["isoSpeed"] / at.metadata["isoSpeed"] > 10
    for wrong, message in (("spot:40,2", "wanted a point inside"), ("spot:ball", "no nodes")):
        with pytest.raises(dg.UsageError, match=message):
            retaken(one, "auto", wrong)


def test_night_stays_night_and_sensors_have_their_isos() -> None:
    dark = retaken(frame(1e-3, exposure="light"), "auto")
    assert dark.frame.metadata["isoSpeed"] == 6400
    assert "ISO 100 .. 6400 cannot expose this: the picture is" in dark.notes[1]
    assert dark.notes[1].endswith("EV too dark")
    few = dg.sensors.load("ideal").with_(iso_range=(200, 800), base_iso=200)
    assert retaken(frame(1e-3), "auto", sensor=few).frame.metadata["isoSpeed"] == 800
    black = retaken(frame(0.0), "auto", ev=1)
    assert black.notes == ["no light to meter, so the exposure mode is light"]
    assert black.frame.metadata["exposure"] == "light"
    assert black.frame.metadata["exposure_compensation"] == 1


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"exposure": "A"}, "exposure A: the picture is already taken; wanted light, manual or"),
        ({"exposure": "dark"}, "exposure: wanted light, manual"),
        ({"exposure": "auto:spot"}, "exposure: wanted light, manual or auto; got"),
        ({"exposure": ["light"]}, "exposure: wanted a name"),
        ({"exposure": "auto", "meter": "center-ish"}, "meter: wanted centre"),
    ],
)
def test_modes_that_a_taken_picture_cannot_have(wrong: dict[str, Any], message: str) -> None:
    with pytest.raises(dg.UsageError, match=message):
        develop(frame(), **wrong)


def test_a_raw_picture_is_exposed() -> None:
    with pytest.raises(dg.UsageError, match="a raw picture is already exposed"):
        frame(size=32).expose("ideal").develop(exposure="light")


# Sensors ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["ideal", "nikon-d5100", "sony-a7r-ii", "fujifilm-x-t4"])
def test_iso_sets_the_noise_of_light_alone(name: str) -> None:
    """A sensor gets 55.6 / ISO lux s for a value of 1, so that pictures have one brightness."""
    sensor = dg.sensors.load(name)
    low, high = sensor.base_iso, sensor.iso_range[1]
    one = frame(0.3, 64, exposure="light")
    means, noise = [], []
    for iso in (low, min(4 * low, high), min(16 * low, high)):
        raw = one.expose(name, iso, seed=2)
        assert raw.luminance_exposure is not None
        np.testing.assert_allclose(raw.luminance_exposure, 0.3 * GREY_LX_S / 0.18 / iso, rtol=1e-5)
        light = raw.develop().linear()[8:-8, 8:-8]
        means.append(light.mean())
        noise.append(light.std())
    np.testing.assert_allclose(means, 0.3, rtol=0.02)
    assert noise[0] < noise[1] < noise[2]


def test_compensation_of_light_acts_on_a_sensor_once() -> None:
    for ev in (0.0, 1.0):
        one = frame(0.2, 64, exposure="light", exposure_compensation=ev or None)
        raw = one.expose("ideal", 400, seed=1)
        light = raw.develop().linear()[8:-8, 8:-8]
        assert light.mean() == pytest.approx(0.2 * 2**ev, rel=0.01)
    more = dataclasses.replace(one, metadata=one.metadata | {"expTime": 1.0, "aperture": 1.4})
    np.testing.assert_array_equal(more.expose("ideal", 400, seed=1).mosaic, raw.mosaic)


def test_truth_of_light_is_what_the_sensor_receives() -> None:
    """``exposure.Y`` is lux s at the sensor's ISO; ``saturated.*`` follows the same light."""
    one = frame(0.5, 4, exposure="light", exposure_compensation=1.0)
    for iso in (100.0, 1600.0):
        facts = one.exposure_truth("ideal", iso)
        wanted = 0.5 * 2 * GREY_LX_S / 0.18 / iso
        np.testing.assert_allclose(facts["exposure.Y"], wanted, rtol=1e-5)
        raw = one.expose("ideal", iso)
        np.testing.assert_allclose(facts["exposure.Y"], raw.exposure(), rtol=1e-6)
        bright = frame(4.0, 4, exposure="light").exposure_truth("ideal", iso)
        assert all((bright[f"saturated.{name}"] == 1).all() for name in "RGB")
        assert all((facts[f"saturated.{name}"] == 0).all() for name in "RGB")
