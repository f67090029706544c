"""Lamps with profiles: a wall shows the table, and every way of finding the light agrees."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from tests.support.pictures.light_proof import CLOSE, Case, check, pictures, thin, wall
from tests.support.pictures.statistical import differences
from tests.support.scene import scenes

Matrix = NDArray[np.float64]
SIZE = (48, 32)
DISTANCE = 2.0  # m from camera and lamp to the wall
FOCAL, FILM = 24.0, (36.0, 24.0)  # mm
CAMERA = dg.Camera(lens="pinhole", focal_length=FOCAL, sensor_size=FILM)


def turn(degrees: float, axis: int) -> Matrix:
    """A rotation about x, y or z."""
    a, i, j = np.radians(degrees), (axis + 1) % 3, (axis + 2) % 3
    out = np.eye(4)
    out[i, i], out[i, j], out[j, i], out[j, j] = np.cos(a), -np.sin(a), np.sin(a), np.cos(a)
    return out


def lobes(theta_deg: Any, phi_deg: Any) -> Any:
    """A smooth distribution with no symmetry, cd."""
    theta, phi = np.radians(theta_deg), np.radians(phi_deg)
    shape = 1 + 0.6 * np.cos(phi) * np.sin(theta) + 0.3 * np.sin(2 * phi + 0.5) * np.sin(theta) ** 2
    return 100 * shape * (0.3 + 0.7 * np.cos(theta / 2) ** 4)


def measured() -> dg.LightProfile:
    """The distribution as a photometer measures it, each 2.5 and 5 degrees."""
    theta, phi = np.arange(0, 181, 2.5), np.arange(0, 361, 5.0)
    return dg.LightProfile.table(theta, lobes(theta[:, None], phi), phi)


def before_wall(*lights: tuple[Any, Any], reflectance: float = 0.5) -> dg.Scene:
    """A wall in the plane z = -2, and lamps."""
    scene = dg.Scene()
    points, faces = scenes.quad(30, -DISTANCE)
    kind = dg.Diffuse((reflectance,) * 3)
    scene.add_instance(scene.add_mesh(points, faces), dg.Material(kind))
    for light, transform in lights:
        scene.add_light(light, transform)
    return scene


def luminance(scene: dg.Scene, **options: Any) -> NDArray[np.float64]:
    """Luminance of the wall (cd/m2) at each pixel, without what the camera does to it."""
    given: dict[str, Any] = {"resolution": SIZE, "spp": 64, "max_depth": 1, "filter": "box"}
    given |= options
    white = dg.Scene()
    points, faces = scenes.quad(30, -DISTANCE)
    shining = dg.Material(dg.Diffuse((0, 0, 0)), emission=(1, 1, 1))
    white.add_instance(white.add_mesh(points, faces), shining)
    through = dg.render(white, CAMERA, **given).rgb[..., 1].astype(float)
    return dg.render(scene, CAMERA, **given).rgb[..., 1].astype(float) / through


def wall_points() -> NDArray[np.float64]:
    """Middles of the pixels on the wall, (H, W, 3)."""
    width, height = SIZE
    x = ((np.arange(width) + 0.5) / width - 0.5) * FILM[0] / FOCAL * DISTANCE
    y = (0.5 - (np.arange(height) + 0.5) / height) * FILM[1] / FOCAL * DISTANCE
    grid = np.stack(np.meshgrid(x, y), -1)
    return np.concatenate([grid, np.full((height, width, 1), -DISTANCE)], -1)


def angles(away: NDArray[np.float64], transform: Matrix) -> tuple[Any, Any, Any]:
    """Distance (m), and theta and phi (degrees) of ways from the lamp in its frame."""
    distance = np.linalg.norm(away, axis=-1)
    local = away / distance[..., None] @ transform[:3, :3]
    theta = np.degrees(np.arccos(np.clip(-local[..., 2], -1, 1)))
    return distance, theta, np.degrees(np.arctan2(local[..., 1], local[..., 0]))


def by_inverse_square(transform: Matrix, reflectance: float = 0.5) -> NDArray[np.float64]:
    """L = rho / pi I(theta, phi) cos / d^2."""
    away = wall_points() - transform[:3, 3]
    distance, theta, phi = angles(away, transform)
    return reflectance / np.pi * lobes(theta, phi) * -away[..., 2] / distance**3


POSES = {
    "straight": scenes.at(0.2, -0.1, 0.3),
    "rolled": scenes.at(0, 0, 0) @ turn(130, 2),
    "tilted and rolled": scenes.at(-0.4, 0.2, 0.1) @ turn(35, 0) @ turn(70, 1) @ turn(200, 2),
}


@pytest.mark.parametrize("name", POSES)
def test_a_table_is_reproduced_on_a_wall(name: str) -> None:
    lamp = dg.PointLight(profile=measured())
    found = luminance(before_wall((lamp, POSES[name])))
    expected = by_inverse_square(POSES[name])
    assert np.abs(found / expected - 1).max() < 0.01
    mirrored = expected[:, ::-1]  # the table is no other's
    assert np.abs(found / mirrored - 1).max() > 0.1


@pytest.mark.parametrize("kind", ["sphere", "point with a radius"])
def test_a_small_ball_is_the_point_light_of_its_intensity(kind: str) -> None:
    radius, pose = 0.004, POSES["tilted and rolled"]
    lamp: Any = dg.PointLight(radius=radius, profile=measured())
    if kind == "sphere":
        lamp = dg.SphereLight((1 / (math.pi * radius**2),) * 3, radius, profile=measured())
    found = luminance(before_wall((lamp, pose)), spp=256)
    assert np.abs(found / by_inverse_square(pose) - 1).max() < 0.01


def test_a_hard_cone_has_an_edge_and_no_ring() -> None:
    pose = scenes.at(0, 0, 0) @ turn(8, 1)
    cone = dg.LightProfile.cone(20)
    even = luminance(before_wall((dg.PointLight((100,) * 3), pose)))
    found = luminance(before_wall((dg.PointLight((100,) * 3, profile=cone), pose)))
    _, theta, _ = angles(wall_points() - pose[:3, 3], pose)
    assert np.allclose(found[theta < 18.5], even[theta < 18.5], rtol=1e-5)
    assert (found[theta > 21.5] == 0).all()
    assert ((found <= even * 1.02) & (found >= 0)).all()
    assert 100 < (theta < 18.5).sum() < 1000


def test_parts_are_multiplied_and_a_tint_has_its_colour() -> None:
    pose = POSES["straight"]
    parts = (
        dg.LightProfile.cone(50, 0.6),
        dg.LightProfile.focus(4, (0.5, 0.1, 0.0)),
        measured().relative(),
    )
    product = parts[0] * parts[1] * parts[2]
    scene = before_wall((dg.PointLight((100,) * 3, profile=product), pose))
    even = before_wall((dg.PointLight((100,) * 3), pose))
    options: dict[str, Any] = {"resolution": SIZE, "spp": 256, "max_depth": 1, "filter": "box"}
    ratio = dg.render(scene, CAMERA, **options).rgb / dg.render(even, CAMERA, **options).rgb
    away = (wall_points() - pose[:3, 3]).reshape(-1, 3)
    expected = np.prod([part.factors(away) for part in parts], axis=0).reshape(*ratio.shape)
    assert np.abs(ratio - expected)[expected > 0].max() < 0.02
    assert np.abs(ratio - expected).mean() < 0.002


def shaped_card(profile: dg.LightProfile | None, pose: Matrix, half: float) -> dg.Scene:
    """A card of 10 cd/m2 that shines along its -z."""
    scene = before_wall()
    points, faces = scenes.quad(half)
    material = dg.Material(dg.Diffuse((0, 0, 0)), emission=(10, 10, 10), profile=profile)
    mesh = scene.add_mesh(points, np.asarray(faces)[:, ::-1])
    scene.add_instance(mesh, material, pose, name="card")
    return scene


def by_quadrature(profile: dg.LightProfile, pose: Matrix, half: float) -> Any:
    """L = rho / pi sum of 10 P cos cos / d^2 dA over the card."""
    n = 24
    side = (np.arange(n) + 0.5) / n * 2 * half - half
    u, v = np.meshgrid(side, side)
    local = np.stack([u, v, 0 * u, 0 * u + 1], -1).reshape(-1, 4)
    corners = (local @ pose.T)[:, :3]
    normal = -pose[:3, 2] / np.linalg.norm(pose[:3, 2])
    area = np.linalg.norm(np.cross(pose[:3, 0], pose[:3, 1])) * (2 * half / n) ** 2
    axes = pose[:3, :3] / np.linalg.norm(pose[:3, :3], axis=0)
    total = np.zeros(SIZE[::-1])
    for corner in corners:
        away = wall_points() - corner
        distance = np.linalg.norm(away, axis=-1)
        factor = profile.factors((away @ axes).reshape(-1, 3))[:, 1].reshape(total.shape)
        facing = np.maximum(away @ normal, 0) * -away[..., 2] / distance**4
        total += 10 * factor * facing * area
    return 0.5 / np.pi * total


@pytest.mark.parametrize(
    ("scale", "half"),
    [((1, 1, 1), 0.3), ((2.0, 0.5, 3.0), 0.3), ((-1, 1, 1), 0.3), ((1, 1, 1), 1.2)],
)
def test_a_shaped_card_lights_a_wall_as_quadrature_says(
    scale: tuple[float, float, float], half: float
) -> None:
    """A large card is met by many rays of the wall itself: weights of both ways count."""
    profile = measured().relative() * dg.LightProfile.cone(60, 0.5)
    pose = scenes.at(0.2, 0.1, 0.4) @ turn(15, 1) @ turn(110, 2) @ np.diag([*scale, 1.0])
    found = luminance(shaped_card(profile, pose, half), spp=1024)
    expected = by_quadrature(profile, pose, half)
    lit = expected > 0.02 * expected.max()
    error = found[lit] / expected[lit] - 1
    assert np.abs(error).mean() < 0.01
    assert abs(found[lit].sum() / expected[lit].sum() - 1) < 0.003
    plain = luminance(shaped_card(None, pose, half), spp=64)
    assert np.abs(plain[lit] / expected[lit] - 1).mean() > 0.2


def test_the_camera_sees_lamps_as_their_profiles_say() -> None:
    """A ball and a card, straight from the eye: luminance times the factor of the way."""
    profile = measured().relative()
    ball = dg.SphereLight((10,) * 3, 0.5, profile=profile)
    turned = turn(180, 1) @ turn(40, 0) @ turn(30, 2)
    scene = before_wall((ball, scenes.at(-0.8, 0, -1.5) @ turned), reflectance=0.0)
    points, faces = scenes.quad(0.4)
    material = dg.Material(dg.Diffuse((0, 0, 0)), "", (10, 10, 10), True, profile)
    scene.add_instance(scene.add_mesh(points, faces), material, scenes.at(0.8, 0, -1.5) @ turned)
    found = luminance(scene, spp=64)
    away = -wall_points().reshape(-1, 3) @ turned[:3, :3]  # to the eye, in the lamps' frame
    expected = 10 * profile.factors(away)[:, 1].reshape(found.shape)
    seen = found > 0.5 * expected.min()
    inner = seen & np.roll(seen, 1, 0) & np.roll(seen, -1, 0) & np.roll(seen, 1, 1)
    inner &= np.roll(seen, -1, 1)
    assert inner[:, :24].sum() > 50
    assert inner[:, 24:].sum() > 30
    assert np.abs(found[inner] / expected[inner] - 1).max() < 0.01


NARROW = dg.LightProfile.cone(40, 0.5) * measured().relative()


def lit_by(light: Any, pose: Matrix) -> Callable[[], dg.Scene]:
    """A ball or a point before a wall that it lights."""

    def made() -> dg.Scene:
        scene = dg.Scene(time=0.0)
        wall(scene, -1.6)
        scene.add_light(light, pose)
        return scene

    return made


def lit_by_cards(moves: bool = False) -> dg.Scene:
    """Cards that light a wall and are seen, one of them from its back."""
    scene = dg.Scene(time=0.0)
    wall(scene, -1.6)
    for x, angle, both in ((-0.05, 60.0, True), (0.05, 150.0, False)):
        points, faces = scenes.quad(0.02)
        glow = dg.Material(dg.Diffuse((0.2,) * 3), "", (60, 40, 20), both, NARROW)
        pose: Any = scenes.at(x, 0.02, -CLOSE) @ turn(angle, 1)
        if moves:
            pose = dg.keys([(-0.05, pose @ turn(-30, 0)), (0.05, pose @ turn(50, 0))])
        scene.add_instance(scene.add_mesh(points, faces), glow, pose)
    return scene


BALL = dg.SphereLight((60, 50, 30), 0.03, profile=NARROW)
AT = scenes.at(0.02, 0.01, -CLOSE) @ turn(120, 1)
TURNS = dg.keys([(-0.05, AT @ turn(-20, 0)), (0.05, AT @ turn(40, 0))])
TINY: dict[str, Any] = {"resolution": (32, 21)}
CASES = {
    "cards": Case(lit_by_cards, thin(), brightest=120, options=TINY),
    "a ball": Case(lit_by(BALL, AT), thin(), brightest=120, options=TINY),
    "cards that turn": Case(
        lambda: lit_by_cards(True), thin(shutter_time=0.04), brightest=120, options=TINY
    ),
    "a ball that turns": Case(
        lit_by(BALL, TURNS), thin(shutter_time=0.04), brightest=120, options=TINY
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_camera_light_and_both_find_one_picture(name: str) -> None:
    """Straight light: by paths that meet the lamp, and by light paths to the lens."""
    check(CASES[name])


AWAY = scenes.at(0.1, 0.05, -0.7) @ turn(160, 1) @ turn(70, 2)
AWAY_TURNS = dg.keys([(-0.05, AWAY @ turn(-30, 0)), (0.05, AWAY @ turn(40, 0))])


def indirect(lamp: Any, pose: Any) -> Callable[[], dg.Scene]:
    """A lamp that shines at a white card behind the camera, which lights the wall before it."""

    def made() -> dg.Scene:
        scene = dg.Scene(time=0.0)
        wall(scene, -1.6)
        points, faces = scenes.quad(1.5, 0.3)
        back = scene.add_mesh(points, np.asarray(faces)[:, ::-1])
        scene.add_instance(back, dg.Material(dg.Diffuse((0.9, 0.9, 0.9))))
        if isinstance(lamp, dg.Material):
            points, faces = scenes.quad(0.1)
            scene.add_instance(scene.add_mesh(points, np.asarray(faces)[:, ::-1]), lamp, pose)
        else:
            scene.add_light(lamp, pose)
        return scene

    return made


POINT = dg.PointLight((4, 3, 2), profile=NARROW)
LARGE = dg.SphereLight((100, 80, 60), 0.06, profile=NARROW)
GLOW = dg.Material(dg.Diffuse((0, 0, 0)), "", (100, 80, 60), False, NARROW)
BOUNCED = {
    "a card": indirect(GLOW, AWAY),
    "a card that turns": indirect(GLOW, AWAY_TURNS),
    "a ball": indirect(LARGE, AWAY),
    "a point": indirect(POINT, AWAY),
    "a point that turns": indirect(POINT, AWAY_TURNS),
}


@pytest.mark.parametrize("name", BOUNCED)
def test_light_that_is_followed_from_the_lamp_is_that_of_next_event_estimation(name: str) -> None:
    camera = thin(shutter_time=0.04)
    case = Case(BOUNCED[name], camera, (0.0, 4000.0), (128, 64, 64), 3, TINY)
    alone, bounced = pictures(case, "camera"), pictures(case, "both")
    assert not np.array_equal(bounced, alone)
    assert differences(bounced, alone) == []
    assert differences(bounced * 1.05, alone) != []
