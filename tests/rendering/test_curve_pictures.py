"""Pictures of curves: against tubes of triangles, in furnaces, moving, glowing, of glass."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre.scene.materials import Gltf, TextureSlot
from tests.support.pictures.blur import ALPHA, blurred, case, disagreement, frozen, mean_of_stills
from tests.support.pictures.statistical import differences
from tests.support.scene import scenes
from tests.support.scene.motion_scenes import OPEN, TIME, pattern, pinhole, sky

Picture = NDArray[np.float64]
Array = NDArray[np.float64]
SMALL: dict[str, Any] = {
    "resolution": (24, 16),
    "filter": "box",
    "max_depth": 6,
    "light_paths": "off",
}
BATCHES = 6
#: Bezier points of a bow from left to right before the camera, its diameters, and points around it.
BOW = np.array([(-1.0, -0.4, -3), (-0.4, 0.9, -3), (0.3, -0.9, -2.6), (1.0, 0.5, -3)])
WIDTHS = np.array([0.5, 0.3, 0.4, 0.2])
AROUND, ALONG = 96, 192


def pictures(scene: dg.Scene, spp: int = 48, **options: Any) -> Picture:
    """Independent pictures, (BATCHES, H, W, 3)."""
    camera = pinhole()
    frames = (
        dg.render(scene, camera, spp=spp, seed=i, **(SMALL | options)) for i in range(BATCHES)
    )
    return np.array([frame.rgb for frame in frames], np.float64)


def bow_points(u: Array) -> tuple[Array, Array, Array]:
    """Centres, derivatives and radii of the bow at u, by De Casteljau's algorithm."""
    rows = np.column_stack([BOW, WIDTHS / 2])
    level = [np.tile(row, (len(u), 1)) for row in rows]
    while len(level) > 2:
        level = [a + (b - a) * u[:, None] for a, b in pairwise(level)]
    at, slope = level[0] + (level[1] - level[0]) * u[:, None], 3 * (level[1] - level[0])
    return at[:, :3], slope, at[:, 3]


def tube() -> tuple[Array, NDArray[np.int64], Array, Array]:
    """The bow as triangles with flat ends: positions, triangles, normals, texture coordinates."""
    u = np.linspace(0, 1, ALONG)
    centre, slope, radius = bow_points(u)
    tangent = slope[:, :3] / np.linalg.norm(slope[:, :3], axis=1, keepdims=True)
    x = np.cross(tangent, (0.0, 0.0, 1.0))
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    y = np.cross(tangent, x)
    angle = np.linspace(0, 2 * np.pi, AROUND, endpoint=False)
    out = x[:, None] * np.cos(angle)[:, None] + y[:, None] * np.sin(angle)[:, None]
    points = centre[:, None] + radius[:, None, None] * out
    by_u = np.gradient(points, u, axis=0, edge_order=2)
    by_angle = y[:, None] * np.cos(angle)[:, None] - x[:, None] * np.sin(angle)[:, None]
    normals = np.cross(by_angle, by_u)
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    i, j = np.meshgrid(np.arange(ALONG - 1), np.arange(AROUND), indexing="ij")
    a, b = i * AROUND + j, i * AROUND + (j + 1) % AROUND
    faces = [np.stack([a, b, b + AROUND], -1), np.stack([a, b + AROUND, a + AROUND], -1)]
    side = np.concatenate([f.reshape(-1, 3) for f in faces])
    uv = np.stack(np.broadcast_arrays(u[:, None], angle / (2 * np.pi)), -1)
    ends, caps = [], []
    for ring, normal, turn in ((0, -tangent[0], -1), (ALONG - 1, tangent[-1], 1)):
        first = ALONG * AROUND + len(ends) * AROUND
        ends.append((points[ring], np.tile(normal, (AROUND, 1)), uv[ring]))
        fan = [(first, first + k, first + k + 1)[::turn] for k in range(1, AROUND - 1)]
        caps += fan
    return (
        np.concatenate([points.reshape(-1, 3), *(e[0] for e in ends)]),
        np.concatenate([side, np.array(caps)]),
        np.concatenate([normals.reshape(-1, 3), *(e[1] for e in ends)]),
        np.concatenate([uv.reshape(-1, 2), *(e[2] for e in ends)]),
    )


