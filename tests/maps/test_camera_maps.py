"""Raymaps and STMaps of cameras: OpenCV as oracle, ground truth, traced rays, there and back."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre import lenses
from daguerre.analysis import set_up
from daguerre.analysis.chief import chief_rays
from daguerre.cli import main
from daguerre.distortion.lens import LensDistortion
from daguerre.distortion.rectified import RectifiedView
from daguerre.errors import UsageError
from daguerre.pictures.exr.reader import ExrReader
from tests.support.formats.make_gltf import triangle
from tests.support.scene import scenes

cv2 = pytest.importorskip("cv2")

SIZE = (96, 64)
MATRIX = np.array([[80.0, 0, 50.3], [0, 82, 30.1], [0, 0, 1]])
BARREL = (-0.25, 0.06, 1e-3, -2e-3, 0.01)
PINCUSHION = (0.2, 0.02, -1e-3, 2e-3)
STILL = (np.zeros(3), np.zeros(3))
GAUSS = dg.Camera(lens="double-gauss-50mm-f2", f_stop=2.8, focus_distance=2.0)
ANAMORPHIC = dg.Camera(
    lens="schneider-anamorphic-60mm", focus_distance=3.0, sensor_size=(24.9, 20.7)
)


def calibrated(k: tuple[float, ...], model: str = "opencv", **options: Any) -> dg.Camera:
    projection = dg.Projection(model, SIZE, (80.0, 82.0), (50.3, 30.1), k)
    return dg.Camera(projection=projection, f_stop=None, **options)


def centres() -> np.ndarray:
    """Middles of pixels as OpenCV counts, shape (H, W, 2)."""
    return np.stack(np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1])), axis=-1).astype(float)


CAMERAS = {
    "pinhole": dg.Camera(lens="pinhole", focal_length=30.0, shift=(2.0, 1.0)),
    "thin": dg.Camera(focal_length=30.0, focus_distance=2.0, tilt=(6.0, 0.0)),
    "exact": GAUSS.with_(shift=(1.0, -2.0)),
    "polynomial": GAUSS.with_(lens_model="polynomial"),
    "tilted": GAUSS.with_(tilt=(2.0, 1.0)),
    "decentred": GAUSS.with_(decenter=(((0, 3), (0.3, 0.1)),)),
    "anamorphic": ANAMORPHIC,
    "fisheye lens": dg.Camera(lens="canon-ef-15mm-f2.8-fisheye", focus_distance=1.0),
    "barrel": calibrated(BARREL),
    "pincushion": calibrated(PINCUSHION),
    "kannala": calibrated((0.02, -0.01, 0.002, 0.0), "kannala_brandt"),
    "equirectangular": dg.Camera(
        projection=dg.Projection.of_field("equirectangular", SIZE, 200), f_stop=None
    ),
}


@pytest.mark.parametrize("k", [BARREL, PINCUSHION])
@pytest.mark.parametrize("metres", [0.5, 100.0])
def test_opencv_puts_the_rays_of_a_raymap_into_the_middles_of_its_pixels(k, metres, tmp_path):
    made = dg.raymap(calibrated(k), SIZE)
    made.save(tmp_path / "rays.exr")
    reader = ExrReader(tmp_path / "rays.exr")
    rows = reader.rows(0, SIZE[1])
    for given in (
        (made.origin, made.direction),
        tuple(
            np.stack([rows[f"{name}.{axis}"] for axis in "XYZ"], 2).astype(float)
            for name in ("origin", "direction")
        ),
    ):
        points = (given[0] + metres * given[1]).reshape(-1, 1, 3)
        there = cv2.projectPoints(points, *STILL, MATRIX, np.array(k))[0].reshape(SIZE[1], -1, 2)
        np.testing.assert_allclose(there, centres(), atol=1e-4)
    assert np.array_equal(rows["time.R"], np.zeros(SIZE[::-1]))


def test_ground_truth_lies_on_the_rays_of_a_central_camera():
    scene, camera = scenes.lamp_room(), calibrated(BARREL, transform=scenes.at(0.2, 0.1, 1.0))
    frame = dg.render(scene, camera, resolution=SIZE, spp=1, aovs=True, gt_time="mid")
    made = dg.raymap(camera, SIZE, frame="world")
    place = made.origin + frame.aovs["distance.Z"][..., None] * made.direction
    seen = frame.aovs["object_id"] > 0
    assert seen.mean() > 0.2
    for k, axis in enumerate("XYZ"):
        np.testing.assert_allclose(frame.aovs[f"P.{axis}"][seen], place[:, :, k][seen], atol=1e-5)


@pytest.mark.parametrize("name", ["exact", "anamorphic", "tilted"])
def test_ground_truth_lies_on_the_rays_of_real_lenses(name):
    scene = dg.Scene()
    scene.add_instance(scene.add_mesh(*scenes.quad(9, -2.5)))
    camera = CAMERAS[name].with_(transform=scenes.at(0.1, 0.2, 0.5))
    frame = dg.render(scene, camera, resolution=(24, 16), spp=1, aovs=True, gt_time="mid")
    made = dg.raymap(camera, (24, 16), frame="world")
    place = np.stack([frame.aovs[f"P.{axis}"] for axis in "XYZ"], axis=2)
    away = place - made.origin
    beside = np.linalg.norm(np.cross(away, made.direction), axis=2)
    known = np.isfinite(beside)
    assert known.mean() > 0.9
    assert beside[known].max() < 5e-6  # single precision at 3 m, where a pixel is 0.1 m


def test_rays_of_a_lens_are_those_that_go_through_the_middle_of_its_iris():
    """Stopped down, the mean of what passes is the ray of the bench through the middle."""
    name, size = "double-gauss-50mm-f2", (36, 24)
    camera = dg.Camera(lens=name, f_stop=16.0, focus_distance=2.0)
    made = dg.raymap(camera, size)
    bench = set_up(lenses.load(name), f_stop=16.0, focus_m=2.0)
    x, y = np.meshgrid(np.arange(size[0]) + 0.5 - 18, np.arange(size[1]) + 0.5 - 12)
    traced = chief_rays(bench, np.stack([-x, y], axis=-1).reshape(-1, 2))
    # Toward the scene along -z of the lens: x right, y down, z ahead.
    direction = (traced.directions * (-1, 1, 1)).reshape(24, 36, 3) * (1, 1, 1)
    assert np.abs(made.direction - direction).max() * 1400 < 0.05  # px of 36 um
    point = traced.points.reshape(24, 36, 3) - (0, 0, bench.order.entrance_pupil.z)
    point = 1e-3 * point * (1, -1, -1)
    beside = np.linalg.norm(np.cross(point - made.origin, made.direction), axis=2)
    assert beside.max() < 5e-5


def test_lines_of_a_rolling_shutter_have_their_own_times_and_poses():
    def turned(z: float) -> np.ndarray:
        matrix = np.eye(4)
        matrix[0, 3] = z
        return matrix

    camera = dg.Camera(
        lens="pinhole",
        transform=dg.keys([(-1.0, turned(-3.0)), (1.0, turned(3.0))]),
        shutter_time=0.002,
        rolling_shutter=dg.RollingShutter("top", line_time=1e-4),
    )
    made = dg.raymap(camera, SIZE, frame="world")
    lines = 1e-4 * (np.arange(SIZE[1]) - (SIZE[1] - 1) / 2)
    assert made.time[:, 5] == pytest.approx(lines, abs=1e-9)
    assert made.origin[:, 5, 0] == pytest.approx(3 * lines, abs=1e-7)
    early = dg.raymap(camera, SIZE, frame="world", gt_time="open")
    assert early.time[:, 5] == pytest.approx(lines - 0.001, abs=1e-9)
    still = dg.raymap(camera, SIZE)
    assert not still.origin.any()  # in the camera's own frame it stands still


def test_what_sees_nothing_is_nan():
    circle = dg.Camera(lens="fisheye-16mm-f2.8", focus_distance=math.inf, sensor_size=(60.0, 40.0))
    origin = dg.raymap(circle, (60, 40)).origin
    assert np.isnan(origin[0, 0]).all()
    assert np.isfinite(origin[20, 30]).all()
    picture = dg.render(white(), circle, resolution=(60, 40), spp=16, filter="box:0.25")
    dark = picture.rgb[:, :, 1] == 0
    assert 0.2 < dark.mean() < 0.8
    assert (np.isnan(origin[:, :, 0]) != dark).mean() < 0.01  # at the edge
    sphere = dg.Camera(projection=dg.Projection.of_field("orthographic", SIZE, 180), f_stop=None)
    assert np.isnan(dg.raymap(sphere, SIZE).direction[0, 0]).all()


def white() -> dg.Scene:
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    return scene


@pytest.mark.parametrize("name", CAMERAS)
def test_both_ways_are_the_identity(name):
    view = RectifiedView(CAMERAS[name], SIZE)
    x, y = np.meshgrid(np.linspace(0, SIZE[0], 41), np.linspace(0, SIZE[1], 31))
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    bent = view.bent_from_straight(points)
    back = view.straight_from_bent(bent)
    known = np.isfinite(back).all(axis=1)
    assert known.mean() > 0.8
    np.testing.assert_allclose(back[known], points[known], atol=1e-4)
    straight = view.straight_from_bent(points)
    known = np.isfinite(straight).all(axis=1)
    assert known.mean() > 0.4
    np.testing.assert_allclose(view.bent_from_straight(straight[known]), points[known], atol=1e-4)


@pytest.mark.parametrize("name", ["barrel", "exact", "anamorphic", "decentred"])
def test_maps_of_pixels_undo_each_other(name):
    """Maps as compositors have them: 32-bit s and t at pixels, read between them."""
    size = (192, 128)
    camera = CAMERAS[name]
    if camera.projection is not None:
        projection = dg.Projection("opencv", size, (160.0, 164.0), (100.6, 60.2), BARREL)
        camera = dg.Camera(projection=projection, f_stop=None)
    maps = dg.stmaps(camera, size)
    inner = np.s_[32:-32, 48:-48]
    s, t = np.moveaxis(maps.undistort[inner], 2, 0).astype(float)
    px, py = s * size[0] - 0.5, (1 - t) * size[1] - 0.5
    found = [sampled(maps.redistort[:, :, k], px, py) for k in range(2)]
    x, y = np.meshgrid(np.arange(48, size[0] - 48), np.arange(32, size[1] - 32))
    assert np.abs(found[0] * size[0] - 0.5 - x).max() < 1e-3
    assert np.abs((1 - found[1]) * size[1] - 0.5 - y).max() < 1e-3


def sampled(plane: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """By Lagrange's cubics between pixels."""
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)

    def weights(u: np.ndarray) -> list[np.ndarray]:
        return [
            -u * (u - 1) * (u - 2) / 6,
            (u + 1) * (u - 1) * (u - 2) / 2,
            -(u + 1) * u * (u - 2) / 2,
            (u + 1) * u * (u - 1) / 6,
        ]

    wx, wy = weights(x - i), weights(y - j)
    total = np.zeros(x.shape)
    for b in range(4):
        for a in range(4):
            total += wx[a] * wy[b] * plane[j + b - 1, i + a - 1]
    return total


