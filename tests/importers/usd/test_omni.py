"""Lens distortion and rolling shutter of NVIDIA cameras, as Isaac Sim and Isaac Lab write it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import daguerre as dg

pytest.importorskip("pxr")

from pxr import Usd, UsdGeom

from .stage import FILE, PATH, camera_prim, noted, read

cv2 = pytest.importorskip("cv2")

K = np.array([[958.8, 0, 957.8], [0, 956.7, 589.5], [0, 0, 1]])
SIZE = (1920, 1200)
RATIONAL = (0.14, -0.03, -0.0002, -0.00003, 0.009, 0.5, -0.07, 0.017, 1e-3, -2e-4, 5e-4, 1e-4)
FISHEYE = (0.05, 0.01, -0.003, -0.0005)


def opencv_lines(stem: str, terms: dict[str, float]) -> str:
    """A calibration by OpenCV's names, as Isaac Sim's cameras have it."""
    values = {"fx": K[0, 0], "fy": K[1, 1], "cx": K[0, 2], "cy": K[1, 2], **terms}
    stem = f"omni:lensdistortion:{stem}:"
    lines = [f"float {stem}{name} = {value!r}" for name, value in values.items()]
    lines.append(f"int2 {stem}imageSize = ({SIZE[0]}, {SIZE[1]})")
    return "\n".join(lines).replace("np.float64(", "").replace(")\n", "\n")


def pixels() -> np.ndarray:
    """Pixels evenly over the picture, whose centres are at integers."""
    x, y = np.linspace(0, SIZE[0] - 1, 13), np.linspace(0, SIZE[1] - 1, 9)
    return np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)


def test_opencv_pinhole_is_opencvs() -> None:
    names = ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6", "s1", "s2", "s3", "s4")
    lines = opencv_lines("opencvPinhole", dict(zip(names, RATIONAL, strict=True)))
    lines += '\ntoken omni:lensdistortion:model = "opencvPinhole"'
    made = read(camera_prim(lines)).projection
    assert made is not None
    assert (made.model, made.size) == ("opencv", SIZE)
    seen = made.unproject(pixels())
    got = cv2.projectPoints(seen, np.zeros(3), np.zeros(3), K, np.array(RATIONAL))[0][:, 0]
    # NVIDIA counts from the corner of the picture, OpenCV from the centre of the first pixel.
    np.testing.assert_allclose(got - 0.5, pixels(), atol=2e-3)


def test_opencv_fisheye_is_opencvs_by_its_schema_alone() -> None:
    names = ("k1", "k2", "k3", "k4")
    lines = opencv_lines("opencvFisheye", dict(zip(names, FISHEYE, strict=True)))
    made = read(camera_prim(lines, '"OmniLensDistortionOpenCvFisheyeAPI"')).projection
    assert made is not None
    seen = made.unproject(pixels())
    got = cv2.fisheye.projectPoints(seen[:, None], np.zeros(3), np.zeros(3), K, np.array(FISHEYE))
    np.testing.assert_allclose(got[0].reshape(-1, 2) - 0.5, pixels(), atol=2e-3)


FTHETA = """
    token omni:lensdistortion:model = "ftheta"
    float omni:lensdistortion:ftheta:nominalWidth = 1936
    float omni:lensdistortion:ftheta:nominalHeight = 1216
    float2 omni:lensdistortion:ftheta:opticalCenter = (970.9424, 600.3748)
    float omni:lensdistortion:ftheta:k1 = 0.00245
    float omni:lensdistortion:ftheta:k2 = 1e-7
    float omni:lensdistortion:ftheta:k3 = -2e-10
    float omni:lensdistortion:ftheta:k4 = 1e-14
"""
OLDER_FTHETA = """
    token cameraProjectionType = "fisheyePolynomial"
    float fthetaWidth = 1936
    float fthetaHeight = 1216
    float fthetaCx = 970.9424
    float fthetaCy = 600.3748
    float fthetaMaxFov = 400
    float fthetaPolyA = 0
    float fthetaPolyB = 0.00245
    float fthetaPolyC = 1e-7
    float fthetaPolyD = -2e-10
    float fthetaPolyE = 1e-14
