"""Calibrations of EuRoC, camodocal, basalt, BOP and KITTI against formulas; others by name."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from daguerre import calibration
from daguerre.calibration.foreign import READ
from daguerre.cli import main
from daguerre.errors import InputError, UsageError
from daguerre.lenses.foreign_json import READ as READ_LENSES

cv2 = pytest.importorskip("cv2")

#: Files that are kept beside the project.
CASES = Path(__file__).parents[3] / "shared" / "cases" / "files"
K = np.array([[458.6, 0, 367.2], [0, 457.3, 248.4], [0, 0, 1]])
STILL = (np.zeros(3), np.zeros(3))
POINTS = np.array([[0.3, -0.2, 1.2], [-0.5, 0.3, 1.1], [0.02, 0.01, 0.9], [0.4, 0.35, 1.0]])
BROWN = (-0.28, 0.07, 2e-4, 2e-5)
RATIONAL = (0.1, -0.05, 1e-3, -2e-3, 0.01, 0.12, -0.03, 0.004)
FISHEYE = (0.01, -0.003, 0.001, -2e-4)
FLIP = np.diag((1.0, -1.0, -1.0, 1.0))

Formula = Callable[[np.ndarray], np.ndarray]


def brown(*values: float) -> Formula:
    return lambda p: cv2.projectPoints(p, *STILL, K, np.array(values))[0].reshape(-1, 2)


def fisheye(p: np.ndarray) -> np.ndarray:
    return cv2.fisheye.projectPoints(p[:, None], *STILL, K, np.array(FISHEYE))[0].reshape(-1, 2)


def pinhole(p: np.ndarray) -> np.ndarray:
    return (p[:, :2] / p[:, 2:]) @ K[:2, :2] + K[:2, 2]


def double_sphere(xi: float, alpha: float) -> Formula:
    """Usenko, Demmel and Cremers 2018, equations (40) to (42)."""

    def project(p: np.ndarray) -> np.ndarray:
        d1 = np.linalg.norm(p, axis=1)
        z = xi * d1 + p[:, 2]
        d2 = np.hypot(np.hypot(p[:, 0], p[:, 1]), z)
        return p[:, :2] / (alpha * d2 + (1 - alpha) * z)[:, None] @ K[:2, :2] + K[:2, 2]

    return project


def unified(alpha: float, beta: float = 1.0) -> Formula:
    """Usenko, Demmel and Cremers 2018, equations (9) and (20): UCM, and EUCM with beta."""

    def project(p: np.ndarray) -> np.ndarray:
        d = np.sqrt(beta * (p[:, 0] ** 2 + p[:, 1] ** 2) + p[:, 2] ** 2)
        return p[:, :2] / (alpha * d + (1 - alpha) * p[:, 2])[:, None] @ K[:2, :2] + K[:2, 2]

    return project


def mei(p: np.ndarray) -> np.ndarray:
    """CataCamera of camodocal: onto the unit sphere, seen from xi above it, then distorted."""
    on = p / np.linalg.norm(p, axis=1)[:, None] + (0, 0, 0.9)
    x, y = on[:, 0] / on[:, 2], on[:, 1] / on[:, 2]
    k1, k2, p1, p2 = BROWN
    r2 = x * x + y * y
    radial = k1 * r2 + k2 * r2 * r2
    x, y = (
        x + x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
        y + y * radial + 2 * p2 * x * y + p1 * (r2 + 2 * y * y),
    )
    return np.stack([x, y], 1) @ K[:2, :2] + K[:2, 2]


def _yaml(path: Path, value: Any) -> Path:
    path.write_text(f"%YAML:1.0\n---\n{json.dumps(value)}\n")
    return path


def _json(path: Path, value: Any) -> Path:
    path.write_text(json.dumps(value))
    return path


def same(found: calibration.Calibration, formula: Formula) -> None:
    np.testing.assert_allclose(found.projection.project(POINTS), formula(POINTS), atol=1e-9)
    assert found.projection.size == (752, 480)


EUROC = {
    "sensor_type": "camera",
    "T_BS": {"cols": 4, "rows": 4, "data": np.eye(4).ravel().tolist()},
    "rate_hz": 20,
    "resolution": [752, 480],
    "camera_model": "pinhole",
    "intrinsics": [458.6, 457.3, 367.2, 248.4],
}


@pytest.mark.parametrize(
    ("name", "values", "formula"),
    [
        ("radial-tangential", BROWN, brown(*BROWN)),
        ("equidistant", FISHEYE, fisheye),
        (None, None, pinhole),
    ],
)
def test_euroc(tmp_path: Path, name: str | None, values: Any, formula: Formula) -> None:
    more = {} if name is None else {"distortion_model": name, "distortion_coefficients": values}
    path = _yaml(tmp_path / "sensor.yaml", EUROC | more)
    (found,) = calibration.read_all(path).values()
    same(found, formula)
    assert found.notes[0].startswith("T_BS")
    for wrong, message in (
        ({"intrinsics": [1, 2, 3]}, "got 3"),
        ({"resolution": [752]}, "width and height"),
        ({"camera_model": "omni"}, "wanted pinhole"),
        ({"distortion_model": "radial"}, "wanted radial-tangential"),
        ({"T_BS": np.ones((4, 4)).tolist()}, "a rotation"),
    ):
        with pytest.raises(InputError, match=message):
            calibration.read_all(_yaml(path, EUROC | more | wrong))


def _camodocal(kind: str, **sections: dict[str, float]) -> dict[str, Any]:
    size = {"image_width": 752, "image_height": 480}
    return {"model_type": kind, "camera_name": "own", **size, **sections}


_LENS = {"fx": 458.6, "fy": 457.3, "cx": 367.2, "cy": 248.4}
_BENT = dict(zip(("k1", "k2", "p1", "p2"), BROWN, strict=True))


@pytest.mark.parametrize(
    ("given", "formula"),
    [
        (
            _camodocal("PINHOLE", distortion_parameters=_BENT, projection_parameters=_LENS),
            brown(*BROWN),
        ),
        (
            _camodocal(
                "PINHOLE_FULL",
                distortion_parameters=dict(
                    zip(("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"), RATIONAL, strict=True)
                ),
                projection_parameters=_LENS,
            ),
            brown(*RATIONAL),
        ),
        (
            _camodocal(
                "KANNALA_BRANDT",
                projection_parameters={
                    **dict(zip(("k2", "k3", "k4", "k5"), FISHEYE, strict=True)),
                    **{"mu": 458.6, "mv": 457.3, "u0": 367.2, "v0": 248.4},
                },
            ),
            fisheye,
        ),
        (
            _camodocal(
                "MEI",
                mirror_parameters={"xi": 0.9},
                distortion_parameters=_BENT,
                projection_parameters={
                    "gamma1": 458.6, "gamma2": 457.3, "u0": 367.2, "v0": 248.4,
                },
            ),
            mei,
        ),
    ],
    ids=lambda value: value["model_type"] if isinstance(value, dict) else "",
)  # fmt: skip
def test_camodocal(tmp_path: Path, given: dict[str, Any], formula: Formula) -> None:
    path = _yaml(tmp_path / "cam0.yaml", given)
    found = calibration.read(path)
    same(found, formula)
    assert found.name == "own"
    with pytest.raises(InputError, match=r"wanted PINHOLE.* got 'SCARAMUZZA'"):
        calibration.read_all(_yaml(path, given | {"model_type": "SCARAMUZZA"}))
    with pytest.raises(InputError, match="projection_parameters"):
        calibration.read_all(_yaml(path, given | {"projection_parameters": {}}))


def _basalt(kind: str, **numbers: float) -> dict[str, Any]:
    """Two such cameras, the second 0.1 m to the right and turned by 10 degrees about y."""
    half = np.radians(5)
    second = {"px": 0.1, "py": 0.0, "pz": 0.0, "qx": 0.0, "qy": np.sin(half), "qz": 0.0}
    first = {"px": 0.5, "py": 0.2, "pz": -0.3, "qx": 0.5, "qy": 0.5, "qz": 0.5, "qw": 0.5}
    turn = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])  # of (0.5, 0.5, 0.5, 0.5)
    place = turn @ (0.1, 0, 0) + (0.5, 0.2, -0.3)
    w, x, y, z = 0.5, 0.5, 0.5, 0.5
    c, s = np.cos(half), np.sin(half)  # Hamilton's product with (c, 0, s, 0)
    second = {
        **dict(zip(("px", "py", "pz"), place.tolist(), strict=True)),
        **{"qw": w * c - y * s, "qx": x * c - z * s, "qy": y * c + w * s, "qz": z * c + x * s},
    }
    camera = {"camera_type": kind, "intrinsics": {**_LENS, **numbers}}
    return {
        "value0": {
            "T_imu_cam": [first, second],
            "intrinsics": [camera, camera],
            "resolution": [[752, 480], [752, 480]],
        }
    }


@pytest.mark.parametrize(
    ("given", "formula"),
    [
        (_basalt("pinhole"), pinhole),
        (_basalt("ds", xi=-0.2, alpha=0.57), double_sphere(-0.2, 0.57)),
        (_basalt("eucm", alpha=0.57, beta=1.1), unified(0.57, 1.1)),
        (_basalt("ucm", alpha=0.57), unified(0.57)),
        (_basalt("kb4", **dict(zip(("k1", "k2", "k3", "k4"), FISHEYE, strict=True))), fisheye),
        (
            _basalt(
                "pinhole-radtan8",
                **dict(
                    zip(("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"), RATIONAL, strict=True)
                ),
                rpmax=2.0,
            ),
            brown(*RATIONAL),
        ),
    ],
    ids=lambda v: v["value0"]["intrinsics"][0]["camera_type"] if isinstance(v, dict) else "",
)
def test_basalt(tmp_path: Path, given: dict[str, Any], formula: Formula) -> None:
    found = calibration.read_all(_json(tmp_path / "calibration.json", given))
    assert list(found) == ["cam0", "cam1"]
    for one in found.values():
        same(one, formula)
    np.testing.assert_array_equal(found["cam0"].rig_from_camera, np.eye(4))
    c, s = np.cos(np.radians(10)), np.sin(np.radians(10))
    second = np.array([[c, 0, s, 0.1], [0, 1, 0, 0], [-s, 0, c, 0], [0, 0, 0, 1]])
    np.testing.assert_allclose(found["cam1"].rig_from_camera, FLIP @ second @ FLIP, atol=1e-12)


def test_bad_rigs_of_basalt(tmp_path: Path) -> None:
    path, given = tmp_path / "calibration.json", _basalt("ds", xi=-0.2, alpha=0.57)
    for change, message in (
        ({"resolution": [[752, 480]]}, "got 2, 1 and 2"),
        ({"intrinsics": [{"camera_type": "bal"}] * 2}, "wanted pinhole"),
        ({"T_imu_cam": [{**given["value0"]["T_imu_cam"][0], "qw": 2.0}] * 2}, "length 1"),
    ):
        with pytest.raises(InputError, match=message):
            calibration.read_all(_json(path, {"value0": given["value0"] | change}))


def test_bop(tmp_path: Path) -> None:
    given = {**_LENS, "depth_scale": 1.0, "height": 480, "width": 752}
    (found,) = calibration.read_all(_json(tmp_path / "camera.json", given)).values()
    same(found, pinhole)
    with pytest.raises(UsageError, match="bop takes none"):
        calibration.read_all(tmp_path / "camera.json", size=(752, 480))


def _p(shift: tuple[float, float, float]) -> str:
    """P of a rectified camera that stands at a place of the first one's frame."""
    p = np.c_[K, K @ -np.array(shift)]
    return " ".join(f"{v:.15e}" for v in p.ravel())


