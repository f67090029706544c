"""Calibration files: what OpenCV says of the same numbers, conventions, round trips, bad input."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre import calibration
from daguerre.calibration import Calibration
from daguerre.calibration.calibration import field_notes
from daguerre.camera.projection import Projection
from daguerre.errors import DaguerreError, InputError, UsageError

cv2 = pytest.importorskip("cv2")

SIZE = (640, 480)
K = np.array([[520.0, 0, 331.3], [0, 515, 236.8], [0, 0, 1]])
BROWN = (-0.28, 0.09, 1e-3, -2e-3, -0.01)
RATIONAL = (0.1, -0.05, 1e-3, -2e-3, 0.01, 0.12, -0.03, 0.004)
FISHEYE = (0.01, -0.003, 0.001, -2e-4)
STILL = (np.zeros(3), np.zeros(3))
POINTS = np.array([[0.3, -0.2, 1.2], [-0.5, 0.3, 1.1], [0.02, 0.01, 0.9], [0.4, 0.35, 1.0]])


def by_opencv(k: tuple[float, ...], fisheye: bool = False) -> np.ndarray:
    if fisheye:
        return cv2.fisheye.projectPoints(POINTS[:, None], *STILL, K, np.array(k))[0].reshape(-1, 2)
    return cv2.projectPoints(POINTS, *STILL, K, np.array(k))[0].reshape(-1, 2)


@pytest.mark.parametrize("suffix", ["yml", "json"])
@pytest.mark.parametrize("k", [BROWN, RATIONAL, FISHEYE])
def test_files_of_opencv_say_what_opencv_means(
    tmp_path: Path, suffix: str, k: tuple[float, ...]
) -> None:
    path, fisheye = tmp_path / f"camera.{suffix}", k is FISHEYE
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
    storage.write("image_width", SIZE[0])
    storage.write("image_height", SIZE[1])
    storage.write("fisheye_model", int(fisheye))
    storage.write("camera_matrix", K)
    storage.write("distortion_coefficients", np.array([k]).T)
    storage.release()
    found = calibration.read(path).projection
    np.testing.assert_allclose(found.project(POINTS), by_opencv(k, fisheye), atol=1e-9)
    assert found.parameters == k
    # Pixel centres stay at integers: half a pixel either way would be another principal point.
    assert found.principal == (331.3, 236.8)


def test_what_we_write_opencv_reads(tmp_path: Path) -> None:
    path = tmp_path / "camera.yml"
    made = Projection("opencv", SIZE, (520, 515), (331.3, 236.8), RATIONAL)
    calibration.write(path, Calibration(made), "opencv")
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_READ)
    np.testing.assert_array_equal(storage.getNode("camera_matrix").mat(), K)
    k = storage.getNode("distortion_coefficients").mat().ravel()
    np.testing.assert_array_equal(k, RATIONAL)
    assert storage.getNode("image_width").real() == SIZE[0]


def test_a_dict_with_arrays_is_as_good() -> None:
    given = {"K": K, "dist_coeffs": np.array(BROWN)[:, None], "image_size": SIZE}
    camera = dg.Camera.from_opencv(given, pixel_pitch=5.0)
    assert camera.projection is not None
    np.testing.assert_allclose(camera.projection.project(POINTS), by_opencv(BROWN), atol=1e-9)
    assert camera.sensor_size == pytest.approx((3.2, 2.4))
    assert calibration.read_opencv({"K": K}, size=SIZE).projection.model == "rectilinear"


def ros(model: str, k: tuple[float, ...], **more: Any) -> dict[str, Any]:
    message = {"header": {"frame_id": "left"}, "width": 640, "height": 480, "K": K.ravel()}
    return {**message, "distortion_model": model, "D": k, **more}


@pytest.mark.parametrize(
    ("model", "k"),
    [("plumb_bob", BROWN), ("rational_polynomial", RATIONAL), ("equidistant", FISHEYE)],
)
def test_ros_means_what_opencv_does(model: str, k: tuple[float, ...]) -> None:
    found = calibration.read_ros(ros(model, k)).projection
    np.testing.assert_allclose(found.project(POINTS), by_opencv(k, k is FISHEYE), atol=1e-9)


def test_an_echoed_message_is_read(tmp_path: Path) -> None:
    path = tmp_path / "info.yaml"
    path.write_text(
        "header:\n  frame_id: left\nheight: 480\nwidth: 640\ndistortion_model: plumb_bob\n"
        "d: [0.1, -1e-02, 0, 0, 0]\nk: [500, 0, 320, 0, 500, 240, 0, 0, 1]\n---\n"
    )
    assert calibration.read(path).projection.parameters[1] == -0.01


def test_a_right_camera_stands_to_the_right() -> None:
    """By P of the stereo rig: -fx times 0.12 m; R turns the raw camera onto the rig's rows."""
    turn = cv2.Rodrigues(np.array([0.02, -0.05, 0.01]))[0]
    p = [500, 0, 320, -60, 0, 500, 240, 0, 0, 0, 1, 0]
    found = calibration.read_ros(ros("plumb_bob", BROWN, R=turn.ravel(), P=p))
    np.testing.assert_allclose(found.rig_from_camera[:3, 3], (0.12, 0, 0), atol=1e-12)
    flip = np.diag((1, -1, -1))
    np.testing.assert_allclose(flip @ found.rig_from_camera[:3, :3] @ flip, turn, atol=1e-12)


