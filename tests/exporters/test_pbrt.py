"""Scenes written for pbrt-v4: the text against pbrt's documented syntax and conventions."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.exporters.pbrt.octahedral import directions, resampled
from daguerre.importers.pbrt.octahedral import directions_of
from daguerre.pictures.panorama import looked_up
from tests.support.formats import pbrt_syntax, ply_file
from tests.support.formats.pbrt_syntax import Directive
from tests.support.scene import outgoing_scenes

SCENES = [
    outgoing_scenes.box, outgoing_scenes.textures, outgoing_scenes.glass, outgoing_scenes.metals,
    outgoing_scenes.sky, outgoing_scenes.mirrored, outgoing_scenes.depth, outgoing_scenes.lamps,
    outgoing_scenes.layered,
]  # fmt: skip


def written(scene: dg.Scene, folder: Path, **more: object) -> list[Directive]:
    """Writes a scene and reads its directives."""
    file = folder / "scene.pbrt"
    dg.export_scene(scene, file, resolution=(48, 32), spp=4, **more)  # type: ignore[arg-type]
    return pbrt_syntax.read(file.read_text())


def named(found: list[Directive], name: str) -> list[Directive]:
    """Directives of a name."""
    return [one for one in found if one.name == name]


@pytest.mark.parametrize("make", SCENES, ids=lambda make: make.__name__)
def test_the_text_keeps_the_documented_syntax(make: Callable[[], dg.Scene], tmp_path: Path) -> None:
    found = written(make(), tmp_path)
    for one in found:
        for name in ("filename", "normalmap", "lensfile"):
            if name in one.parameters and one.name != "Film":
                assert (tmp_path / one.text(name)).is_file(), one


def test_the_camera_sees_what_ours_sees(tmp_path: Path) -> None:
    """Corners of the picture, by pbrt's own rules: transform, fov across the shorter side."""
    scene = outgoing_scenes.box()
    camera = dg.Camera(
        transform=dg.look_at((1, 2, 5), (0.3, 0, 0)), lens="thin", focal_length=40, f_stop=2.0,
        focus_distance=4.0, shift=(4.0, -2.5),
    )  # fmt: skip
    found = written(scene, tmp_path, camera=camera)
    (view,) = named(found, "Camera")
    world = np.linalg.inv(np.array(found[0].numbers).reshape(4, 4).T)
    assert found[0].name == "Transform"
    tangent = math.tan(math.radians(view.values("fov")[0]) / 2)
    left, right, bottom, top = np.array(view.values("screenwindow")) * tangent
    ours = dg.raymap(camera, (48, 32), scene=scene, frame="world")
    for x, y, column, row in ((left, top, 0, 0), (right, bottom, 47, 31)):
        # Middles of corner pixels lie half a pixel inside.
        u = x + (right - left) / 96 * (1 if column == 0 else -1)
        v = y + (top - bottom) / 64 * (-1 if row == 0 else 1)
        toward = world[:3, :3] @ (u, v, 1.0)
        toward = toward / np.linalg.norm(toward)
        np.testing.assert_allclose(toward, ours.direction[row, column], atol=1e-5)
    np.testing.assert_allclose(world[:3, 3], camera.transform[:3, 3], atol=1e-9)
    assert view.values("lensradius")[0] == pytest.approx(40 / 2 / 2 * 1e-3)
    assert view.values("focaldistance") == [4.0]


def test_meshes_stand_where_ours_stand(tmp_path: Path) -> None:
    scene = outgoing_scenes.mirrored()
    found = written(scene, tmp_path)
    seen = []
    transform, objects, inside = np.eye(4), {}, ""
    for one in found:
        if one.name == "Transform":
            transform = np.array(one.numbers).reshape(4, 4).T
        elif one.name == "ObjectBegin":
            inside = one.words[0]
        elif one.name == "ObjectEnd":
            inside = ""
        elif one.name == "Shape":
            mesh = ply_file.read(tmp_path / one.text("filename")).columns("x y z")
            if inside:
                objects[inside] = mesh
            else:
                seen.append(mesh @ transform[:3, :3].T + transform[:3, 3])
        elif one.name == "ObjectInstance":
            seen.append(objects[one.words[0]] @ transform[:3, :3].T + transform[:3, 3])
    ours = [
        scene.meshes[i.mesh].positions @ i.transform[:3, :3].T + i.transform[:3, 3]
        for i in scene.instances
    ]
    assert len(seen) == len(ours)
    for mesh in ours:
        assert any(m.shape == mesh.shape and np.allclose(m, mesh, atol=1e-6) for m in seen)


