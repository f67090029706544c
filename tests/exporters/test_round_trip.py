"""Scenes written for pbrt and Mitsuba, read back by our own readers: they are the same."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.files import formats
from tests.support.scene import outgoing_scenes

SIZE = (48, 32)


def reader_of(suffix: str) -> None:
    """Skips without a reader of these scenes."""
    rows = formats.formats("scene")
    if not any(row.reads and suffix in row.suffixes for row in rows):
        pytest.skip(f"there is no reader of {suffix} here")


def triangles(scene: dg.Scene) -> np.ndarray:
    """Corners in the world, sides as front faces go, sorted: shape (N, 9)."""
    found = []
    for instance in scene.instances:
        mesh = scene.meshes[instance.mesh]
        world = mesh.positions @ instance.transform[:3, :3].T + instance.transform[:3, 3]
        corners = world[mesh.indices.reshape(-1, 3)]
        if np.linalg.det(instance.transform[:3, :3]) < 0:
            corners = corners[:, ::-1]
        # The corner that is lowest in x + 2 y + 4 z comes first; a turn keeps the side.
        first = np.round(corners @ (1.0, 2.0, 4.0), 4).argmin(axis=1)
        turn = (first[:, None] + np.arange(3)) % 3
        found.append(np.take_along_axis(corners, turn[:, :, None], axis=1).reshape(-1, 9))
    flat = np.concatenate(found)
    return flat[np.lexsort(np.round(flat, 4).T)]


SCENES = [
    outgoing_scenes.box,
    outgoing_scenes.mirrored,
    outgoing_scenes.depth,
    outgoing_scenes.glass,
]


@pytest.mark.parametrize("suffix", [".pbrt", ".xml"])
@pytest.mark.parametrize("make", SCENES, ids=lambda make: make.__name__)
def test_meshes_and_camera_come_back(
    make: Callable[[], dg.Scene], suffix: str, tmp_path: Path
) -> None:
    reader_of(suffix)
    scene = make()
    if suffix == ".xml":  # there a shifted thin lens is a window of a larger film
        scene.cameras["main"] = scene.camera().with_(shift=(0.0, 0.0))
    file = tmp_path / f"scene{suffix}"
    dg.export_scene(scene, file, resolution=SIZE, spp=4)
    again = dg.load(file)
    np.testing.assert_allclose(triangles(again), triangles(scene), atol=2e-6)
    ours, theirs = (dg.raymap(one.camera(), SIZE, frame="world")
                    for one in (scene, again))  # fmt: skip
    np.testing.assert_allclose(theirs.origin, ours.origin, atol=1e-6)
    np.testing.assert_allclose(theirs.direction, ours.direction, atol=1e-6)
    assert (scene.camera().lens == "thin") == (again.camera().lens != "pinhole")


@pytest.mark.parametrize("suffix", [".pbrt", ".xml"])
def test_normals_of_a_mirrored_mesh_point_outside(suffix: str, tmp_path: Path) -> None:
    reader_of(suffix)
    scene = dg.Scene()
    shape = outgoing_scenes.ball(scene, 12)
    scales = np.array((-0.4, 0.3, 0.8))
    scene.add_instance(shape, dg.Diffuse(), outgoing_scenes.placed(1, 2, 3, scales))
    scene.set_environment(color=(1, 1, 1))
    scene.add_camera("main", outgoing_scenes.camera())
    file = tmp_path / f"scene{suffix}"
    dg.export_scene(scene, file, resolution=SIZE, spp=4)
    again = dg.load(file)
    (found,) = again.instances
    mesh = again.meshes[found.mesh]
    linear = found.transform[:3, :3]
    points = mesh.positions @ linear.T + found.transform[:3, 3] - (1, 2, 3)
    assert mesh.normals is not None
    normals = mesh.normals @ np.linalg.inv(linear)
    expected = points / scales**2  # of an ellipsoid
    cosines = np.einsum("ij,ij->i", unit(normals), unit(expected))
    assert cosines.min() > 1 - 1e-5


def unit(vectors: np.ndarray) -> np.ndarray:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))


@pytest.mark.parametrize("suffix", [".pbrt", ".xml"])
def test_light_comes_back(suffix: str, tmp_path: Path) -> None:
    """One unit: 1 cd/m2 of the world, a lamp's candelas, lux of the sun."""
    reader_of(suffix)
    scene = outgoing_scenes.room()
    scene.add_light(dg.PointLight((3.0, 2.0, 1.0)), outgoing_scenes.placed(0.1, 0.2, 0.3))
    scene.add_light(dg.DirectionalLight((5.0, 6.0, 7.0)), dg.look_at((1, 2, 3), (0, 0, 0)))
    scene.set_environment(color=(0.5, 1.0, 2.0), scale=3.0)
    file = tmp_path / f"scene{suffix}"
    dg.export_scene(scene, file, resolution=SIZE, spp=4)
    again = dg.load(file)
    lamps = {type(light): (light, place) for light, place in again.lights}
    lamp, place = lamps[dg.PointLight]
    np.testing.assert_allclose(lamp.intensity, (3, 2, 1), rtol=1e-5)
    np.testing.assert_allclose(place[:3, 3], (0.1, 0.2, 0.3), atol=1e-6)
    sun, place = lamps[dg.DirectionalLight]
    np.testing.assert_allclose(sun.illuminance, (5, 6, 7), rtol=1e-5)
    toward = place[:3, 2] / np.linalg.norm(place[:3, 2])
    np.testing.assert_allclose(toward, np.array((1, 2, 3)) / np.sqrt(14), atol=1e-6)
    sky = again.environment
    assert sky is not None
    assert sky.color is not None
    np.testing.assert_allclose(np.array(sky.color) * sky.scale, (1.5, 3, 6), rtol=1e-5)
    shining = [m for m in again.materials if max(m.emission) > 0]
    assert len({m.emission for m in shining}) == 1
    np.testing.assert_allclose(shining[0].emission, (20, 18, 15), rtol=1e-5)


