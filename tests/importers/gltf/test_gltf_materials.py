"""Materials and textures of glTF; exact numbers from files made here."""

from __future__ import annotations

import base64
import math

import numpy as np
import pytest

from daguerre import memory
from daguerre.errors import InputError
from daguerre.importers.gltf import reader as gltf
from daguerre.pictures import images
from daguerre.scene.materials import Gltf, TextureSlot
from tests.support.formats.make_gltf import Builder, jpeg, png, triangle

RED = np.array([[[255, 0, 0], [0, 255, 0]]], np.uint8)
UV = [[0, 0], [1, 0], [0, 1]]


def with_material(material, *pictures) -> Builder:
    b = triangle()
    primitive = b.json["meshes"][0]["primitives"][0]
    primitive["attributes"] |= {"TEXCOORD_0": b.accessor(UV), "TEXCOORD_1": b.accessor(UV)}
    primitive["material"] = b.add("materials", material)
    for picture in pictures:
        b.image(picture)
    return b


def read(b: Builder, tmp_path):
    return gltf.read(b.glb(tmp_path / "a.glb"))


def kind(b: Builder, tmp_path) -> Gltf:
    scene = read(b, tmp_path)
    assert scene.warnings == []
    value = scene.materials[scene.instances[0].material].kind
    assert isinstance(value, Gltf)
    return value


def test_missing_material_is_the_default_of_gltf(tmp_path):
    scene = read(triangle(), tmp_path)
    assert scene.materials[scene.instances[0].material].kind == Gltf()
    assert Gltf().metallic == Gltf().roughness == 1
    assert kind(with_material({}), tmp_path) == Gltf()


def test_factors(tmp_path):
    value = kind(
        with_material(
            {
                "pbrMetallicRoughness": {
                    "baseColorFactor": [0.1, 0.2, 0.3, 0.4],
                    "metallicFactor": 0.5,
                    "roughnessFactor": 0.6,
                },
                "emissiveFactor": [1, 0.5, 0],
                "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 200}},
                "alphaMode": "MASK",
                "alphaCutoff": 0.7,
                "doubleSided": True,
            }
        ),
        tmp_path,
    )
    assert value == Gltf(
        base_color=(0.1, 0.2, 0.3),
        base_alpha=0.4,
        metallic=0.5,
        roughness=0.6,
        emissive=(200, 100, 0),
        alpha_mode="mask",
        alpha_cutoff=0.7,
        double_sided=True,
    )


@pytest.mark.parametrize("mode", ["OPAQUE", "MASK", "BLEND"])
def test_alpha_modes(tmp_path, mode):
    assert kind(with_material({"alphaMode": mode}), tmp_path).alpha_mode == mode.lower()


def test_extensions(tmp_path):
    value = kind(
        with_material(
            {
                "extensions": {
                    "KHR_materials_ior": {"ior": 1.33},
                    "KHR_materials_transmission": {"transmissionFactor": 0.9},
                    "KHR_materials_volume": {
                        "thicknessFactor": 0.02,
                        "attenuationDistance": 0.5,
                        "attenuationColor": [0.9, 0.8, 0.7],
                    },
                    "KHR_materials_specular": {
                        "specularFactor": 0.3,
                        "specularColorFactor": [1, 2, 0.5],
                    },
                    "KHR_materials_dispersion": {"dispersion": 0.36},
                }
            }
        ),
        tmp_path,
    )
    assert value == Gltf(
        ior=1.33,
        transmission=0.9,
        thickness=0.02,
        attenuation_distance=0.5,
        attenuation_color=(0.9, 0.8, 0.7),
        specular=0.3,
        specular_color=(1, 2, 0.5),
        dispersion=0.36,
    )


def test_empty_extensions_give_their_defaults(tmp_path):
    names = ("ior", "transmission", "volume", "specular", "emissive_strength", "dispersion")
    b = with_material({"extensions": {f"KHR_materials_{name}": {} for name in names}})
    assert kind(b, tmp_path) == Gltf()


def test_ior_zero_reflects_everything(tmp_path):
    b = with_material({"extensions": {"KHR_materials_ior": {"ior": 0}}})
    ior = kind(b, tmp_path).ior
    assert ((ior - 1) / (ior + 1)) ** 2 > 0.999


