"""Calibrations of several cameras, and of pictures as they are read out: OpenCV, ROS, COLMAP."""

from __future__ import annotations

import json
import random
import re
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre import calibration
from daguerre.calibration import Calibration
from daguerre.errors import DaguerreError, InputError, UsageError
from daguerre.files.reading import shown

cv2 = pytest.importorskip("cv2")

SIZE = (640, 480)
K1 = np.array([[520.0, 0, 331.3], [0, 515, 236.8], [0, 0, 1]])
K2 = np.array([[510.0, 0, 318.1], [0, 506, 245.2], [0, 0, 1]])
D1 = np.array([[-0.28, 0.09, 1e-3, -2e-3, -0.01]])
D2 = np.array([[-0.25, 0.07, -5e-4, 1e-3, 0.0]])
R = cv2.Rodrigues(np.array([0.03, -0.06, 0.02]))[0]
T = np.array([[-0.12], [0.004], [0.006]])
STILL = (np.zeros(3), np.zeros(3))
#: Points in the first camera's frame, y down; off its axis on all sides.
POINTS = np.array([[0.3, -0.2, 1.2], [-0.3, 0.3, 1.1], [0.02, 0.01, 0.9], [0.25, 0.3, 1.0]])
FLIP = np.diag((1.0, -1, -1, 1))


def seen(one: Calibration, points: np.ndarray = POINTS) -> np.ndarray:
    """Pixels of points of the rig's frame, y down."""
    camera_from_rig = FLIP @ np.linalg.inv(one.rig_from_camera) @ FLIP
    moved = points @ camera_from_rig[:3, :3].T + camera_from_rig[:3, 3]
    return np.asarray(one.projection.project(moved))


def rectification() -> dict[str, np.ndarray]:
    r1, r2, p1, p2, q, *_ = cv2.stereoRectify(K1, D1, K2, D2, SIZE, R, T, alpha=0)
    return {"R1": r1, "R2": r2, "P1": p1, "P2": p2, "Q": q}


def pair(**more: Any) -> dict[str, Any]:
    found = {"M1": K1, "D1": D1, "M2": K2, "D2": D2, "R": R, "T": T, "image_size": SIZE}
    return {**found, **rectification(), **more}


def store(path: Path, values: dict[str, Any]) -> Path:
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
    for name, value in values.items():
        storage.write(name, value)
    storage.release()
    return path


@pytest.mark.parametrize("suffix", ["yml", "xml", "json"])
def test_a_pair_by_opencv_sees_what_opencv_projects(tmp_path: Path, suffix: str) -> None:
    values = {name: value for name, value in pair().items() if name != "image_size"}
    path = store(tmp_path / f"stereo.{suffix}", values)
    found = calibration.read_all(path, size=SIZE)
    assert list(found) == ["left", "right"]
    left = cv2.projectPoints(POINTS, *STILL, K1, D1)[0].reshape(-1, 2)
    right = cv2.projectPoints(POINTS, R, T, K2, D2)[0].reshape(-1, 2)
    np.testing.assert_allclose(seen(found["left"]), left, atol=1e-9)
    np.testing.assert_allclose(seen(found["right"]), right, atol=1e-9)


def test_the_two_files_of_opencvs_sample(tmp_path: Path) -> None:
    """Its extrinsics lie beside the intrinsics; the board's squares were millimetres."""
    inner = store(tmp_path / "intrinsics.yml", {"M1": K1, "D1": D1, "M2": K2, "D2": D2})
    with pytest.raises(InputError, match=r"missing: R, T, here or in .*extrinsics.yml"):
        calibration.read_all(inner, size=SIZE)
    store(tmp_path / "extrinsics.yml", {"R": R, "T": 1e3 * T, **rectification()})
    found = calibration.read_all(inner, size=SIZE, unit_m=1e-3)
    right = cv2.projectPoints(POINTS, R, T, K2, D2)[0].reshape(-1, 2)
    np.testing.assert_allclose(seen(found["right"]), right, atol=1e-9)
    assert not found["right"].notes
    assert "120.2 m apart" in calibration.read_all(inner, size=SIZE)["right"].notes[0]
    camera = dg.Camera.from_opencv(inner, "right", size=SIZE, unit_m=1e-3)
    assert camera.transform[0, 3] == pytest.approx(-(R.T @ T)[0, 0])


