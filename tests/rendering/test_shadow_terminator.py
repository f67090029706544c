"""Coarse meshes with vertex normals: no blocks along the shadow terminator, and no light leaks.

The reference is a ball of 200 rings. A coarse ball with smooth normals must have its light,
whichever way finds the light; only its outline may show the facets.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from tests.support.scene import scenes

SIZE = 64
FINE = 200
DEPTH = 5.0  # m from the camera to the ball
# At 60 degrees from the camera. The pixels of a coarse ball show other places than those of the
# fine one, since it is smaller. At this angle that changes its mean least: for 10 rings by -1.5 %
# with the light behind the camera and by +2.2 % at 90 degrees, with shadows or without.
TO_LIGHT = np.array((0.788, 0.355, 0.5)) / np.linalg.norm((0.788, 0.355, 0.5))
AXIS = np.array((0.3, 0.5, 0.8)) / np.linalg.norm((0.3, 0.5, 0.8))
WHITE = dg.Material(dg.Diffuse((0.8, 0.8, 0.8)))
CAMERA = dg.Camera(focal_length=50, f_stop=None, sensor_size=(22, 22))


def facing(z: Any, place: Any = (0, 0, 0)) -> np.ndarray:
    """A transform that turns +z to a direction, with its origin relative to the ball's center."""
    z = np.asarray(z, float) / np.linalg.norm(z)
    x = np.cross((0, 1, 0), z)
    x /= np.linalg.norm(x)
    transform = np.eye(4)
    transform[:3, :3] = np.stack([x, np.cross(z, x), z], 1)
    transform[:3, 3] = np.add(place, (0, 0, -DEPTH))
    return transform


def ball(rings: int, material: dg.Material = WHITE, flat: bool = False) -> dg.Scene:
    scene = dg.Scene()
    points, triangles, normals = scenes.sphere(rings)
    mesh = scene.add_mesh(points, triangles, None if flat else normals)
    scene.add_instance(mesh, material, facing(AXIS))
    return scene


def by_point(scene: dg.Scene) -> dict[str, Any]:
    scene.add_light(dg.PointLight((20, 20, 20)), facing(TO_LIGHT, TO_LIGHT * 4))
    return {"max_depth": 1, "spp": 64}


def by_lamp(scene: dg.Scene, strategy: str) -> dict[str, Any]:
    scene.add_light(dg.SphereLight((60, 60, 60), 0.4), facing(TO_LIGHT, TO_LIGHT * 4))
    return {"max_depth": 1, "spp": 64 if strategy == "light" else 900, "strategy": strategy}


def by_sky(scene: dg.Scene) -> dict[str, Any]:
    sky = np.zeros((32, 64, 3), np.float32)
    sky[10:13, 50:53] = 8
    scene.set_environment(sky)
    return {"max_depth": 1, "spp": 400, "strategy": "bsdf"}


def by_wall(scene: dg.Scene, **options: Any) -> dict[str, Any]:
    """A white square lit by a spot lamp lights the ball."""
    square, faces = scenes.quad(0.7)
    wall = facing(-TO_LIGHT, TO_LIGHT * 3.2)
    scene.add_instance(scene.add_mesh(square, faces), WHITE, wall)
    lamp = np.array((0.2, 2.2, 1.6))
    scene.add_light(dg.SpotLight((150, 150, 150), 12, 15), facing(lamp - TO_LIGHT * 3.2, lamp))
    return {"max_depth": 3, "spp": 600, **options}


WAYS = {
    "point": by_point,
    "light sampling": lambda scene: by_lamp(scene, "light"),
    "BSDF sampling": lambda scene: by_lamp(scene, "bsdf"),
    "sky by BSDF sampling": by_sky,
    "indirect": by_wall,
    "light paths": lambda scene: by_wall(scene, light_paths=(0, 20000), spp=100, technique="light"),
    "light paths and camera paths": lambda scene: by_wall(scene, light_paths=(0, 20000), spp=100),
}