def test_every_texture_slot_and_its_colour_space(tmp_path):
    b = with_material(
        {
            "pbrMetallicRoughness": {
                "baseColorTexture": {"index": 0},
                "metallicRoughnessTexture": {"index": 1},
            },
            "normalTexture": {"index": 2, "scale": 0.5},
            "occlusionTexture": {"index": 3, "strength": 0.5},
            "emissiveTexture": {"index": 4, "texCoord": 1},
            "extensions": {
                "KHR_materials_specular": {
                    "specularTexture": {"index": 5},
                    "specularColorTexture": {"index": 6},
                },
                "KHR_materials_transmission": {"transmissionTexture": {"index": 7}},
            },
        },
        *[png(np.full((1, 1, 3), 10 * i, np.uint8)) for i in range(8)],
    )
    scene = read(b, tmp_path)
    value = scene.materials[0].kind
    slots = {
        "base_color": (0, True),
        "metallic_roughness": (1, False),
        "normal": (2, False),
        "occlusion": (3, False),
        "emissive": (4, True),
        "specular": (5, False),
        "specular_color": (6, True),
        "transmission": (7, False),
    }
    for name, (image, srgb) in slots.items():
        slot = getattr(value, name + "_texture")
        texture = scene.textures[slot.texture]
        assert texture.pixels[0, 0, 0] == 10 * image, name
        assert texture.srgb is srgb, name
        assert slot.uv_set == (1 if name == "emissive" else 0), name
    assert value.normal_scale == 0.5


def test_an_image_is_decoded_once_for_all_its_uses(tmp_path, monkeypatch):
    calls = []
    real = images.decode
    monkeypatch.setattr(images, "decode", lambda *a: calls.append(a[1]) or real(*a))
    b = with_material({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}, png(RED))
    view = b.json["images"][0]["bufferView"]
    b.add("images", {"bufferView": view, "mimeType": "image/png"})
    b.add("samplers", {"wrapS": 33071})
    b.add("textures", {"source": 1, "sampler": 0})
    b.add("textures", {"source": 1})
    b.json["materials"][0] |= {"normalTexture": {"index": 1}, "emissiveTexture": {"index": 2}}
    scene = read(b, tmp_path)
    assert len(calls) == 1
    value = scene.materials[0].kind
    assert len(scene.textures) == 2
    assert scene.textures[0].pixels is scene.textures[1].pixels
    assert value.base_color_texture == value.emissive_texture


def test_images_take_a_share_of_the_memory_that_is_free(tmp_path, monkeypatch):
    b = with_material({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}, png(RED))
    monkeypatch.setattr(memory, "left_bytes", lambda: 10)  # the image has 6 bytes
    read(b, tmp_path)
    monkeypatch.setattr(memory, "left_bytes", lambda: 9)
    with pytest.raises(InputError, match=r"too many bytes of decoded images \(60% of the 9 B"):
        read(b, tmp_path)


@pytest.mark.parametrize(
    ("sampler", "wrap", "name"),
    [
        ({}, ("repeat", "repeat"), "linear"),
        ({"wrapS": 33071, "wrapT": 33648}, ("clamp", "mirror"), "linear"),
        ({"wrapS": 10497, "magFilter": 9728, "minFilter": 9987}, ("repeat", "repeat"), "nearest"),
        ({"magFilter": 9729}, ("repeat", "repeat"), "linear"),
    ],
)
def test_samplers(tmp_path, sampler, wrap, name):
    b = with_material({"normalTexture": {"index": 0}}, png(RED))
    b.json["textures"][0]["sampler"] = b.add("samplers", sampler)
    texture = read(b, tmp_path).textures[0]
    assert (texture.wrap, texture.filter) == (wrap, name)


def transformed(tmp_path, uv, **transform):
    info = {"index": 0, "extensions": {"KHR_texture_transform": transform}}
    b = with_material({"normalTexture": info}, png(RED))
    a = kind(b, tmp_path).normal_texture.transform
    return pytest.approx(
        (a[0] * uv[0] + a[1] * uv[1] + a[2], a[3] * uv[0] + a[4] * uv[1] + a[5]), abs=1e-12
    )


def test_texture_transform(tmp_path):
    assert transformed(tmp_path, (0.2, 0.4)) == (0.2, 0.4)
    assert transformed(tmp_path, (0.2, 0.4), offset=[1, 2]) == (1.2, 2.4)
    assert transformed(tmp_path, (0.2, 0.4), scale=[2, 3]) == (0.4, 1.2)
    # Counter-clockwise as seen with v down: u turns into -v, v into u.
    assert transformed(tmp_path, (1, 0), rotation=math.pi / 2) == (0, -1)
    assert transformed(tmp_path, (0, 1), rotation=math.pi / 2) == (1, 0)
    # Scale first, then rotation, then offset.
    both = {"rotation": math.pi / 2, "scale": [2, 3], "offset": [10, 20]}
    assert transformed(tmp_path, (1, 1), **both) == (13, 18)


