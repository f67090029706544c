"""Cameras written as USD: read back equal, and understood by USD's own functions."""

from __future__ import annotations

import math
import random
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.camera import shutter
from daguerre.camera.exposure import PINHOLE_F_STOP
from daguerre.cli import main
from daguerre.errors import UsageError
from daguerre.exposure.lux_seconds import display_gain
from daguerre.files import extras, formats
from daguerre.lenses import library

pytest.importorskip("pxr")

from pxr import Usd, UsdGeom

from tests.importers.usd.conftest import both_sides  # noqa: F401
from tests.importers.usd.stage import again, opened, read

#: Fields that a stage states though a camera may leave them to its defaults.
STATED = {"focal_length": 50.0, "shutter_angle": 180.0}
SINGLE = 3e-7  # relative, of numbers that USD's schema has in single precision


def round_trip(camera: dg.Camera, folder: Path, suffix: str = ".usda", **options: Any) -> dg.Camera:
    path = folder / f"cam{len(list(folder.iterdir()))}{suffix}"  # USD keeps layers by their paths
    dg.export_camera(camera, path, **options)
    (prim,) = opened(path)
    return again(prim, folder)


def numbers_of(value: Any) -> np.ndarray:
    """Numbers of a parameter, in order."""
    if isinstance(value, dg.Projection):
        terms = (*value.parameters, *(0.0,) * (14 - len(value.parameters)))
        return np.array((*value.size, *value.focal, *value.center, *terms))
    return np.asarray(value, np.float64).ravel()


def same(a: dg.Camera, b: dg.Camera, times: tuple[float, ...] = (0.0,)) -> None:
    """Checks that all parameters agree, as closely as single precision has them."""
    assert set(a.motion) == set(b.motion)
    for time in times:
        one, two = a.evaluated_at(time), b.evaluated_at(time)
        for name in dg.Camera.__dataclass_fields__:
            x, y = getattr(one, name), getattr(two, name)
            if name in ("motion", "shutter_time", "shutter_angle", "shutter_offset"):
                continue
            if x is None and name == "focal_length" and one.lens in (None, "thin", "pinhole"):
                x = None if one.projection else STATED[name]
            if isinstance(x, dg.Projection) and not any(x.parameters):
                assert x.model in ("rectilinear", "equidistant") or x.model == y.model
            if isinstance(x, dg.Projection):
                assert (x.model, x.size) == (y.model, y.size)
            if (
                x is None
                and name == "exposure_f_stop"
                and one.exposure == "manual"
                and y is not None
            ):
                x = PINHOLE_F_STOP  # which a stage states
            if x is None or isinstance(x, str | Path | bool | dg.RollingShutter | dg.LensScatter):
                assert y == x, name
                continue
            if name == "shutter_curve" and isinstance(x, tuple):
                assert y == x
                continue
            if name == "sensor_size" and one.projection is not None:
                x, y = x[:1], y[:1]  # the height is that of the calibrated picture
            if name == "shift" and one.projection is not None:
                continue
            if name == "aperture_image":
                np.testing.assert_array_equal(x, y)
                continue
            np.testing.assert_allclose(
                numbers_of(y), numbers_of(x), rtol=SINGLE, atol=SINGLE, err_msg=name
            )
    size = a.projection.size if a.projection else (64, 48)
    assert shutter.shutter_time(b) == pytest.approx(shutter.shutter_time(a), rel=1e-12, abs=1e-15)
    np.testing.assert_allclose(
        shutter.interval(b, 0.5, size), shutter.interval(a, 0.5, size), rtol=1e-12
    )


def any_pose(draw: random.Random) -> np.ndarray:
    eye = tuple(draw.uniform(-20, 20) for _ in range(3))
    return dg.look_at(eye, (0.1, 0.2, 0.3), draw.uniform(-180, 180))


