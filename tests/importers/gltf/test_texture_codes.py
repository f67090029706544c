"""Meaning of a texture's codes, slot by slot: a grey texture against the factor that it equals.

Files are read and rendered whole; both pictures draw the same random numbers, so they agree but for
rounding. Source: glTF 2.0, 3.9; the texts of the extensions.
"""

from __future__ import annotations

import io
import math
from typing import Any, NamedTuple

import numpy as np
import OpenImageIO as oiio
import pytest

from daguerre import Camera, render
from daguerre.importers.gltf import reader as gltf
from daguerre.pictures import images
from tests.importers.gltf.test_gltf_materials import with_material
from tests.support.formats.make_gltf import png
from tests.support.scene import scenes

CODE = 128
LINEAR = CODE / 255


def light(share: float) -> float:
    """Luminance of a share of an sRGB code's range (IEC 61966-2-1), above 0.04."""
    return ((share + 0.055) / 1.055) ** 2.4


LIGHT = light(LINEAR)  # 0.216
GREY = png(np.full((1, 1, 4), CODE, np.uint8))

MATTE = {"metallicFactor": 0.0}
BLACK = {"baseColorFactor": [0, 0, 0, 1]}
DARK = {**BLACK, "metallicFactor": 0.0, "roughnessFactor": 0.3}


class Slot(NamedTuple):
    """Where a texture stands; the members beside it; those that take its place."""

    extension: str  # of KHR_materials; pbrMetallicRoughness, or the material itself: ""
    texture: str
    beside: dict[str, Any]
    instead: dict[str, Any]
    surface: dict[str, Any] | None = None

    def material(self, textured: bool) -> dict[str, Any]:
        texture = {self.texture: {"index": 0}}
        members = {**self.beside, **(texture if textured else self.instead)}
        if self.extension in ("", "pbrMetallicRoughness"):
            return {"pbrMetallicRoughness": self.surface or {}} | (
                {self.extension: members} if self.extension else members
            )
        return {
            "pbrMetallicRoughness": self.surface or {},
            "extensions": {f"KHR_materials_{self.extension}": members},
        }


RED_SIDE = {"diffuseTransmissionColorFactor": [1, 0, 0]}
SLOTS = {
    "base": Slot(
        "pbrMetallicRoughness",
        "baseColorTexture",
        {},
        {"baseColorFactor": [LIGHT, LIGHT, LIGHT, LINEAR]},
    ),
    "metallic, roughness": Slot(
        "pbrMetallicRoughness",
        "metallicRoughnessTexture",
        {},
        {"metallicFactor": LINEAR, "roughnessFactor": LINEAR},
    ),
    "emissive": Slot(
        "", "emissiveTexture", {"emissiveFactor": [1] * 3}, {"emissiveFactor": [LIGHT] * 3}
    ),
    "specular": Slot("specular", "specularTexture", {}, {"specularFactor": LINEAR}, DARK),
    "specular colour": Slot(
        "specular", "specularColorTexture", {}, {"specularColorFactor": [LIGHT] * 3}, DARK
    ),
    "transmission": Slot(
        "transmission",
        "transmissionTexture",
        {"transmissionFactor": 1},
        {"transmissionFactor": LINEAR},
        {"metallicFactor": 0.0, "roughnessFactor": 0.3},
    ),
    "clearcoat": Slot(
        "clearcoat", "clearcoatTexture", {"clearcoatFactor": 1}, {"clearcoatFactor": LINEAR}, BLACK
    ),
    "clearcoat roughness": Slot(
        "clearcoat",
        "clearcoatRoughnessTexture",
        {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 1},
        {"clearcoatRoughnessFactor": LINEAR},
        DARK,
    ),
    "sheen colour": Slot(
        "sheen",
        "sheenColorTexture",
        {"sheenColorFactor": [1] * 3, "sheenRoughnessFactor": 0.5},
        {"sheenColorFactor": [LIGHT] * 3},
        BLACK,
    ),
    "sheen roughness": Slot(
        "sheen",
        "sheenRoughnessTexture",
        {"sheenColorFactor": [1] * 3, "sheenRoughnessFactor": 1},
        {"sheenRoughnessFactor": LINEAR},
        BLACK,
    ),
    "anisotropy": Slot(  # red and green alike: a direction of 45 degrees
        "anisotropy",
        "anisotropyTexture",
        {"anisotropyStrength": 1},
        {"anisotropyStrength": LINEAR, "anisotropyRotation": math.pi / 4},
        {"roughnessFactor": 0.4},
    ),
    "iridescence": Slot(
        "iridescence",
        "iridescenceTexture",
        {"iridescenceFactor": 1},
        {"iridescenceFactor": LINEAR},
        MATTE,
    ),
    "film thickness": Slot(
        "iridescence",
        "iridescenceThicknessTexture",
        {"iridescenceFactor": 1},
        {"iridescenceThicknessMaximum": 100 + 300 * LINEAR},
        MATTE,
    ),
    "diffuse transmission": Slot(
        "diffuse_transmission",
        "diffuseTransmissionTexture",
        {"diffuseTransmissionFactor": 1, **RED_SIDE},
        {"diffuseTransmissionFactor": LINEAR},
        MATTE,
    ),
    "diffuse transmission colour": Slot(
        "diffuse_transmission",
        "diffuseTransmissionColorTexture",
        {"diffuseTransmissionFactor": 1},
        {"diffuseTransmissionColorFactor": [LIGHT] * 3},
        MATTE,
    ),
    "diffuse": Slot(
        "pbrSpecularGlossiness",
        "diffuseTexture",
        {"specularFactor": [0] * 3},
        {"diffuseFactor": [LIGHT, LIGHT, LIGHT, LINEAR]},
    ),
    "specular, glossiness": Slot(
        "pbrSpecularGlossiness",
        "specularGlossinessTexture",
        {},
        {"specularFactor": [LIGHT] * 3, "glossinessFactor": LINEAR},
    ),
}


