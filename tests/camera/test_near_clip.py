"""Near clipping plane: what is nearer is not in the picture, by whatever way light comes there."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.errors import UsageError
from daguerre.rendering.session import Session
from daguerre.setup.camera import set_up
from daguerre.setup.near_clip import directions_of, is_round
from tests.support.pictures.statistical import batch_means, differences
from tests.support.scene import scenes

LENS = "double-gauss-50mm-f2"
FISHEYE = "olympus-zuiko-fisheye-8mm-f2.8"
SIZE = (32, 20)
NEAR = 0.8
CARD = (0.04, 0.0, -0.6)
AWAY = (0.0, 0.0, 50.0)
FILM = {"focus_distance": 1.2, "sensor_size": (9.0, 5.4)}
CAMERAS: dict[str, dg.Camera] = {
    "pinhole": dg.Camera(lens="pinhole", focal_length=50, **FILM),
    "thin": dg.Camera(focal_length=50, f_stop=2.0, **FILM),
    "tilted": dg.Camera(focal_length=50, f_stop=2.0, tilt=(8.0, 3.0), **FILM),
    "thick": dg.Camera(lens=LENS, lens_model="thick", f_stop=2.0, **FILM),
    "exact": dg.Camera(lens=LENS, f_stop=2.0, **FILM),
    "polynomial": dg.Camera(lens=LENS, lens_model="polynomial", f_stop=2.0, **FILM),
    "projection": dg.Camera(
        projection=dg.Projection("opencv", SIZE, (178.0, 178.0), parameters=(-0.1,)), f_stop=2.0,
        **FILM,
    ),
    "fisheye": dg.Camera(
        projection=dg.Projection("equidistant", SIZE, (178.0, 178.0)), f_stop=2.0, **FILM
    ),
}  # fmt: skip


def stage(card: tuple[float, float, float] = CARD, color: float = 0.7) -> dg.Scene:
    """Lamps before a wall, one of them nearer than the plane, and a card in front of half of it."""
    scene = dg.Scene()
    for x, y, z, light in (
        (-0.05, 0.02, -0.7, (60, 30, 10)),
        (0.03, 0.01, -1.2, (30, 40, 60)),
        (-0.1, -0.1, -3.2, (60, 60, 100)),
    ):
        scene.add_light(dg.SphereLight(light, 0.02), scenes.at(x, y, z))
    pane = scene.add_mesh(*scenes.quad(0.05))
    glow = dg.Material(dg.Diffuse((0, 0, 0)), emission=(20, 90, 60))
    scene.add_instance(pane, glow, scenes.at(0.06, 0.0, -1.0))
    scene.add_instance(pane, dg.Material(dg.Diffuse((color,) * 3)), scenes.at(*card))
    scene.add_instance(scene.add_mesh(*scenes.quad(1.0)), dg.Material(), scenes.at(0, 0, -3.5))
    return scene


def clipped(kind: str) -> dg.Camera:
    return CAMERAS[kind].with_(near_clip=NEAR)


def depth(frame: dg.Frame) -> np.ndarray:
    """Depth, m; 0: nothing is met."""
    return np.nan_to_num(frame.aovs["depth.Z"], posinf=0.0)


def drawn(scene: dg.Scene, camera: dg.Camera, **options: Any) -> dg.Frame:
    given = {"resolution": SIZE, "spp": 4, "light_paths": "off", "max_depth": 1, "aovs": True}
    return dg.render(scene, camera, **given | options)


@pytest.mark.parametrize("kind", CAMERAS)
def test_a_card_before_the_plane_leaves_the_picture_to_the_bit(kind: str) -> None:
    """By direct light alone: the card hides no lamp from the wall."""
    without = drawn(stage(AWAY), clipped(kind))
    frame = drawn(stage(), clipped(kind))
    assert np.array_equal(frame.rgb, without.rgb)
    assert np.array_equal(depth(frame), depth(without))
    assert without.rgb.max() > 0
    assert not np.array_equal(drawn(stage(), CAMERAS[kind]).rgb, without.rgb)


def lit_wall() -> dg.Scene:
    """A wall that another one lights, and a card before half of it; the lamp is out of sight."""
    scene = dg.Scene()
    aside = np.array([[0, 0, -1, 0.9], [0, 1, 0, 0], [1, 0, 0, -3.2], [0, 0, 0, 1.0]])
    lamp = aside.copy()
    lamp[0, 3] = 0.3  # it shines on the other wall alone
    scene.add_light(dg.SpotLight((3000, 2000, 1000), 15.0, 22.0), lamp)
    pane = scene.add_mesh(*scenes.quad(0.05))
    scene.add_instance(pane, dg.Material(dg.Diffuse((0.9,) * 3)), scenes.at(*CARD))
    wall = scene.add_mesh(*scenes.quad(1.0))
    scene.add_instance(wall, dg.Material(), scenes.at(0, 0, -3.5))
    scene.add_instance(wall, dg.Material(dg.Diffuse((0.9,) * 3)), aside)
    return scene


@pytest.mark.parametrize("kind", ["pinhole", "thin", "exact", "polynomial", "fisheye"])
@pytest.mark.parametrize("made", [stage, lit_wall])
def test_camera_light_and_both_are_one_picture(made: Callable[[], dg.Scene], kind: str) -> None:
    """Nothing that is clipped is met or in the way, from either end."""
    scene, camera = made(), clipped(kind)

    def draw(technique: str, spp: int, plan: Any, seed: int, one: dg.Camera = camera) -> np.ndarray:
        options = {"technique": technique, "light_paths": plan, "seed": seed, "max_depth": 3}
        return batch_means(scene, one, 8, spp, resolution=SIZE, filter="box", **options)

    plan = (4000.0, 4000.0)
    by_camera = draw("camera", 96, "off", 1000)
    by_light, by_both = draw("light", 24, plan, 2000), draw("both", 24, plan, 3000)
    assert differences(by_camera, by_light) == []
    assert differences(by_camera, by_both) == []
    assert differences(by_camera, draw("light", 24, plan, 4000, CAMERAS[kind])) != []


PLAIN = dg.Camera(lens="pinhole", focal_length=50.0)
ROWS = 40
HEIGHT = 0.1


def floor(camera: dg.Camera) -> dg.Frame:
    """A black floor below the camera, from before it to far away, under a white sky all around."""
    scene = dg.Scene()
    points = np.array([(-9, 0, 0), (9, 0, 0), (9, 0, -9), (-9, 0, -9)], float)
    mesh = scene.add_mesh(points, np.array([(0, 1, 2), (0, 2, 3)]))
    scene.add_instance(mesh, dg.Material(dg.Diffuse((0, 0, 0))), scenes.at(0, -HEIGHT, 0))
    scene.set_environment(color=(1, 1, 1))
    options = {"resolution": (60, ROWS), "spp": 64, "filter": "box", "light_paths": "off"}
    return dg.render(scene, camera, motion=True, **options)


@pytest.mark.parametrize("near", [0.55, 0.9, 1.7])
def test_what_crosses_the_plane_is_cut_in_its_row(near: float) -> None:
    frame = floor(PLAIN.with_(near_clip=near))
    edge = ROWS / 2 + HEIGHT / near * 50 / 36 * 60  # px from above
    row, left = int(edge), edge - int(edge)
    value = frame.rgb[..., 1]
    np.testing.assert_allclose(value[row + 1 :], 1, atol=0.02)
    assert value[ROWS // 2 + 2 : row].max() == 0
    assert value[row].mean() == pytest.approx(1 - left, abs=0.02)
    seen = depth(frame)
    assert seen[row - 1].min() > 0
    assert not seen[row + 1 :].any()
    assert floor(PLAIN).rgb[ROWS // 2 + 2 :].max() == 0


def bumpy(turn: np.ndarray) -> dg.Scene:
    """Balls all about the camera, at many distances."""
    scene = dg.Scene()
    points, faces, normals = scenes.sphere(12, 0.15)
    ball = scene.add_mesh(points, faces, normals)
    draw = np.random.default_rng(3)
    for _ in range(300):
        x, y, z = draw.uniform((-1, -0.7, -4), (1, 0.7, -0.2))
        scene.add_instance(ball, dg.Material(), turn @ scenes.at(x, y, z))
    return scene


def pose() -> np.ndarray:
    return dg.look_at((1.0, 2.0, -0.5), (0.2, 1.1, 3.0), roll=25)


@pytest.mark.parametrize("kind", ["pinhole", "tilted", "exact"])
def test_depth_begins_at_the_plane_wherever_the_camera_looks(kind: str) -> None:
    camera = CAMERAS[kind].with_(transform=pose(), near_clip=1.5, sensor_size=(36.0, 22.5))
    options = {"resolution": SIZE, "spp": 1, "motion": True}
    cut = depth(dg.render(bumpy(pose()), camera, **options))
    whole = depth(dg.render(bumpy(pose()), camera.with_(near_clip=0), **options))
    far = whole >= 1.5
    met = cut > 0
    assert (whole[~far & (whole > 0)]).size > 50
    assert np.array_equal(cut[far & (whole < 100)], whole[far & (whole < 100)])
    assert cut[met].min() >= 1.5 - 1e-5
    assert cut[met].min() < 1.6  # some ball crosses it


def shells() -> dg.Scene:
    """A ball within another, both about the camera."""
    scene = dg.Scene()
    for radius in (0.5, 2.0):
        points, faces, _ = scenes.sphere(32, radius)
        scene.add_instance(scene.add_mesh(points, faces), dg.Material())
    return scene


def test_a_lens_that_sees_behind_itself_has_a_sphere() -> None:
    around = dg.Projection.of_field("equidistant", SIZE, 300.0)
    camera = dg.Camera(projection=around, near_clip=1.0)
    options = {"resolution": SIZE, "spp": 1, "motion": True}
    found = depth(dg.render(shells(), camera, **options))
    pixels = np.stack(np.meshgrid(np.arange(32.0), np.arange(20.0)), -1)
    ahead = around.unproject(pixels.reshape(-1, 2))[:, 2].reshape(20, 32)
    np.testing.assert_allclose(found, 2.0 * ahead, atol=0.02)
    nearer = depth(dg.render(shells(), camera.with_(near_clip=0.4), **options))
    np.testing.assert_allclose(nearer, 0.5 * ahead, atol=0.01)


@pytest.mark.parametrize(("lens", "wide"), [(LENS, False), (FISHEYE, True), (None, False)])
def test_which_lenses_have_a_sphere(lens: str | None, wide: bool) -> None:
    camera = dg.Camera(lens=lens, f_stop=8.0, focus_distance=2.0)
    setup = set_up(dg.Scene(), camera, (36, 24), None)
    assert is_round(camera, directions_of(setup.core), setup.frame_size_mm) is wide
    steep = math.degrees(math.atan(13.0 / 9.0))  # the widest of rectilinear lenses
    assert steep < 80


def test_autofocus_looks_beyond_the_plane() -> None:
    scene, camera = stage((0.0, 0.0, -0.6)), dg.Camera(focal_length=50, f_stop=2.0)
    for near, wanted in ((0.0, 0.6), (0.8, 3.5)):
        for focus in ({}, {"focus_at": (15.0, 11.0)}):
            session = Session(scene, camera.with_(near_clip=near, **focus), resolution=SIZE)
            found = session.metadata["camera"]["focus_distance_m"]
            assert found == pytest.approx(wanted, abs=1e-4)


def test_shadows_of_what_is_clipped_stay() -> None:
    """A lamp behind the camera, a card between them, and a wall that it darkens."""

    def lit(card: tuple[float, float, float]) -> float:
        scene = dg.Scene()
        scene.add_light(dg.SphereLight((900, 900, 900), 0.05), scenes.at(0, 0, 1.0))
        scene.add_instance(
            scene.add_mesh(*scenes.quad(0.2)), dg.Material(dg.Diffuse((0, 0, 0))), scenes.at(*card)
        )
        scene.add_instance(scene.add_mesh(*scenes.quad(1.0)), dg.Material(), scenes.at(0, 0, -3))
        return float(drawn(scene, CAMERAS["pinhole"].with_(near_clip=1.0)).rgb.mean())

    assert lit((0, 0, -0.5)) < 1e-6 < 0.01 * lit(AWAY)


def test_ghosts_know_neither_lamps_nor_cards_before_the_plane() -> None:
    def flare(z: float, card: float, near: float) -> np.ndarray:
        scene = dg.Scene()
        scene.add_light(dg.SphereLight((9e4,) * 3, 0.002), scenes.at(0.1 * -z, 0.05 * -z, z))
        cover = dg.Material(dg.Diffuse((0, 0, 0)))
        scene.add_instance(scene.add_mesh(*scenes.quad(0.3)), cover, scenes.at(0, 0, card))
        camera = dg.Camera(lens=LENS, f_stop=4.0, focus_distance=5.0, near_clip=near)
        options = {"flare": 20000.0, "flare_highlights": "off", "light_paths": "off"}
        session = Session(scene, camera, resolution=(36, 24), **options)
        session.draw(0, 2)
        found = session.frame().flare
        assert found is not None
        return np.asarray(found)

    free = flare(-2.0, 50.0, 1.0)
    assert free.max() > 0
    assert flare(-2.0, -0.5, 0.0).max() == 0  # behind the card
    np.testing.assert_array_equal(flare(-2.0, -0.5, 1.0), free)
    assert flare(-0.8, 50.0, 0.0).max() > 0
    assert flare(-0.8, 50.0, 1.0).max() == 0


def test_without_a_plane_nothing_is_said_of_it() -> None:
    options = {"resolution": SIZE}
    plain = Session(stage(), CAMERAS["thin"], **options).metadata["camera"]
    assert (
        Session(stage(), CAMERAS["thin"].with_(near_clip=0), **options).metadata["camera"] == plain
    )
    assert "near_clip_m" not in plain
    assert Session(stage(), clipped("thin"), **options).metadata["camera"]["near_clip_m"] == NEAR


@pytest.mark.parametrize("value", [-1.0, math.nan, math.inf, 1e30, "near"])
def test_bad_distances_are_refused(value: Any) -> None:
    with pytest.raises(UsageError, match="near_clip: wanted"):
        Session(stage(), dg.Camera(near_clip=value), resolution=SIZE)


def test_it_is_constant() -> None:
    with pytest.raises(UsageError, match="camera: near_clip: cannot change over time"):
        dg.Camera(near_clip=dg.keys([(0.0, 1.0), (1.0, 2.0)]))
