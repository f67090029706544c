"""Motion in pixels against what plain still worlds say, for everything that may move.

The oracle finds the triangle and the barycentric coordinates of the point that a pixel sees from
the plain lists of the scene, and looks for the same point in the plain lists of the next frame. It
knows nothing of motion.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre.setup.lens_motion import MODEL_BLUR
from tests.support.formats import motion_files
from tests.support.pictures.blur import Case
from tests.support.scene import motion_scenes

SIZE = (24, 16)
FPS = 24.0
Points = NDArray[np.float64]

SCENES = list(motion_scenes.ALL)
FILES = list(motion_files.ALL)


def corners(scene: dg.Scene, instance: int) -> Points:
    """Triangles (T, 3, 3) of an instance in the world."""
    placed = scene.instances[instance]
    mesh, matrix = scene.meshes[placed.mesh], np.asarray(placed.transform)
    points = mesh.positions.astype(float) @ matrix[:3, :3].T + matrix[:3, 3]
    return points[mesh.indices]


def barycentrics(triangles: Points, point: Points) -> tuple[int, Points]:
    """The triangle on which a point lies, and its weights there."""
    a, b, c = (triangles[:, i] for i in range(3))
    e, f, p = b - a, c - a, point - a
    n = np.cross(e, f)
    size = np.maximum((n * n).sum(1), 1e-300)
    v = (np.cross(p, f) * n).sum(1) / size
    w = (np.cross(e, p) * n).sum(1) / size
    off = np.abs((p * n).sum(1)) / np.sqrt(size)
    out = np.maximum(0, -np.minimum(np.minimum(v, w), 1 - v - w)) * size**0.25
    best = int(np.argmin(off + out))
    return best, np.array([1 - v[best] - w[best], v[best], w[best]])


def px(camera: dg.Camera, point: Points) -> Points:
    """Where a pinhole, a projection, or the middle of a thin lens, sees a point, px."""
    x, y, z = (np.linalg.inv(camera.transform) @ [*point, 1])[:3]
    if camera.projection is not None:
        return np.asarray(camera.projection.project([[x, -y, -z]])[0] + 0.5)
    if z >= 0:
        return np.full(2, np.nan)
    film = np.array([x, y]) / -z * (camera.focal_length or 50.0) - camera.shift
    return film * (1, -1) * SIZE[0] / camera.sensor_size[0] + np.array(SIZE) / 2


def moment(case: Case, pixel: Points) -> float:
    """The middle of the exposure of the line through a point (px) of the frame, s."""
    begin, end = case.interval
    roll = case.camera.rolling_shutter
    if roll is None or roll.line_time is None:
        return 0.5 * (begin + end)
    columns = roll.scan_order in ("left", "right")
    lines = SIZE[0 if columns else 1]
    line = np.clip(pixel[0 if columns else 1] - 0.5, 0, lines - 1)
    if roll.scan_order in ("bottom", "right"):
        line = lines - 1 - line
    exposure = end - begin - (lines - 1) * roll.line_time
    return float(begin + line * roll.line_time + 0.5 * exposure)


def landing(case: Case, instance: int, place: Points, pixel: Points, found: Points, later: float):
    """Where a surface point is when the line opens on which it is said to land, px."""
    now, eye = case.still(moment(case, pixel))
    then, other = case.still(moment(case, pixel + np.nan_to_num(found)) + later)
    before, after = corners(now, instance), corners(then, instance)
    if not then.instances[instance].shown or np.ptp(after, axis=(0, 1)).max() == 0:
        return np.full(2, np.nan)
    triangle, weights = barycentrics(before, place)
    return px(other, weights @ after[triangle]) - px(eye, weights @ before[triangle])


def check(case: Case, atol: float = 2e-3) -> None:
    camera = case.camera.with_(fps=FPS)
    frame = dg.render(case.scene, camera, resolution=SIZE, spp=1, max_depth=1, motion=True)
    ids = frame.aovs["object_id"]
    places = np.stack([frame.aovs[f"P.{axis}"] for axis in "XYZ"], -1).astype(float)
    looked = np.argwhere(ids > 0)[::3]
    for name, later in (("motion", 1 / FPS), ("motion_back", -1 / FPS)):
        flow = getattr(frame, name)
        wanted = [
            landing(
                case, int(ids[y, x]) - 1, places[y, x], np.array([x, y]) + 0.5, flow[y, x], later
            )
            for y, x in looked
        ]
        found = flow[looked[:, 0], looked[:, 1]]
        np.testing.assert_allclose(found, np.reshape(wanted, (-1, 2)), atol=atol, err_msg=name)


@pytest.mark.parametrize("name", SCENES)
def test_motion_of_scenes(name: str) -> None:
    check(motion_scenes.ALL[name]())


@pytest.mark.parametrize("name", ["zoom", "sensor shift", "zoom of a calibration"])
def test_motion_by_a_lens_that_changes_from_line_to_line(name: str) -> None:
    made = motion_scenes.ALL[name]()
    roll = dg.RollingShutter("bottom", line_time=0.01)
    half = 0.5 * (0.1 + 0.01 * (SIZE[1] - 1))
    check(
        replace(
            made,
            camera=made.camera.with_(shutter_time=0.1, rolling_shutter=roll),
            interval=(made.scene.time - half, made.scene.time + half),
        ),
        2e-3 + MODEL_BLUR * ("calibration" in name),  # whose distortion changes in steps
    )


@pytest.mark.parametrize("name", FILES)
def test_motion_of_files(name: str, tmp_path: Path) -> None:
    check(motion_files.file_case(name, tmp_path))