def test_kitti_odometry_and_objects(tmp_path: Path) -> None:
    path = tmp_path / "calib.txt"
    shift = (0.54, -0.003, 0.0027)  # forward, too, as P2 of the object data has it
    path.write_text(
        f"P0: {_p((0, 0, 0))}\nP2: {_p(shift)}\nR0_rect: 1 0 0 0 1 0 0 0 1\n\n"
        "Tr_velo_to_cam: 1 0 0 0 0 1 0 0 0 0 1 0\n"
    )
    with pytest.raises(InputError, match="missing: the size of the picture"):
        calibration.read_all(path)
    found = calibration.read_all(path, size=(752, 480))
    assert list(found) == ["P0", "P2"]
    for one in found.values():
        same(one, pinhole)
    x, y, z = shift
    np.testing.assert_allclose(found["P2"].rig_from_camera[:3, 3], (x, -y, -z), atol=1e-12)
    assert list(calibration.read_all(path, size=(752, 480), rectified=True)) == ["P0", "P2"]


def test_kitti_raw(tmp_path: Path) -> None:
    turn, place = cv2.Rodrigues(np.array([0.01, -0.02, 0.03]))[0], np.array([-0.54, 0.01, 0.02])
    lines = ["calib_time: 09-Jan-2012 13:57:47", "corner_dist: 9.95e-02"]
    for i, (r, t) in enumerate(((np.eye(3), np.zeros(3)), (turn, place))):
        rows = {
            "S": (752, 480), "K": K.ravel(), "D": (*BROWN, -0.01), "R": r.ravel(), "T": t,
            "S_rect": (752, 480), "R_rect": np.eye(3).ravel(),
        }  # fmt: skip
        lines += [
            f"{name}_{i:02}: {' '.join(f'{v:.15e}' for v in values)}"
            for name, values in rows.items()
        ]
        lines.append(f"P_rect_{i:02}: {_p((0.54 * i, 0, 0))}")
    path = tmp_path / "calib_cam_to_cam.txt"
    path.write_text("\n".join(lines))
    raw = calibration.read_all(path)
    assert list(raw) == ["00", "01"]
    for one in raw.values():
        same(one, brown(*BROWN, -0.01))
    second = np.eye(4)
    second[:3, :3], second[:3, 3] = turn, place
    wanted = FLIP @ np.linalg.inv(second) @ FLIP
    np.testing.assert_allclose(raw["01"].rig_from_camera, wanted, atol=1e-12)
    straight = calibration.read_all(path, rectified=True)
    same(straight["01"], pinhole)
    np.testing.assert_allclose(straight["01"].rig_from_camera[:3, 3], (0.54, 0, 0), atol=1e-12)
    with pytest.raises(InputError, match="752 x 480 px, got 640 x 480"):
        calibration.read_all(path, size=(640, 480))
    path.write_text("\n".join(lines).replace("K_01", "K_00"))
    with pytest.raises(InputError, match="K_00 appears twice"):
        calibration.read_all(path)