"""


@pytest.mark.parametrize("lines", [FTHETA, OLDER_FTHETA])
def test_ftheta_gives_the_angle_of_a_radius(lines: str) -> None:
    made = read(camera_prim(lines)).projection
    assert made is not None
    assert made.size == (1936, 1216)
    points = np.array([(970.0, 700.0), (100.5, 300.25), (1900.0, 1200.0)])
    away = points + 0.5 - (970.9424, 600.3748)
    r = np.hypot(*away.T)
    angle = 0.00245 * r + 1e-7 * r**2 - 2e-10 * r**3 + 1e-14 * r**4
    seen = made.unproject(points)
    np.testing.assert_allclose(np.arccos(seen[:, 2]), angle, rtol=1e-6)
    np.testing.assert_allclose(
        np.arctan2(*seen[:, 1::-1].T), np.arctan2(*away[:, ::-1].T), rtol=1e-6
    )


def test_models_without_a_focal_length_take_that_of_the_film() -> None:
    """Radius f (a + k0 a^3 + ...), with f of focalLength on horizontalAperture."""
    stem = "omni:lensdistortion:kannalaBrandtK3:"
    lines = f"""
        float focalLength = 10
        float horizontalAperture = 20
        token omni:lensdistortion:model = "kannalaBrandtK3"
        float {stem}nominalWidth = 1000
        float {stem}nominalHeight = 800
        float2 {stem}opticalCenter = (500, 400)
        float {stem}k0 = 0.05
        float {stem}k1 = 0.01
    """
    camera, notes = noted(camera_prim(lines))
    assert camera is not None
    assert camera.projection is not None
    a = 0.6
    point = camera.projection.project([(np.sin(a), 0, np.cos(a))])[0]
    assert point[0] + 0.5 - 500 == pytest.approx(500 * (a + 0.05 * a**3 + 0.01 * a**5), rel=1e-6)
    assert len(notes) == 1
    assert "has no focal length; focalLength" in notes[0]
    older = lines.replace("kannalaBrandtK3", "radTanThinPrism") + f"float {stem}s2 = 0.1".replace(
        "kannalaBrandtK3", "radTanThinPrism"
    )
    camera, notes = noted(camera_prim(older))
    assert camera is not None
    assert camera.projection is not None
    assert camera.projection.parameters == (0.05, 0.01)
    assert "radTanThinPrism of a camera: only k0 .. k3 are read (1 use)" in notes


def test_older_names_of_opencv() -> None:
    """Names that Isaac Lab's importers of calibrations write."""
    lines = """
        token cameraProjectionType = "pinholeOpenCV"
        float fthetaWidth = 1920
        float fthetaHeight = 1280
        float fthetaCx = 935.5
        float fthetaCy = 635
        float openCVFx = 2059
        float openCVFy = 2060
        float fthetaPolyA = 0.04
        float fthetaPolyB = -0.34
        float fthetaPolyC = 0.2
        float fthetaPolyD = 0.01
        float fthetaPolyE = 0.02
        float fthetaPolyF = 0.03
        float p0 = 0.0018
        float p1 = -0.0005
        float s1 = 0.001
    """
    made = read(camera_prim(lines)).projection
    assert made is not None
    assert made == dg.Projection(
        "opencv", (1920, 1280), (2059, 2060), (935, 634.5),
        (0.04, -0.34, 0.0018, -0.0005, 0.2, 0.01, 0.02, 0.03, 0, 0.001),
    )  # fmt: skip


def test_a_calibration_replaces_lens_and_offsets_and_keeps_stop_and_width() -> None:
    lines = (
        FTHETA
        + """
        float horizontalAperture = 19.36
        float verticalAperture = 10
        float horizontalApertureOffset = 3
        float fStop = 2.8
        float focusDistance = 100
    """
    )
    camera = read(camera_prim(lines))
    assert camera.sensor_size == pytest.approx((19.36, 12.16))
    assert (camera.shift, camera.focal_length) == ((0, 0), None)
    assert (camera.f_stop, camera.focus_distance) == (2.8, 1)
    sharp = read(camera_prim(FTHETA + "float fStop = 0"))
    assert (sharp.f_stop, sharp.lens) == (None, None)
    frame = dg.render(dg.Scene(), camera, resolution=(121, 76), spp=1)
    assert frame.rgb.shape == (76, 121, 3)


def test_a_calibration_over_time() -> None:
    lines = FTHETA.replace("k1 = 0.00245", "k1.timeSamples = {0: 0.00245, 24: 0.003}")
    camera = read(camera_prim(lines))
    first, last = (camera.evaluated_at(t).projection for t in (0.0, 1.0))
    assert first is not None
    assert last is not None
    assert (1 / first.focal[0], 1 / last.focal[0]) == pytest.approx((0.00245, 0.003))
    assert last.parameters[0] == pytest.approx(1e-7 / 0.003**2)


