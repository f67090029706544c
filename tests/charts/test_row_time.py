"""Row times of rolling shutters, measured in pictures taken while the camera turns."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre import charts
from daguerre.errors import DaguerreError

SIZE = (320, 240)
LINE_S = 60e-6
RATE = 200.0  # degrees per second
HOLE = dg.Projection("rectilinear", SIZE, (260.0, 260.0))
BROWN = dg.Projection("opencv", SIZE, (260.0, 257.5), (163.4, 118.2), (-0.2, 0.08, 1e-3, -8e-4))
WIDE = dg.Projection("kannala_brandt", SIZE, (130.0, 129.0), (163.4, 118.2), (0.01, -0.003))
UPRIGHT, LEVEL = (125, 0, 201, 240), (0, 80, 320, 156)  # columns and rows that are looked at
RIGHT, UP = (0.0, -1.0, 0.0), (1.0, 0.0, 0.0)  # axes about which the camera turns so


def place(projection: dg.Projection, roll: float = 0.0) -> np.ndarray:
    """From where a board of squares of 0.35 m fills the picture."""
    a = np.radians(roll)
    out = np.eye(4)
    out[:2, :2] = [[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]]
    out[2, 3] = 1.2 * projection.focal[0] / 260
    return out


def turning(
    projection: dg.Projection, axis: tuple[float, float, float], roll: float = 0.0, **more: Any
) -> dg.Camera:
    moving = dg.spin(axis, RATE / 360, transform=place(projection, roll))
    return dg.Camera(transform=moving, projection=projection, shutter_time=1e-3).with_(**more)


def shots(camera: dg.Camera, crop: tuple[int, int, int, int], count: int = 1) -> np.ndarray:
    """Pictures 1/200 s apart, around the moment at which the camera looks at an edge's middle."""
    columns, rows = (6, 7) if crop[3] == SIZE[1] else (7, 6)
    scene, out = charts.make("checkerboard", columns=columns, rows=rows, square=0.35).scene(1.0), []
    for i in range(count):
        scene.time = (i - (count - 1) / 2) / 200
        options: dict[str, Any] = {"spp": 64, "filter": "box", "max_depth": 1, "seed": i}
        out.append(dg.render(scene, camera, resolution=SIZE, crop=crop, **options).xyz[..., 1])
    return np.array(out)


@pytest.mark.parametrize(
    ("order", "projection", "timed"),
    [
        ("top", HOLE, "line_time"),
        ("top", BROWN, "readout_time"),
        ("bottom", WIDE, "line_time"),
        ("left", BROWN, "line_time"),
        ("right", HOLE, "readout_time"),
    ],
)
def test_the_row_time_comes_back(order: str, projection: dg.Projection, timed: str) -> None:
    """Within 0.25 %: a readout that is one line too long or too short would be 0.3 or 0.4 % off."""
    upright = order in ("top", "bottom")
    lines = SIZE[1 if upright else 0]
    shutter = dg.RollingShutter(order, **{timed: LINE_S * (lines if timed != "line_time" else 1)})
    axis, crop = (RIGHT, UPRIGHT) if upright else (UP, LEVEL)
    picture = shots(turning(projection, axis, rolling_shutter=shutter), crop)
    found = charts.row_time(picture, projection, turn_rate=RATE, corner=crop[:2])
    assert found.scan_order == order
    assert found.line_time == pytest.approx(LINE_S, rel=2.5e-3)
    assert found.readout_time == pytest.approx(LINE_S * lines, rel=2.5e-3)


def test_pictures_one_after_the_other_tell_how_fast_the_camera_turns() -> None:
    camera = turning(BROWN, RIGHT, rolling_shutter=dg.RollingShutter("top", line_time=LINE_S))
    pictures = shots(camera, UPRIGHT, 3)
    found = charts.row_time(pictures, BROWN, fps=200, corner=UPRIGHT[:2])
    assert found.line_time == pytest.approx(LINE_S, rel=2.5e-3)
    assert found.turn_rate == pytest.approx(RATE, rel=2.5e-3)
    back = charts.row_time(pictures[::-1], BROWN, fps=200, corner=UPRIGHT[:2])
    assert (back.scan_order, back.turn_rate) == ("bottom", pytest.approx(-RATE, rel=2.5e-3))