def picture(tmp_path, material, *pictures, **options) -> np.ndarray:
    """The inside of a triangle under an uneven sky."""
    b = with_material(material, *pictures)
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    scene.set_environment(np.random.default_rng(3).uniform(0.2, 1, (8, 16, 3)))
    camera = Camera(lens="pinhole", focal_length=150, transform=scenes.at(0.3, 0.3, 1))
    options = {"spp": 16, "max_depth": 2, "threads": 1} | options
    return render(scene, camera, resolution=(6, 4), filter="box", **options).rgb


def same(a: np.ndarray, b: np.ndarray) -> bool:
    return bool(np.allclose(a, b, rtol=1e-3, atol=1e-4))


@pytest.mark.parametrize("name", SLOTS)
def test_a_grey_texture_is_the_factor_that_its_code_stands_for(tmp_path, name):
    textured = picture(tmp_path, SLOTS[name].material(True), GREY)
    assert same(textured, picture(tmp_path, SLOTS[name].material(False)))
    white = png(np.full((1, 1, 4), 255, np.uint8))  # the slot does reach the picture
    assert not same(textured, picture(tmp_path, SLOTS[name].material(True), white))


def glow(tmp_path, data: bytes) -> np.ndarray:
    """Mean RGB of a picture used as the emission of a black triangle."""
    material = {"emissiveTexture": {"index": 0}, "emissiveFactor": [1] * 3}
    material["pbrMetallicRoughness"] = BLACK
    return picture(tmp_path, material, data, spp=256).mean(axis=(0, 1))


@pytest.mark.parametrize(
    ("shape", "dtype", "code", "expected"),
    [
        ((1, 1, 1), np.uint8, 128, LIGHT),
        ((1, 1, 2), np.uint8, 128, LIGHT),
        ((1, 1, 1), np.uint16, 32768, 0.21404),  # half of the range
        ((1, 1, 2), np.uint16, 32768, 0.21404),
        ((1, 1, 3), np.uint16, 32768, 0.21404),
        ((1, 1, 4), np.uint16, 12345, light(12345 / 65535)),
    ],
)
def test_grey_alpha_and_16_bits_shine_alike(tmp_path, shape, dtype, code, expected):
    rgb = glow(tmp_path, png(np.full(shape, code, dtype)))
    assert rgb == pytest.approx(expected, rel=0.02)


def test_jpeg_of_four_inks_becomes_rgb():
    image = pytest.importorskip("PIL.Image", reason="OpenImageIO writes no CMYK")
    stream = io.BytesIO()
    image.new("CMYK", (8, 8), (0, 128, 255, 51)).save(stream, "JPEG", quality=95)
    pixels = images.decode(stream.getvalue(), "a.jpg")
    assert pixels.shape == (8, 8, 3)
    assert pixels[4, 4] == pytest.approx([204, 0.8 * 127, 0], abs=4)


@pytest.mark.parametrize("orientation", [1, 3, 6, 8])
def test_the_orientation_of_a_texture_is_not_looked_at(tmp_path, orientation):
    """glTF 2.0, 3.8, knows none: coordinates speak of the pixels as they are stored."""
    stored = np.zeros((8, 16, 3), np.uint8)
    stored[:, :8] = 255
    path = str(tmp_path / "a.jpg")
    spec = oiio.ImageSpec(16, 8, 3, oiio.UINT8)
    spec.attribute("Orientation", orientation)
    out = oiio.ImageOutput.create(path)
    assert out.open(path, spec)
    assert out.write_image(stored)
    out.close()
    assert oiio.ImageInput.open(path).spec().get_int_attribute("Orientation") == orientation
    pixels = images.decode((tmp_path / "a.jpg").read_bytes(), "a.jpg")
    assert pixels.shape == stored.shape
    assert pixels == pytest.approx(stored, abs=3)