def any_opening(draw: random.Random) -> dict[str, Any]:
    return draw.choice(
        [
            {},
            {"f_stop": draw.uniform(1, 22)},
            {"f_stop": draw.uniform(1, 22), "blades": draw.randrange(3, 12), "blade_rotation": 7.5},
            {"aperture_image": np.tri(5, 7, dtype=np.float32)},
        ]
    )


def any_focus(draw: random.Random) -> dict[str, Any]:
    return draw.choice(
        [
            {},
            {"focus_distance": draw.uniform(0.2, 100)},
            {"focus_distance": math.inf, "focus_from": "sensor"},
            {"focus_at": (12.5, 30.0)},
            {"focus_on": "lamp", "focus_by": "best"},
        ]
    )


def any_shutter(draw: random.Random) -> dict[str, Any]:
    return draw.choice(
        [
            {},
            {"shutter_time": draw.uniform(0, 0.1)},
            {"shutter_angle": draw.uniform(0, 360), "fps": 24000 / 1001},
            {"shutter_time": 0.01, "shutter_offset": draw.uniform(-1, 1), "fps": 30.0},
            {"shutter_time": 0.02, "rolling_shutter": dg.RollingShutter("left", line_time=1.5e-5)},
            {"rolling_shutter": dg.RollingShutter("bottom", readout_time=draw.uniform(0, 0.03))},
            {"shutter_type": "leaf", "shutter_curve": ("trapezoid", 0.7)},
            {"shutter_type": "rotary", "shutter_curve": [(0.0, 0.0), (0.3, 1.0), (1.0, 0.2)]},
            {"shutter_curve": "box"},
        ]
    )


def any_exposure(draw: random.Random) -> dict[str, Any]:
    return draw.choice(
        [
            {},
            {"iso": draw.uniform(50, 6400), "exposure_compensation": draw.uniform(-3, 3)},
            {"exposure_time": draw.uniform(1e-4, 1), "exposure_f_stop": draw.uniform(1, 16)},
            {"responsivity": draw.uniform(0.1, 2), "white_balance": 5600.0},
            {"white_balance": (0.31, 0.33)},
            {"exposure_compensation": -1.25, "iso": 800.0},
        ]
    ) | {"exposure": draw.choice(["light", "manual"])}


def any_calibration(draw: random.Random) -> dict[str, Any]:
    size, focal = (1280, 720), (draw.uniform(600, 900), draw.uniform(600, 900))
    center = (draw.uniform(600, 680), draw.uniform(330, 390))
    k = [draw.uniform(-0.05, 0.05) for _ in range(4)]
    model, pair, terms = draw.choice(
        [
            ("rectilinear", focal, ()),
            ("opencv", focal, (k[0], k[1], k[2] / 50, k[3] / 50)),
            (
                "opencv",
                focal,
                (*k[:2], 1e-3, -1e-3, 0.01, 0.02, 0.01, 1e-3, 1e-3, -1e-3, 5e-4, 0.02),
            ),
            ("opencv", focal, (*k[:2], 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.01, -0.02)),
            ("kannala_brandt", focal, (k[0], k[1] / 10)),
            ("equidistant", focal, ()),
            ("equisolid", focal, ()),
            ("double_sphere", focal, (-0.2, 0.58)),
            ("eucm", focal, (0.6, 1.1)),
            ("omni", focal, (0.9, -0.1, 0.02, 1e-3, -1e-3)),
            ("fov", focal, (0.9,)),
            ("opencv_inverse", focal, (0.1, -0.02, 1e-3, -8e-4, 0.01)),
            ("ftheta", (focal[0], focal[0]), (k[0], k[1], k[2] / 10)),
            ("ftheta", focal, (k[0],)),
        ]
    )
    return {
        "projection": dg.Projection(model, size, pair, center, terms),
        "sensor_size": (draw.uniform(4, 36), 3.0),
    }