def test_an_edge_that_leans_by_itself_is_told_by_a_picture_at_rest() -> None:
    shutter = dg.RollingShutter("top", line_time=LINE_S)
    camera = turning(BROWN, RIGHT, roll=2.0, rolling_shutter=shutter)
    resting = shots(camera.with_(transform=place(BROWN, 2.0)), UPRIGHT)[0]
    picture, options = shots(camera, UPRIGHT), {"turn_rate": RATE, "corner": UPRIGHT[:2]}
    found = charts.row_time(picture, BROWN, still=resting, **options)
    assert found.line_time == pytest.approx(LINE_S, rel=2.5e-3)
    assert charts.row_time(picture, BROWN, **options).line_time != pytest.approx(LINE_S, rel=0.1)
    # At rest nothing leans, whatever the shutter.
    assert charts.row_time(resting, BROWN, still=resting, **options).scan_order == "none"


def test_undistorted_pictures_have_lost_their_lines() -> None:
    """Why pictures must be as the sensor has them: pixels have moved to other rows."""
    cv2 = pytest.importorskip("cv2")
    camera = turning(BROWN, RIGHT, rolling_shutter=dg.RollingShutter("top", line_time=LINE_S))
    x0, y0, x1, y1 = UPRIGHT
    whole = np.zeros(SIZE[::-1])
    whole[y0:y1, x0:x1] = shots(camera, UPRIGHT)[0]
    matrix = np.array([[260.0, 0, 163.4], [0, 257.5, 118.2], [0, 0, 1]])
    flat = cv2.undistort(whole, matrix, np.array(BROWN.parameters))[y0:y1, x0 + 4 : x1 - 4]
    straight = dg.Projection("rectilinear", SIZE, BROWN.focal, BROWN.center)
    found = charts.row_time(flat, straight, turn_rate=RATE, corner=(x0 + 4, y0))
    assert abs(found.line_time / LINE_S - 1) > 0.01


def test_through_a_lens_by_the_projection_that_its_calibration_finds() -> None:
    lens, options = "fisheye-16mm-f2.8", {"f_stop": 11.0, "focus_distance": 1.0}
    fit = dg.calibrate(lens, "fisheye", resolution=SIZE, sensor_size=(36, 27), **options)
    shutter = dg.RollingShutter("top", line_time=LINE_S)
    camera = turning(fit.projection, RIGHT, rolling_shutter=shutter, sensor_size=(36, 27))
    exact = camera.with_(projection=None, lens=lens, lens_model="exact", **options)
    picture = shots(exact, UPRIGHT)
    found = charts.row_time(picture, fit.projection, turn_rate=RATE, corner=UPRIGHT[:2])
    assert found.line_time == pytest.approx(LINE_S, rel=0.01)


EDGE = np.tile(np.arange(9) > 4, (40, 1)).astype(float)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"turn_rate": None}, "either turn_rate or fps, got neither"),
        ({"fps": 25}, "either turn_rate or fps, got both"),
        ({"turn_rate": 0}, "turn_rate: wanted a rate other than 0"),
        ({"turn_rate": None, "fps": 25}, "at least two pictures"),
        ({"turn_rate": None, "fps": 25, "regions": [EDGE, EDGE]}, "edge that moves"),
        ({"corner": (315, 0)}, r"9 x 40 px.*320 x 240.*got 315, 0"),
        ({"corner": (0.5, 0)}, "whole pixels"),
        ({"projection": "opencv"}, "wanted a Projection"),
        ({"regions": np.zeros(4)}, r"got \(4,\)"),
        ({"regions": np.full((40, 9), np.nan)}, "finite light"),
        ({"regions": np.ones((40, 9))}, "wanted an edge"),
        ({"still": EDGE[:, 1:]}, r"the regions, \(40, 9\), got \(40, 8\)"),
    ],
)
def test_what_tells_no_row_time_is_refused(changes: dict[str, Any], message: str) -> None:
    given = {"regions": EDGE, "projection": HOLE, "turn_rate": RATE} | changes
    with pytest.raises(DaguerreError, match=message):
        charts.row_time(**given)