def back(kind: object, suffix: str, folder: Path) -> tuple[dg.Scene, dg.Material]:
    """A ball of a material that was written and read: the scene, and the material."""
    reader_of(suffix)
    scene = dg.Scene()
    made = kind if isinstance(kind, dg.Material) else dg.Material(kind)  # type: ignore[arg-type]
    scene.add_instance(outgoing_scenes.ball(scene, 8), scene.add_material(made))
    scene.set_environment(color=(1, 1, 1))
    scene.add_camera("main", outgoing_scenes.camera())
    file = folder / f"scene{suffix}"
    dg.export_scene(scene, file, resolution=SIZE, spp=4)
    again = dg.load(file)
    return again, again.materials[again.instances[0].material]


GOLD = dg.Conductor.of_metal("Au", alpha=0.2)
KINDS: list[Any] = [
    dg.Diffuse((0.2, 0.4, 0.6)),
    GOLD,
    dg.Conductor.of_metal("Ag", alpha=0.0),
    dg.Conductor.of_metal("Cu", alpha=0.1, alpha_v=0.3),
    dg.Dielectric(1.33),
    dg.Dielectric(1.7, alpha=0.25),
    dg.Dielectric(1.5, thin=True),
    dg.Coated(dg.Diffuse((0.3, 0.5, 0.1)), ior=1.4, nonlinear=True),
    dg.Boundary(),
]


@pytest.mark.parametrize("suffix", [".pbrt", ".xml"])
@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: type(kind).__name__)
def test_materials_come_back(kind: Any, suffix: str, tmp_path: Path) -> None:
    _, found = back(kind, suffix, tmp_path)
    assert type(found.kind) is type(kind)
    assert plain(found.kind) == pytest.approx(plain(kind), rel=1e-4, abs=1e-6)
    assert found.two_sided