def any_lens(draw: random.Random) -> dict[str, Any]:
    kind = draw.randrange(4)
    film = {"sensor_size": (draw.uniform(5, 50), draw.uniform(5, 40))}
    if kind == 0:
        shift = {"shift": (draw.uniform(-5, 5), draw.uniform(-5, 5)), "tilt": (2.0, -3.5)}
        return {"focal_length": draw.uniform(10, 300), **shift, **film, **any_opening(draw)}
    if kind == 1:
        glass = {"lens": "double-gauss-50mm-f2", "degree": 9, "lens_model": "polynomial"}
        return draw.choice(
            [
                {"lens": "double-gauss-50mm-f2", "f_stop": draw.uniform(2, 16), **film},
                {"lens": "double-gauss-50mm-f2", "dispersion": False},
                {**glass, "fit_tolerance": 0.25, "t_stop": draw.uniform(2.5, 16)},
                {
                    **{"lens": "double-gauss-50mm-f2", "cover_glass": (2.0, 1.0, 1.5)},
                    **{"sensor_reflectance": 0.05, "ripple": (2.0, 100.0)},
                    **{"decenter": (((1, 2), (0.1, 0.0), (0.0, 0.2)),)},
                    "scatter": dg.LensScatter(barrel=0.02, gloss_lobe=(0.2, -2.0)),
                },
            ]
        )
    if kind == 2:
        hole = {"lens": "pinhole", "natural_vignetting": True, "sensor_fit": "auto"}
        thin = {"aperture_diameter": draw.uniform(1, 30), "focus_breathing": True}
        return {"focal_length": draw.uniform(10, 90), **draw.choice([hole, thin])}
    return any_calibration(draw) | draw.choice([{}, {"f_stop": draw.uniform(1, 8)}])


@pytest.mark.parametrize("seed", range(120))
def test_any_camera_comes_back_equal(seed: int, tmp_path: Path) -> None:
    draw = random.Random(seed)
    camera = dg.Camera(
        transform=any_pose(draw),
        **any_lens(draw),
        **any_focus(draw),
        **any_shutter(draw),
        **any_exposure(draw),
        near_clip=draw.choice([0.0, draw.uniform(1e-4, 1e4)]),
    )
    made = round_trip(camera, tmp_path, draw.choice([".usda", ".usdc", ".usd"]))
    if camera.f_stop is None and camera.projection is not None:
        assert made.lens is None
    same(camera, made)


def moved(draw: random.Random, low: float, high: float) -> dg.Keys:
    return dg.keys([(t, draw.uniform(low, high)) for t in (0.0, 0.4, 1.0)])


MOVING: dict[str, Any] = {
    "pose": lambda d: {"transform": dg.keys([(t, any_pose(d)) for t in (0.0, 0.7, 1.0)])},
    "slerp": lambda d: {"transform": dg.keys([(t, any_pose(d)) for t in (0.0, 0.5)], "slerp")},
    "film": lambda d: {
        "focal_length": moved(d, 20, 90), "sensor_size": (moved(d, 10, 40), 24.0),
        "shift": (0.0, moved(d, -4, 4)), "f_stop": moved(d, 2, 9), "focus_distance": moved(d, 1, 9),
    },
    "iris": lambda d: {
        "aperture_diameter": moved(d, 2, 20), "blade_rotation": moved(d, 0, 90),
        "blade_curvature": moved(d, 0, 1), "tilt": (moved(d, 0, 5), 1.0),
        "blades": dg.keys([(0.0, 5), (0.5, 7)], "step"),
    },
    "steps": lambda d: {"f_stop": dg.keys([(0.0, 2.8), (0.5, 5.6), (1.0, 8.0)], "step")},
    "opencv": lambda d: {"projection": dg.keys([
        (0.0, dg.Projection("opencv", (640, 480), (500, 510), (320, 240), (0.1,))),
        (1.0, dg.Projection("opencv", (640, 480), (600, 610), (310, 250), (0.1, -0.02)))])},
    "eucm": lambda d: {"projection": dg.keys([
        (0.0, dg.Projection("eucm", (640, 480), (500, 510), (320, 240), (0.5, 1.0))),
        (1.0, dg.Projection("eucm", (640, 480), (600, 610), (310, 250), (0.6, 1.2)))])},
}  # fmt: skip