def test_a_rectified_pair_sees_what_opencv_rectifies() -> None:
    found = calibration.read_all(pair(), rectified=True)
    values = rectification()
    pixels = {}
    for name, number, pose, k, d in (
        ("left", 1, STILL, K1, D1),
        ("right", 2, (R, T), K2, D2),
    ):
        raw = cv2.projectPoints(POINTS, *pose, k, d)[0]
        turn, onto = values[f"R{number}"], values[f"P{number}"]
        ways = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 200, 1e-12)
        wanted = cv2.undistortPoints(raw, k, d, None, turn, onto, ways).reshape(-1, 2)
        pixels[name] = seen(found[name])
        np.testing.assert_allclose(pixels[name], wanted, atol=1e-6)
    np.testing.assert_allclose(pixels["left"][:, 1], pixels["right"][:, 1], atol=1e-9)
    depth = (POINTS @ values["R1"].T)[:, 2]
    disparity = -values["P2"][0, 3] / depth  # focal length times baseline over depth
    np.testing.assert_allclose(pixels["left"][:, 0] - pixels["right"][:, 0], disparity, atol=1e-9)


def test_a_pair_of_fisheyes_is_asked_for() -> None:
    k = np.array([0.01, -0.003, 0.001, -2e-4])
    found = calibration.read_all(pair(D1=k, D2=k), model="fisheye")
    wanted = cv2.fisheye.projectPoints(POINTS[:, None], *STILL, K1, k)[0].reshape(-1, 2)
    np.testing.assert_allclose(seen(found["left"]), wanted, atol=1e-9)


def ros(number: int = 1, **more: Any) -> dict[str, Any]:
    values = rectification()
    k, d = (K1, D1) if number == 1 else (K2, D2)
    message = {"width": 640, "height": 480, "K": k.ravel(), "D": d.ravel()}
    turned = {"R": values[f"R{number}"].ravel(), "P": values[f"P{number}"].ravel()}
    return {**message, "distortion_model": "plumb_bob", **turned, **more}


def test_rectified_pictures_of_ros_are_those_of_p() -> None:
    """The rig's frame is that of the left camera after rectification."""
    turned = POINTS @ rectification()["R1"].T
    raw = {n: calibration.read_ros(ros(n)) for n in (1, 2)}
    right = cv2.projectPoints(POINTS, R, T, K2, D2)[0].reshape(-1, 2)
    np.testing.assert_allclose(seen(raw[2], turned), right, atol=1e-9)
    for number in (1, 2):
        found = calibration.read_ros(ros(number), rectified=True)
        onto = rectification()[f"P{number}"]
        ahead = np.c_[turned, np.ones(len(turned))] @ onto.T
        np.testing.assert_allclose(seen(found, turned), ahead[:, :2] / ahead[:, 2:], atol=1e-9)
    assert dg.Camera.from_ros(ros(), rectified=True).projection.model == "rectilinear"  # type: ignore[union-attr]


