"""Suns with an angle: penumbra and umbra in closed form, and the same sun as a far ball."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from tests.support.pictures.light_proof import Case, pictures
from tests.support.pictures.statistical import Reference, batch_means, differences
from tests.support.scene import scenes

Picture = NDArray[np.float64]
LUX = 3.0
WALL = -2.0  # m, where the wall is that the camera at the origin looks at
PLAIN: dict[str, Any] = {"filter": "box", "max_depth": 1, "light_paths": "off"}


def before_wall(sun: dg.DirectionalLight) -> dg.Scene:
    """A white wall of luminance 1 per lux that a sun shines on straight from behind the camera."""
    scene = dg.Scene()
    scene.add_instance(scene.add_mesh(*scenes.quad(30, WALL)), dg.Material(dg.Diffuse((1, 1, 1))))
    scene.add_light(sun)
    return scene


def telephoto(width: float, height: float) -> dg.Camera:
    """A pinhole that sees this much of the wall, m, evenly bright to its corners."""
    focal = 1000.0  # mm
    size = (width / -WALL * focal, height / -WALL * focal)
    return dg.Camera(lens="pinhole", focal_length=focal, sensor_size=size)


# The shadow of a straight edge -------------------------------------------------------------------

ACROSS, DOWN = 48, 8  # px
EDGE = 1.0  # m, plane of the card behind the camera that hides the sun where x < 0


def edge(angle: float) -> dg.Scene:
    scene = before_wall(dg.DirectionalLight((LUX,) * 3, angle=angle))
    black = dg.Material(dg.Diffuse((0, 0, 0)))
    scene.add_instance(scene.add_mesh(*scenes.quad(5, EDGE)), black, scenes.at(-5, 0, 0))
    return scene


def lit_share(u: Any) -> Any:
    """Area of a unit disc beyond the line x = -u, a circular segment, over that of the disc."""
    u = np.clip(u, -1, 1)
    return 0.5 + (u * np.sqrt(1 - u * u) + np.arcsin(u)) / math.pi


def penumbra(angle: float, width: float) -> Picture:
    """Luminance of the wall, (DOWN, ACROSS, 3): what the edge leaves of a disc of this angle.

    The sines of directions toward a small disc fill a disc evenly, and the cosine is 1.
    """
    x = ((np.arange(ACROSS * 100) + 0.5) / (ACROSS * 100) - 0.5) * width
    lit = lit_share(x / ((EDGE - WALL) * math.tan(math.radians(angle / 2))))
    columns = LUX / math.pi * lit.reshape(ACROSS, 100).mean(axis=1)
    return np.tile(columns[:, None], (DOWN, 1, 3))


@pytest.mark.parametrize("angle", [0.53, 3.0])
def test_the_penumbra_of_an_edge_is_a_segment_of_the_disc(angle: float) -> None:
    width = 2.5 * (EDGE - WALL) * math.tan(math.radians(angle / 2))
    camera = telephoto(width, width * DOWN / ACROSS)
    found = batch_means(edge(angle), camera, 8, 256, resolution=(ACROSS, DOWN), **PLAIN)
    expected = penumbra(angle, width)

    def near(picture: Picture) -> list[str]:
        return differences(found, Reference(picture, (1e-3 * picture) ** 2 + 1e-9, 1000))

    assert near(expected) == []
    assert (expected.min(), expected.max()) == pytest.approx((0, LUX / math.pi))
    assert near(penumbra(1.05 * angle, width)) != []  # 5 % wider
    ramp = np.linspace(-1.25, 1.25, ACROSS)[:, None] / 2 + 0.5  # the penumbra of a square sun
    square = np.tile(LUX / math.pi * np.clip(ramp, 0, 1), (DOWN, 1, 3))
    assert near(square) != []


def test_a_sun_without_an_angle_has_a_sharp_edge() -> None:
    """Each pixel is lit or dark, but for those on the edge."""
    width = 0.1
    camera = telephoto(width, width * DOWN / ACROSS)
    frame = dg.render(edge(0.0), camera, spp=16, resolution=(ACROSS, DOWN), **PLAIN)
    light = frame.rgb[:, :, 1].astype(float) * math.pi / LUX
    middle = ACROSS // 2
    assert np.allclose(light[:, : middle - 1], 0)
    assert np.allclose(light[:, middle + 1 :], 1, atol=0.05)  # by chance of wavelengths


# The shadow of a ball ----------------------------------------------------------------------------


@pytest.mark.parametrize("distance", [2.2, 2.8, 3.0, 4.0, 8.0])
def test_the_umbra_of_a_ball_ends_where_it_covers_the_disc_no_more(distance: float) -> None:
    """On the axis, L pi (sin^2 h - (r / d)^2) is left of L pi sin^2 h beyond d = r / sin h."""
    radius, angle = 0.05, 2.0
    scene = before_wall(dg.DirectionalLight((LUX,) * 3, angle=angle))
    points, faces, normals = scenes.sphere(128, radius)
    ball = scene.add_mesh(points, faces, normals)
    scene.add_instance(ball, dg.Material(dg.Diffuse((0, 0, 0))), scenes.at(0, 0, WALL + distance))
    frame = dg.render(scene, telephoto(1e-4, 1e-4), spp=1024, resolution=(8, 8), **PLAIN)
    light = frame.rgb.astype(float).mean() * math.pi / LUX
    umbra = radius / math.sin(math.radians(angle / 2))
    assert 2.8 < umbra < 3.0
    assert light == pytest.approx(max(0.0, 1 - (umbra / distance) ** 2), abs=0.006)


# The same sun as a far ball ----------------------------------------------------------------------


def still_life(light: Any, pose: Any) -> dg.Scene:
    """A matte floor under two balls, one glossy, in the light of a lamp."""
    scene = dg.Scene()
    floor = scenes.at(0, -0.3, -2)
    floor[:3, :3] = [[1, 0, 0], [0, 0, 1], [0, -1, 0]]
    scene.add_instance(
        scene.add_mesh(*scenes.quad(2)), dg.Material(dg.Diffuse((0.6, 0.5, 0.4))), floor
    )
    ball = scene.add_mesh(*scenes.sphere(24, 0.3))
    matte, glossy = dg.Diffuse((0.3, 0.5, 0.7)), dg.Conductor((0.9, 0.7, 0.4), 0.3)
    scene.add_instance(ball, dg.Material(matte), scenes.at(-0.35, 0, -2))
    scene.add_instance(ball, dg.Material(glossy), scenes.at(0.35, 0, -2))
    scene.add_light(light, pose)
    return scene


def toward(x: float, y: float, z: float, distance: float = 0.0) -> Any:
    """A pose at this distance whose +z points away from the origin: light shines back to it."""
    back = np.array((x, y, z)) / math.sqrt(x * x + y * y + z * z)
    pose = dg.look_at((0, 0, 0), tuple(-back))
    pose[:3, 3] = distance * back
    return pose


SKYWARD = (0.5, 0.7, 0.6)
EYE = dg.Camera(lens="pinhole", focal_length=50, sensor_size=(36, 24))


@pytest.mark.parametrize("angle", [25.0, 60.0, 120.0])
def test_a_sun_with_an_angle_is_a_far_ball(angle: float) -> None:
    """Rays meet the ball, but not the sun: they share nothing but what the light should be."""
    sine, far = math.sin(math.radians(angle / 2)), 2e4
    ball = dg.SphereLight((LUX / (math.pi * sine**2),) * 3, far * sine)
    options: dict[str, Any] = {"resolution": (48, 32), "max_depth": 3, "light_paths": "off"}

    def drawn(light: Any, pose: Any, seed: int) -> Picture:
        scene = still_life(light, pose)
        return batch_means(scene, EYE, 8, 128, seed=seed, **options)

    by_ball = drawn(ball, toward(*SKYWARD, far), 100)
    by_sun = drawn(dg.DirectionalLight((LUX,) * 3, angle=angle), toward(*SKYWARD), 200)
    assert differences(by_sun, by_ball) == []
    assert differences(1.02 * by_sun, by_ball) != []
    other = drawn(dg.DirectionalLight((LUX,) * 3, angle=angle / 2), toward(*SKYWARD), 300)
    assert differences(other, by_ball) != []


def test_light_paths_from_a_sun_with_an_angle_draw_the_same_picture() -> None:
    sun = dg.DirectionalLight((LUX,) * 3, angle=30.0)
    scene = still_life(sun, toward(*SKYWARD))
    case = Case(lambda: scene, EYE, plan=(0.0, 3000.0), spp=(256, 64, 64))
    by_camera, by_light, by_both = (pictures(case, name) for name in ("camera", "light", "both"))
    assert differences(by_light, by_camera) == []
    assert differences(by_both, by_camera) == []


def test_neither_the_camera_nor_a_mirror_shows_the_disc() -> None:
    scene = dg.Scene()
    scene.add_instance(scene.add_mesh(*scenes.quad(1, -4)), dg.Material(dg.Conductor((1, 1, 1), 0)))
    scene.add_light(dg.DirectionalLight((LUX,) * 3, angle=60.0))  # from behind the camera
    scene.add_light(dg.DirectionalLight((LUX,) * 3, angle=60.0), toward(0, 0, -1))
    frame = dg.render(scene, EYE, spp=16, resolution=(24, 16), light_paths="off")
    assert not frame.rgb.any()


@pytest.mark.parametrize("angle", [-0.1, 361, math.nan, math.inf, "wide", None, True])
def test_angles_that_are_none(angle: Any) -> None:
    with pytest.raises(dg.InputError, match="light 'sun': angle: wanted a number of at least 0"):
        dg.Scene().add_light(dg.DirectionalLight(name="sun", angle=angle))