UNKNOWN = {
    "models.json": ('{"own": {"projection_type": "perspective", "focal": 0.85}}', "OpenSfM"),
    "sensor.json": ('[{"token": "a", "camera_intrinsic": [[1, 0, 0]]}]', "nuScenes"),
    "aria.json": ('{"projection": {"model": "CameraModelType.FISHEYE624"}}', "Project Aria"),
    "slam.yaml": ('%YAML:1.0\nCamera.type: "PinHole"\nCamera1.fx: 458.6\n', "ORB-SLAM3"),
    "cameras.xml": ('<?xml version="1.0"?><document version="2"><chunk label="a"/></document>',
                    "Metashape"),
    "calib.txt": ("cam0=[1733.74 0 792.27; 0 1733.74 541.89; 0 0 1]\n", "Middlebury"),
    "scene_camera.json": ('{"0": {"cam_K": [1, 0, 0], "depth_scale": 1}}', "BOP scene_camera"),
    "other.json": ('{"fx": 500}', "missing: a camera matrix"),
    "list.json": ("[1, 2]", "wanted"),
    "other.xml": ("<colors/>", "got <colors>"),
    "other.txt": ("a text", "wanted names and values"),
    "other.bin": ("\x00\x01", "YAML"),
}  # fmt: skip


@pytest.mark.parametrize("name", UNKNOWN)
def test_files_of_others_are_named_and_all_that_is_read(name: str, tmp_path: Path) -> None:
    text, message = UNKNOWN[name]
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(InputError, match=message) as caught:
        calibration.read_all(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert str(caught.value).endswith(READ)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('{"surface_group": {}, "fields": {}}', "a lens of optiland"),
        ('{"optical_model": {}}', "a lens of ray-optics"),
        ('{"surfaces": [], "d_sensor": 5.0}', "a lens of DeepLens.*write_lens_zmx"),
        ('{"lens": 1}', "schema: missing"),
    ],
)
def test_lenses_of_others_are_named_and_all_that_is_read(
    text: str, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "lens.json"
    path.write_text(text)
    assert main(["lens", str(path)]) == 3
    error = capsys.readouterr().err
    assert READ_LENSES in error
    with pytest.raises(InputError, match=message):
        calibration_of_lens(path)


def calibration_of_lens(path: Path) -> object:
    from daguerre import lenses

    return lenses.load(str(path))


@pytest.mark.skipif(not CASES.is_dir(), reason="../shared/cases/files is not here")
@pytest.mark.parametrize("name", ["bop_camera.json", "euroc_sensor.yaml", "kitti_calib.txt"])
def test_files_that_were_refused(name: str) -> None:
    size = (1241, 376) if name == "kitti_calib.txt" else None
    assert calibration.read_all(CASES / name, size=size)


@pytest.mark.skipif(not CASES.is_dir(), reason="../shared/cases/files is not here")
@pytest.mark.parametrize(
    "name",
    [
        *("aria.json", "metashape.xml", "nuscenes_calibrated_sensor.json"),
        *("opensfm_camera_models.json", "middlebury_calib.txt"),
    ],
)
def test_files_of_others_say_what_is_read(name: str) -> None:
    with pytest.raises(InputError, match="which is not read: ") as caught:
        calibration.read_all(CASES / name)
    assert str(caught.value).endswith(READ)