CHAIN = """
cam0:
  camera_model: pinhole
  intrinsics: [520, 515, 331.3, 236.8]
  distortion_model: radtan
  distortion_coeffs: [-0.28, 0.09, 1.0e-3, -2e-03]
  resolution: [640, 480]
cam1:
  camera_model: ds
  intrinsics: [-0.2, 0.59, 320, 321, 331.3, 236.8]
  distortion_model: none
  resolution: [640, 480]
  T_cn_cnm1:
  - [0, -1, 0, -0.1]
  - [1, 0, 0, 0.02]
  - [0, 0, 1, 0.03]
  - [0, 0, 0, 1]
cam2:
  camera_model: pinhole
  intrinsics: [520, 515, 331.3, 236.8]
  distortion_model: equidistant
  distortion_coeffs: [0.01, -0.003, 0.001, -2e-04]
  resolution: [640, 480]
  T_cn_cnm1: [[1, 0, 0, -0.2], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
"""


@pytest.fixture
def chain(tmp_path: Path) -> Path:
    path = tmp_path / "camchain.yaml"
    path.write_text(CHAIN)
    return path


def test_kalibr_means_what_opencv_does(chain: Path) -> None:
    found = calibration.read_kalibr(chain)
    straight = found["cam0"].projection.project(POINTS)
    np.testing.assert_allclose(straight, by_opencv(BROWN[:4]), atol=1e-9)
    wide = found["cam2"].projection.project(POINTS)
    np.testing.assert_allclose(wide, by_opencv(FISHEYE, True), atol=1e-9)
    assert found["cam1"].projection.parameters == (-0.2, 0.59)
    assert found["cam1"].projection.focal == (320, 321)


def test_cameras_of_a_chain_see_the_same_point(chain: Path) -> None:
    """T_cn_cnm1 takes points from one frame into the next: seen so, and by the cameras' places."""
    base = np.eye(4)
    base[:3, :3] = cv2.Rodrigues(np.array([0.1, 0.4, -0.2]))[0]
    base[:3, 3] = 1, 2, 3
    t1 = np.array([[0, -1, 0, -0.1], [1, 0, 0, 0.02], [0, 0, 1, 0.03], [0, 0, 0, 1]])
    t2 = np.eye(4)
    t2[0, 3] = -0.2
    flip = np.diag((1.0, -1, -1, 1))
    point = np.array([0.1, -0.05, 1.5, 1])  # of cam0, y down
    for name, wanted in (("cam0", point), ("cam1", t1 @ point), ("cam2", t2 @ t1 @ point)):
        camera = dg.Camera.from_kalibr(chain, name, camera=dg.Camera(transform=base))
        world = base @ flip @ point
        seen = flip @ np.linalg.inv(camera.transform) @ world
        np.testing.assert_allclose(seen, wanted, atol=1e-12)


FOCAL, PITCH = 35.0, 6e-3  # mm