def test_a_rough_coat_that_loses_light_comes_back_from_mitsuba(tmp_path: Path) -> None:
    base = dg.Diffuse((0.3, 0.5, 0.1))
    for nonlinear in (True, False):
        kind = dg.Coated(base, 1.4, 0.2, nonlinear=nonlinear, energy_compensation=False)
        scene, found = back(kind, ".xml", tmp_path)
        assert plain(found.kind) == pytest.approx(plain(kind), rel=1e-4, abs=1e-6)
        assert not any("coat" in note for note in scene.warnings)


def plain(kind: Any) -> list[float]:
    """Numbers of a kind without textures; spectra at three wavelengths, words by their letters."""
    numbers: list[float] = []
    for field in dataclasses.fields(kind):
        value = getattr(kind, field.name)
        if value is None:
            numbers.append(-1.0)
        elif isinstance(value, str):
            numbers += [float(ord(letter)) for letter in value]
        elif isinstance(value, dg.Spectrum):
            numbers += np.asarray(value.at(np.array([450.0, 550.0, 650.0]))).tolist()
        elif dataclasses.is_dataclass(value):
            numbers += plain(value)
        else:
            numbers += np.ravel(np.asarray(value, float)).tolist()
    return numbers


@pytest.mark.parametrize("suffix", [".pbrt", ".xml"])
def test_textures_and_masks_come_back(suffix: str, tmp_path: Path) -> None:
    pixels = outgoing_scenes.checks()
    scene = dg.Scene()
    slot = dg.TextureSlot(scene.add_texture(pixels, srgb=True, min_filter="linear"))
    mask = np.arange(64, dtype=np.float32).reshape(8, 8, 1) / 64
    holes = dg.TextureSlot(scene.add_texture(mask, min_filter="linear"))
    made = dg.Material(dg.Diffuse((1, 1, 1), slot), opacity=0.5, opacity_texture=holes)
    scene.add_instance(outgoing_scenes.card(scene), made)
    scene.set_environment(color=(1, 1, 1))
    scene.add_camera("main", outgoing_scenes.camera())
    reader_of(suffix)
    file = tmp_path / f"scene{suffix}"
    dg.export_scene(scene, file, resolution=SIZE, spp=4)
    again = dg.load(file)
    found = again.materials[again.instances[0].material]
    assert isinstance(found.kind, dg.Diffuse)
    color, opacity = found.kind.reflectance_texture, found.opacity_texture
    assert color is not None
    assert opacity is not None
    texture = again.textures[color.texture]
    assert texture.srgb
    np.testing.assert_array_equal(texture.pixels, pixels)
    assert color.transform == pytest.approx((1, 0, 0, 0, 1, 0), abs=1e-6)
    seen = again.textures[opacity.texture].pixels[:, :, :1] * found.opacity
    np.testing.assert_allclose(seen, mask * 0.5, atol=1e-4)
    uv = [one.meshes[one.instances[0].mesh].uv for one in (scene, again)]
    np.testing.assert_allclose(uv[1], uv[0], atol=1e-6)


def leaves(scene: dg.Scene, material: dg.Material) -> list[dg.Material]:
    """Parts of a mixture that are none."""
    kind = material.kind
    if not isinstance(kind, dg.Mix):
        return [material]
    return [leaf for i in (kind.first, kind.second) for leaf in leaves(scene, scene.materials[i])]


@pytest.mark.parametrize("suffix", [".pbrt", ".xml"])
def test_normals_over_a_mixture_come_back(suffix: str, tmp_path: Path) -> None:
    """All parts have the normal map, its green as it was."""
    scene = dg.Scene()
    code = np.tile(np.array((0.6, 0.7, 0.9), np.float32), (4, 4, 1))
    code = 0.5 + 0.5 * (2 * code - 1) / np.linalg.norm(2 * code - 1, axis=2, keepdims=True)
    bumps = dg.TextureSlot(scene.add_texture(code.astype(np.float32), min_filter="linear"))
    made = dg.Gltf(metallic=0.5, roughness=0.5, normal_texture=bumps)
    scene.add_instance(outgoing_scenes.card(scene), made)
    scene.set_environment(color=(1, 1, 1))
    scene.add_camera("main", outgoing_scenes.camera())
    reader_of(suffix)
    file = tmp_path / f"scene{suffix}"
    dg.export_scene(scene, file, resolution=SIZE, spp=4)
    again = dg.load(file)
    whole = again.materials[again.instances[0].material]
    assert isinstance(whole.kind, dg.Mix)
    for part in leaves(again, whole):
        inner = part.kind.normal_texture if isinstance(part.kind, dg.Gltf) else part.normal_texture
        assert inner is not None
        pixels = again.textures[inner.texture].pixels
        linear = pixels / 255 if pixels.dtype == np.uint8 else pixels
        np.testing.assert_allclose(linear[1, 1], code[1, 1], atol=3e-3)


