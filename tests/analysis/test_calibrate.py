"""Calibration of lenses by their chief rays: projections that say where lenses put things."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.analysis.calibrate import calibrate_all, directions_seen, fit_projection
from daguerre.analysis.chief import chief_rays
from daguerre.cli import main
from daguerre.errors import InputError, UsageError

SIZE = (640, 480)
GAUSS, FISHEYE = "double-gauss-50mm-f2", "fisheye-16mm-f2.8"
NIKKOR = "nikon-28mm-f2.8"


@pytest.mark.parametrize(
    ("model", "parameters"),
    [
        ("rectilinear", ()),
        ("equisolid", ()),
        ("opencv", (-0.2, 0.08, 1e-3, -8e-4, -0.01)),
        ("opencv", (-0.28, 0.09, 1e-3, -2e-3, -0.01, 0.02, 0.01, 1e-3)),
        ("kannala_brandt", (0.01, -0.003, 1e-3, -2e-4)),
        ("double_sphere", (-0.2, 0.58)),
        ("eucm", (0.6, 1.1)),
        ("omni", (0.9, -0.1, 0.02, 1e-3, -1e-3)),
        ("fov", (0.9,)),
        ("opencv_inverse", (0.1, -0.02, 1e-3, -8e-4, 0.01)),
        ("ftheta", (0.02, -0.05, 0.01, 1e-3)),
    ],
)
def test_a_model_is_found_by_its_own_rays(model: str, parameters: tuple[float, ...]) -> None:
    truth = dg.Projection(model, SIZE, (420.0, 417.0), (331.3, 236.8), parameters)
    x, y = np.meshgrid(np.linspace(0, 639, 21), np.linspace(0, 479, 16))
    pixels = np.stack([x, y], axis=-1).reshape(-1, 2)
    made = fit_projection(model, SIZE, pixels, truth.unproject(pixels), len(parameters))
    np.testing.assert_allclose(made.project(truth.unproject(pixels)), pixels, atol=1e-9)
    np.testing.assert_allclose(made.focal, truth.focal, rtol=1e-8)
    np.testing.assert_allclose(made.center, truth.center, atol=1e-5)


@pytest.mark.parametrize(
    ("lens", "model", "focus", "bound"),
    [
        (GAUSS, "opencv", 2.0, 0.001),
        (GAUSS, "opencv", np.inf, 0.001),
        (FISHEYE, "fisheye", 1.0, 0.04),
        (FISHEYE, "fisheye", np.inf, 0.04),
        ("nikon-28mm-f2.8", "opencv", 5.0, 0.07),
    ],
)
def test_models_fit_lenses(lens: str, model: str, focus: float, bound: float) -> None:
    fit = dg.calibrate(lens, model, resolution=(1920, 1280), f_stop=8, focus_distance=focus)
    assert fit.largest < bound
    # A lens that is the same on all sides has its axis in the middle, and one focal length.
    np.testing.assert_allclose(fit.projection.center, (959.5, 639.5), atol=1e-6)
    assert fit.projection.focal[0] == pytest.approx(fit.projection.focal[1], rel=1e-5)


def test_focal_lengths_are_those_of_the_lens() -> None:
    """Far away, the pinhole's of the paraxial focal length; near, the image distance's."""
    pitch = 36 / 1920
    far = dg.calibrate(GAUSS, resolution=(1920, 1280))
    assert far.projection.focal[0] * pitch == pytest.approx(far.bench.order.efl, rel=2e-5)
    near = dg.calibrate(GAUSS, resolution=(1920, 1280), focus_distance=0.8)
    # Image size is magnification times object size, which the pupil sees at the focus distance.
    wanted = -near.bench.magnification * near.bench.focus_mm
    assert near.projection.focal[0] * pitch == pytest.approx(wanted, rel=2e-5)


def test_a_zoom_has_the_focal_length_that_it_is_set_to() -> None:
    fit = dg.calibrate("nikon-ai-25-50mm-f4", resolution=(1920, 1280), focal_length=35.0)
    assert fit.projection.focal[0] * 36 / 1920 == pytest.approx(35.0, rel=1e-4)


def test_wavelengths_differ_by_the_lateral_colour_of_the_bench() -> None:
    blue, red = (
        dg.calibrate(NIKKOR, "fisheye", resolution=(1920, 1280), wavelength_nm=nm)
        for nm in (486.13, 656.27)
    )
    # Chief rays of the design wavelength in the middle of the field, and where others put them.
    (angle,) = chief_rays(blue.bench, [[-15.0, 0.0]]).angles
    seen = np.array([[np.sin(angle), 0, np.cos(angle)]])
    ((x, _),) = blue.projection.project(seen) - red.projection.project(seen)
    heights = np.linspace(14.95, 15.05, 11)
    film = np.column_stack([-heights, np.zeros(11)])
    at = [
        np.interp(angle, chief_rays(blue.bench, film, nm).angles, heights)
        for nm in (486.13, 656.27)
    ]
    wanted = (at[0] - at[1]) * 1920 / 36
    assert abs(wanted) > 0.1
    assert x == pytest.approx(wanted, abs=2e-3)


@pytest.mark.parametrize(
    ("lens", "model", "focus", "angle"),
    [(GAUSS, "opencv", 1.0, 18.0), (FISHEYE, "fisheye", 2.0, 70.0)],
)
def test_rendered_lamps_land_where_the_projection_says(
    lens: str, model: str, focus: float, angle: float
) -> None:
    """Through the exact lens, at f/16, so that the spot is next to the chief ray: 0.1 px."""
    size, f_stop = (1200, 800), 16.0
    middle = 559.0  # nm, of daylight as the eye has it: at 588 nm a fisheye is 0.1 px off
    options = {"f_stop": f_stop, "focus_distance": focus}
    fit = dg.calibrate(lens, model, resolution=size, wavelength_nm=middle, **options)
    camera = dg.Camera(lens=lens, lens_model="exact", f_stop=f_stop, focus_distance=focus)
    for turn in (0.5, 3.5):  # a mirrored picture would show
        a = np.radians(angle)
        point = np.array([np.sin(a) * np.cos(turn), np.sin(a) * np.sin(turn), np.cos(a)])
        point *= focus / (1 if model == "fisheye" else point[2])
        scene, place = dg.Scene(), np.eye(4)
        place[:3, 3] = point * (1, -1, -1)
        scene.add_light(dg.SphereLight((1e5, 1e5, 1e5), 2e-3 * focus), place)
        wanted = fit.projection.project(point[None])[0]
        x, y = np.round(wanted).astype(int)
        crop = (x - 9, y - 9, x + 10, y + 10)
        frame = dg.render(scene, camera, resolution=size, crop=crop, spp=256, filter="box")
        light = np.maximum(frame.xyz[..., 1], 0)
        assert light.sum() > 0
        rows, columns = np.indices(light.shape)
        got = [(light * k).sum() / light.sum() for k in (columns + x - 9, rows + y - 9)]
        np.testing.assert_allclose(got, wanted, atol=0.1)


def test_a_shifted_sensor_has_its_principal_point_elsewhere() -> None:
    """Right and up, mm: the axis meets the picture to the left of its middle, and below."""
    fit = dg.calibrate(GAUSS, resolution=(960, 640), shift=(3.0, 2.0), f_stop=16, focus_distance=1)
    assert fit.projection.center == pytest.approx((479.5 - 80, 319.5 + 160 / 3), abs=0.01)
    assert fit.projection.focal[0] == pytest.approx(fit.projection.focal[1], rel=1e-5)
    scene, place = dg.Scene(), np.eye(4)
    place[:3, 3] = point = np.array([0.1, 0.08, -1.0])
    scene.add_light(dg.SphereLight((1e5, 1e5, 1e5), 2e-3), place)
    x, y = wanted = fit.projection.project([point * (1, -1, -1)])[0]
    crop = (int(x) - 9, int(y) - 9, int(x) + 10, int(y) + 10)
    frame = dg.render(scene, fit.camera, resolution=(960, 640), crop=crop, spp=64, filter="box")
    light = np.maximum(frame.xyz[..., 1], 0)
    rows, columns = np.indices(light.shape)
    got = [(light * k).sum() / light.sum() for k in (columns + crop[0], rows + crop[1])]
    np.testing.assert_allclose(got, wanted, atol=0.1)


def test_models_are_compared_by_what_they_leave() -> None:
    fits = calibrate_all(FISHEYE, resolution=(960, 640), focus_distance=3.0)
    names = [fit.projection.model for fit in fits]
    assert names[0] == "kannala_brandt"
    assert "opencv" not in names  # which sees up to 90 degrees
    assert [fit.rms for fit in fits] == sorted(fit.rms for fit in fits)
    alone = dg.calibrate(FISHEYE, "equisolid", resolution=(960, 640), focus_distance=3.0)
    assert fits[names.index("equisolid")].projection == alone.projection


def test_the_command_compares_models_and_says_what_fits_badly(capsys: Any) -> None:
    command = ["calibrate", FISHEYE, "--focus", "3", "--res", "960x640"]
    assert main([*command, "--model", "all"]) == 0
    rows = capsys.readouterr().out.splitlines()
    assert rows[0].split()[0] == "model"
    assert rows[1].split()[:2] == ["kannala_brandt", "4"]
    assert main([*command, "--model", "all", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)[0]["model"] == "kannala_brandt"
    assert main([*command, "--model", "equisolid"]) == 0
    assert "px off; --model all" in capsys.readouterr().err
    assert main([*command, "--model", "fisheye"]) == 0
    assert "px off" not in capsys.readouterr().err


def test_rays_meet_what_is_in_focus() -> None:
    """Directions are those of points of the plane in focus from the middle of the pupil."""
    fit = dg.calibrate(GAUSS, resolution=SIZE, focus_distance=0.5)
    film = np.array([[3.0, 8.0], [-15.0, 2.0]])
    rays = chief_rays(fit.bench, film)
    seen = directions_seen(fit.bench, rays)
    plane = fit.bench.order.entrance_pupil.z - 500
    at = (
        rays.points
        + rays.directions * ((plane - rays.points[:, 2]) / rays.directions[:, 2])[:, None]
    )
    np.testing.assert_allclose(seen[:, 0] / seen[:, 2], at[:, 0] / 500, rtol=1e-9)
    np.testing.assert_allclose(seen[:, 1] / seen[:, 2], -at[:, 1] / 500, rtol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("lens", "model", "session"),
    [
        (FISHEYE, "fisheye", {"count": 20, "square": 0.8, "spp": 24}),
        # Many corners all over the picture tell the middle of weak distortion.
        (NIKKOR, "opencv", {"count": 24, "columns": 18, "rows": 13, "square": 0.45, "spp": 32}),
    ],
)
def test_opencv_finds_the_projection_of_a_lens_by_its_pictures(
    lens: str, model: str, session: dict[str, Any]
) -> None:
    """Boards through the exact lens, calibrated by OpenCV, against its chief rays.

    They are 8 m large: to near ones the fisheye's pupil wanders, at 1 m 0.14 % of the focal length.
    """
    cv2 = pytest.importorskip("cv2")
    from tests.charts.test_boards import calibrated, check, photographed

    options: dict[str, Any] = {"f_stop": 16.0, "focus_distance": 10.0}
    fit = dg.calibrate(
        lens, model, resolution=SIZE, sensor_size=(36, 27), wavelength_nm=559, **options
    )
    camera = dg.Camera(lens=lens, lens_model="exact", sensor_size=(36, 27), **options)
    seen = photographed(fit.projection, camera=camera, farthest=1.0, **session)
    check(fit.projection, *calibrated(fit.projection, seen), 1)
    if model == "opencv":  # without p1 and p2, which pass for a shift of the middle
        found = calibrated(fit.projection, seen, cv2.CALIB_ZERO_TANGENT_DIST)
        check(fit.projection, *found, 0.5)


def test_the_command_writes_what_it_finds(tmp_path: Path, capsys: Any) -> None:
    out, picture = tmp_path / "lens.yaml", tmp_path / "residuals.png"
    command = ["calibrate", FISHEYE, "--model", "fisheye", "--focus", "1", "--f-stop", "8"]
    options = ["--res", "960x640", "--sensor", "36x24", "-o", str(out), "--residuals", str(picture)]
    pytest.importorskip("matplotlib")
    assert main([*command, *options]) == 0
    assert "kannala_brandt" in capsys.readouterr().out
    assert main([*command, *options, "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["pixel_pitch_um"] == pytest.approx(37.5)
    assert facts["rms_px"] < 0.01
    again = dg.calibration.read(out).projection
    assert again.model == facts["model"]
    assert again.parameters == pytest.approx(facts["parameters"])
    assert again.center == pytest.approx((479.5, 319.5), abs=1e-6)
    assert picture.read_bytes()[:4] == b"\x89PNG"


@pytest.mark.parametrize("kind", [kind for kind in dg.calibration.WRITTEN if kind != "usd"])
def test_every_format_says_where_the_lens_puts_things(kind: str, tmp_path: Path) -> None:
    out = tmp_path / "lens.yaml"
    command = ["calibrate", "nikon-28mm-f2.8", "--res", "640x480", "--focus", "3"]
    assert main([*command, "--format", kind, "-o", str(out)]) == 0
    fit = dg.calibrate("nikon-28mm-f2.8", resolution=SIZE, focus_distance=3)
    found = dg.calibration.read(out).projection.project(fit.directions)
    # Kalibr's model has no k3.
    assert np.abs(found - fit.pixels).max() < (0.1 if kind == "kalibr" else 1.001 * fit.largest)


def test_a_stage_says_where_the_lens_puts_things(tmp_path: Path) -> None:
    pytest.importorskip("pxr")
    from tests.importers.usd.stage import opened, read

    out = tmp_path / "lens.usda"
    command = ["calibrate", "nikon-28mm-f2.8", "--res", "640x480", "--focus", "3"]
    assert main([*command, "--format", "usd", "-o", str(out)]) == 0
    fit = dg.calibrate("nikon-28mm-f2.8", resolution=SIZE, focus_distance=3)
    found = read(opened(out)[0], metres=1.0)
    assert found.projection is not None
    miss = np.abs(found.projection.project(fit.directions) - fit.pixels).max()
    assert miss < fit.largest + 1e-3  # single precision
    assert found.sensor_size == pytest.approx((36, 27))


@pytest.mark.parametrize(
    ("options", "code", "message"),
    [
        (["--model", "fishey"], 2, "did you mean 'fisheye'"),
        (["--model", "cube"], 2, "model"),
        (["--terms", "15"], 2, "terms of opencv"),
        (["--model", "all", "--terms", "4"], 2, "writes no file"),
        (["--model", "all", "-o", "x.yaml"], 2, "no file"),
        (["--shift", "3"], 2, "--shift"),
        (["--focus-by", "eye"], 2, "--focus-by"),
        (["--format", "rost", "-o", "x.yaml"], 2, "did you mean 'ros'"),
        (["--format", "ros"], 2, "-o FILE"),
        (["--model", "equisolid", "-o", "/no/such/x"], 5, "/no/such"),
        (["--residuals", "x.bmp"], 2, "--residuals"),
        (["--f-stop", "1"], 3, "f"),
        (["--wavelength", "nan"], 2, "wavelength_nm"),
        (["--wavelength", "5000"], 2, "at most 2500"),
        (["--sensor", "1000x1000"], 3, "image circle"),
        (["-o", "same.png", "--residuals", "./same.png"], 2, "named twice"),
    ],
)
def test_bad_wishes_are_one_line(options: list[str], code: int, message: str, capsys: Any) -> None:
    assert main(["calibrate", GAUSS, *options]) == code
    text = capsys.readouterr().err
    assert message in text
    assert text.count("\n") == 1


def test_a_model_with_too_small_a_field_says_so() -> None:
    with pytest.raises(InputError, match=r"9\d\.\d* degrees.*opencv up to 90"):
        dg.calibrate(FISHEYE, "opencv", resolution=SIZE)
    with pytest.raises(UsageError, match="resolution"):
        dg.calibrate(GAUSS, resolution=(640.5, 480))  # type: ignore[arg-type]
