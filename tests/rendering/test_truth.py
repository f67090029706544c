"""Ground truth: chief rays and their inverse, exact values at a stated time, motion in pixels."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest

import daguerre as dg
import daguerre._core as _core
from daguerre import lenses
from daguerre.camera.rolling_shutter import RollingShutter
from daguerre.cli import main
from daguerre.errors import UsageError
from tests.support.scene import scenes

SIZE = (24, 18)
FPS = 10.0
#: 50 mm before a film 36 mm wide
PINHOLE = dg.Camera(lens="pinhole", focal_length=50.0, fps=FPS, shutter_time=0.04)
PIXELS = 50 / 36 * SIZE[0]  # film distance, px
MIDDLE = (SIZE[1] // 2, SIZE[0] // 2)


def at(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def turned(axis: int, degrees: float) -> np.ndarray:
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    matrix = np.eye(4)
    matrix[i, i], matrix[j, j], matrix[i, j], matrix[j, i] = c, c, -s, s
    return matrix


def wall(transform: Any, **options: Any) -> dg.Scene:
    """A square of half side 4 as the transform has it, under a white sky."""
    scene = dg.Scene(**options)
    scene.add_instance(scene.add_mesh(*scenes.quad(4)), transform=transform)
    scene.set_environment(color=(1, 1, 1))
    return scene


def drifting(per_second: tuple[float, float, float]) -> dg.Scene:
    """A wall at z = -4 at the time 0."""
    x, y, z = per_second
    return wall(dg.keys([(-1, at(-x, -y, -4 - z)), (1, at(x, y, -4 + z))]))


def truth(scene: dg.Scene, camera: dg.Camera = PINHOLE, **options: Any) -> dg.Frame:
    return dg.render(scene, camera, spp=1, resolution=SIZE, **{"motion": True, **options})


def seen() -> tuple[np.ndarray, np.ndarray]:
    """Slopes x / -z and y / -z of the rays through the centres of the pixels."""
    x = (np.arange(SIZE[0]) + 0.5 - SIZE[0] / 2) / PIXELS
    y = (SIZE[1] / 2 - np.arange(SIZE[1]) - 0.5) / PIXELS
    slopes = np.meshgrid(x, y)
    return slopes[0], slopes[1]


@pytest.mark.parametrize("name", ["fisheye-16mm-f2.8", "telephoto-200mm-f1.8", "sonnar-50mm-f2"])
def test_the_film_point_of_a_chief_ray_is_where_it_came_from(name: str) -> None:
    lens = lenses.load(name)
    f_stop = lens.first_order().f_number
    settings = _core.ExactLensSettings(f_stop=f_stop, focus_distance_m=3.0, half_diagonal_mm=22.0)
    exact = _core.ExactLens(lens.prescription, settings)
    chief = _core.Camera.exact(_core.Motion.still(np.eye(4)), exact).chief_rays()
    radius, angle = np.random.default_rng(1).uniform(0, [[21.6], [6.28]], (2, 500))
    film = radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], 1)
    origins, directions = chief.rays(film)
    for distance in (0.5, 3.0, 1e6):
        back = chief.film_points(origins + distance * directions)
        assert np.abs(back - film).max() < 1e-3 * 0.006  # mm: 1e-3 px of 6 um
    assert np.abs(chief.film_points(directions, True) - film).max() < 1e-3 * 0.006


def test_motion_is_right_and_down_and_of_one_frame() -> None:
    # 0.3 m/s to the right, 0.2 m/s down, seen from 4 m, for a tenth of a second.
    frame = truth(drifting((0.3, -0.2, 0)))
    right, down = 0.03 / 4 * PIXELS, 0.02 / 4 * PIXELS
    np.testing.assert_allclose(frame.motion[..., 0], right, atol=1e-4)
    np.testing.assert_allclose(frame.motion[..., 1], down, atol=1e-4)
    np.testing.assert_allclose(frame.motion_back[..., 0], -right, atol=1e-4)
    np.testing.assert_allclose(frame.motion_back[..., 1], -down, atol=1e-4)
    assert frame.metadata["gt_time"] == "mid"
    assert frame.metadata["motion_missing"] == 0


@pytest.mark.parametrize(("moment", "seconds"), [("open", -0.02), ("mid", 0), ("close", 0.02)])
def test_values_are_those_of_the_moment(moment: str, seconds: float) -> None:
    frame = truth(drifting((0, 0, 5)), gt_time=moment, motion=False)
    depth = 4 - 5 * seconds
    x, y = seen()
    planes = frame.aovs
    np.testing.assert_allclose(planes["depth.Z"], depth, rtol=1e-6)
    np.testing.assert_allclose(planes["distance.Z"], depth * np.hypot(np.hypot(x, y), 1), rtol=1e-6)
    np.testing.assert_allclose(planes["P.X"], depth * x, atol=1e-5)
    np.testing.assert_allclose(planes["P.Y"], depth * y, atol=1e-5)
    np.testing.assert_allclose(planes["N.Z"], 1)
    assert (planes["object_id"] == 1).all()
    assert (planes["material_id"] == 1).all()
    assert frame.motion is None


def test_a_moving_camera_looks_from_where_it_is() -> None:
    # It moves to the right by 1 m/s and turns to the left by 40 degrees/s: at mid both are known.
    path = dg.keys([(t, at(t) @ turned(1, 40 * t)) for t in (-1.0, 1.0)])
    frame = truth(wall(at(z=-4)), PINHOLE.with_(transform=path))
    x, y = seen()
    points = np.stack([4 * x, 4 * y, -4 + 0 * x, 1 + 0 * x])
    expected = []
    for seconds in (0.1, -0.1):
        camera = np.linalg.inv(at(seconds) @ turned(1, 40 * seconds))
        u, v, w, _ = np.einsum("ij,jyx->iyx", camera, points)
        expected.append(np.stack([u / -w - x, y - v / -w], -1) * PIXELS)
    np.testing.assert_allclose(frame.motion, expected[0], atol=1e-3)
    np.testing.assert_allclose(frame.motion_back, expected[1], atol=1e-3)


def test_the_background_moves_with_the_camera_alone() -> None:
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    path = dg.keys([(t, at(5 * t) @ turned(2, 30 * t)) for t in (-1.0, 1.0)])
    frame = truth(scene, PINHOLE.with_(transform=path))
    x, y = seen()
    angle = math.radians(-3)  # the camera rolls counter-clockwise, so the picture turns clockwise
    right = math.cos(angle) * x - math.sin(angle) * y - x
    down = y - (math.sin(angle) * x + math.cos(angle) * y)
    np.testing.assert_allclose(frame.motion, np.stack([right, down], -1) * PIXELS, atol=1e-3)
    assert not frame.aovs["depth.Z"].any()


def test_a_sky_that_turns_carries_its_points() -> None:
    scene = dg.Scene()
    sky = np.random.default_rng(1).uniform(0, 1, (8, 16, 3))
    scene.set_environment(sky, rotation=dg.keys([(-1.0, -20.0), (1.0, 20.0)]))
    frame = truth(scene)
    x, y = seen()
    c, s = math.cos(math.radians(2)), math.sin(math.radians(2))  # about +y, so ahead goes left
    u, v, w = c * x - s, y, s * x + c
    expected = np.stack([u / w - x, y - v / w], -1) * PIXELS
    np.testing.assert_allclose(frame.motion, expected, atol=1e-3)
    assert frame.motion[*MIDDLE, 0] < -1


def test_a_lamp_that_travels_and_grows() -> None:
    scene = dg.Scene()
    lamp = dg.SphereLight(radius=dg.keys([(0.0, 1.0), (1.0, 2.0)]), luminance=(1, 1, 1))
    scene.add_light(lamp, dg.keys([(0.0, at(0, 0, -5)), (1.0, at(3, 0, -5))]))
    frame = truth(scene)
    row, column = MIDDLE
    x, y = (seen()[i][row, column] for i in range(2))
    depth = frame.aovs["depth.Z"][row, column]
    assert depth == pytest.approx(4, rel=1e-3)
    # The point of the ball has its direction from the centre; the ball has 1.1 of its radius then.
    then = 1.1 * np.array([depth * x, depth * y, 5 - depth]) + (0.3, 0, 0)
    moved = np.array([then[0] / (5 - then[2]) - x, y - then[1] / (5 - then[2])]) * PIXELS
    np.testing.assert_allclose(frame.motion[row, column], moved, atol=2e-3)
    assert not frame.aovs["object_id"].any()


def test_a_zoom_moves_what_stands_still() -> None:
    zoom = PINHOLE.with_(focal_length=dg.keys([(-1.0, 40.0), (1.0, 60.0)]))
    frame = truth(wall(at(z=-4)), zoom)
    x, y = seen()
    grown = 51 / 50 - 1
    np.testing.assert_allclose(frame.motion[..., 0], x * PIXELS * grown, atol=1e-3)
    np.testing.assert_allclose(frame.motion[..., 1], -y * PIXELS * grown, atol=1e-3)


def test_through_an_exact_lens_motion_is_that_of_its_chief_rays() -> None:
    camera = dg.Camera(
        lens="double-gauss-50mm-f2",
        f_stop=2.8,
        fps=FPS,
        focus_distance=4.0,
        transform=dg.keys([(t, turned(1, 40 * t)) for t in (-1.0, 1.0)]),
    )
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    session = dg.Session(scene, camera, resolution=SIZE, motion=True)
    session.draw(0, 1)
    chief = session.prepared.setup.core.chief_rays()
    x, y = seen()
    film = np.stack([x, y], -1).reshape(-1, 2) * 50
    _, directions = chief.rays(film)
    then = chief.film_points(directions @ turned(1, 4)[:3, :3], True)
    expected = ((then - film) * SIZE[0] / 36 * (1, -1)).reshape(*SIZE[::-1], 2)
    np.testing.assert_allclose(session.frame().motion, expected, atol=1e-3)


@pytest.mark.parametrize("lens", ["double-gauss-50mm-f2", "wide-angle-28mm-f3.5"])
def test_in_focus_means_over_the_samples_agree(lens: str) -> None:
    camera = dg.Camera(lens=lens, focus_distance=4.0, shutter_time=0.0)
    scene = wall(at(z=-4))
    options = {"resolution": SIZE, "spp": 256, "filter": "box", "max_depth": 1}
    means = dg.render(scene, camera, aovs=True, **options).aovs
    exact = dg.render(scene, camera, gt_time="mid", **options).aovs
    for name in ("P.X", "P.Y"):
        pixel = np.ptp(exact[name]) / (SIZE[name == "P.Y"] - 1)
        error = (means[name] - exact[name]) / pixel
        # A pixel of 256 stratified samples knows its middle to far less than sqrt(1 / 12 / 256).
        assert np.abs(error).max() < 0.02
        assert np.abs(error.mean()) < 2e-3


def test_a_vertex_animation_is_followed_inside_its_triangles() -> None:
    # The wall stretches to the right, by half in a second: x -> x (1 + t / 2).
    corners, faces = scenes.quad(4)
    wide = corners * (1.5, 1, 1)
    scene = dg.Scene()
    mesh = scene.add_mesh(dg.keys([(0.0, corners), (1.0, wide)]), faces)
    scene.add_instance(mesh, transform=at(z=-4))
    scene.set_environment(color=(1, 1, 1))
    frame = truth(scene.at(0.5), PINHOLE)
    x, _ = seen()
    np.testing.assert_allclose(frame.motion[..., 0], x * PIXELS * 0.05 / 1.25, atol=1e-3)
    np.testing.assert_allclose(frame.motion[..., 1], 0, atol=1e-3)


def test_a_thin_lens_and_autofocus_see_what_the_pinhole_sees() -> None:
    scene = drifting((0.3, -0.2, 1.0))
    one, two = truth(scene), truth(scene, dg.Camera(f_stop=2.0, fps=FPS, shutter_time=0.04))
    np.testing.assert_array_equal(one.motion, two.motion)
    np.testing.assert_array_equal(one.aovs["P.X"], two.aovs["P.X"])


def test_each_line_of_a_rolling_shutter_has_its_own_moment() -> None:
    line_time = 2e-3
    camera = PINHOLE.with_(rolling_shutter=RollingShutter("top", line_time=line_time))
    frame = truth(drifting((0, -1.0, 5.0)), camera, gt_time="mid")
    lines = np.arange(SIZE[1])[:, None] - (SIZE[1] - 1) / 2
    depth = np.broadcast_to(4 - 5 * line_time * lines, SIZE[::-1])
    np.testing.assert_allclose(frame.aovs["depth.Z"], depth, rtol=1e-6)
    # Falling alone: by v T / (1 - v t) lines, as each line further down is later by t.
    frame = truth(drifting((0, -1.0, 0)), camera)
    speed = PIXELS / 4
    fall = speed / FPS / (1 - speed * line_time)
    stays = slice(0, SIZE[1] - math.ceil(fall) - 1)
    np.testing.assert_allclose(frame.motion[stays, :, 1], fall, atol=1e-3)
    assert abs(fall - speed / FPS) > 5e-3  # what it would be without the times of the lines


def test_hidden_in_the_next_frame_is_no_place_and_counted() -> None:
    scene = dg.Scene()
    shown = dg.keys([(0.0, True), (0.05, False)])
    scene.add_instance(scene.add_mesh(*scenes.quad(4)), transform=at(z=-4), shown=shown)
    scene.set_environment(color=(1, 1, 1))
    frame = truth(scene)
    assert np.isnan(frame.motion).all()
    assert frame.metadata["motion_missing"] == SIZE[0] * SIZE[1]
    assert not np.isnan(frame.motion_back).any()


def picture(size: int = 64) -> np.ndarray:
    """Smooth waves, bytes (H, W, 3)."""
    v, u = np.mgrid[0:size, 0:size] / size * 2 * np.pi
    waves = [np.sin(3 * u) * np.cos(2 * v), np.cos(4 * u + v), np.sin(2 * u - 3 * v)]
    return np.uint8(np.stack([128 + 100 * w for w in waves], -1))


def test_a_frame_warped_by_its_motion_is_the_next_frame() -> None:
    scene = dg.Scene()
    corners, faces = scenes.quad(4)
    uv = (corners[:, :2] / 8 + 0.5) * (1, -1)
    texture = scene.add_texture(picture(), srgb=False)
    paint = dg.Material(
        dg.Gltf(metallic=0, roughness=1, base_color_texture=dg.TextureSlot(texture))
    )
    path = [(t, at(0.8 * t, -0.5 * t, -4) @ turned(2, 60 * t)) for t in (-1.0, 0.0, 1.0)]
    scene.add_instance(scene.add_mesh(corners, faces, uv=uv), paint, dg.keys(path))
    scene.set_environment(color=(1, 1, 1))
    camera = PINHOLE.with_(shutter_time=0.0)
    size = {"resolution": (64, 48), "spp": 64, "filter": "box"}
    now = dg.render(scene, camera, motion=True, **size)
    later = dg.render(scene.at(1 / FPS), camera, **size)
    y, x = np.mgrid[0:48, 0:64]
    flow = now.motion

    def difference(flow: np.ndarray) -> float:
        u, v = x + flow[..., 0], y + flow[..., 1]
        inside = (u >= 0) & (v >= 0) & (u < 63) & (v < 47)
        i, j = np.where(inside, u, 0).astype(int), np.where(inside, v, 0).astype(int)
        a, b = (np.where(inside, u, 0) - i)[..., None], (np.where(inside, v, 0) - j)[..., None]
        rgb = later.rgb
        there = (rgb[j, i] * (1 - a) + rgb[j, i + 1] * a) * (1 - b)
        there += (rgb[j + 1, i] * (1 - a) + rgb[j + 1, i + 1] * a) * b
        return float(np.abs(there - now.rgb)[inside].mean())

    assert difference(flow) < 0.01
    assert difference(0 * flow) > 0.05
    assert difference(-flow) > 0.05


def test_channels_of_the_command_line_and_of_merged_passes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from tests.support.formats.make_gltf import Builder

    monkeypatch.chdir(tmp_path)
    made = Builder()
    corners, faces = scenes.quad(4)
    ends = {"min": corners.min(0).tolist(), "max": corners.max(0).tolist()}
    position = made.accessor(corners.astype(np.float32), **ends)
    made.node(mesh=made.mesh({"POSITION": position}, indices=made.accessor(faces.ravel(), "u2")))
    made.add("cameras", {"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.01}})
    made.node(camera=0, translation=[0, 0, 2.0])
    made.glb(tmp_path / "s.glb")
    flags = ["--res", "12x8", "--sky", "1,1,1", "--quiet", "--aov", "depth,motion,object_id"]
    for name, samples in (("a", ["--samples", "0:2"]), ("b", ["--samples", "2:4"]), ("c", [])):
        drawn = samples or ["--spp", "4"]
        assert main(["render", "s.glb", "-o", f"{name}.exr", *drawn, *flags]) == 0
    assert main(["merge", "b.exr", "a.exr", "-o", "m.exr", "--quiet"]) == 0
    channels = []
    for name in "mc":
        with OpenEXR.File(f"{name}.exr", separate_channels=True) as file:
            channels.append({key: c.pixels.copy() for key, c in file.channels().items()})
            assert file.header()["daguerre:gt_time"] == "mid"
    merged, whole = channels
    assert set(whole) >= {"depth.Z", "object_id", "motion.U", "motion.V"}
    assert "motion_back.U" not in whole
    assert set(merged) == set(whole)
    for key, plane in whole.items():
        np.testing.assert_array_equal(merged[key], plane, err_msg=key)


def test_what_is_no_moment_is_refused_by_name() -> None:
    with pytest.raises(UsageError, match="gt_time: wanted open, mid, close, got 'opn'"):
        truth(drifting((0, 0, 0)), gt_time="opn")
    with pytest.raises(UsageError, match=r"gt_time: wanted open, mid, close, got \['mid'\]"):
        truth(drifting((0, 0, 0)), gt_time=["mid"])
    assert main(["render", "s.glb", "-o", "a.exr", "--gt-time", "late", "--aov", "N"]) == 2
    assert main(["render", "s.glb", "-o", "a.exr", "--gt-time", "mid"]) == 2
