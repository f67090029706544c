"""Exposure in lux seconds: of every kind of lens, split from blur, and read back from files."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre import lenses
from daguerre.camera.exposure import ideal_h0
from daguerre.exposure.lux_seconds import luminance_exposure, pinhole_note, with_exposure
from daguerre.frame.frame import Frame
from tests.support.scene import scenes

SIZE = (12, 8)
LENS = "double-gauss-50mm-f2"


def facts(**changes: object) -> dict:
    camera = dg.Camera(**({"focus_distance": 2.0, "shutter_time": 1 / 50} | changes))
    return dg.Session(scenes.furnace(), camera, resolution=SIZE, light_paths="off").metadata


@pytest.mark.parametrize(
    ("camera", "n_eff"),
    [
        ({"f_stop": 4.0, "focus_distance": math.inf}, 4.0),
        ({"f_stop": 4.0, "focus_breathing": True, "focus_distance": 0.1}, 8.0),  # life-size: 2 f
        ({"aperture_diameter": 25.0}, 2.0),
        ({"f_stop": 4.0, "blades": 5}, 4.0),  # of equal area
        ({"lens": "pinhole"}, 8.0),
        ({"lens": "pinhole", "exposure_f_stop": 11.0}, 11.0),
        ({"f_stop": 0.3}, 0.5),  # no lens has more than the half sphere
    ],
)
def test_an_ideal_lens_has_the_sine_condition(camera: dict, n_eff: float) -> None:
    # E = pi L sin^2(theta'), sin(theta') = 1 / (2 N)
    expected = math.pi * math.sin(math.asin(1 / (2 * n_eff))) ** 2
    assert facts(**camera)["h0"] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("model", ["exact", "thick", "thin", "pinhole"])
def test_a_real_lens_has_that_of_its_glass(model: str) -> None:
    stop = {} if model == "pinhole" else {"f_stop": 5.6}
    found = facts(lens=LENS, lens_model=model, focus_distance=math.inf, **stop)
    n = found["camera"]["f_stop"]
    expected = ideal_h0(n) * found["camera"]["transmittance"]
    assert found["h0"] == pytest.approx(expected, rel=0.01)  # corrected for the sine condition


def test_h0_is_the_mean_over_the_exit_pupil() -> None:
    """By brute force: E = integral over the exit pupil of L cos cos / d^2 dA."""
    order = lenses.load(LENS).first_order()
    found = facts(lens=LENS, f_stop=8.0, focus_distance=math.inf)
    radius = order.exit_pupil.diameter / 2 * order.f_number / 8
    away = order.back_focal_point - order.exit_pupil.z
    rng = np.random.default_rng(3)
    rho2 = radius**2 * rng.random(200_000)
    light = (away**2 / (away**2 + rho2) ** 2).mean() * math.pi * radius**2
    assert found["h0"] == pytest.approx(light * found["camera"]["transmittance"], rel=0.01)


def test_the_exposure_triangle() -> None:
    base = luminance_exposure(facts(f_stop=4.0))
    assert base == pytest.approx(ideal_h0(4) / 50, rel=1e-12)
    assert luminance_exposure(facts(f_stop=4.0, shutter_time=1 / 100)) == pytest.approx(base / 2)
    assert luminance_exposure(facts(f_stop=4 * math.sqrt(2))) == pytest.approx(base / 2)
    assert luminance_exposure(facts(f_stop=4.0, iso=800.0)) == base  # H is of the film alone
    assert luminance_exposure(facts(f_stop=4.0, responsivity=0.25)) == pytest.approx(base / 4)


def test_blur_and_light_may_be_split() -> None:
    base = facts(f_stop=4.0)
    light = luminance_exposure(base)
    slow = facts(f_stop=4.0, exposure_time=1 / 25)
    assert luminance_exposure(slow) == pytest.approx(2 * light)
    assert slow["expTime"] == 1 / 25
    assert slow["camera"]["shutter"]["time_s"] == 1 / 50
    deep = facts(f_stop=4.0, exposure_f_stop=8.0)
    assert luminance_exposure(deep) == pytest.approx(light / 4)
    assert (deep["aperture"], deep["camera"]["f_stop"]) == (8.0, 4.0)
    real = [facts(lens=LENS, f_stop=4.0, exposure_f_stop=n) for n in (None, 8.0)]
    assert luminance_exposure(real[1]) == pytest.approx(luminance_exposure(real[0]) / 4)


def test_notes_tell_of_a_split() -> None:
    scene = scenes.furnace()

    def notes(**changes: object) -> str:
        camera = dg.Camera(f_stop=4.0, focus_distance=2.0, shutter_time=0.02, exposure="manual")
        camera = camera.with_(**changes)
        return " ".join(dg.Session(scene, camera, resolution=SIZE, light_paths="off").notes)

    assert not notes()
    assert not notes(exposure_time=0.02, exposure_f_stop=4.0)
    assert "exposure_time sets the brightness (as for 0.5 s)" in notes(exposure_time=0.5)
    assert "brightness (as for f/8); the lens at f/4 sets the blur" in notes(exposure_f_stop=8.0)
    assert not notes(exposure_time=0.5, exposure="light")  # neither sets the brightness


def test_a_pinhole_says_at_which_stop_it_is_exposed() -> None:
    assert "f/8" in (pinhole_note(facts(lens="pinhole")) or "")
    assert pinhole_note(facts(lens="pinhole", exposure_f_stop=16.0)) is None
    assert pinhole_note(facts()) is None


def test_exposure_changes_no_picture() -> None:
    def drawn(**changes: object) -> Frame:
        camera = dg.Camera(focus_distance=2.0, **changes)
        return dg.render(scenes.lamp_room(), camera, resolution=SIZE, spp=1)

    plain = drawn()
    split = drawn(exposure_time=2.0, exposure_f_stop=22.0, responsivity=3.0, white_balance=3200.0,
                  iso=1600.0, exposure_compensation=2.0)  # fmt: skip
    assert np.array_equal(plain.rgb, split.rgb)


@pytest.mark.parametrize("lens", ["thin", "pinhole"])
def test_passes_and_checkpoints_go_on_with_another_exposure(lens: str) -> None:
    def key(**changes: object) -> dict:
        camera = dg.Camera(lens=lens, focus_distance=2.0, shutter_time=0.02).with_(**changes)
        one = dg.Session(scenes.lamp_room(), camera, resolution=SIZE, light_paths="off")
        return one.key

    plain = key()
    for changes in ({"iso": 800.0}, {"exposure_time": 1.0}, {"exposure_f_stop": 16.0},
                    {"exposure_compensation": -1.0}, {"responsivity": 2.0},
                    {"white_balance": 3200.0}):  # fmt: skip
        assert key(**changes) == plain, changes
    assert key(shutter_time=0.01) != plain
    assert lens == "pinhole" or key(f_stop=4.0) != plain


BAD = [
    ({}, "expTime: wanted the exposure time in s, got none"),
    ({"expTime": 0.01}, "aperture: wanted an f-number, got none"),
    ({"expTime": -0.01, "aperture": 4.0}, "expTime: .*, got -0.01"),
    ({"expTime": 0.0, "h0": 0.1}, "expTime: .*, got 0.0; the shutter was frozen"),
    ({"expTime": 0.01, "aperture": math.nan}, "aperture: .*, got nan"),
    ({"expTime": 0.01, "h0": math.inf}, "h0: .*, got inf"),
    ({"luminance_exposure": -1.0}, "luminance_exposure: .*, got -1.0"),
    ({"luminance_exposure": math.nan, "expTime": 0.01}, "luminance_exposure: .*, got nan"),
    ({"expTime": "soon", "aperture": 4.0}, "expTime: .*, got 'soon'"),
]  # fmt: skip


@pytest.mark.parametrize(("metadata", "message"), BAD)
def test_metadata_that_tell_no_exposure(metadata: dict, message: str) -> None:
    with pytest.raises(dg.InputError, match=message):
        luminance_exposure(metadata)


def test_exposure_of_other_programs() -> None:
    by_stop = luminance_exposure({"expTime": 1 / 100, "aperture": 2.0})
    assert by_stop == pytest.approx(math.pi / 16 / 100)
    by_glass = luminance_exposure({"expTime": 1 / 100, "aperture": 2.0, "tStop": 2.2})
    assert by_glass == pytest.approx(math.pi / 4 / 2.2**2 / 100)


def test_a_bracket_is_exposed_by_time() -> None:
    base = facts(f_stop=4.0)
    longer = with_exposure({**base, "exposure": "manual"}, 2.0)
    assert luminance_exposure(longer) == pytest.approx(4 * luminance_exposure(base))
    assert longer["expTime"] == pytest.approx(4 * base["expTime"])
    assert base["expTime"] == 1 / 50


def test_a_bracket_in_light_is_exposed_by_compensation() -> None:
    base = {**facts(f_stop=4.0), "exposure": "light", "exposure_compensation": 0.5}
    longer = with_exposure(base, 2.0)
    assert longer["exposure_compensation"] == 2.5
    assert longer["expTime"] == base["expTime"]
    assert with_exposure(base, -0.5)["exposure_compensation"] is None


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"exposure_time": 0.0}, "exposure_time: wanted a number above 0, got 0.0"),
        ({"exposure_time": math.nan}, "exposure_time"),
        ({"exposure_f_stop": -2.0}, "exposure_f_stop: wanted a number above 0"),
        ({"responsivity": 0.0}, "responsivity"),
        ({"exposure_compensation": math.inf}, "exposure_compensation"),
        ({"white_balance": 900.0}, "camera: white_balance: wanted"),
        ({"white_balance": (0.9, 0.3)}, "camera: white_balance: wanted"),
        ({"white_balance": "sunny"}, "white_balance: wanted"),
    ],
)
def test_parameters_that_no_camera_has(changes: dict, message: str) -> None:
    with pytest.raises(dg.UsageError, match=message):
        facts(**changes)


def test_a_frozen_shutter_has_no_exposure() -> None:
    with pytest.raises(dg.InputError, match="expTime"):
        luminance_exposure(facts(shutter_time=0.0))
    assert luminance_exposure(facts(shutter_time=0.0, exposure_time=0.01)) > 0


def test_a_frame_comes_back_whole(tmp_path: Path) -> None:
    camera = dg.Camera(lens=LENS, f_stop=4.0, focus_distance=5.0, white_balance=(0.3457, 0.3585))
    frame = dg.render(
        scenes.lamp_room(),
        camera,
        resolution=(24, 16),
        crop=(4, 3, 20, 13),
        spp=2,
        aovs=True,
        seed=2**40,
    )
    rng = np.random.default_rng(5)
    frame.channels = rng.random((10, 16, 3), np.float32)
    frame.bands = rng.random((10, 16, 7), np.float32)
    frame.metadata |= {"sensor": "x", "sensor_channels": ["R", "G", "B"], "sensor_from": "channels"}
    frame.save(tmp_path / "a.exr")
    back = dg.load_frame(tmp_path / "a.exr")
    for name in ("rgb", "alpha", "variance", "samples", "channels", "bands"):
        assert np.array_equal(getattr(back, name), getattr(frame, name)), name
    np.testing.assert_allclose(back.xyz, frame.xyz, rtol=1e-4, atol=1e-5)
    assert set(back.aovs) == set(frame.aovs)
    for name, plane in frame.aovs.items():
        assert np.array_equal(back.aovs[name], plane), name
    same = ("seed", "resolution", "crop", "lensModel", "samples", "sensor", "sensor_channels",
            "scene_hash", "sensor_from")  # fmt: skip
    assert {n: back.metadata[n] for n in same} == {n: frame.metadata[n] for n in same}
    assert back.metadata["white_balance"] == [0.3457, 0.3585]
    assert luminance_exposure(back.metadata) == pytest.approx(
        luminance_exposure(frame.metadata), rel=1e-6
    )
    np.testing.assert_allclose(
        back.metadata["worldToNDC"], frame.metadata["worldToNDC"], rtol=1e-6, atol=1e-6
    )
    assert back.metadata["camera"]["f_stop"] == frame.metadata["camera"]["f_stop"]
    back.save(tmp_path / "b.exr")
    again = dg.load_frame(tmp_path / "b.exr")
    assert np.array_equal(again.rgb, frame.rgb)
    assert again.metadata["crop"] == frame.metadata["crop"]


def test_a_frame_of_another_program_has_its_white(tmp_path: Path) -> None:
    import OpenEXR

    ap1 = (0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767)  # ACEScg
    pixels = np.full((2, 3, 3), 0.5, np.float16)
    pixels[0, 0] = (1, 0, 0)
    header = {"chromaticities": ap1, "expTime": 0.5, "compression": OpenEXR.ZIP_COMPRESSION}
    with OpenEXR.File(header, {"RGB": pixels}) as file:
        file.write(str(tmp_path / "other.exr"))
    frame = dg.load_frame(tmp_path / "other.exr")
    np.testing.assert_allclose(frame.rgb[1], 0.5, atol=1e-3)
    # AP1 red in linear Rec.709: ACES 1.3's own matrix, S-2014-004 with Bradford to D65.
    np.testing.assert_allclose(frame.rgb[0, 0], (1.7051, -0.1302, -0.0240), atol=3e-3)
    assert frame.metadata["expTime"] == 0.5


def test_files_that_are_no_frames(tmp_path: Path) -> None:
    (tmp_path / "text.exr").write_text("no picture")
    with pytest.raises(dg.InputError, match=r"text\.exr: format: wanted an OpenEXR file"):
        dg.load_frame(tmp_path / "text.exr")
    with pytest.raises(dg.InputError, match=r"none\.exr: no such file"):
        dg.load_frame(tmp_path / "none.exr")


def test_a_grey_picture_is_read(tmp_path: Path) -> None:
    import OpenEXR

    with OpenEXR.File({}, {"Y": np.full((2, 2), 0.25, np.float32)}) as file:
        file.write(str(tmp_path / "grey.exr"))
    assert dg.load_frame(tmp_path / "grey.exr").rgb.tolist() == [[[0.25] * 3] * 2] * 2
    frame = Frame(np.zeros((2, 2, 3), np.float32), aovs={"q.Z": np.zeros((2, 2), np.float32)})
    replace(frame).save(tmp_path / "plain.exr")
    assert list(dg.load_frame(tmp_path / "plain.exr").aovs) == ["q.Z"]