@pytest.mark.parametrize("kind", MOVING)
def test_values_over_time_come_back_at_every_time(kind: str, tmp_path: Path) -> None:
    draw = random.Random(7)
    camera = dg.Camera(**MOVING[kind](draw))
    made = round_trip(camera, tmp_path)
    times = tuple(
        t for t in np.linspace(-0.1, 1.2, 53) if abs(t - 0.5) > 1e-6 and abs(t - 1) > 1e-6
    )
    same(camera, made, times)


def test_a_spin_needs_times_and_gets_them(tmp_path: Path) -> None:
    pose = dg.look_at((0, 1, 4), (0, 1, 0))
    around = dg.spin((0, 1, 0), 0.5, center=(0, 0, -4), transform=pose)  # in orbit
    camera = dg.Camera(transform=around)
    with pytest.raises(dg.UsageError, match="times"):
        dg.export_camera(camera, tmp_path / "a.usda")
    assert list(tmp_path.iterdir()) == []
    made = round_trip(camera, tmp_path, times=(0.0, 2.0))
    for t in np.linspace(0, 2, 37):
        np.testing.assert_allclose(
            made.evaluated_at(t).transform, camera.evaluated_at(t).transform, atol=2e-5
        )


def test_usd_itself_sees_the_camera(tmp_path: Path) -> None:
    """Frustum, focus and exposure by USD's own functions, in a stage that says its units."""
    camera = dg.Camera(
        transform=dg.look_at((1, 2, 3), (0, 0, 0)), focal_length=35, shift=(4, -2), f_stop=4,
        focus_distance=2.5, iso=400, exposure_time=0.01, exposure_f_stop=5.6,
        exposure_compensation=1, shutter_time=0.5 / 24,
    )  # fmt: skip
    dg.export_camera({"main camera": camera, "main_camera": camera}, tmp_path / "a.usda")
    stage = Usd.Stage.Open(str(tmp_path / "a.usda"))
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1
    assert UsdGeom.GetStageUpAxis(stage) == "Y"
    assert stage.GetTimeCodesPerSecond() == 24
    first, _ = opened(tmp_path / "a.usda")
    assert [str(p.GetPath()) for p in opened(tmp_path / "a.usda")] == [
        "/World/main_camera", "/World/main_camera_2",
    ]  # fmt: skip
    usd = UsdGeom.Camera(first)
    window = usd.GetCamera(0).frustum.window
    np.testing.assert_allclose(window.GetMin(), (-14 / 35, -14 / 35), rtol=1e-6)
    np.testing.assert_allclose(window.GetMax(), (22 / 35, 10 / 35), rtol=1e-6)
    assert usd.GetCamera(0).focusDistance == 2.5
    scale = usd.ComputeLinearExposureScale(Usd.TimeCode.Default())
    assert scale == pytest.approx(2, rel=1e-6)  # in light the EV alone
    assert (usd.GetShutterOpenAttr().Get(), usd.GetShutterCloseAttr().Get()) == (-0.25, 0.25)
    assert usd.GetClippingRangeAttr().Get()[0] < 0.01  # its default hides the nearest metre
    assert read(first, metres=1.0).near_clip == 0
    dg.export_camera(camera.with_(near_clip=0.25), tmp_path / "b.usda")
    (second,) = opened(tmp_path / "b.usda")
    assert tuple(UsdGeom.Camera(second).GetClippingRangeAttr().Get()) == (0.25, 1e6)
    assert not second.GetAttribute("daguerre:nearClip")
    assert read(second, metres=1.0).near_clip == 0.25