def draw(scene: dg.Scene, **options: Any) -> np.ndarray:
    options = {"light_paths": "off", "filter": "box", "resolution": (SIZE, SIZE), **options}
    return dg.render(scene, CAMERA, **options).rgb[..., 1].astype(float)


@cache
def covered(rings: int) -> np.ndarray:
    """Pixels that lie in the outline as a whole."""
    light = dg.Material(dg.Diffuse((0, 0, 0)), emission=(1, 1, 1))
    return draw(ball(rings, light), spp=64, max_depth=1) > 0.999


@cache
def lit(way: str, rings: int, flat: bool = False) -> np.ndarray:
    scene = ball(rings, flat=flat)
    return draw(scene, **WAYS[way](scene))


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("rings", [10, 48])
def test_a_coarse_ball_has_the_light_of_a_fine_one(way: str, rings: int) -> None:
    both = covered(rings) & covered(FINE)
    assert lit(way, rings)[both].mean() == pytest.approx(lit(way, FINE)[both].mean(), rel=0.01)


def sun_at(degrees: float) -> np.ndarray:
    """Direction to a sun, by its angle from the direction to the camera."""
    angle = np.radians(degrees)
    return np.array((0.912 * np.sin(angle), 0.41 * np.sin(angle), np.cos(angle)))


def without_shadows(rings: int, to_sun: np.ndarray, side: int = 4) -> np.ndarray:
    """Cosine of the smooth normal at each pixel, by ``side`` x ``side`` points."""
    points, triangles, normals = scenes.sphere(rings)
    world = facing(AXIS)
    points, normals = points @ world[:3, :3].T + world[:3, 3], normals @ world[:3, :3].T
    at = 22 * ((np.arange(SIZE * side) + 0.5) / (SIZE * side) - 0.5)
    x, y = np.meshgrid(at, -at)
    rays = np.stack([x, y, np.full_like(x, -50)], -1).reshape(-1, 3)
    cosine = np.zeros(len(rays))
    for corner in triangles:
        plane = np.linalg.solve(points[corner].T, rays.T).T  # shares of the corners, not to scale
        if np.linalg.det(points[corner]) >= 0:  # the back
            continue
        met = (plane >= 0).all(axis=1)
        normal = plane[met] @ normals[corner]
        cosine[met] = normal @ to_sun / np.linalg.norm(normal, axis=1)
    return cosine.clip(0).reshape(SIZE, side, SIZE, side).mean((1, 3))


@pytest.mark.parametrize("degrees", [0, 60, 90, 120])
def test_a_convex_mesh_has_the_light_of_its_smooth_normals_without_shadows(degrees: int) -> None:
    """The rest of the error against the fine ball is from its size, not from lift or shadows."""
    scene, to_sun = ball(10), sun_at(degrees)
    scene.add_light(dg.DirectionalLight((1, 1, 1)), facing(to_sun))
    whole = covered(10)
    drawn = draw(scene, max_depth=1, spp=64)[whole] * np.pi / 0.8
    assert drawn.mean() == pytest.approx(without_shadows(10, to_sun)[whole].mean(), rel=3e-3)


@pytest.mark.parametrize("way", WAYS)
def test_facets_that_face_away_from_the_light_are_not_black(way: str) -> None:
    both = covered(6) & covered(FINE)
    away = both & (lit("point", 6, flat=True) < 0.02 * lit("point", FINE))
    assert away.sum() > 150
    assert lit(way, 6)[away].sum() == pytest.approx(lit(way, FINE)[away].sum(), rel=0.25)


def test_techniques_agree_on_a_coarse_ball() -> None:
    """Light paths must not have a share in the light that only camera paths find."""
    both = covered(6) & covered(FINE)
    camera, light, mixed = (
        lit(way, 6)[both].mean()
        for way in ("indirect", "light paths", "light paths and camera paths")
    )
    assert light == pytest.approx(camera, rel=0.01)
    assert mixed == pytest.approx(camera, rel=0.01)


