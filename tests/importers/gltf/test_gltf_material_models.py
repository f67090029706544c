"""Unlit, specular-glossiness and diffuse transmission of glTF: fields, textures, pictures."""

from __future__ import annotations

import re

import numpy as np
import pytest

import daguerre as dg
from daguerre.importers.gltf import reader as gltf
from daguerre.scene.materials import Gltf
from tests.importers.gltf.test_gltf_materials import kind, with_material
from tests.support.formats.make_gltf import png
from tests.support.scene import scenes

THROUGH = "KHR_materials_diffuse_transmission"
GLOSS = "KHR_materials_pbrSpecularGlossiness"
UNLIT = "KHR_materials_unlit"


def extended(name, **values):
    return {"extensions": {name: values}}


def test_diffuse_transmission(tmp_path):
    factors = {"diffuseTransmissionFactor": 0.25, "diffuseTransmissionColorFactor": [1, 0.9, 0.8]}
    value = kind(with_material(extended(THROUGH, **factors)), tmp_path)
    assert value == Gltf(diffuse_transmission=0.25, diffuse_transmission_color=(1, 0.9, 0.8))
    assert kind(with_material(extended(THROUGH)), tmp_path) == Gltf()


def test_specular_glossiness(tmp_path):
    factors = {
        "diffuseFactor": [0.1, 0.2, 0.3, 0.4],
        "specularFactor": [0.5, 0.6, 0.7],
        "glossinessFactor": 0.8,
    }
    value = kind(with_material(extended(GLOSS, **factors)), tmp_path)
    assert value == Gltf(
        specular_glossiness=True,
        base_color=(0.1, 0.2, 0.3),
        base_alpha=0.4,
        specular_color=(0.5, 0.6, 0.7),
        glossiness=0.8,
    )
    assert kind(with_material(extended(GLOSS)), tmp_path) == Gltf(specular_glossiness=True)


def test_specular_glossiness_takes_the_place_of_metallic_roughness(tmp_path):
    material = {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0.5}}
    material |= {"emissiveFactor": [1, 0, 0], **extended(GLOSS, glossinessFactor=0.5)}
    material["extensions"]["KHR_materials_transmission"] = {"transmissionFactor": 1}
    scene = gltf.read(with_material(material).glb(tmp_path / "a.glb"))
    wanted = Gltf(specular_glossiness=True, glossiness=0.5, emissive=(1, 0, 0))
    assert scene.materials[0].kind == wanted
    assert scene.warnings == [
        "'KHR_materials_transmission' is ignored beside specular-glossiness (1 use)"
    ]


def test_unlit_keeps_only_base_colour_and_coverage(tmp_path):
    material = {
        "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5},
        "emissiveFactor": [1, 1, 1],
        "alphaMode": "MASK",
        "doubleSided": True,
        **extended(UNLIT),
    }
    assert kind(with_material(material), tmp_path) == Gltf(
        unlit=True,
        base_color=(0.1, 0.2, 0.3),
        base_alpha=0.4,
        alpha_mode="mask",
        double_sided=True,
    )


def test_textures_and_their_colour_space(tmp_path):
    through = {"diffuseTransmissionTexture": {"index": 0}}
    through["diffuseTransmissionColorTexture"] = {"index": 1, "texCoord": 1}
    gloss = {"diffuseTexture": {"index": 2}, "specularGlossinessTexture": {"index": 3}}
    b = with_material(
        extended(THROUGH, **through),
        *[png(np.full((1, 1, 4), 10 * i, np.uint8)) for i in range(4)],
    )
    b.add("materials", extended(GLOSS, **gloss))
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    leaf, paint = (material.kind for material in scene.materials)
    for slot, image, srgb in (
        (leaf.diffuse_transmission_texture, 0, False),
        (leaf.diffuse_transmission_color_texture, 1, True),
        (paint.base_color_texture, 2, True),
        (paint.specular_glossiness_texture, 3, True),
    ):
        texture = scene.textures[slot.texture]
        assert texture.pixels[0, 0, 0] == 10 * image
        assert texture.srgb is srgb
    assert leaf.diffuse_transmission_color_texture.uv_set == 1


@pytest.mark.parametrize(
    ("name", "values", "message"),
    [
        (THROUGH, {"diffuseTransmissionFactor": 1.5}, r"diffuseTransmissionFactor: out of range"),
        (THROUGH, {"diffuseTransmissionFactor": "1"}, r"diffuseTransmissionFactor: wrong type"),
        (THROUGH, {"diffuseTransmissionColorFactor": [1, 1]}, r"ColorFactor: wrong length"),
        (THROUGH, {"diffuseTransmissionTexture": {"index": 9}}, r"Texture\.index: index out of"),
        (GLOSS, {"diffuseFactor": [1, 1, 1]}, r"diffuseFactor: wrong length: wanted 4"),
        (GLOSS, {"specularFactor": [0, 0, 2]}, r"specularFactor\[2\]: out of range"),
        (GLOSS, {"glossinessFactor": -0.1}, r"glossinessFactor: out of range"),
        (GLOSS, {"specularGlossinessTexture": 3}, r"specularGlossinessTexture: wrong type"),
    ],
)
def test_what_a_file_gets_wrong_is_named(tmp_path, name, values, message):
    path = with_material(extended(name, **values)).glb(tmp_path / "a.glb")
    with pytest.raises(dg.InputError, match=rf"a\.glb: materials\[0\]\.extensions\.{name}\.") as e:
        gltf.read(path)
    assert re.search(message, str(e.value))


def test_unlit_that_is_no_object(tmp_path):
    path = with_material({"extensions": {UNLIT: 1}}).glb(tmp_path / "a.glb")
    with pytest.raises(dg.InputError, match=rf"extensions\.{UNLIT}: wrong type: wanted an object"):
        gltf.read(path)


@pytest.mark.parametrize("sky", [0.0, 5.0])
def test_unlit_looks_the_same_in_any_light(sky):
    kind = Gltf(unlit=True, base_color=(0.8, 0.4, 0.2))
    scene = scenes.furnace(dg.Material(kind))
    scene.set_environment(color=(sky, sky, sky))
    camera = dg.Camera(lens="pinhole", focal_length=40)
    frame = dg.render(scene, camera, resolution=(32, 24), spp=64, filter="box")
    middle = frame.rgb[8:16, 12:20].mean(axis=(0, 1))
    assert middle == pytest.approx([0.8, 0.4, 0.2], abs=0.01)


def test_unlit_is_found_by_light_sampling_as_by_following_the_surface():
    scene = scenes.furnace(dg.Material(dg.Diffuse((0.8, 0.8, 0.8))))
    scene.set_environment(color=(0, 0, 0))
    points, faces = scenes.quad(1.5)
    colors = np.array([[1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, 1], [1, 1, 1, 0.5]])
    panel = scene.add_mesh(points, faces, colors=colors)
    scene.add_instance(panel, Gltf(unlit=True, alpha_mode="blend"), scenes.at(0, 0, -1))
    camera = dg.Camera(lens="pinhole", focal_length=40, transform=scenes.at(2.6, 0, 0))
    means = [
        dg.render(scene, camera, resolution=(24, 24), spp=512, strategy=s).rgb.mean(axis=(0, 1))
        for s in ("light", "bsdf", "mis")
    ]
    assert means[0] == pytest.approx(means[1], rel=0.03)
    assert means[2] == pytest.approx(means[1], rel=0.03)
