"""Normal maps in numbers: each picture is held against one whose normals are in the mesh."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import daguerre as dg
from daguerre.scene.materials import Gltf, TextureSlot
from tests.support.scene import scenes

UPRIGHT = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], float)  # u to the right, v down
TILT = (0.3, 0.2)  # of the normal: to the right and up

# A mirror under the map, and one of lacquer on black; smooth, so that pictures have no noise.
BASE = (Gltf(metallic=1.0, roughness=0.0), "normal")
COAT = (Gltf(base_color=(0, 0, 0), metallic=0.0, specular=0.0, clearcoat=1.0), "clearcoat_normal")
KINDS = pytest.mark.parametrize("layer", [BASE, COAT], ids=["base", "coat"])


def texel(right: float, up: float) -> np.ndarray:
    """A map of one normal, (1, 1, 3), float."""
    n = unit(right, up)
    return (n[None, None] * 0.5 + 0.5).astype(np.float32)


def unit(right: float, up: float) -> np.ndarray:
    n = np.array([right, up, 1.0])
    return n / np.linalg.norm(n)


def picture(layer, pixels=None, scale=1.0, *, yaw=0.0, sky=None, normal=None, **mesh) -> np.ndarray:
    """A square seen from 10 m before its middle, turned by ``yaw`` degrees."""
    kind, name = layer
    scene = dg.Scene()
    if pixels is not None:
        slot = TextureSlot(scene.add_texture(pixels))
        kind = dataclasses.replace(kind, **{name + "_texture": slot, name + "_scale": scale})
    if normal is not None:
        mesh["normals"] = np.tile(normal, (4, 1))
    points, triangles = scenes.quad(8)
    c, s = np.cos(np.radians(yaw)), np.sin(np.radians(yaw))
    turned = np.array([[c, 0, s, 0], [0, 1, 0, 0], [-s, 0, c, -10], [0, 0, 0, 1]])
    mesh.setdefault("uv", UPRIGHT)
    scene.add_instance(scene.add_mesh(points, triangles, **mesh), kind, turned)
    random = np.random.default_rng(3).uniform(0.2, 1, (8, 16, 3))
    scene.set_environment(random if sky is None else sky)
    camera = dg.Camera(lens="pinhole", focal_length=200)
    return dg.render(scene, camera, resolution=(6, 4), spp=16, filter="box", threads=1).rgb


def same(a: np.ndarray, b: np.ndarray) -> bool:
    return bool(np.allclose(a, b, rtol=2e-3))


@KINDS
def test_a_flat_map_and_a_scale_of_0_are_no_map(layer):
    plain = picture(layer)
    assert same(picture(layer, texel(0, 0)), plain)
    assert same(picture(layer, texel(*TILT), 0), plain)
    assert not same(picture(layer, texel(*TILT)), plain)


@KINDS
def test_a_map_tilts_as_the_normals_of_a_mesh_do(layer):
    """Green is up in the image (glTF 2.0, 3.9.3); -1 mirrors, 2 doubles the slope."""
    right, up = TILT
    for scale in (1.0, -1.0, 2.0, 0.5):
        wanted = picture(layer, normal=unit(scale * right, scale * up))
        assert same(picture(layer, texel(*TILT), scale), wanted)
    assert same(picture(layer, texel(*TILT), -1), picture(layer, texel(-right, -up)))


@KINDS
def test_codes_of_8_bits_are_linear(layer):
    codes = np.array([[[166, 153, 245]]], np.uint8)
    r, g, b = codes[0, 0] / 127.5 - 1
    assert same(picture(layer, codes), picture(layer, normal=unit(r / b, g / b)))


@KINDS
@pytest.mark.parametrize(("mirror_u", "mirror_v"), [(0, 0), (1, 0), (0, 1), (1, 1)])
def test_mirrored_coordinates_mirror_the_map(layer, mirror_u, mirror_v):
    """Tangents of the file (w is the handedness) and our own agree."""
    uv = np.abs(UPRIGHT - (mirror_u, mirror_v))
    x, y = 1 - 2 * mirror_u, 1 - 2 * mirror_v
    wanted = picture(layer, normal=unit(x * TILT[0], y * TILT[1]))
    assert same(picture(layer, texel(*TILT), uv=uv), wanted)
    tangents = np.tile((x, 0, 0, x * y), (4, 1))
    assert same(picture(layer, texel(*TILT), uv=uv, tangents=tangents), wanted)


@KINDS
def test_a_back_face_has_the_normal_of_its_front_reversed(layer):
    kind, name = layer
    double = (dataclasses.replace(kind, double_sided=True), name)
    right, up = TILT
    behind = picture(double, texel(*TILT), yaw=180)
    # From behind, right is left; and a reversed normal leans the other way.
    assert same(behind, picture(layer, normal=unit(right, -up)))


@KINDS
@pytest.mark.parametrize("tilt", [-3.0, 3.0])
@pytest.mark.parametrize("roughness", [0.0, 0.3])
def test_no_map_turns_a_grazing_view_black_or_brighter_than_the_sky(layer, tilt, roughness):
    """From 83 degrees, where the map's normals turn away by up to 65 more."""
    kind, name = layer
    field = "roughness" if name == "normal" else "clearcoat_roughness"
    layer = (dataclasses.replace(kind, **{field: roughness}), name)
    rgb = picture(layer, texel(tilt, 0), yaw=83, sky=np.ones((2, 4, 3)))[:, :4].mean(axis=(0, 1))
    assert (rgb < 1.02).all()  # the noise of 16 wavelengths per pixel
    assert (rgb > (0.8 if name == "normal" else 0.035)).all()
    if name == "normal" and not roughness:
        assert rgb == pytest.approx(1, abs=0.02)  # a mirror in a white world