def sample(**lens: Any) -> dict[str, Any]:
    camera = {
        "activeSensorPhysicalDimensions": {"width": 640 * PITCH, "height": 480 * PITCH},
        "activeSensorResolution": {"width": 640, "height": 480},
    }
    return {"static": {"camera": camera}, "lens": {"pinholeFocalLength": 3.0, **lens}}


def bent(points: np.ndarray, radial: tuple[float, ...], p: tuple[float, float]) -> np.ndarray:
    """OpenLensIO's own formula, mm: coefficients alternate between numerator and denominator."""
    x, y = points.T
    r2 = x * x + y * y
    l1, l2, l3, l4, l5, l6 = (*radial, *[0.0] * 6)[:6]
    factor = (1 + l1 * r2 + l3 * r2**2 + l5 * r2**3) / (1 + l2 * r2 + l4 * r2**2 + l6 * r2**3)
    dx = 2 * p[0] * x * y + p[1] * (r2 + 2 * x * x)
    return np.stack([x * factor + dx, y * factor + p[0] * (r2 + 2 * y * y) + 2 * p[1] * x * y], -1)


RADIAL, ASIDE = (-0.012, 0.004, 5e-4, -1e-4), (1e-5, -2e-5)


def test_opentrackio_from_ideal_points_to_the_picture() -> None:
    told = [{"model": "Brown-Conrady U-D", "radial": RADIAL, "tangential": ASIDE}]
    offset = {"x": 0.12, "y": -0.05}
    found = calibration.read(sample(distortion=told, projectionOffset=offset)).projection
    ideal = POINTS[:, :2] / POINTS[:, 2:] * 3.0
    film = bent(ideal, RADIAL, ASIDE) + np.array([0.12, -0.05])
    # From the middle of the sensor, which is (W - 1) / 2 where pixel centres are at integers.
    wanted = film / PITCH + (319.5, 239.5)
    np.testing.assert_allclose(found.project(POINTS), wanted, atol=1e-9)


@pytest.mark.parametrize("model", [None, "Brown-Conrady D-U"])
def test_opentrackio_from_the_picture_to_ideal_points(model: str | None) -> None:
    """Exactly, also with tangential terms of more than 20 px."""
    told = {"radial": RADIAL, "tangential": (0.02, -0.03)} | ({"model": model} if model else {})
    offset = {"x": 0.12, "y": -0.05}
    found = calibration.read(sample(distortion=[told], projectionOffset=offset)).projection
    pixels = np.array([[0, 0], [639, 479], [100, 300], [320.0, 10]])
    film = (pixels - (319.5, 239.5)) * PITCH - (0.12, -0.05)
    ideal = bent(film, RADIAL, (0.02, -0.03)) / 3.0
    points = np.c_[ideal, np.ones(len(ideal))]
    assert np.abs(ideal - bent(film, RADIAL, (0, 0)) / 3.0).max() * 3.0 / PITCH > 20
    np.testing.assert_allclose(found.project(points), pixels, atol=1e-9)
    seen = found.unproject(pixels)
    np.testing.assert_allclose(seen[:, :2] / seen[:, 2:], ideal, atol=1e-12)


def test_opentrackio_stands_where_it_is_tracked() -> None:
    """z up, y ahead; pan about z, tilt about the turned x; the pupil is ahead of the sensor."""
    root = sample(entrancePupilOffset=0.1, fStop=2.8, focusDistance=4.0)
    root["transforms"] = [
        {"translation": {"x": 10, "y": 0, "z": 0}, "rotation": {"pan": 0, "tilt": 0, "roll": 0}},
        {"translation": {"x": 1, "y": 2, "z": 3}, "rotation": {"pan": 90, "tilt": 30, "roll": 0}},
    ]
    camera = dg.Camera.from_opentrackio(root)
    # A pan of 90 degrees about z turns ahead (y) to -x; the tilt then raises it. As (x, z, -y).
    ahead = np.array([-np.cos(np.pi / 6), 0.5, 0.0])
    np.testing.assert_allclose(-camera.transform[:3, 2], ahead, atol=1e-12)
    np.testing.assert_allclose(camera.transform[:3, 3], (11, 3, -2) + 0.1 * ahead, atol=1e-12)
    assert (camera.f_stop, camera.focus_distance) == (2.8, 4.0)
    assert camera.sensor_size == pytest.approx((640 * PITCH, 480 * PITCH))