@pytest.mark.parametrize("k", [BARREL, PINCUSHION])
def test_opencv_straightens_by_the_same_map(k):
    made = dg.stmaps(calibrated(k), SIZE).undistort.astype(float)
    x, y = cv2.initUndistortRectifyMap(MATRIX, np.array(k), None, MATRIX, SIZE, cv2.CV_32FC1)
    assert np.abs(made[:, :, 0] * SIZE[0] - 0.5 - x).max() < 1e-3
    assert np.abs((1 - made[:, :, 1]) * SIZE[1] - 0.5 - y).max() < 1e-3


def test_the_map_of_a_lens_is_that_of_the_darkroom():
    """Through the middle of the iris there, as the mean of what passes here: near each other."""
    size = (192, 128)
    made = dg.stmaps(dg.Camera(lens="canon-ef-11-24mm-f4", f_stop=16.0, focus_distance=1.0), size)
    bench = set_up(lenses.load("canon-ef-11-24mm-f4"), f_stop=16.0, focus_m=1.0)
    model = LensDistortion(bench, 22.0)
    ours = made.view.setup.lens.pinhole_focal_length_mm
    assert model.focal_length_mm == pytest.approx(ours, rel=2e-4)
    focal = model.focal_length_mm / (36 / 192)
    other = dg.post.stmap(model, size, focal_px=focal, inverse=True)
    assert np.nanmax(np.abs(made.undistort - other)) * 192 < 0.05


