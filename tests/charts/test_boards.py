"""Calibration boards: OpenCV finds them where their truth says, and gets the camera back."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre import charts
from daguerre.charts import markers
from daguerre.cli import main
from daguerre.errors import UsageError
from tests.support.pictures.board_pictures import picture, seen

cv2 = pytest.importorskip("cv2")

SIZE = (640, 480)
BROWN = dg.Projection(
    "opencv", SIZE, (520.0, 515.0), (326.3, 236.8), (-0.2, 0.08, 1e-3, -8e-4, -0.01)
)
FISHEYE = dg.Projection(
    "kannala_brandt", SIZE, (260.0, 258.0), (326.3, 236.8), (0.01, -0.003, 1e-3, -2e-4)
)


def corners_found(image: np.ndarray, chart: charts.Chart) -> np.ndarray:
    found, corners = cv2.findChessboardCorners(image, tuple(chart.truth["inner_corners"]))
    assert found
    soft = cv2.GaussianBlur(image, (0, 0), 1.0)  # as lenses are: the search wants slopes
    apart = np.linalg.norm(np.diff(corners.reshape(-1, 2), axis=0), axis=1).min()
    half, criteria = int(np.clip(0.4 * apart, 2, 6)), (3, 50, 1e-4)  # up to the next corners
    fine = cv2.cornerSubPix(soft, corners.astype(np.float32), (half, half), (-1, -1), criteria)
    return np.asarray(fine, np.float64).reshape(-1, 2)


def flat(points: Any) -> np.ndarray:
    """Points of a chart in the world."""
    given = np.asarray(points, np.float64).reshape(-1, 2)
    return np.c_[given, np.zeros(len(given))]


@pytest.mark.parametrize("name", markers.DICTIONARIES)
def test_markers_are_those_of_opencv(name: str) -> None:
    table = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, f"DICT_{name}".replace("H", "h")))
    _, size, count = markers.DICTIONARIES[name]
    assert (table.markerSize, len(table.bytesList)) == (size, count)
    for i in range(count):
        wanted = cv2.aruco.Dictionary_getBitsFromByteList(table.bytesList[i : i + 1], size)
        np.testing.assert_array_equal(markers.bits(name, i), wanted)


@pytest.mark.parametrize("projection", [BROWN, FISHEYE], ids=lambda p: p.model)
def test_corners_are_found_in_the_order_of_the_truth(projection: dg.Projection) -> None:
    chart = charts.make("checkerboard")
    pose = charts.poses(chart, projection, 5, 1)[3]
    image = picture(chart, dg.Camera(transform=pose, projection=projection), projection, spp=8)
    found = corners_found(image, chart)
    wanted = seen(flat(chart.truth["corners_m"]), pose, projection)
    assert np.abs(found - wanted).max() < 0.25
    assert np.abs((found - wanted).mean(axis=0)).max() < 0.03  # half a pixel would show


def test_charuco_boards_are_found_with_their_ids() -> None:
    chart = charts.make("charuco")
    truth = chart.truth
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_5X5_250)
    side, marker = truth["square_m"], truth["marker_m"]
    board = cv2.aruco.CharucoBoard((truth["columns"], truth["rows"]), side, marker, dictionary)
    pose = charts.poses(chart, BROWN, 5, 1)[3]
    image = picture(chart, dg.Camera(transform=pose, projection=BROWN), BROWN, spp=8)
    corners, ids, _, marker_ids = cv2.aruco.CharucoDetector(board).detectBoard(image)
    assert sorted(ids.ravel()) == list(range(len(truth["corners_m"])))
    assert sorted(marker_ids.ravel()) == [m["id"] for m in truth["markers"]]
    wanted = seen(flat(truth["corners_m"]), pose, BROWN)[ids.ravel()]
    assert np.abs(corners.reshape(-1, 2) - wanted).max() < 0.4
    # OpenCV's board begins in its upper left corner.
    ours = charts.object_points(truth["corners_m"])
    theirs = np.asarray(board.getChessboardCorners())
    np.testing.assert_allclose(ours - ours[0], theirs - theirs[0], atol=1e-6)


@pytest.mark.parametrize(("dictionary", "first"), [("APRILTAG_36H11", 0), ("DICT_4X4_50", 20)])
def test_tags_are_found_with_their_corners(dictionary: str, first: int) -> None:
    chart = charts.make("apriltag", dictionary=dictionary, first=first)
    name = markers.checked(dictionary, 0, 1)[0].replace("H", "h")
    table = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, f"DICT_{name}"))
    pose = charts.poses(chart, BROWN, 5, 1)[3]
    image = picture(chart, dg.Camera(transform=pose, projection=BROWN), BROWN, spp=8)
    found, ids, _ = cv2.aruco.ArucoDetector(table).detectMarkers(image)
    assert sorted(ids.ravel()) == [m["id"] for m in chart.truth["markers"]]
    for corners, i in zip(found, ids.ravel(), strict=True):
        wanted = seen(flat(chart.truth["markers"][i - first]["corners_m"]), pose, BROWN)
        assert np.abs(corners.reshape(4, 2) - wanted).max() < 1.5  # whole pixels, but in order


def test_large_boards_keep_their_squares_before_their_paper() -> None:
    """Single precision must not confuse layers: a kilometre of board looks like a metre."""
    shown = []
    for scale in (1, 1000):
        chart = charts.make("checkerboard", square=0.1 * scale)
        pose = charts.poses(chart, BROWN, 5, 1)[3]
        camera = dg.Camera(transform=pose, projection=BROWN)
        shown.append(picture(chart, camera, BROWN, spp=4, max_depth=1).astype(float))
    assert np.abs(shown[1] - shown[0]).mean() < 0.5


def test_poses_show_the_whole_board_all_over_the_picture() -> None:
    chart = charts.make("checkerboard")
    for projection in (BROWN, FISHEYE):
        poses = charts.poses(chart, projection, 24, 3)
        border = flat(charts.boards.outline(chart))
        pixels = np.array([seen(border, pose, projection) for pose in poses])
        assert (pixels > 0).all()
        assert (pixels < np.array(SIZE) - 1).all()
        middles = pixels.mean(axis=1) / SIZE
        assert (middles.min(axis=0) < 0.3).all()
        assert (middles.max(axis=0) > 0.7).all()
        tilts = np.degrees(np.arccos([pose[2, 2] for pose in poses]))
        assert tilts.max() > 25
        assert np.allclose([np.linalg.det(pose[:3, :3]) for pose in poses], 1)
    again = charts.poses(chart, FISHEYE, 24, 3)
    np.testing.assert_array_equal(again, poses)


Session = tuple[np.ndarray, list[np.ndarray]]


def photographed(
    projection: dg.Projection,
    count: int,
    camera: dg.Camera | None = None,
    columns: int = 10,
    rows: int = 7,
    square: float = 0.03,
    farthest: float = 2.0,
    **options: Any,
) -> Session:
    """Corners of a board as OpenCV has them (N, 3), and where it finds them in each picture."""
    chart = charts.make("checkerboard", columns=columns, rows=rows, square=square)
    found = []
    for i, pose in enumerate(charts.poses(chart, projection, count, 1, farthest=farthest)):
        base = camera or dg.Camera(projection=projection)
        image = picture(chart, base.with_(transform=pose), projection, seed=i, **options)
        found.append(corners_found(image, chart))
    return charts.object_points(chart.truth["corners_m"]), found


def calibrated(
    projection: dg.Projection, session: Session, flags: int = 0
) -> tuple[float, np.ndarray]:
    """OpenCV's reprojection error and camera matrix."""
    board, found = session
    if projection.model == "opencv":
        boards = [board.astype(np.float32)] * len(found)
        points = [p.astype(np.float32)[:, None] for p in found]
        error, matrix, *_ = cv2.calibrateCamera(
            boards, points, projection.size, None, None, flags=flags
        )
        return error, matrix
    home = cv2.fisheye if hasattr(cv2.fisheye, "CALIB_FIX_SKEW") else cv2  # cv2: from OpenCV 5 on
    flags = home.CALIB_RECOMPUTE_EXTRINSIC | home.CALIB_FIX_SKEW
    points = [p[None] for p in found]
    error, matrix, *_ = cv2.fisheye.calibrate(
        [board[None]] * len(found), points, projection.size, None, None, flags=flags
    )
    return error, matrix


