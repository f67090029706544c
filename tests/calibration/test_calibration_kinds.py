"""Calibration files as drivers and other programs write them: poses, lengths, folds."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre import calibration
from daguerre.calibration.calibration import field_notes
from daguerre.errors import InputError

cv2 = pytest.importorskip("cv2")

#: Files that are kept beside the project.
CASES = Path(__file__).parents[3] / "shared" / "cases" / "files"
SIZE = (640, 480)
K = np.array([[520.0, 0, 331.3], [0, 515, 236.8], [0, 0, 1]])
STILL = (np.zeros(3), np.zeros(3))
RATIONAL = (-0.03, 0.035, -1e-4, -1e-4, -0.012, 0.02, 0.01, -0.003)


def _pose(seed: int) -> np.ndarray:
    """A rotation and a translation."""
    dice = np.random.default_rng(seed)
    pose = np.eye(4)
    pose[:3, :3] = cv2.Rodrigues(dice.normal(size=3) * 0.3)[0]
    pose[:3, 3] = dice.normal(size=3) * 0.1
    return pose


def _chain(*names: str) -> tuple[dict[str, Any], list[np.ndarray]]:
    """A chain of three cameras with poses under these names, and cameras from the IMU."""
    poses = [_pose(i) for i in range(3)]
    found = {}
    for i, pose in enumerate(poses):
        one: dict[str, Any] = {
            "camera_model": "pinhole",
            "distortion_model": "none",
            "intrinsics": [500, 501, 320, 240],
            "resolution": [640, 480],
        }
        if "T_cam_imu" in names:
            one["T_cam_imu"] = pose
        if "T_imu_cam" in names:
            one["T_imu_cam"] = np.linalg.inv(pose)
        if "T_cn_cnm1" in names and i:
            one["T_cn_cnm1"] = pose @ np.linalg.inv(poses[i - 1])
        found[f"cam{i}"] = one
    return found, poses


@pytest.mark.parametrize(
    "names",
    [("T_cn_cnm1",), ("T_cam_imu",), ("T_imu_cam",), ("T_cn_cnm1", "T_cam_imu", "T_imu_cam")],
    ids="-".join,
)
def test_chains_stand_the_same_by_either_pose(names: tuple[str, ...]) -> None:
    chain, poses = _chain(*names)
    found = calibration.read_kalibr(chain)
    flip = np.diag((1.0, -1.0, -1.0, 1.0))
    for pose, one in zip(poses, found.values(), strict=True):
        wanted = flip @ poses[0] @ np.linalg.inv(pose) @ flip
        np.testing.assert_allclose(one.rig_from_camera, wanted, atol=1e-12)
        assert one.notes == ()


def test_poses_of_a_chain_that_disagree_are_noted() -> None:
    chain, _ = _chain("T_cn_cnm1", "T_cam_imu")
    moved = chain["cam2"]["T_cam_imu"].copy()
    moved[0, 3] += 0.02
    plain = calibration.read_kalibr(chain)
    found = calibration.read_kalibr({**chain, "cam2": {**chain["cam2"], "T_cam_imu": moved}})
    np.testing.assert_allclose(found["cam2"].rig_from_camera, plain["cam2"].rig_from_camera)
    (note,) = found["cam2"].notes
    assert "differ, by 20 mm: took T_cn_cnm1" in note


def test_a_chain_without_poses_is_refused() -> None:
    chain, _ = _chain()
    with pytest.raises(InputError, match=r"cam1: missing: T_cn_cnm1, or T_cam_imu or T_imu_cam"):
        calibration.read_kalibr(chain)
    chain, _ = _chain("T_cam_imu")
    chain["cam0"]["T_cam_imu"] = np.ones((4, 4))
    with pytest.raises(InputError, match=r"cam0\.T_cam_imu: wanted a rotation"):
        calibration.read_kalibr(chain)


def _ros(values: Any, name: str = "plumb_bob") -> dict[str, Any]:
    return {
        "image_width": SIZE[0],
        "image_height": SIZE[1],
        "distortion_model": name,
        "camera_matrix": {"rows": 3, "cols": 3, "data": K.ravel().tolist()},
        "distortion_coefficients": values,
    }


@pytest.mark.parametrize("cols", [5, 8])
def test_plumb_bob_of_eight_numbers_is_rational(cols: int) -> None:
    values = {"rows": 1, "cols": cols, "data": list(RATIONAL)}
    found = calibration.read_ros(_ros(values))
    points = np.array([[0.3, -0.2, 1.2], [-0.5, 0.3, 1.1], [0.4, 0.35, 1.0]])
    wanted = cv2.projectPoints(points, *STILL, K, np.array(RATIONAL))[0].reshape(-1, 2)
    np.testing.assert_allclose(found.projection.project(points), wanted, atol=1e-9)
    assert found.notes[0] == "plumb_bob has 8 coefficients: they are read as rational_polynomial"
    assert len(found.notes) == (2 if cols == 5 else 1)


@pytest.mark.parametrize("count", [4, 5, 8, 12, 14])
def test_lengths_of_both_names(count: int) -> None:
    for name in ("plumb_bob", "rational_polynomial"):
        found = calibration.read_ros(_ros([0.01] * min(count, 12) + [0.0] * (count - 12), name))
        assert len(found.projection.parameters) == count
        assert bool(found.notes) == (name == "plumb_bob" and count > 5)
    with pytest.raises(InputError, match="got 7"):
        calibration.read_ros(_ros([0.01] * 7))


def test_a_pinhole_that_folds_in_the_corners_is_a_circle_with_a_note() -> None:
    """k1 = -0.6 folds at 258 px: beyond the nearest edge, at 237 px, and before the corners."""
    given = {"image_width": 640, "image_height": 480, "camera_matrix": K, "D": [-0.6, 0, 0, 0]}
    made = calibration.read_opencv(given).projection
    (note,) = field_notes(made)
    radius = (1 / 1.8) ** 0.5 * (1 - 0.6 / 1.8) * (520 * 515) ** 0.5
    assert f"circle of {radius:.4g} px radius" in note
    rays = made.unproject([[0, 0], [639, 479], [331.3, 4], [331.3 + 0.99 * radius, 236.8]])
    assert np.isnan(rays[:2]).all()
    back = cv2.projectPoints(rays[2:], *STILL, K, np.array([-0.6, 0, 0, 0]))[0].reshape(-1, 2)
    np.testing.assert_allclose(back, [[331.3, 4], [331.3 + 0.99 * radius, 236.8]], atol=1e-9)
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    camera = dg.Camera.from_opencv(given)
    frame = dg.render(scene, camera, resolution=(64, 48), spp=4)
    assert frame.rgb[0, 0].max() == 0
    assert frame.rgb[24, 33] == pytest.approx([1, 1, 1], rel=0.1)
    with pytest.raises(InputError, match="nearest edge"):
        calibration.read_opencv({**given, "D": [-0.9, 0, 0, 0]})


def test_poses_may_lack_their_last_row() -> None:
    pose = _pose(5)
    frame = {"file_path": "a.png", "transform_matrix": pose.tolist()}
    given = {"w": 640, "h": 480, "fl_x": 500, "frames": [frame]}
    short = {**given, "frames": [{**frame, "transform_matrix": pose[:3].tolist()}]}
    for one in (given, short):
        found = calibration.read_transforms(one)["a.png"]
        np.testing.assert_allclose(found.settings["transform"], pose)
    odd = {**given, "frames": [{**frame, "transform_matrix": pose[:2].tolist()}]}
    with pytest.raises(InputError, match="4 x 4"):
        calibration.read_transforms(odd)


@pytest.mark.skipif(not CASES.is_dir(), reason="../shared/cases/files is not here")
def test_files_that_were_refused() -> None:
    chain = calibration.read_all(CASES / "kalibr_T_cam_imu_only.yaml")
    assert chain["cam1"].rig_from_camera[0, 3] == pytest.approx(0.11)
    ros = calibration.read(CASES / "ros_plumb_bob_8.yaml")
    assert len(ros.projection.parameters) == 8