def bow(material: Any, as_triangles: bool, light: bool = True) -> dg.Scene:
    """The bow over a floor, under a lamp and a sky."""
    scene = sky() if light else dg.Scene()
    if callable(material):
        material = material(scene)
    if as_triangles:
        points, faces, normals, uv = tube()
        mesh = scene.add_mesh(points, faces, normals, uv)
    else:
        mesh = scene.add_curves(BOW, [4], WIDTHS, basis="bezier")
    scene.add_instance(mesh, material, name="bow")
    floor, faces = scenes.quad(4)
    down = np.array([[1, 0, 0, 0], [0, 0, 1, -0.8], [0, -1, 0, -3], [0, 0, 0, 1.0]])
    scene.add_instance(scene.add_mesh(floor, faces), dg.Diffuse((0.6, 0.5, 0.4)), down)
    if light:
        scene.add_light(dg.SphereLight((30, 25, 20), 0.3), scenes.at(1, 2, -1.5))
    return scene


def striped(scene: dg.Scene) -> int:
    """Stripes along the curve, the same all around."""
    colors = np.repeat(pattern(1, 6)[:1], 2, axis=0)
    texture = scene.add_texture(colors, filter="linear")
    return scene.add_material(
        Gltf(base_color_texture=TextureSlot(texture), metallic=0, roughness=1)
    )


MATERIALS: dict[str, Any] = {
    "diffuse": dg.Diffuse((0.8, 0.5, 0.2)),
    "rough metal": dg.Conductor((0.9, 0.8, 0.5), 0.3),
    "textured": striped,
    "brushed": Gltf(base_color=(0.9, 0.9, 0.9), metallic=1, roughness=0.4, anisotropy=0.9),
    "sheer": Gltf(
        base_color=(0.2, 0.4, 0.8), base_alpha=0.6, alpha_mode="blend", double_sided=True
    ),
    "glowing": dg.Material(dg.Diffuse((0.2, 0.2, 0.2)), emission=(2, 1.5, 1)),
    "rough glass": dg.Dielectric(1.5, 0.3),
}


@pytest.mark.parametrize("name", list(MATERIALS))
def test_a_curve_is_its_tube_of_triangles(name: str) -> None:
    material = MATERIALS[name]
    spp = 96 if "glass" in name or name == "glowing" else 48
    a = pictures(bow(material, False), spp)
    b = pictures(bow(material, True), spp)
    assert differences(a, b, alpha=ALPHA) == []


def test_the_light_of_a_glowing_curve_reaches_the_floor() -> None:
    material = MATERIALS["glowing"]
    a = pictures(bow(material, False, light=False), 256)
    b = pictures(bow(material, True, light=False), 64)
    assert a.mean() > 0.01
    assert differences(a, b, alpha=ALPHA) == []


def test_light_paths_leave_the_light_of_a_glowing_curve_to_the_camera() -> None:
    a, b = (
        pictures(bow(MATERIALS["glowing"], False), 128, light_paths=paths) for paths in ("off", 4)
    )
    assert differences(a, b, alpha=ALPHA) == []


def hair(count: int, basis: str, material: Any) -> dg.Scene:
    """Strands across the view in a white furnace, none as bent as it is thick."""
    random = np.random.default_rng(2)
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    points = random.uniform((-1.5, -1, -4), (1.5, 1, -2.5), size=(count, 1, 3))
    way = random.uniform(-0.3, 0.3, size=(count, 1, 3)) * np.arange(7)[:, None]
    points = points + way + random.uniform(-0.02, 0.02, size=(count, 7, 3))
    widths = np.linspace(0.1, 0.02, 7)
    mesh = scene.add_curves(points.reshape(-1, 3), [7] * count, np.tile(widths, count), basis=basis)
    scene.add_instance(mesh, material)
    return scene


def white_sky(curves: Any = None, material: Any = None) -> dg.Scene:
    """A furnace of radiance 1, with curves in it as keywords of ``add_curves``."""
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    if curves is not None:
        scene.add_instance(scene.add_curves(**curves), material)
    return scene


@pytest.mark.parametrize("basis", ["bspline", "catmull-rom", "linear"])
def test_white_hair_in_a_white_sky_is_not_seen(basis: str) -> None:
    found = pictures(hair(30, basis, dg.Diffuse((1, 1, 1))), 16, max_depth=1000)
    empty = pictures(white_sky(), 16)  # with the same wavelengths
    np.testing.assert_allclose(found, empty, atol=1e-4)
    grey = pictures(hair(30, basis, dg.Diffuse((0.5, 0.5, 0.5))), 16)
    assert grey.mean(axis=(0, 3)).min() < 0.7  # it was there


FIBRES: dict[str, dict[str, Any]] = {
    "bow": {"points": BOW, "counts": [4], "widths": WIDTHS, "basis": "bezier"},
    "polyline": {"points": BOW, "counts": [4], "widths": WIDTHS, "basis": "linear"},
    "rod": {"points": BOW[[0, 3]], "counts": [2], "widths": 0.3, "wrap": "pinned"},
    "ring": {
        "points": [(0.5, 0, -3), (0, 0.5, -3), (-0.5, 0, -3), (0, -0.5, -3)],
        "counts": [4],
        "widths": 0.2,
        "wrap": "periodic",
    },
}