def test_regions_and_binning_say_which_pixels_of_the_sensor_are_read() -> None:
    whole = calibration.read_ros(ros()).projection
    region = {"x_offset": 64, "y_offset": 32, "width": 320, "height": 200, "do_rectify": False}
    found = calibration.read_ros(ros(roi=region)).projection
    assert found.size == (320, 200)
    at = whole.project(POINTS)
    np.testing.assert_allclose(found.project(POINTS), at - (64, 32), atol=1e-9)
    read = calibration.read_ros(ros(roi=region, binning_x=4, binning_y=2))
    assert read.projection.size == (80, 100)
    # Pixel (0, 0) is the mean of columns 64 .. 67 and rows 32, 33: its centre lies at (65.5, 32.5).
    wanted = (at - (65.5, 32.5)) / (4, 2)
    np.testing.assert_allclose(read.projection.project(POINTS), wanted, atol=1e-9)
    assert "4 x 2" in read.notes[0]
    empty = {"x_offset": 0, "y_offset": 0, "width": 0, "height": 0}
    assert calibration.read_ros(ros(roi=empty, binning_x=0)).projection == whole
    with pytest.raises(InputError, match="must not have a region"):
        calibration.read_ros(ros(roi=region), rectified=True)
    assert calibration.read({"msg": ros(), "topic": "/left"}).projection == whole


def chain(*shifts: float | None) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for i, shift in enumerate(shifts):
        one = {"camera_model": "pinhole", "distortion_model": "none", "resolution": [640, 480]}
        one |= {"intrinsics": [500, 500, 320, 240]}  # type: ignore[dict-item]
        one |= {"timeshift_cam_imu": shift} if shift is not None else {}  # type: ignore[dict-item]
        found[f"cam{i}"] = one | ({"T_cn_cnm1": np.eye(4)} if i else {})  # type: ignore[dict-item]
    return found


def test_cameras_of_a_chain_are_triggered_apart() -> None:
    """The IMU's time is the camera's and the shift: with equal stamps, the larger was later."""
    from daguerre.camera import shutter

    base = dg.Camera(fps=50, shutter_time=0.01)
    given = chain(0.002, 0.005, None)
    opens = {}
    for name in given:
        camera = dg.Camera.from_kalibr(given, name, timeshift=True, camera=base)
        opens[name] = shutter.interval(camera, 1.0, (640, 480))[0]
    wanted = {"cam0": 0.995, "cam1": 0.998, "cam2": 0.993}
    assert opens == pytest.approx(wanted, abs=1e-12)
    plain = dg.Camera.from_kalibr(given, "cam1", camera=base)
    assert shutter.interval(plain, 1.0, (640, 480))[0] == pytest.approx(0.995)
    offset = base.with_(shutter_offset=0.25)
    camera = dg.Camera.from_kalibr(given, "cam1", timeshift=True, camera=offset)
    assert shutter.interval(camera, 1.0, (640, 480))[0] == pytest.approx(1.008)


CAMERAS = """# Camera list
1 OPENCV 640 480 520 515 331.8 237.3 -0.28 0.09 0.001 -0.002
2 SIMPLE_RADIAL 640 480 500 320 240 -0.1
7 FULL_OPENCV 640 480 520 515 331.8 237.3 0.1 -0.05 0.001 -0.002 0.01 0.12 -0.03 0.004
8 OPENCV_FISHEYE 640 480 520 515 331.8 237.3 0.01 -0.003 0.001 -0.0002
9 FOV 640 480 520 515 331.8 237.3 0.9
"""


def quaternion(turn: np.ndarray) -> np.ndarray:
    """(w, x, y, z) of a rotation by less than a half turn."""
    axis = cv2.Rodrigues(turn)[0].ravel()
    angle = np.linalg.norm(axis)
    return np.array([np.cos(angle / 2), *(np.sin(angle / 2) / angle * axis)])


def colmap(folder: Path, cameras: str = CAMERAS) -> Path:
    q = " ".join(map(str, quaternion(R)))
    t = " ".join(map(str, T.ravel()))
    (folder / "cameras.txt").write_text(cameras)
    (folder / "images.txt").write_text(
        f"# Image list\n1 {q} {t} 1 a/plate one.jpg\n\n3 {q} {t} 7 b.jpg\n10 20 5 30 40 -1\n"
        "4 1 0 0 0 0 0 0 8 c.jpg\n\n"
    )
    return folder