def test_what_is_left_to_nvidias_schema_or_unknown_is_noted() -> None:
    camera, notes = noted(camera_prim("", '"OmniLensDistortionOpenCvPinholeAPI"'))
    assert camera is not None
    assert camera.projection == dg.Projection(
        "rectilinear", (2048, 1024), (900, 800), (1023.5, 511.5)
    )
    assert "leaves omni:lensdistortion:opencvPinhole:imageSize" in notes[0]
    for lines in (
        'token omni:lensdistortion:model = "lut"',
        'token cameraProjectionType = "fisheyeSpherical"',
    ):
        camera, notes = noted(camera_prim(lines))
        assert camera is not None
        assert camera.projection is None
        assert "of a camera is unknown (1 use)" in notes[0]
    assert noted(camera_prim('token cameraProjectionType = "pinhole"'))[1] == []
    narrow = FTHETA + "float omni:lensdistortion:ftheta:maxFov = 120"
    assert "maxFov of a camera is ignored" in noted(camera_prim(narrow))[1][0]
    wide = FTHETA + "float omni:lensdistortion:ftheta:maxFov = 400"
    assert noted(camera_prim(wide))[1] == []
    off = FTHETA + "float omni:lensdistortion:ftheta:k0 = 0.01"
    assert "ftheta:k0 of a camera is ignored" in noted(camera_prim(off))[1][0]


@pytest.mark.parametrize(
    ("order", "side"),
    [
        ("topToBottom", "top"),
        ("bottomToTop", "bottom"),
        ("leftToRight", "left"),
        ("rightToLeft", "right"),
    ],
)
def test_rolling_shutters(order: str, side: str) -> None:
    lines = f"""
        double shutter:close = 0.5
        token omni:rtx:rollingShutter:scanOrder = "{order}"
        double2 omni:rtx:rollingShutter:lineOffset = (1, 64000)
        double2 omni:rtx:rollingShutter:lineExposure = (1, 100)
    """
    camera = read(camera_prim(lines))
    assert camera.rolling_shutter == dg.RollingShutter(side, line_time=1 / 64000)
    assert camera.shutter_time == 0.01
    off = lines.replace(order, "none")
    assert read(camera_prim(off)).rolling_shutter is None
    assert read(camera_prim(off)).shutter_time == pytest.approx(0.5 / 24)


BAD = {
    "omni:lensdistortion:ftheta:k1": FTHETA.replace("0.00245", "-0.1"),
    "omni:lensdistortion:ftheta:k2": FTHETA.replace("1e-7", "nan"),
    "omni:lensdistortion:ftheta:nominalWidth": FTHETA.replace("Width = 1936", "Width = 0"),
    "omni:lensdistortion:ftheta:nominalHeight": FTHETA.replace("1216", "12.5"),
    "omni:lensdistortion:opencvPinhole:fx": opencv_lines("opencvPinhole", {}).replace(
        "fx = 958.8", "fx = 0") + '\ntoken omni:lensdistortion:model = "opencvPinhole"',
    "openCVFx": OLDER_FTHETA.replace("fisheyePolynomial", "pinholeOpenCV"),
    "omni:rtx:rollingShutter:lineExposure": """
        token omni:rtx:rollingShutter:scanOrder = "topToBottom"
        double2 omni:rtx:rollingShutter:lineExposure = (-1, 1)
    """,
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_bad_values_are_one_error_that_names_the_attribute(name: str) -> None:
    with pytest.raises(dg.InputError) as caught:
        noted(camera_prim(BAD[name]))
    assert str(caught.value).startswith(f"{FILE}: {PATH}.{name}: wanted "), str(caught.value)


def test_the_example_of_the_docs_says_what_the_page_says() -> None:
    text = (Path(__file__).parents[3] / "docs" / "usd.md").read_text()
    layer = text.split("```\n#usda 1.0\n")[1].split("```")[0]
    stage = Usd.Stage.CreateInMemory()
    assert stage.GetRootLayer().ImportFromString("#usda 1.0\n" + layer)
    metres = UsdGeom.GetStageMetersPerUnit(stage)
    camera, notes = noted(stage.GetPrimAtPath("/front"), metres=metres)
    assert notes == []
    assert camera is not None
    assert camera.projection is not None
    assert camera.projection.parameters == (-0.1,)
    assert camera.sensor_size[0] / 1920 == pytest.approx(3e-3)
    assert (camera.f_stop, camera.focus_distance, camera.blades) == (1.8, 2, 7)
    assert camera.shutter_time == 0.01
    assert camera.rolling_shutter == dg.RollingShutter("top", line_time=1 / 64000)


def test_numbers_that_make_no_model_are_one_error() -> None:
    lines = opencv_lines("opencvPinhole", {"k1": -0.1}).replace("fx = 958.8", "fx = 1e12")
    lines += '\ntoken omni:lensdistortion:model = "opencvPinhole"'
    with pytest.raises(
        dg.InputError, match=r"^shot.usda: /World/Cam.omni:lens.*model: focal:.*wanted"
    ):
        noted(camera_prim(lines))