BRIGHT: dict[str, dict[str, Any]] = {
    "light": {"iso": 400, "exposure_time": 0.01, "exposure_f_stop": 5.6},
    "EV": {"exposure_compensation": -1.5, "responsivity": 0.5},
    "manual": {"exposure": "manual", "f_stop": 4, "shutter_time": 0.02, "iso": 400},
    "usual": {"exposure": "manual"},
    "split": {
        **{"exposure": "manual", "f_stop": 4, "iso": 50, "exposure_compensation": 1},
        **{"exposure_time": 0.5, "exposure_f_stop": 1.4, "responsivity": 0.3},
    },
    "pinhole": {"exposure": "manual", "lens": "pinhole", "shutter_angle": 90},
    "diameter": {"exposure": "manual", "aperture_diameter": 12.5, "focal_length": 35},
    "fisheye": {
        **{"exposure": "manual", "f_stop": 2.8, "shutter_time": 0.01},
        "projection": dg.Projection("equidistant", (640, 480), (300, 300), (320, 240)),
    },
}


def gain_of(camera: dg.Camera) -> float:
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    placed = camera.with_(focus_distance=None if camera.projection else 3.0)
    return display_gain(dg.render(scene, placed, resolution=(4, 3), spp=1).metadata)


@pytest.mark.parametrize("name", BRIGHT)
def test_usd_shows_an_ideal_lens_as_bright_as_we_do(name: str, tmp_path: Path) -> None:
    """By its own scale; and the camera comes back with its numbers and its brightness."""
    camera = dg.Camera(**BRIGHT[name])
    dg.export_camera(camera, tmp_path / "a.usda")
    (prim,) = opened(tmp_path / "a.usda")
    scale = UsdGeom.Camera(prim).ComputeLinearExposureScale(Usd.TimeCode.Default())
    assert scale == pytest.approx(gain_of(camera), rel=5e-7)
    ours = prim.GetAttribute("daguerre:exposure:iso")  # where USD's would change its brightness
    assert bool(ours) == (camera.exposure == "light" and camera.iso != 100)
    made = again(prim, tmp_path)
    assert gain_of(made) == pytest.approx(gain_of(camera), rel=5e-7)
    same(camera, made)
    assert (made.iso, made.responsivity) == (camera.iso, camera.responsivity)


@pytest.mark.parametrize("mode", ["auto", "A", "S", "P"])
def test_a_mode_that_chooses_comes_back(mode: str, tmp_path: Path) -> None:
    held = {"A": {"iso": 400.0, "f_stop": 4.0}, "S": {"shutter_time": 0.01}}.get(mode, {})
    camera = dg.Camera(exposure=mode, meter="highlight", exposure_compensation=1.0, **held)
    dg.export_camera(camera, tmp_path / "a.usda")
    (prim,) = opened(tmp_path / "a.usda")
    assert UsdGeom.Camera(prim).ComputeLinearExposureScale(Usd.TimeCode.Default()) == 2
    if mode in ("auto", "S"):
        same(camera, again(prim, tmp_path))


def test_a_lens_slower_than_the_usual_stop_keeps_its_brightness(tmp_path: Path) -> None:
    slow = next(
        entry.name
        for entry in library.entries()
        if dg.lenses.load(entry.name).first_order().f_number > 6
    )
    camera = dg.Camera(lens=slow, exposure="manual", focus_distance=3.0)
    dg.export_camera(camera, tmp_path / "a.usda")
    (prim,) = opened(tmp_path / "a.usda")
    widest = dg.lenses.load(slow).first_order().f_number
    assert prim.GetAttribute("exposure:fStop").Get() == pytest.approx(widest, rel=SINGLE)
    made = again(prim, tmp_path)
    assert (made.exposure_f_stop, made.f_stop) == (None, None)