def lowest_facet(rings: int) -> tuple[np.ndarray, float]:
    """A rotation that turns a facet of the ball down, and its height."""
    points, triangles, _ = scenes.sphere(rings)
    corners = points[triangles[len(triangles) // 2]]
    out = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    out *= np.sign(out @ corners[0]) / np.linalg.norm(out)
    across = np.cross(out, (0.3, 0.5, 0.8))
    across /= np.linalg.norm(across)
    rotation = np.eye(4)
    rotation[:3, :3] = [across, -out, np.cross(across, -out)]
    return rotation, -float(out @ corners[0])


def test_no_light_leaks_through_a_sheet_within_the_lift_of_a_facet() -> None:
    """A coarse ball lies on a thin floor lit from below: the smooth ball would stick out of it."""
    scene = dg.Scene()
    points, triangles, normals = scenes.sphere(6)
    rotation, height = lowest_facet(6)
    rotation[2, 3] = -DEPTH
    scene.add_instance(scene.add_mesh(points, triangles, normals), WHITE, rotation)
    square, faces = scenes.quad(40)
    floor = np.array([[1, 0, 0, 0], [0, 0, 1, height - 0.004], [0, -1, 0, -DEPTH], [0, 0, 0, 1.0]])
    scene.add_instance(scene.add_mesh(square, faces), WHITE, floor)
    up = np.array([[1, 0, 0, 0], [0, 0, -1, -3], [0, 1, 0, -DEPTH], [0, 0, 0, 1.0]])
    scene.add_light(dg.DirectionalLight((1000, 1000, 1000)), facing((0.1, -1, 0.1)))
    scene.add_light(dg.PointLight((1000, 1000, 1000)), up)
    low = dg.Camera(focal_length=50, f_stop=None, sensor_size=(22, 22))
    frame = dg.render(scene, low, resolution=(48, 48), spp=256, max_depth=8, light_paths="off")
    assert frame.rgb.max() == 0


@pytest.mark.parametrize("rings", [6, 10])
def test_no_light_leaks_into_a_thin_shell(rings: int) -> None:
    """The camera is in a ball of one layer, and in a ball of two close layers, lit from outside."""
    for layers in ((1.0,), (1.0, 0.995)):
        scene = dg.Scene()
        points, triangles, normals = scenes.sphere(rings)
        for radius, side in zip(layers, (1, -1), strict=False):
            order = triangles if side > 0 else triangles[:, ::-1]
            mesh = scene.add_mesh(points * radius, order, normals * side)
            scene.add_instance(mesh, WHITE)
        for direction in ((1, 0.5, 0.2), (-0.3, 0.4, 1), (0.2, -0.8, 0.6)):
            scene.add_light(dg.DirectionalLight((1000, 1000, 1000)), facing(direction))
        wide = dg.Camera(focal_length=8, f_stop=None, sensor_size=(22, 22))
        frame = dg.render(scene, wide, resolution=(48, 48), spp=64, max_depth=6, light_paths="off")
        assert frame.rgb.max() == 0


def test_flat_facets_are_as_without_normals() -> None:
    points, triangles, _ = scenes.sphere(10)
    corners = points[triangles]
    out = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    pictures = []
    for normals in (None, np.repeat(out, 3, 0)):
        scene = dg.Scene()
        faces = np.arange(3 * len(triangles)).reshape(-1, 3)
        mesh = scene.add_mesh(corners.reshape(-1, 3), faces, normals)
        scene.add_instance(mesh, WHITE, facing(AXIS))
        scene.add_light(dg.PointLight((20, 20, 20)), facing(TO_LIGHT, TO_LIGHT * 4))
        pictures.append(draw(scene, spp=16, max_depth=2))
    assert pictures[0].max() > 0.1
    np.testing.assert_allclose(pictures[1], pictures[0], rtol=2e-5, atol=1e-6)