def test_texture_transform_overrides_the_set(tmp_path):
    info = {"index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform": {"texCoord": 1}}}
    b = with_material({"normalTexture": info}, png(RED))
    assert kind(b, tmp_path).normal_texture == TextureSlot(0, 1)


@pytest.mark.parametrize("where", ["file", "data", "view"])
def test_images_from_everywhere(tmp_path, where):
    b = with_material({"normalTexture": {"index": 0}}, png(RED))
    if where == "file":
        (tmp_path / "tex ture.png").write_bytes(png(RED))  # codespell:ignore ture
        b.json["images"][0] = {"uri": "tex%20ture.png"}
    if where == "data":
        packed = base64.b64encode(png(RED)).decode()
        b.json["images"][0] = {"uri": "data:image/png;base64," + packed}
    assert read(b, tmp_path).textures[0].pixels.tolist() == RED.tolist()


def test_jpeg(tmp_path):
    color = np.full((16, 16, 3), (200, 100, 50), np.uint8)
    b = with_material({"normalTexture": {"index": 0}}, jpeg(color, tmp_path))
    pixels = read(b, tmp_path).textures[0].pixels
    assert pixels.shape == (16, 16, 3)
    assert np.abs(pixels.astype(int) - (200, 100, 50)).max() <= 3


def test_16_bit_pictures_stay_fine(tmp_path):
    values = np.array([[[0, 16384, 65535, 32768]]], np.uint16)
    b = with_material({"normalTexture": {"index": 0}, "emissiveTexture": {"index": 0}}, png(values))
    scene = read(b, tmp_path)
    value = scene.materials[0].kind
    linear = scene.textures[value.normal_texture.texture]
    assert linear.pixels.dtype == np.float32
    assert linear.pixels[0, 0] == pytest.approx([0, 16384 / 65535, 1, 32768 / 65535], abs=1e-7)
    # Colours are undone from sRGB here, as lookups do that for 8 bits only; alpha is linear.
    color = scene.textures[value.emissive_texture.texture]
    assert color.srgb is False
    wanted = ((16384 / 65535 + 0.055) / 1.055) ** 2.4
    assert color.pixels[0, 0] == pytest.approx([0, wanted, 1, 32768 / 65535], abs=1e-6)


def test_a_pixel_of_alpha_zero_keeps_its_colour(tmp_path):
    values = np.array([[[200, 100, 50, 0], [200, 100, 50, 128]]], np.uint8)
    b = with_material({"normalTexture": {"index": 0}}, png(values))
    assert read(b, tmp_path).textures[0].pixels.tolist() == values.tolist()


def test_what_is_left_out_is_told(tmp_path):
    b = with_material(
        {
            "normalTexture": {"index": 0, "texCoord": 2},
            "emissiveTexture": {"index": 1},
            "extensions": {"KHR_materials_volume": {"thicknessTexture": {"index": 0}}},
        },
        png(RED),
    )
    b.add("textures", {"extensions": {"EXT_texture_avif": {"source": 0}}})
    scene = read(b, tmp_path)
    assert scene.materials[0].kind.normal_texture is None
    assert scene.materials[0].kind.emissive_texture is None
    assert scene.warnings == [
        "extension 'EXT_texture_avif' is not supported (1 use)",
        "a texture on texture coordinates other than sets 0 and 1 is left out (1 use)",
        "a texture without an image of a supported format is left out (1 use)",
        "'thicknessTexture' is not needed: the path through the volume is traced (1 use)",
    ]


def test_missing_texture_coordinates_are_told(tmp_path):
    b = with_material({"normalTexture": {"index": 0, "texCoord": 1}}, png(RED))
    del b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"]
    assert "lacks the texture coordinates" in read(b, tmp_path).warnings[0]


def test_unused_broken_image_does_not_stop_the_scene(tmp_path):
    b = with_material({}, b"not an image")
    assert read(b, tmp_path).textures == []


@pytest.mark.parametrize(
    ("code", "name"),
    [
        (None, "linear_mipmap_linear"),
        (9728, "nearest"),
        (9729, "linear"),
        (9984, "nearest_mipmap_nearest"),
        (9985, "linear_mipmap_nearest"),
        (9986, "nearest_mipmap_linear"),
        (9987, "linear_mipmap_linear"),
    ],
)
def test_min_filters(tmp_path, code, name):
    b = with_material({"normalTexture": {"index": 0}}, png(RED))
    b.json["textures"][0]["sampler"] = b.add(
        "samplers", {} if code is None else {"minFilter": code}
    )
    assert read(b, tmp_path).textures[0].min_filter == name
