"""KHR_materials_{clearcoat, sheen, anisotropy, iridescence}: members, ranges, textures."""

from __future__ import annotations

import math

import numpy as np
import pytest

from daguerre.errors import InputError
from daguerre.importers.gltf import reader as gltf
from daguerre.scene.materials import Gltf
from tests.importers.gltf.test_gltf_materials import kind, read, with_material
from tests.support.formats.make_gltf import png

LAYERS = ("clearcoat", "sheen", "anisotropy", "iridescence")


def extended(name, members, *pictures):
    return with_material({"extensions": {f"KHR_materials_{name}": members}}, *pictures)


def test_empty_layers_give_their_defaults(tmp_path):
    b = with_material({"extensions": {f"KHR_materials_{name}": {} for name in LAYERS}})
    assert kind(b, tmp_path) == Gltf()
    assert Gltf().iridescence_ior == 1.3
    assert (Gltf().iridescence_thickness_min_nm, Gltf().iridescence_thickness_max_nm) == (100, 400)


@pytest.mark.parametrize(
    ("name", "members", "values"),
    [
        (
            "clearcoat",
            {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.25},
            {"clearcoat": 0.5, "clearcoat_roughness": 0.25},
        ),
        (
            "sheen",
            {"sheenColorFactor": [0.1, 0.2, 0.3], "sheenRoughnessFactor": 0.4},
            {"sheen_color": (0.1, 0.2, 0.3), "sheen_roughness": 0.4},
        ),
        (
            "anisotropy",
            {"anisotropyStrength": 0.6, "anisotropyRotation": math.pi / 2},
            {"anisotropy": 0.6, "anisotropy_rotation": 90},
        ),
        (
            "iridescence",
            {
                "iridescenceFactor": 1,
                "iridescenceIor": 1.8,
                "iridescenceThicknessMinimum": 700,
                "iridescenceThicknessMaximum": 300,
            },
            {
                "iridescence": 1,
                "iridescence_ior": 1.8,
                "iridescence_thickness_min_nm": 700,
                "iridescence_thickness_max_nm": 300,
            },
        ),
    ],
)
def test_factors(tmp_path, name, members, values):
    assert kind(extended(name, members), tmp_path) == Gltf(**values)


def test_textures_and_their_colour_space(tmp_path):
    members = {
        "clearcoat": ("clearcoatTexture", "clearcoatRoughnessTexture", "clearcoatNormalTexture"),
        "sheen": ("sheenColorTexture", "sheenRoughnessTexture"),
        "anisotropy": ("anisotropyTexture",),
        "iridescence": ("iridescenceTexture", "iridescenceThicknessTexture"),
    }
    keys = [key for group in members.values() for key in group]
    extensions = {
        f"KHR_materials_{name}": {key: {"index": keys.index(key)} for key in group}
        for name, group in members.items()
    }
    extensions["KHR_materials_clearcoat"]["clearcoatNormalTexture"] |= {"scale": 0.5, "texCoord": 1}
    pictures = [png(np.full((1, 1, 4), 10 * i, np.uint8)) for i in range(len(keys))]
    scene = read(with_material({"extensions": extensions}, *pictures), tmp_path)
    value = scene.materials[0].kind
    assert isinstance(value, Gltf)
    fields = (
        "clearcoat",
        "clearcoat_roughness",
        "clearcoat_normal",
        "sheen_color",
        "sheen_roughness",
        "anisotropy",
        "iridescence",
        "iridescence_thickness",
    )
    for i, name in enumerate(fields):
        slot = getattr(value, name + "_texture")
        texture = scene.textures[slot.texture]
        assert texture.pixels[0, 0, 0] == 10 * i, name
        # The roughness is only read from alpha, which the transfer curve leaves alone.
        assert texture.srgb is name.startswith("sheen"), name
        assert slot.uv_set == (1 if name == "clearcoat_normal" else 0), name
    assert value.clearcoat_normal_scale == 0.5


@pytest.mark.parametrize(
    ("name", "member", "value", "wanted"),
    [
        ("clearcoat", "clearcoatFactor", 1.5, "wanted 0 .. 1"),
        ("clearcoat", "clearcoatFactor", "1", "wanted a number"),
        ("clearcoat", "clearcoatTexture", {"index": 7}, "index out of range"),
        ("clearcoat", "clearcoatRoughnessFactor", -0.5, "wanted 0 .. 1"),
        ("clearcoat", "clearcoatRoughnessTexture", [], "wanted an object"),
        ("clearcoat", "clearcoatNormalTexture", 1, "wanted an object"),
        ("sheen", "sheenColorFactor", [1, 1], "wanted 3 numbers"),
        ("sheen", "sheenColorFactor", [1, 2, 1], "wanted 0 .. 1"),
        ("sheen", "sheenColorTexture", {"index": "0"}, "wanted an integer"),
        ("sheen", "sheenRoughnessFactor", None, "wanted a number"),
        ("sheen", "sheenRoughnessTexture", {}, "missing"),
        ("anisotropy", "anisotropyStrength", 2, "wanted 0 .. 1"),
        ("anisotropy", "anisotropyRotation", True, "wanted a number"),
        ("anisotropy", "anisotropyTexture", "a", "wanted an object"),
        ("iridescence", "iridescenceFactor", -1, "wanted 0 .. 1"),
        ("iridescence", "iridescenceTexture", {"index": 0, "texCoord": -1}, "texCoord"),
        ("iridescence", "iridescenceIor", 0.5, "at least 1"),
        ("iridescence", "iridescenceThicknessMinimum", -1, "at least 0"),
        ("iridescence", "iridescenceThicknessMaximum", [400], "wanted a number"),
        ("iridescence", "iridescenceThicknessTexture", 4, "wanted an object"),
    ],
)
def test_bad_members_are_refused_with_their_path(tmp_path, name, member, value, wanted):
    b = extended(name, {member: value}, png(np.zeros((1, 1, 3), np.uint8)))
    with pytest.raises(InputError) as error:
        gltf.read(b.glb(tmp_path / "a.glb"))
    message = str(error.value)
    where = f"materials[0].extensions.KHR_materials_{name}.{member}"
    assert "a.glb" in message
    assert where in message
    assert wanted in message


def test_required_layers_are_understood(tmp_path):
    b = extended("sheen", {"sheenColorFactor": [1, 1, 1]})
    b.json["extensionsRequired"] = [f"KHR_materials_{name}" for name in LAYERS]
    assert kind(b, tmp_path).sheen_color == (1, 1, 1)