def tracked(seconds: int, nanoseconds: int, **lens: Any) -> dict[str, Any]:
    stamp = {"seconds": seconds, "nanoseconds": nanoseconds}
    return sample(**lens) | {"timing": {"sampleTimestamp": stamp}}


def test_samples_of_opentrackio_make_keys() -> None:
    """A zoom whose focus and place stay, and a static part that only the first sample has."""
    first = tracked(1_700_000_000, 980_000_000, pinholeFocalLength=3.0, fStop=2.8)
    last = tracked(1_700_000_001, 20_000_000, pinholeFocalLength=5.0, fStop=4.0)
    del last["static"]
    camera = dg.Camera.from_opentrackio([first, last])
    assert set(camera.motion) == {"projection", "f_stop"}
    now = camera.frozen_at(0.01)
    alone = dg.Camera.from_opentrackio(first).projection
    assert now.f_stop == pytest.approx(3.1, abs=1e-4)
    assert now.projection is not None
    assert alone is not None
    assert now.projection.focal[0] == pytest.approx(alone.focal[0] * 3.5 / 3.0, rel=1e-4)
    assert camera.frozen_at(-1).projection == alone
    rated = [{**first, "timing": {"sampleRate": {"num": 25}}}, last | {"timing": {}}]
    with pytest.raises(InputError, match=r"samples\[1\].*sampleTimestamp or timing.sampleRate"):
        dg.Camera.from_opentrackio(rated)
    rated[1]["timing"] = rated[0]["timing"]
    assert dg.Camera.from_opentrackio(rated).frozen_at(0.02).f_stop == pytest.approx(3.4)
    with pytest.raises(InputError, match="times must increase"):
        dg.Camera.from_opentrackio([last | {"static": first["static"]}, first])
    with pytest.raises(InputError, match="samples: no samples"):
        dg.Camera.from_opentrackio([])


MADE = {
    "opencv": Projection("opencv", SIZE, (520, 515), (331.3, 236.8), BROWN),
    "rational": Projection("opencv", SIZE, (520, 515), (331.3, 236.8), RATIONAL),
    "rectilinear": Projection("rectilinear", SIZE, (520, 515), (331.3, 236.8)),
    "kannala_brandt": Projection("kannala_brandt", SIZE, (520, 515), (331.3, 236.8), FISHEYE),
    "double_sphere": Projection("double_sphere", SIZE, (320, 321), (331.3, 236.8), (-0.2, 0.59)),
    "eucm": Projection("eucm", SIZE, (320, 321), (331.3, 236.8), (0.6, 1.1)),
    "omni": Projection("omni", SIZE, (520, 515), (331.3, 236.8), (0.9, -0.1, 0.01, 1e-3, 2e-3)),
    "unified": Projection("omni", SIZE, (520, 515), (331.3, 236.8), (0.9,)),
    "fov": Projection("fov", SIZE, (520, 515), (331.3, 236.8), (0.9,)),
    "inverse": Projection("opencv_inverse", SIZE, (520, 515), (331.3, 236.8), RATIONAL),
}
BACK = [
    *(("opencv", name) for name in ("opencv", "rational", "rectilinear", "kannala_brandt")),
    *(("ros", name) for name in ("opencv", "rational", "rectilinear", "kannala_brandt")),
    *(("opentrackio", name) for name in ("opencv", "rational", "rectilinear", "inverse")),
    *(("kalibr", name) for name in MADE if name not in ("opencv", "rational", "inverse")),
]


@pytest.mark.parametrize(("format", "name"), BACK)
def test_there_and_back(tmp_path: Path, format: str, name: str) -> None:
    made, path = MADE[name], tmp_path / ("x.json" if format == "opentrackio" else "x.yaml")
    calibration.write(path, Calibration(made, pixel_pitch=3.45), format)
    found = calibration.read(path)
    assert found.projection.size == made.size
    np.testing.assert_allclose(found.projection.project(POINTS), made.project(POINTS), atol=1e-9)