@pytest.mark.parametrize("suffix", [".pbrt", ".xml"])
def test_media_come_back(suffix: str, tmp_path: Path) -> None:
    inside = dg.Medium(absorption=(0.1, 0.2, 0.3), scattering=(1, 2, 4), lobes=((0.3, 1.0),))
    _, found = back(dg.Material(dg.Boundary(), interior=inside), suffix, tmp_path)
    assert found.interior is not None
    np.testing.assert_allclose(found.interior.absorption, inside.absorption, rtol=1e-4)
    np.testing.assert_allclose(found.interior.scattering, inside.scattering, rtol=1e-4)
    assert found.interior.lobes[0][0] == pytest.approx(0.3)


def test_a_light_profile_within_a_cone_comes_back_from_mitsuba(tmp_path: Path) -> None:
    """Its light is where it was, around the axis as well."""
    reader_of(".xml")
    theta, phi = np.linspace(0, 50, 11), np.arange(0, 360, 30)
    around = 1 + 0.8 * np.cos(np.radians(phi - 40))
    values = np.cos(np.radians(theta))[:, None] * around * np.linspace(1, 0, 11)[:, None]
    lamp = dg.PointLight((3.0, 2.0, 1.0), profile=dg.LightProfile.table(theta, values, phi))
    scene = dg.Scene()
    place = dg.look_at((1, 2, 3), (0, 0.5, -1))
    scene.add_light(lamp, place)
    scene.add_instance(outgoing_scenes.card(scene), dg.Diffuse())
    scene.add_camera("main", outgoing_scenes.camera())
    file = tmp_path / "scene.xml"
    dg.export_scene(scene, file, resolution=SIZE, spp=4)
    again = dg.load(file)
    rng = np.random.default_rng(4)
    ways = rng.normal(size=(400, 3)) @ np.diag((1, 1, 0.5)) - (0, 0, 1.5)
    world = ways @ place[:3, :3].T
    expected = lamp.profile.factors(ways) * np.array(lamp.intensity)  # type: ignore[union-attr]
    found = np.zeros((400, 3))
    for light, pose in again.lights:
        assert isinstance(light, dg.PointLight)
        assert light.profile is not None
        found += light.profile.factors(world @ pose[:3, :3]) * np.array(light.intensity)
        np.testing.assert_allclose(pose[:3, 3], (1, 2, 3), atol=1e-6)
    np.testing.assert_allclose(found, expected, atol=0.01 * expected.max())


@pytest.mark.parametrize("suffix", [".pbrt", ".xml"])
@pytest.mark.parametrize(("x", "nested"), [(0.1, True), (0.4, True), (2.5, False)])
def test_solids_in_solids_are_told(x: float, nested: bool, suffix: str, tmp_path: Path) -> None:
    """Other renderers do not nest: a bubble in glass is a ball of air in air there."""
    scene = dg.Scene()
    ball = outgoing_scenes.ball(scene, 12)
    for place, size in ((0.0, 0.5), (x, 0.25)):
        world = outgoing_scenes.placed(place, 0, 0, np.full(3, size))
        scene.add_instance(ball, dg.Dielectric(1.0 + size), world, name=f"{size} m")
    scene.add_camera("main", outgoing_scenes.camera())
    notes = dg.export_scene(scene, tmp_path / f"scene{suffix}")
    told = [note for note in notes if "written with its index against air" in note]
    assert ["(2 uses, the first '0.5 m')" in note for note in told] == [True] * nested