def test_colmap_has_pixel_centres_at_halves_and_poses_of_its_world(tmp_path: Path) -> None:
    found = calibration.read_all(colmap(tmp_path))
    assert list(found) == ["a/plate one.jpg", "b.jpg", "c.jpg"]
    # 331.8 there is 331.3 in OpenCV's pixels.
    k = {"a/plate one.jpg": (-0.28, 0.09, 1e-3, -2e-3)}
    k["b.jpg"] = (0.1, -0.05, 1e-3, -2e-3, 0.01, 0.12, -0.03, 0.004)
    for name, values in k.items():
        camera = found[name].camera()
        camera_from_world = FLIP @ np.linalg.inv(camera.transform)
        points = np.c_[POINTS, np.ones(len(POINTS))] @ camera_from_world.T
        wanted = cv2.projectPoints(POINTS, R, T, K1, np.array(values))[0].reshape(-1, 2)
        np.testing.assert_allclose(found[name].projection.project(points[:, :3]), wanted, atol=1e-9)
    wide = cv2.fisheye.projectPoints(
        POINTS[:, None], *STILL, K1, np.array([0.01, -0.003, 0.001, -2e-4])
    )
    np.testing.assert_allclose(seen(found["c.jpg"]), wide[0].reshape(-1, 2), atol=1e-9)
    np.testing.assert_array_equal(found["c.jpg"].camera().transform, FLIP)
    camera = dg.Camera.from_colmap(tmp_path, "b.jpg", unit_m=0.5)
    np.testing.assert_allclose(camera.transform[:3, 3], 0.5 * (-R.T @ T).ravel(), atol=1e-12)
    (tmp_path / "images.txt").unlink()
    assert list(calibration.read_all(tmp_path)) == [f"camera{i}" for i in (1, 2, 7, 8, 9)]
    two = calibration.read(tmp_path, "camera2").projection
    assert (two.focal, two.principal, two.parameters) == ((500, 500), (319.5, 239.5), (-0.1,))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("1 OPENCV 640", "line 1: wanted CAMERA_ID"),
        ("1 OPENC 640 480 1 2 3", "'OPENCV'"),
        ("1 PINHOLE 640 480 1 2 3", "wanted 4 parameters, got 3"),
        ("1 PINHOLE 640.5 480 1 2 3 4", "whole numbers"),
        ("1 PINHOLE 640 480 1e99 2 3 4", "finite number"),
        ("1 PINHOLE 640 480 -1 2 3 4", "focal"),
        ("1 PINHOLE 640 480 500 500 3 4\n" * 2, "line 2: camera 1 appears twice"),
        ("2 PINHOLE 640 480 500 500 3 4", "line 2: wanted a CAMERA_ID of cameras.txt, got '1'"),
        ("1 RADIAL 640 480 500 320 240 -0.9 0", "line 1: opencv: the radial polynomial folds"),
        ("# nothing", "no cameras"),
    ],
)
def test_bad_models_of_colmap(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        calibration.read_all(colmap(tmp_path, text))


def test_bad_pictures_of_colmap(tmp_path: Path) -> None:
    images = colmap(tmp_path) / "images.txt"
    for text, message in (
        ("1 1 0 0 0 0 0 0 1", "got 9 words"),
        ("1 2 0 0 0 0 0 0 1 a", "length 1"),
        ("1 nan 0 0 0 0 0 0 1 a", "finite"),
        ("1 1 0 0 0 0 0 0 1 a\n\n2 1 0 0 0 0 0 0 1 a", "line 3: picture 'a' appears twice"),
        ("", "no pictures"),
    ):
        images.write_text(text)
        with pytest.raises(InputError, match=message):
            calibration.read_all(tmp_path)
    images.write_bytes(b"\xff\xfe1")
    with pytest.raises(InputError, match="UTF-8"):
        calibration.read_all(tmp_path)
    with pytest.raises(InputError, match="no such file"):
        calibration.read_all(tmp_path / "cameras" / "cameras.txt")


def test_a_missing_folder_of_colmap_is_named(tmp_path: Path) -> None:
    for path in (tmp_path / "nope", tmp_path / "nope" / "sparse"):
        with pytest.raises(InputError, match=f"^{re.escape(shown(path))}: no such folder; wanted"):
            dg.Camera.from_colmap(path)


def transforms(**more: Any) -> dict[str, Any]:
    """Pictures of ``CAMERAS`` 1 and 8 as Nerfstudio has them: OpenGL's axes, world from camera."""
    world_from_camera = np.eye(4)
    world_from_camera[:3, :3] = R.T
    world_from_camera[:3, 3:] = -R.T @ T
    lens = {"w": 640, "h": 480, "fl_x": 520, "fl_y": 515, "cx": 331.8, "cy": 237.3}
    bent = {"k1": -0.28, "k2": 0.09, "p1": 1e-3, "p2": -2e-3}
    one = {"file_path": "images/a.jpg", "transform_matrix": world_from_camera @ FLIP, **bent}
    two = {"file_path": "images/c.jpg", "transform_matrix": FLIP, "is_fisheye": True}
    two |= {"k1": 0.01, "k2": -0.003, "k3": 0.001, "k4": -2e-4}
    return {**lens, "frames": [one, two], **more}


def test_transforms_are_colmaps_cameras_in_opengls_axes(tmp_path: Path) -> None:
    truth = calibration.read_all(colmap(tmp_path))
    found = calibration.read_all(transforms())
    for name, same in (("images/a.jpg", "a/plate one.jpg"), ("images/c.jpg", "c.jpg")):
        one, other = found[name], truth[same]
        moved = one.camera().transform
        np.testing.assert_allclose(moved, other.camera().transform, atol=1e-12)
        np.testing.assert_allclose(
            one.projection.project(POINTS), other.projection.project(POINTS), atol=1e-9
        )
    half = calibration.read(transforms(), "images/a.jpg", unit_m=0.5).camera()
    np.testing.assert_allclose(half.transform[:3, 3], 0.5 * (-R.T @ T).ravel(), atol=1e-12)
    plain = {"file_path": "a", "transform_matrix": np.eye(4)}
    angles = {"camera_angle_x": np.pi / 2, "frames": [plain]}
    made = calibration.read(angles, size=(800, 600)).projection
    assert (made.model, made.center) == ("rectilinear", (399.5, 299.5))
    assert made.focal == pytest.approx((400, 400))


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"frames": []}, "no pictures"),
        ({"frames": [{}]}, r"frames\[0\].file_path: missing"),
        ({"w": None}, "w: wrong type"),
        ({"w": 640.5}, "whole number"),
        ({"fl_x": 0}, "above 0"),
        ({"k4": 0.1}, "k4: wanted k1, k2, p1, p2, k3 for opencv, got k4"),
        ({"camera_model": "OPENC"}, "'OPENCV'"),
        ({"frames": [{"file_path": "a", "transform_matrix": 2 * np.eye(4)}]}, "a rotation"),
        ({"frames": [{"file_path": "a", "transform_matrix": np.eye(4)}] * 2}, "'a' appears twice"),
    ],
)
def test_bad_transforms(more: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        calibration.read_all(transforms(**more))


XML = '<?xml version="1.0"?>\n{}<opencv_storage>{}</opencv_storage>\n'


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            XML.format("<!DOCTYPE a [<!ENTITY b 'c'>]>", "<K>&b;</K>"),
            "x.xml: XML: line 2, column 13: .*DOCTYPE",
        ),
        (XML.format("", "<K>1</K><K>2</K>"), "<K> appears twice"),
        (XML.format("", "<K>1</M>"), "line 2, column .*mismatched"),
        (XML.format("", "<a>" * 70 + "</a>" * 70), "nested too deeply"),
        ("<opencv_storage><K>1 2", "empty or truncated"),
        ("<storage></storage>", "wanted <opencv_storage>, .* got <storage>"),
        ('<?xml version="1.0" encoding="klingon"?><opencv_storage/>', "encoding"),
        (XML.format("", "<K>" + "9" * 5000 + "</K>"), "digit"),
        (XML.format("", "text"), "wanted names and values"),
        (XML.format("", "<_>1</_><_>2</_>"), "wanted names and values"),
        (XML.format("", "<K>1</K>"), "a list"),
    ],
)
def test_xml_that_calibrations_do_not_need_is_refused(
    tmp_path: Path, text: str, message: str
) -> None:
    path = tmp_path / "x.xml"
    path.write_text(text)
    with pytest.raises(InputError, match=message) as error:
        calibration.read(path)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (pair(M2=K2[:2]), "3 x 3"),
        (pair(R=2 * R), "R: wanted a rotation"),
        (pair(T=[1, 2]), "wanted 3 numbers"),
        (pair(D2=[0.1] * 7), "got 7"),
        (pair(D2=[-0.9, 0, 0, 0]), "camera 2: opencv: the radial polynomial folds"),
        ({name: value for name, value in pair().items() if name != "R"}, "missing: R, T$"),
        ({name: v for name, v in pair().items() if name != "image_size"}, "size of the picture"),
    ],
)
def test_bad_pairs(given: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        calibration.read_all(given)


def test_options_belong_to_formats(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="rectified: wanted ROS"):
        calibration.read_all(chain(0), rectified=True)
    with pytest.raises(UsageError, match="unit: wanted COLMAP"):
        calibration.read_all(ros(), unit_m=1e-3)
    with pytest.raises(UsageError, match="unit_m"):
        calibration.read_all(pair(), unit_m=0)
    with pytest.raises(UsageError, match="model: ros takes none"):
        calibration.read_all(ros(), model="fisheye")
    with pytest.raises(UsageError, match="a folder"):
        calibration.read_all(pair(), format="colmap")
    with pytest.raises(UsageError, match="left, right; got 'middle'"):
        calibration.read(pair(), "middle")
    with pytest.raises(InputError, match="fx 0 cx"):
        calibration.read(pair(P1=np.zeros((3, 4))), rectified=True)


def test_broken_files_are_errors_of_ours(tmp_path: Path) -> None:
    made = {name: value for name, value in pair().items() if name != "image_size"}
    made |= {"image_width": 640, "image_height": 480}
    texts = [store(tmp_path / f"a.{suffix}", made).read_text() for suffix in ("xml", "yml", "json")]
    folder = colmap(tmp_path)
    texts += [(folder / name).read_text() for name in ("cameras.txt", "images.txt")]
    given = transforms()
    for frame in given["frames"]:
        frame["transform_matrix"] = frame["transform_matrix"].tolist()
    texts.append(json.dumps(given))
    names = ["a.xml", "a.yml", "a.json", "cameras.txt", "images.txt", "transforms.json"]
    dice, read = random.Random(2), 0
    for i in range(300):
        text, name = texts[i % 6], names[i % 6]
        for _ in range(dice.randint(1, 3)):
            at, length = dice.randrange(len(text)), dice.choice((0, 1, 1, 7))
            text = (
                text[:at]
                + dice.choice('0123456789e.-[]{}<>/&;:,!*\n" \x00n~_')
                + text[at + length :]
            )
        (tmp_path / name).write_text(text)
        with suppress(DaguerreError):  # and nothing else
            calibration.read_all(tmp_path / name, rectified=i % 4 == 0 and i % 6 < 3)
            read += 1
        (folder / "cameras.txt").write_text(CAMERAS)
    assert 5 < read < 280


def test_a_coefficient_of_the_name_of_a_matrix_makes_no_pair() -> None:
    given = {"K": K1, "image_size": SIZE, "K1": -0.1, "K2": 0.02}
    assert list(calibration.read_all(given)) == ["camera"]