@pytest.mark.parametrize("name", list(FIBRES))
def test_glass_in_a_white_sky_is_not_seen(name: str) -> None:
    """Light that goes in comes out: a boundary missed once leaves a factor of 1.5^2."""
    found = pictures(white_sky(FIBRES[name], dg.Dielectric(1.5, 0)), 64, max_depth=400)
    off = (found - pictures(white_sky(), 64)).mean(axis=(1, 2, 3))
    assert abs(off.mean()) < 4 * off.std(ddof=1) / math.sqrt(BATCHES) + 1e-5
    assert off.std() < 1e-3


def test_a_moving_curve_is_the_mean_of_its_stills() -> None:
    begin, end = TIME - OPEN / 2, TIME + OPEN / 2
    scene = sky()
    moved = BOW + np.array([(0, 0.5, 0), (0.2, -0.4, 0), (0, 0.3, 0.3), (-0.3, 0, 0)])
    curves = scene.add_curves(dg.keys([(begin, BOW), (end, moved)]), [4], WIDTHS, basis="bezier")
    scene.add_instance(curves, MATERIALS["diffuse"])
    turn = dg.keys([(begin, scenes.at(0, 0, 0)), (end, scenes.at(0.3, -0.4, 0.2))])
    rod = scene.add_curves([(-1, 0.6, -3), (0, 0.9, -3), (1, 0.6, -2.8)], [3], 0.2, basis="linear")
    scene.add_instance(rod, dg.Diffuse((0.2, 0.7, 0.3)), turn)
    moving = case(scene, pinhole(), OPEN, light_paths="off")
    open_frames = blurred(moving, BATCHES, 64)
    assert disagreement(open_frames, mean_of_stills(moving, BATCHES, 16, 4)) == []
    assert disagreement(open_frames, frozen(moving, BATCHES, 64)) != []


def test_instances_of_curves_stand_as_their_copies() -> None:
    transform = scenes.at(0.2, 0.1, -0.5) @ np.diag([0.8, -0.8, 0.8, 1.0])
    placed, copied = sky(), sky()
    mesh = placed.add_curves(BOW, [4], WIDTHS, basis="bezier")
    for x in (-0.3, 0.4):
        placed.add_instance(mesh, MATERIALS["rough metal"], scenes.at(x, 0, 0) @ transform)
        world = scenes.at(x, 0, 0) @ transform
        points = BOW @ world[:3, :3].T + world[:3, 3]
        copied.add_instance(
            copied.add_curves(points, [4], 0.8 * WIDTHS, basis="bezier"), MATERIALS["rough metal"]
        )
    assert differences(pictures(placed), pictures(copied), alpha=ALPHA) == []


def test_ground_truth_sees_curves() -> None:
    scene = dg.Scene()
    rod = scene.add_curves([(-1, 0, -3), (1, 0, -3)], [2], 0.5, basis="linear")
    scene.add_instance(rod, dg.Diffuse((1, 1, 1)), name="rod")
    scene.add_node("rod", np.array([0.0, 0, -3]))
    scene.group_instances("rod", [0])
    camera = pinhole(focus_on="rod")
    frame = dg.render(scene, camera, spp=1, resolution=(48, 32), aovs=True, filter="box")
    depth = frame.aovs["depth.Z"]
    assert float(depth[16, 24]) == pytest.approx(2.75, abs=0.02)
    annotation = dg.annotate(scene, camera, resolution=(480, 320))
    (thing,) = annotation.things
    pixels = 480 / 36 * 35
    # Silhouette of a cylinder of radius r at the distance d: r / sqrt(d^2 - r^2).
    half = 0.25 / math.sqrt(9 - 0.25**2) * pixels
    assert thing.box is not None
    assert thing.box[3] == pytest.approx(2 * half, abs=2)
    assert thing.box3 is not None
    assert thing.box3.size == pytest.approx((2.5, 0.5, 0.5), abs=1e-6)


def test_curves_have_the_same_bits_every_time() -> None:
    scene = hair(20, "bspline", dg.Diffuse((0.7, 0.6, 0.5)))
    a = dg.render(scene, pinhole(), spp=4, seed=1, threads=1, **SMALL).rgb
    b = dg.render(scene, pinhole(), spp=4, seed=1, threads=2, **SMALL).rgb
    np.testing.assert_array_equal(a, b)