def test_a_chain_comes_back(tmp_path: Path, chain: Path) -> None:
    found = calibration.read_kalibr(chain)
    calibration.write(tmp_path / "again.yaml", list(found.values()), "kalibr")
    again = calibration.read_kalibr(tmp_path / "again.yaml")
    for name, one in found.items():
        assert again[name].projection == one.projection
        np.testing.assert_allclose(again[name].rig_from_camera, one.rig_from_camera, atol=1e-12)


def opencv(**changes: Any) -> dict[str, Any]:
    return {"image_width": 640, "image_height": 480, "camera_matrix": K} | changes


@pytest.mark.parametrize(
    ("read", "given", "message"),
    [
        (calibration.read_opencv, {"camera_matrix": K}, "size of the picture"),
        (calibration.read_opencv, {"image_size": SIZE}, "camera matrix"),
        (calibration.read_opencv, opencv(camera_matrix=K[:2]), "3 x 3"),
        (calibration.read_opencv, opencv(camera_matrix=K.T), "fx 0 cx"),
        (calibration.read_opencv, opencv(camera_matrix=K * np.nan), "not finite"),
        (calibration.read_opencv, opencv(dist_coeffs=[0.1] * 7), "got 7"),
        (calibration.read_opencv, opencv(dist_coeffs=[-0.9, 0, 0, 0]), "folds at"),
        (
            calibration.read_opencv,
            opencv(dist_coeffs=[1e30, 0, 0, 0]),
            r"pixel \(0, 0\) sees nothing",
        ),
        (calibration.read_opencv, opencv(dist_coeffs=[0, 0, 0.9, 0]), "pixel .* sees nothing"),
        (calibration.read_opencv, opencv(distortion_model="fisheyes"), "'fisheye'"),
        (calibration.read_ros, ros("fisheyee", FISHEYE), "did you mean 'fisheye'"),
        (calibration.read_opencv, opencv(image_width=0), "image_width"),
        (calibration.read_ros, ros("plum_bob", BROWN), "did you mean 'plumb_bob'"),
        (calibration.read_ros, ros("equidistant", BROWN), "got 5"),
        (calibration.read_ros, ros("equidistant", (-3.0, 0, 0, 0)), "folds at"),
        (calibration.read_ros, ros("plumb_bob", BROWN, binning_x=641), "binning"),
        (calibration.read_ros, ros("plumb_bob", BROWN, binning_x=-1), "binning_x"),
        (calibration.read_ros, ros("plumb_bob", BROWN, roi={"x_offset": 640}), "x_offset"),
        (
            calibration.read_ros,
            ros("plumb_bob", BROWN, roi={"y_offset": 9, "height": 475}),
            "within",
        ),
        (calibration.read_ros, ros("plumb_bob", BROWN, P=[1] * 12), "fx 0 cx"),
        (calibration.read_ros, ros("plumb_bob", BROWN, R=[1] * 9), "rotation"),
        (calibration.read_kalibr, {"cam1": {}}, "cam0, cam1"),
        (calibration.read_kalibr, {"cam0": {"camera_model": "pinhol"}}, "'pinhole'"),
        (calibration.read, sample(distortionOffset={"x": 1, "y": 0}), "distortionOffset"),
        (calibration.read, sample(distortion=[{"radial": []}]), "1 to 6"),
        (calibration.read, sample(distortion=[{"radial": [1], "model": "Brown"}]), "Brown-Conrady"),
        (calibration.read, sample(distortion=[{"radial": [-0.2]}]), "opencv_inverse: .* folds at"),
        (calibration.read_opencv, opencv(dist_coeffs="abc"), "a list"),
        (calibration.read_opencv, opencv(distortion_coefficents=BROWN), "did you mean 'distortion"),
        (calibration.read_opencv, opencv(dist_coefs=BROWN), "did you mean 'dist_coeff"),
        (calibration.read_ros, ros("plumb_bob", BROWN, R=[1] * 9), r"rotation, got \[\[1"),
        (
            calibration.read_ros,
            ros("plumb_bob", BROWN, roi={"y_offset": 9, "height": 475}),
            r"got columns and rows 0 \.\. \d+ and 9 \.\. 484",
        ),
    ],
)
def test_bad_calibrations_say_what_is_wrong(
    read: Callable[[Any], Any], given: dict[str, Any], message: str
) -> None:
    with pytest.raises(InputError, match=message) as error:
        read(given)
    assert "\n" not in str(error.value)