def test_exposure_over_time_comes_back(tmp_path: Path) -> None:
    camera = dg.Camera(
        exposure="manual",
        f_stop=dg.keys([(0.0, 2.0), (1.0, 8.0)]),
        iso=dg.keys([(0.0, 100.0), (0.5, 400.0)]),
        responsivity=dg.keys([(0.0, 1.0), (1.0, 0.5)]),
        exposure_compensation=dg.keys([(0.0, 0.0), (1.0, 2.0)]),
    )
    same(camera, round_trip(camera, tmp_path), (0.0, 0.2, 0.5, 0.8, 1.0))


def test_isaac_sims_names_are_written(tmp_path: Path) -> None:
    """Attributes and schemas as its own importers write them."""
    terms = (-0.1, 0.05, 1e-3, -2e-3, 0.01)
    projection = dg.Projection("opencv", (1920, 1200), (958.8, 956.7), (957.3, 589.0), terms)
    rolling = dg.RollingShutter("top", line_time=1 / 64000)
    camera = dg.Camera(projection=projection, shutter_time=0.01, rolling_shutter=rolling)
    dg.export_camera(camera, tmp_path / "a.usda")
    (prim,) = opened(tmp_path / "a.usda")
    listed = prim.GetMetadata("apiSchemas").GetAddedOrExplicitItems()
    assert set(listed) == {"OmniLensDistortionOpenCvPinholeAPI", "OmniRtxRollingShutterAPI"}
    stem = "omni:lensdistortion:opencvPinhole:"
    wanted = {
        "omni:lensdistortion:model": "opencvPinhole", stem + "imageSize": (1920, 1200),
        stem + "fx": 958.8, stem + "fy": 956.7, stem + "cx": 957.8, stem + "cy": 589.5,
        stem + "k1": -0.1, stem + "k2": 0.05, stem + "p1": 1e-3, stem + "p2": -2e-3,
        stem + "k3": 0.01, stem + "s4": 0.0,
        "omni:rtx:rollingShutter:scanOrder": "topToBottom",
        "omni:rtx:rollingShutter:lineOffset": (1, 64000),
        "omni:rtx:rollingShutter:lineExposure": (1, 100),
    }  # fmt: skip
    for name, value in wanted.items():
        got = prim.GetAttribute(name).Get()
        assert got == value if isinstance(value, str) else got == pytest.approx(value, rel=1e-6), (
            name
        )


def test_lens_files_stand_beside_the_stage(tmp_path: Path) -> None:
    from daguerre.lenses import load
    from daguerre.lenses.library import FOLDER

    source = (FOLDER / "double-gauss-50mm-f2.json").read_bytes()
    (tmp_path / "lens.json").write_bytes(source)
    made = round_trip(dg.Camera(lens=str(tmp_path / "lens.json")), tmp_path)
    assert Path(str(made.lens)).resolve() == tmp_path / "lens.json"
    (tmp_path / "deep").mkdir()
    with pytest.raises(dg.UsageError, match="folder of the stage"):
        dg.export_camera(dg.Camera(lens=str(tmp_path / "lens.json")), tmp_path / "deep/a.usda")
    library = load("double-gauss-50mm-f2")
    assert round_trip(dg.Camera(lens=library), tmp_path).lens == "double-gauss-50mm-f2"
    mine = library.rebuilt(library.surfaces, name="mine")
    with pytest.raises(dg.UsageError, match=r"lens: wanted .*got 'mine' in memory"):
        dg.export_camera(dg.Camera(lens=mine), tmp_path / "a.usda")


def test_sensors_are_named(tmp_path: Path) -> None:
    from daguerre.sensors import load

    made = round_trip(dg.Camera(sensor="sony-a7r-ii"), tmp_path)
    assert made.sensor == "sony-a7r-ii"
    assert made.sensor_size == pytest.approx(load("sony-a7r-ii").size)
    assert round_trip(dg.Camera(sensor=load("sony-a7r-ii")), tmp_path).sensor == "sony-a7r-ii"