def test_a_world_of_one_candela_stays_one(tmp_path: Path) -> None:
    """pbrt's L of 1 is 1 nit, and its film keeps it at ISO 100, 1 s, with the CIE's observer."""
    scene = dg.Scene()
    scene.set_environment(color=(1, 2, 3), scale=0.5)
    scene.add_camera("main", dg.Camera(lens="pinhole"))
    found = written(scene, tmp_path)
    (light,) = named(found, "LightSource")
    assert light.values("L") == [0.5, 1.0, 1.5]
    (film,) = named(found, "Film")
    assert (film.values("iso"), film.text("sensor")) == ([100.0], "cie1931")
    assert film.values("diagonal")[0] == pytest.approx(math.hypot(36, 24))


def test_the_octahedral_map_has_equal_areas_and_pbrts_corners() -> None:
    rows = 64
    found = directions(rows)
    np.testing.assert_allclose(np.linalg.norm(found, axis=-1), 1, atol=1e-12)
    moments = np.einsum("ija,ijb->ab", found, found) / rows**2
    np.testing.assert_allclose(moments, np.eye(3) / 3, atol=1e-3)  # equal areas
    middle, corner, right = directions_of(np.array([0.5, 1.0, 1.0]), np.array([0.5, 1.0, 0.5]))
    np.testing.assert_allclose(middle, (0, 0, 1), atol=1e-12)
    np.testing.assert_allclose(corner, (0, 0, -1), atol=1e-12)
    np.testing.assert_allclose(right, (1, 0, 0), atol=1e-12)
    (down,) = directions_of(np.array([0.5]), np.array([1.0]))
    np.testing.assert_allclose(down, (0, 1, 0), atol=1e-12)


def test_a_resampled_panorama_has_its_light_in_its_directions() -> None:
    rng = np.random.default_rng(1)
    rows = (np.arange(64) + 0.5) / 64 * math.pi
    panorama = np.ones((64, 128, 3), np.float32) * (2 + np.cos(rows))[:, None, None]
    panorama = (panorama * (1 + 0.2 * rng.random((64, 128, 1)))).astype(np.float32)
    made = resampled(panorama)
    weights = np.sin(rows)[:, None] * np.ones((64, 128))
    mean = np.average(panorama[..., 0], weights=weights)
    assert made[..., 0].mean() == pytest.approx(mean, rel=2e-3)  # equal areas
    axis = directions_of(np.array([0.5005]), np.array([0.5]))[0]  # +z of the map is +y
    assert axis[2] == pytest.approx(1, abs=1e-5)
    middle = made[made.shape[0] // 2, made.shape[1] // 2, 0]
    assert middle == pytest.approx(float(panorama[0, :, 0].mean()), rel=0.15)
    ahead = looked_up(panorama, np.array([0, 0, 1], np.float32).reshape(3, 1, 1))[0, 0]
    expected = panorama[31:33, 63:65].reshape(-1, 3).mean(axis=0)
    np.testing.assert_allclose(ahead, expected, rtol=1e-5)


def test_a_lens_of_spheres_is_a_lens_file(tmp_path: Path) -> None:
    """Its paraxial focal length, by matrices of its rows, is that of the lens."""
    scene = outgoing_scenes.box()
    camera = dg.Camera(lens="double-gauss-50mm-f2", f_stop=4.0, focus_distance=5.0,
                       transform=dg.look_at((0, 0, 5), (0, 0, 0)))  # fmt: skip
    found = written(scene, tmp_path, camera=camera)
    (view,) = named(found, "Camera")
    rows = np.loadtxt(tmp_path / view.text("lensfile"))
    height, slope, before = 1.0, 0.0, 1.0
    for radius, gap, index, _ in rows:
        index = index or 1.0
        if radius:
            slope = (before * slope - height * (index - before) / radius) / index
            before = index
        height += slope * gap
    order = dg.lenses.load("double-gauss-50mm-f2").first_order()
    assert -1 / slope == pytest.approx(order.efl, rel=1e-4)
    assert (rows[:, 0] == 0).sum() == 1  # the stop
    wide = 2 * order.stop_semi_diameter
    assert view.values("aperturediameter")[0] == pytest.approx(wide * order.f_number / 4, rel=1e-3)


def test_names_of_files_are_no_syntax(tmp_path: Path) -> None:
    scene = outgoing_scenes.box()
    file = tmp_path / 'a "b" \\ c.pbrt'
    dg.export_scene(scene, file, resolution=(8, 8), spp=1)
    found = pbrt_syntax.read(file.read_text())
    assert any(one.name == "Shape" for one in found)