def test_a_fisheye_whose_circle_lies_within_its_picture_is_no_error() -> None:
    """Beyond 90 degrees a polynomial may end: the calibrations of circular fisheyes do."""
    fisheye = {
        **opencv(camera_matrix=[[430, 0, 959.5], [0, 430, 759.5], [0, 0, 1]]),
        "fisheye_model": 1,
    }
    fisheye |= {"image_width": 1920, "image_height": 1520, "dist_coeffs": [0.06, -0.03, 0.0, 0.0]}
    made = calibration.read_opencv(fisheye).projection
    assert 90 < made.largest_angle < 180
    radius = float(made.core.largest_radius) * 430
    assert radius < 759
    assert any(f"circle of {radius:.4g} px" in note for note in field_notes(made))
    with pytest.raises(InputError, match="folds at"):
        calibration.read_opencv({**fisheye, "dist_coeffs": [0.06, -0.3, 0.0, 0.0]})


FRAME = {"file_path": "0.png", "transform_matrix": np.eye(4).tolist()}


@pytest.mark.parametrize(
    ("read", "given"),
    [
        (calibration.read_opencv, {"image_size": (640, 480), "camera_matrix": K}),
        (calibration.read_opentrackio, sample()),
        (
            calibration.read_transforms,
            {"w": 640, "h": 480, "fl_x": 500, "frames": [FRAME]},
        ),
    ],
)
def test_a_size_beside_the_files_own_is_the_same(
    read: Callable[..., Any], given: dict[str, Any]
) -> None:
    made = read(given)
    told = (next(iter(made.values())) if isinstance(made, dict) else made).projection.size
    read(given, size=told)
    with pytest.raises(InputError, match=f"{told[0]} x {told[1]} px, got 641 x 7"):
        read(given, size=(641, 7))


def test_width_and_height_that_are_exchanged_are_noticed() -> None:
    exchanged = opencv(
        camera_matrix=[500, 0, 322, 0, 500, 238, 0, 0, 1], image_width=480, image_height=640
    )
    assert "swapped" in field_notes(calibration.read_opencv(exchanged).projection)[0]
    for x, y in ((322, 238), (322, 200), (100, 238), (322, 400)):
        right = opencv(camera_matrix=[500, 0, x, 0, 500, y, 0, 0, 1])
        assert field_notes(calibration.read_opencv(right).projection) == []