def test_windows_and_overscan_of_maps(tmp_path):
    maps = dg.stmaps(calibrated(PINCUSHION), SIZE, overscan=(8, 4, 12, 6))
    maps.save(undistort=tmp_path / "u.exr", redistort=tmp_path / "r.exr")
    plain = dg.stmaps(calibrated(PINCUSHION), SIZE)
    for name in ("undistort", "redistort"):
        reader = ExrReader(tmp_path / f"{name[0]}.exr")
        assert (reader.corner, reader.full_size) == ((-8, -4), SIZE)
        assert (reader.width, reader.height) == (SIZE[0] + 20, SIZE[1] + 10)
        assert reader.facts["daguerre:stmap"] == name
        inner = getattr(maps, name)[4:-6, 8:-12]
        np.testing.assert_allclose(inner, getattr(plain, name), atol=2e-6)
    assert not maps.needed["redistort"]
    assert maps.needed["undistort"]


def test_command_line(tmp_path: Path, capsys) -> None:
    room = triangle().glb(tmp_path / "room.glb")
    files = {n: tmp_path / f"{n}.exr" for n in ("raymap", "stmap-undistort", "stmap-redistort")}
    words = [f"--export-{name}={path}" for name, path in files.items()]
    lens = ["--lens", "double-gauss-50mm-f2", "--focus", "2", "--res", "48x32"]
    assert main(["render", str(room), *lens, *words, "--raymap-frame", "world"]) == 0
    assert all(path.exists() for path in files.values())
    header = ExrReader(files["raymap"]).header.facts
    assert header["daguerre:raymap"].startswith("world: ")
    assert "worldToCamera" in header
    assert len(list(tmp_path.iterdir())) == 4  # nothing is drawn
    for wrong, word in (
        (["--export-raymap", "a.png"], ".exr"),
        ([], "-o"),
        (["--export-raymap", "a.exr", "--spp", "8", "--noise", "0.1"], "-o"),
        (["--export-raymap", "a.exr", "--export-stmap-undistort", "a.exr"], "twice"),
        (["--export-raymap", "a.exr", "--raymap-frame", "wrld"], "world"),
        (["-o", "a.exr", "--raymap-frame", "world"], "--export-raymap"),
    ):
        capsys.readouterr()
        assert main(["render", str(room), *lens, *wrong]) == 2
        assert word in capsys.readouterr().err


