"""The desk and its calibration files: made the same twice, read, and seen where OpenCV says."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest

import daguerre as dg
from daguerre.calibration import read, read_kalibr
from daguerre.cli import main
from tests.support.scene.example_scenes import made_twice

ROOT = Path(__file__).resolve().parents[2]
FILES = ROOT / "scenes" / "calibrated"
GALLERY = ROOT / "script" / "docs" / "gallery"
COLUMNS, ROWS, SQUARE, MARKER = 8, 5, 0.030, 0.021  # of the board on the desk


@pytest.fixture(scope="module")
def desk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return made_twice("calibrated", tmp_path_factory.mktemp("desk"), 4_000_000) / "desk.glb"


def test_desk_is_read_without_a_note_and_its_things_are_named(desk: Path) -> None:
    scene = dg.load(desk)
    assert not scene.warnings
    assert list(scene.cameras) == ["phone", "fisheye", "rig"]
    names = {instance.name for instance in scene.instances}
    assert names >= {"desk", "laptop", "mug", "book", "lamp", "plant", "fan", "chair", "apple"}


def board_corners(scene: dg.Scene) -> np.ndarray:
    """Where four squares meet, row by row, in the world, m."""
    pose = next(np.asarray(i.transform) for i in scene.instances if i.name == "board")
    x = SQUARE * (np.arange(1, COLUMNS) - COLUMNS / 2)
    z = SQUARE * (np.arange(1, ROWS) - ROWS / 2)
    across, down = np.meshgrid(x, z)
    lift = np.full(across.size, 0.0042)
    return np.stack([across.ravel(), lift, down.ravel()], 1) @ pose[:3, :3].T + pose[:3, 3]


def test_opencv_finds_the_board_where_its_own_numbers_put_it(desk: Path) -> None:
    """The file by cv2.FileStorage, the pose by the scene, the picture by Daguerre."""
    scene = dg.load(desk)
    camera = dg.Camera.from_opencv(FILES / "phone.yaml", camera=scene.camera("phone"))
    size = (2016, 1512)  # half of the calibrated one, so pixel centres move by half, too
    crop = (40, 980, 620, 1290)  # left, top, right, bottom
    frame = dg.render(
        scene,
        camera.with_(f_stop=None, shutter_time=0),
        resolution=size,
        spp=8,
        max_depth=1,
        crop=crop,
        aovs=True,
    )
    grey = np.clip(frame.aovs["albedo.G"], 0, 1) ** 0.45  # no noise of lighting
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_5X5_250)
    board = cv2.aruco.CharucoBoard((COLUMNS, ROWS), SQUARE, MARKER, dictionary)
    found, ids, _, _ = cv2.aruco.CharucoDetector(board).detectBoard((grey * 255).astype(np.uint8))
    assert found is not None
    assert len(found) > 25

    file = cv2.FileStorage(str(FILES / "phone.yaml"), cv2.FILE_STORAGE_READ)
    k, d = file.getNode("camera_matrix").mat(), file.getNode("distortion_coefficients").mat()
    view = np.diag((1, -1, -1, 1)) @ np.linalg.inv(camera.transform)
    turn, _ = cv2.Rodrigues(view[:3, :3])
    wanted, _ = cv2.projectPoints(board_corners(scene), turn, view[:3, 3], k, d)
    wanted = (wanted[:, 0] + 0.5) / 2 - 0.5 - crop[:2]
    off = found.reshape(-1, 2) - wanted[ids.ravel()]
    assert np.abs(np.median(off, axis=0)).max() < 0.1
    assert np.hypot(*off.T).max() < 0.4


def test_fisheye_ends_beyond_190_degrees(desk: Path) -> None:
    fisheye = read(FILES / "fisheye.yaml").projection
    assert 95 < fisheye.largest_angle < 99
    edge = fisheye.unproject([[0.5, 718.8], [1439, 718.8], [720.3, 0.5], [0, 0]])
    angles = np.degrees(np.arccos(edge[:, 2]))
    assert (angles[:3] > 93).all()
    assert np.isnan(angles[3])
    scene = dg.load(desk)
    camera = dg.Camera.from_ros(FILES / "fisheye.yaml", camera=scene.camera("fisheye"))
    frame = dg.render(
        scene, camera.with_(f_stop=None), resolution=(48, 48), spp=2, max_depth=1, aovs=True
    )
    seen = frame.aovs["object_id"] > 0
    y, x = np.mgrid[0:48, 0:48] - 23.5
    assert not seen[np.hypot(x, y) > 25].any()
    assert seen[np.hypot(x, y) < 20].mean() > 0.99


def test_stereo_cameras_stand_twelve_centimetres_apart() -> None:
    rig = read_kalibr(FILES / "stereo.yaml")
    assert list(rig) == ["cam0", "cam1"]
    aside = rig["cam1"].rig_from_camera
    assert aside[0, 3] == pytest.approx(0.12, abs=1e-4)
    assert np.abs(aside[1:3, 3]).max() < 1.5e-3
    assert np.degrees(np.arccos((np.trace(aside[:3, :3]) - 1) / 2)) < 0.5


def test_pictures_of_depth_and_of_boxes(
    desk: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    calibration = [*("--camera", "phone"), *("--calibration", str(FILES / "phone.yaml"))]
    flags = ["--res", "2%", "--spp", "1", "--max-depth", "1", "--aov", "depth", "--quiet"]
    flags += ["--coco", "c.json", "--categories", str(FILES / "categories.json")]
    assert main(["render", str(desk), *calibration, *flags, "-o", "d.exr", "-o", "p.png"]) == 0
    coco = json.loads(Path("c.json").read_text())
    names = {one["id"]: one["name"] for one in coco["categories"]}
    found = [names[one["category_id"]] for one in coco["annotations"]]
    assert {"laptop", "cup", "mouse", "apple", "potted plant"} <= set(found)
    assert found.count("book") == 5  # a pile of four, and the notebook
    for script, *given in (
        ["depth_map.py", "d.exr", "depth.png", "0.4", "1.3"],
        ["coco_boxes.py", "c.json", "p.png", "boxes.png"],
    ):
        subprocess.run([sys.executable, GALLERY / script, *given], check=True)
    assert cv2.imread("depth.png").shape == (61 + 40, 81, 3)
    boxes, plain = cv2.imread("boxes.png"), cv2.imread("p.png")
    assert boxes.shape == plain.shape == (61, 81, 3)
    x, y, wide, high = next(a["bbox"] for a in coco["annotations"] if a["node"] == "laptop")
    part = slice(int(y), int(y + high)), slice(int(x), int(x + wide))
    inside = np.abs(boxes[part].astype(int) - plain[part])
    assert inside.mean() > 10  # tinted there,
    assert np.abs(boxes[:6, 20:50].astype(int) - plain[:6, 20:50]).mean() < 2  # and not elsewhere