def test_a_chain_with_a_model_outside_its_field(chain: Path) -> None:
    chain.write_text(CHAIN.replace("[-0.2, 0.59,", "[-0.2, 1.59,"))
    with pytest.raises(InputError, match=r"cam1: .*alpha"):
        calibration.read_kalibr(chain)
    omni = CHAIN.replace("camera_model: ds", "camera_model: omni").replace("none", "radtan")
    for xi, k1, folds in ((0.9, -0.4, True), (0.9, -0.2, False), (5, -3, False)):
        coefficients = f"[{xi}, 320, 321, 331.3, 236.8]\n  distortion_coeffs: [{k1}, 0, 0, 0]"
        chain.write_text(omni.replace("[-0.2, 0.59, 320, 321, 331.3, 236.8]", coefficients))
        if folds:
            with pytest.raises(InputError, match=r"cam1: omni: .* folds at 195 px .*78"):
                calibration.read_kalibr(chain)
        else:
            assert calibration.read_kalibr(chain)["cam1"].projection.model == "omni"
    chain.write_text(CHAIN.replace("distortion_model: none", "distortion_model: fov"))
    with pytest.raises(InputError, match="wanted none with camera_model ds"):
        calibration.read_kalibr(chain)
    chain.write_text(CHAIN.replace("cam2:", "camera2:"))
    with pytest.raises(InputError, match="camera2: wanted the name cam2"):
        calibration.read_kalibr(chain)
    chain.write_text(CHAIN.replace("[1, 0, 0, -0.2]", "[2, 0, 0, -0.2]"))
    with pytest.raises(InputError, match=r"cam2.T_cn_cnm1: wanted a rotation"):
        calibration.read_kalibr(chain)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a: &x [1]\nb: *x", "line 1, column 4: anchors and aliases are not supported"),
        ("a: !!python/object:os.system x", "the only supported tag is"),
        ("a: !!opencv-matrix [1]", "opencv-matrix"),
        ("a: 1\na: 2", "'a' appears twice"),
        ("? [a]\n: 1", "names must be text"),
        ("a: [1", "line 2, column 1: did not find expected"),
        ("a: 1\n---\nb: 1\n", "another document"),
        ("[" * 5000, "nested too deeply"),
        ("a: " + "9" * 5000, "digit"),
        ("- 1", "names and values"),
        ("%YAML:1.0\n---\ncamera_matrix: .nan", "a list"),
        ("x: " + "a" * (1 << 20), "wanted at most 1048576 bytes, got 1048579"),
    ],
)
def test_yaml_that_calibrations_do_not_need_is_refused(
    tmp_path: Path, text: str, message: str
) -> None:
    path = tmp_path / "x.yaml"
    path.write_text(text)
    with pytest.raises(InputError, match=message) as error:
        calibration.read(path)
    assert str(path) in str(error.value)


def test_broken_files_are_errors_of_ours(tmp_path: Path, chain: Path) -> None:
    texts = [chain.read_text(), json.dumps(sample(distortion=[{"radial": RADIAL}]))]
    calibration.write(tmp_path / "o.yaml", Calibration(MADE["opencv"]), "opencv")
    calibration.write(tmp_path / "r.yaml", Calibration(MADE["opencv"]), "ros")
    texts += [(tmp_path / name).read_text() for name in ("o.yaml", "r.yaml")]
    dice, read = random.Random(1), 0
    for i in range(240):
        text = texts[i % 4]
        for _ in range(dice.randint(1, 3)):
            at, length = dice.randrange(len(text)), dice.choice((0, 1, 1, 7))
            text = text[:at] + dice.choice('0123456789e.-[]{}:,!&*\n" \x00n~') + text[at + length :]
        path = tmp_path / ("fuzz.json" if i % 4 == 1 else "fuzz.yaml")
        path.write_text(text)
        with suppress(DaguerreError):  # and nothing else
            calibration.read(path)
            read += 1
    assert 5 < read < 220


def test_a_take_is_no_calibration(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"wanted one calibration; a \.jsonl file holds several"):
        calibration.read(tmp_path / "take.jsonl", format="ros")


def test_formats_that_always_say_the_size_take_none(chain: Path) -> None:
    with pytest.raises(UsageError, match="size: kalibr takes none"):
        calibration.read(chain, size=(640, 480))
    with pytest.raises(UsageError, match="size: ros takes none"):
        calibration.read(ros("plumb_bob", BROWN), size=(640, 480))


def test_the_wrong_arguments_are_errors() -> None:
    with pytest.raises(UsageError, match="did you mean 'fisheye'"):
        dg.Camera.from_opencv(opencv(), model="fishey")
    with pytest.raises(UsageError, match="file or a dict"):
        calibration.read(3)  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="pixel_pitch"):
        dg.Camera.from_opencv(opencv(), pixel_pitch=-1)
    with pytest.raises(UsageError, match="'kalibr'"):
        calibration.write("x", Calibration(MADE["eucm"]), "kalib")
    with pytest.raises(InputError, match="got eucm"):
        calibration.write("x", Calibration(MADE["eucm"]), "ros")
    moving = dg.Camera(transform=dg.keys([(0, np.eye(4)), (1, np.eye(4))]))
    kalibr = {"cam0": {"camera_model": "pinhole", "distortion_model": "none"}}
    kalibr["cam0"] |= {"intrinsics": [500, 500, 320, 240], "resolution": [640, 480]}  # type: ignore[dict-item]
    shifted = np.eye(4)
    shifted[0, 3] = -0.1
    kalibr["cam1"] = kalibr["cam0"] | {"T_cn_cnm1": shifted}  # type: ignore[dict-item]
    assert dg.Camera.from_kalibr(kalibr, camera=moving).motion
    assert (
        dg.Camera.from_kalibr(kalibr, "cam1", camera=moving).motion["transform"].at(0)[0, 3] == 0.1
    )