def check(projection: dg.Projection, error: float, matrix: np.ndarray, share: float) -> None:
    assert error < 0.1
    got = (matrix[0, 0], matrix[1, 1])
    np.testing.assert_allclose(got, projection.focal, rtol=1e-3 * share)
    np.testing.assert_allclose(matrix[:2, 2], projection.center, atol=0.2 * share)


def test_opencv_calibrates_a_camera_back() -> None:
    """A few small boards, quickly: within three times the bounds of the full test."""
    small = dg.Projection("opencv", (320, 240), (260, 257.5), (163.4, 118.2), (-0.2, 0.08))
    flags = cv2.CALIB_ZERO_TANGENT_DIST | cv2.CALIB_FIX_K3
    session = photographed(small, 8, columns=7, rows=6)
    check(small, *calibrated(small, session, flags), 3)


@pytest.mark.slow
@pytest.mark.parametrize("projection", [BROWN, FISHEYE], ids=lambda p: p.model)
def test_opencv_calibrates_cameras_back(projection: dg.Projection) -> None:
    check(projection, *calibrated(projection, photographed(projection, 20, spp=32)), 1)


def test_a_board_is_written_with_its_truth(tmp_path: Path) -> None:
    path = tmp_path / "board.glb"
    options = ["--set", "square=0.05", "--set", "columns=8", "--set", "rows=5"]
    assert main(["chart", "checkerboard", *options, "-o", str(path)]) == 0
    truth = json.loads(path.with_suffix(".json").read_text())
    assert truth["inner_corners"] == [7, 4]
    np.testing.assert_allclose(truth["corners_m"][0], [-0.15, 0.075])
    assert dg.load(path).cameras


@pytest.mark.parametrize(
    ("name", "values", "message"),
    [
        ("checkerboard", {"columns": 1}, "columns"),
        ("checkerboard", {"square": 0}, "square"),
        ("charuco", {"dictionary": "DICT_7X8"}, "dictionary: wanted"),
        ("charuco", {"dictionary": "4X4_50", "columns": 30, "rows": 30}, "450 markers"),
        ("charuco", {"marker": 2}, "marker"),
        ("apriltag", {"first": 580}, "first"),
        ("apriltag", {"border": 0}, "border"),
        ("apriltag", {"gap": "wide"}, "gap"),
    ],
)
def test_boards_that_cannot_be_made_are_refused(
    name: str, values: dict[str, Any], message: str
) -> None:
    with pytest.raises(UsageError, match=message):
        charts.make(name, **values)


def test_a_session_that_cannot_be_is_refused() -> None:
    chart = charts.make("checkerboard")
    with pytest.raises(UsageError, match="count"):
        charts.poses(chart, BROWN, 0)
    with pytest.raises(UsageError, match="tilt"):
        charts.poses(chart, BROWN, 2, tilt=80)
    with pytest.raises(UsageError, match="farthest"):
        charts.poses(chart, BROWN, 2, farthest=0.5)