def test_maps_of_a_calibrated_lens(tmp_path):
    name, size = "canon-ef-11-24mm-f4", (96, 64)
    words = ["--zoom", "20", "--focus", "1", "--f-stop", "16", "--sensor", "apsc", "--res", "96x64"]
    file = tmp_path / "rays.exr"
    assert main(["calibrate", name, *words, "--export-raymap", str(file)]) == 0
    rows = ExrReader(file).rows(0, 64)
    sensor = (23.6, 23.6 * 64 / 96)
    fit = dg.calibrate(
        name,
        resolution=size,
        sensor_size=sensor,
        f_stop=16.0,
        focus_distance=1.0,
        focal_length=20.0,
    )
    direction = np.stack([rows[f"direction.{axis}"] for axis in "XYZ"], 2).astype(float)
    origin = np.stack([rows[f"origin.{axis}"] for axis in "XYZ"], 2).astype(float)
    # Where they meet what is in focus.
    plane = origin + direction * ((1 - origin[:, :, 2:]) / direction[:, :, 2:])
    there = fit.projection.project(plane.reshape(-1, 3)).reshape(64, 96, 2)
    assert np.abs(there - centres()).max() < fit.largest + 0.05


def test_a_cube_is_not_straightened():
    cube = dg.Camera(projection=dg.Projection.of_field("cube", (96, 16), 360), f_stop=None)
    with pytest.raises(UsageError, match="cube"):
        dg.stmaps(cube, (96, 16))
    assert np.isfinite(dg.raymap(cube, (96, 16)).direction).all()