def test_a_calibration_without_an_iris_and_shares_of_its_size(chain: Path) -> None:
    from daguerre.cli.flags.calibration import CalibrationFlags

    flags = CalibrationFlags(calibration=[f"{chain}:cam1"])
    (found,) = flags.found.values()
    base = dg.Camera(f_stop=2)
    assert flags.camera(base, found, {}).f_stop == 2
    assert flags.camera(base, found, {"lens": "pinhole"}).f_stop is None
    phone = Calibration(dg.Projection("opencv", (4032, 3024), (2713, 2713)))
    assert flags.resolution(phone, "2%", (960, 540)) == (81, 61)  # 60.48 rows, but 81 columns
    assert flags.resolution(phone, "50%", (960, 540)) == (2016, 1512)


def test_a_render_by_the_command_line(tmp_path: Path, chain: Path) -> None:
    from daguerre.cli import main

    scene, out = tmp_path / "chart.glb", tmp_path / "out.exr"
    assert main(["chart", "slanted-edge", "-o", str(scene)]) == 0
    base = ["render", str(scene), "--spp", "1", "--quiet", "-o", str(out)]
    given = [*base, "--calibration", f"{chain}:cam1", "--pixel-pitch", "6", "--res", "25%"]
    assert main(given) == 0
    camera = dg.load_frame(out).metadata["camera"]
    assert camera["projection"]["model"] == "double_sphere"
    assert camera["sensor_size_mm"] == pytest.approx([3.84, 2.88])
    assert dg.load_frame(out).rgb.shape == (120, 160, 3)
    for flags in (
        ["--lens", "thin"],
        ["--focal-length", "35"],
        ["--tilt", "1,0"],
        ["--fit", "vertical"],
        ["--focus-breathing"],
        ["--lens", "pinhole", "--f-stop", "2"],
    ):
        assert main([*given, *flags]) == 2
    assert main([*given, "--lens", "pinhole"]) == 0
    assert main([*base, "--pixel-pitch", "6"]) == 2
    assert main([*base, "--calibration", f"{chain}:cam7"]) == 2
    assert main([*base, "--calibration", str(tmp_path / "no.yaml")]) == 3


def test_what_we_write_for_nvidia_says_the_same(tmp_path: Path) -> None:
    """A rig of USD cameras, by the names that Isaac Sim reads."""
    usd = pytest.importorskip("pxr.Usd")
    pose = dg.look_at((0.1, 0.02, -0.03), (0.2, 0.1, -3))
    rig = [
        Calibration(MADE["rational"], "left", pixel_pitch=3.45),
        Calibration(MADE["kannala_brandt"], rig_from_camera=pose, pixel_pitch=3.45),
    ]
    calibration.write(tmp_path / "rig.usda", rig, "usd")
    stage = usd.Stage.Open(str(tmp_path / "rig.usda"))
    left, right = (stage.GetPrimAtPath(f"/World/{name}") for name in ("left", "cam1"))
    stem = "omni:lensdistortion:opencvPinhole:"
    got = [
        left.GetAttribute(stem + k).Get() for k in ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6")
    ]
    np.testing.assert_allclose(got, RATIONAL, rtol=1e-6)
    # NVIDIA counts pixels from the corner of the picture.
    assert left.GetAttribute(stem + "cx").Get() == pytest.approx(K[0, 2] + 0.5)
    assert left.GetAttribute("horizontalAperture").Get() == pytest.approx(640 * 3.45e-3 / 100)
    assert right.GetAttribute("omni:lensdistortion:model").Get() == "opencvFisheye"
    np.testing.assert_allclose(right.GetAttribute("xformOp:translate").Get(), pose[:3, 3])
    with pytest.raises(UsageError, match=r"\.usda"):
        calibration.write(tmp_path / "rig.yaml", rig, "usd")