def test_bad_arguments(tmp_path: Path) -> None:
    with pytest.raises(dg.UsageError, match="camera: no camera given"):
        dg.export_camera({}, tmp_path / "a.usda")
    with pytest.raises(dg.UsageError, match="begin before end"):
        dg.export_camera(dg.Camera(), tmp_path / "a.usda", times=(1, 0))
    with pytest.raises(dg.UsageError, match=r"\.usda, \.usdc or \.usd"):
        dg.export_camera(dg.Camera(), tmp_path / "a.fbx")
    with pytest.raises(dg.UsageError, match="f_stop"):
        dg.export_camera(dg.Camera(f_stop=-1), tmp_path / "a.usda")
    with pytest.raises(dg.OutputError, match="no such folder"):
        dg.export_camera(dg.Camera(), tmp_path / "none/a.usda")
    assert list(tmp_path.iterdir()) == []


def test_without_usd_one_error_says_how_to_install_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(formats, "find_spec", lambda name: None)
    with pytest.raises(dg.UsageError, match=re.escape(extras.hint("pxr"))):
        dg.export_camera(dg.Camera(), tmp_path / "a.usda")


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = tmp_path / "chart.glb"
    dg.charts.make("slanted-edge").save(scene)
    out = tmp_path / "cam.usda"
    words = ["export-camera", str(scene), "-o", str(out), "--lens", "double-gauss-50mm-f2"]
    assert main([*words, "--f-stop", "2.8", "--focus", "1.5"]) == 0
    (prim,) = opened(out)
    made = again(prim, tmp_path)
    assert (made.lens, made.f_stop) == ("double-gauss-50mm-f2", 2.8)
    there = dg.load(scene).camera().transform
    np.testing.assert_allclose(made.transform, there, atol=1e-9)
    assert main([*words, "-c", "nobody"]) == 3
    assert main(["export-camera", str(scene)]) == 2
    assert main(["export-camera", str(scene), "-o", str(tmp_path / "cam.obj")]) == 2
    assert main([*words, "--times", "2"]) == 2
    assert "Traceback" not in capsys.readouterr().err


def test_cameras_of_a_stage_leave_as_its_flags_say(tmp_path: Path, capsys: Any) -> None:
    stage = tmp_path / "shot.usda"
    stage.write_text(
        """#usda 1.0
        ( metersPerUnit = 1
          timeCodesPerSecond = 24 )
        def Xform "Rig" ( variants = { string lens = "long" }
                          prepend variantSets = "lens" ) {
            variantSet "lens" = {
                "long" {
                    def Camera "Cam" { 
                        float focalLength = 85
                        float horizontalAperture = 36
                    }
                }
                "wide" {
                    def Camera "Cam" {
                        float focalLength = 24
                        float horizontalAperture = 36
                        float exposure:iso.timeSamples = { 0: 100, 24: 400 }
                        double daguerre:sensor:whiteBalance.timeSamples = { 0: 3200, 24: 5600 }
                    }
                }
            }
        }"""
    )
    out = tmp_path / "cam.usda"
    words = ["export-camera", str(stage), "-o", str(out), "--camera-units", "mm"]
    assert main([*words, "--variant", "/Rig:lens=wide", "--time-code", "24"]) == 0
    (prim,) = opened(out)
    made = again(prim, tmp_path)
    assert made.focal_length == pytest.approx(24, rel=1e-6)
    assert made.sensor_size[0] == pytest.approx(36, rel=1e-6)
    assert made.evaluated_at(1.0).iso == 400
    assert made.white_balance == 5600  # it takes no keys, which is a note
    assert main([*words, "--variant", "/Rig:lens=wide", "--strict"]) == 3
    assert main([*words, "--time", "1", "--time-code", "24"]) == 2
    assert "Traceback" not in capsys.readouterr().err


@pytest.mark.parametrize("bad", [{"a": 1}, {1: dg.Camera()}, {"a": None}])
def test_what_is_no_camera_is_one_error(bad: Any, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="wanted cameras by name, got"):
        dg.export_camera(bad, tmp_path / "cam.usda")
