"""Materials, textures, samplers, and the members of every extension of materials."""

from __future__ import annotations

from tests.support.formats.make_gltf import Builder

from .bases import full, seen
from .case import Case, Change, both, drawn, put, scenes

M = r"materials\[0\]\."
E = "materials.0.extensions."

BAD: dict[str, tuple[Change, str]] = {
    "base colour": (
        put("materials.0.pbrMetallicRoughness.baseColorFactor", [1, 1, 1]),
        r"baseColorFactor: wrong length: wanted 4 numbers, got 3",
    ),
    "negative colour": (
        put("materials.0.pbrMetallicRoughness.baseColorFactor", [1, -1, 1, 1]),
        r"baseColorFactor\[1\]: out of range: wanted 0 \.\. 1",
    ),
    "roughness": (
        put("materials.0.pbrMetallicRoughness.roughnessFactor", 2),
        r"materials\[0\]\.pbrMetallicRoughness\.roughnessFactor: out of range",
    ),
    "alpha mode": (put("materials.0.alphaMode", "FADE"), r"alphaMode: unknown value: .* 'FADE'"),
    "double sided": (put("materials.0.doubleSided", 1), r"doubleSided: wrong type"),
    "ior": (
        put("materials.0.extensions.KHR_materials_ior.ior", 0.5),
        r"materials\[0\]\.extensions\.KHR_materials_ior\.ior: out of range: wanted 0 or at least 1",
    ),
    "extension is a list": (put("materials.0.extensions", []), r"extensions: wrong type"),
    "emission": (put("materials.0.emissiveFactor", [-1, 0, 0]), r"emissiveFactor\[0\]: out of ran"),
    "attenuation": (
        put("materials.0.extensions.KHR_materials_volume", {"attenuationDistance": 0}),
        r"attenuationDistance: out of range: wanted a number above 0",
    ),
    "texture out of range": (
        put("materials.0.normalTexture", {"index": 1}),
        r"materials\[0\]\.normalTexture\.index: index out of range: wanted 0 \.\. 0 \(textures\)",
    ),
    "texture without index": (put("materials.0.normalTexture", {}), r"index: missing"),
    "texture set": (put("materials.0.normalTexture", {"index": 0, "texCoord": -1}), r"texCoord: "),
    "texture scale": (
        put(
            "materials.0.pbrMetallicRoughness.baseColorTexture.extensions.KHR_texture_transform",
            {"scale": 2},
        ),
        r"KHR_texture_transform\.scale: wrong type: wanted a list of 2 numbers, got 2",
    ),
    "image out of range": (put("textures.0.source", 7), r"textures\[0\]\.source: index out of"),
    "sampler out of range": (put("textures.0.sampler", 7), r"textures\[0\]\.sampler: index out"),
    "wrap": (put("samplers.0.wrapS", 5), r"samplers\[0\]\.wrapS: unknown value"),
    "filter": (put("samplers.0.minFilter", 5), r"samplers\[0\]\.minFilter: unknown value"),
    "image from nowhere": (put("images.0", {}), r"images\[0\]: wanted either a uri or a bufferVi"),
    "image view": (put("images.0.bufferView", 77), r"images\[0\]\.bufferView: index out of range"),
    "image a folder": (
        put("images.0", {"uri": ".", "name": "wood"}),
        r"images\[0\]\.uri: '.*': wanted a file, got a folder",
    ),
    "image is text": (
        put("images.0", {"uri": "data:image/png;base64,aGVsbG8=", "name": "wood"}),
        r"images\[0\] \('wood'\): wanted a PNG, JPEG, WebP or KTX2 image, got b'hello'",
    ),
    "data without comma": (
        put("images.0", {"uri": "data:x"}),
        r"images\[0\]\.uri: broken data URI",
    ),
    "data not base64": (
        put("images.0", {"uri": "data:image/png;base64,!!"}),
        r"images\[0\]\.uri: broken data URI",
    ),
    "material is null": (put("materials.0", None), r"materials\[0\]: wrong type"),
    "materials is text": (put("materials", "all"), r"materials: wrong type"),
    "pbr is a list": (put("materials.0.pbrMetallicRoughness", []), M + "pbrMetal.*: wrong type"),
    "metallic is text": (
        put("materials.0.pbrMetallicRoughness.metallicFactor", "1"),
        M + r"pbrMetallicRoughness\.metallicFactor: wrong type",
    ),
    "roughness is null": (
        put("materials.0.pbrMetallicRoughness.roughnessFactor", None),
        M + r"pbrMetallicRoughness\.roughnessFactor: wrong type",
    ),
    "roughness is negative": (
        put("materials.0.pbrMetallicRoughness.roughnessFactor", -0.1),
        M + r"pbrMetallicRoughness\.roughnessFactor: out of range",
    ),
    "base colour of 2": (
        put("materials.0.pbrMetallicRoughness.baseColorFactor", [2, 0, 0, 1]),
        r"baseColorFactor\[0\]: out of range",
    ),
    "alpha mode is a list": (put("materials.0.alphaMode", ["MASK"]), r"alphaMode: wrong type"),
    "alpha cutoff": (put("materials.0.alphaCutoff", -1), M + r"alphaCutoff: out of range"),
    "normal scale is text": (
        put("materials.0.normalTexture", {"index": 0, "scale": "1"}),
        M + r"normalTexture\.scale: wrong type",
    ),
    "normal texture is 0": (put("materials.0.normalTexture", 0), M + r"normalTexture: wrong type"),
    "texture index is text": (
        put("materials.0.normalTexture", {"index": "0"}),
        M + r"normalTexture\.index: wrong type",
    ),
    "occlusion out of range": (
        put("materials.0.occlusionTexture", {"index": 3}),
        M + r"occlusionTexture\.index: index out of range",
    ),
    "texture set is text": (
        put("materials.0.normalTexture", {"index": 0, "texCoord": "0"}),
        r"texCoord: wrong type",
    ),
    "texture is null": (put("textures.0", None), r"textures\[0\]: wrong type"),
    "source is text": (put("textures.0.source", "0"), r"textures\[0\]\.source: wrong type"),
    "samplers is an object": (put("samplers", {}), r"samplers: wrong type"),
    "wrap is text": (put("samplers.0.wrapT", "REPEAT"), r"samplers\[0\]\.wrapT: unknown value"),
    "texture rotation": (
        put(
            "materials.0.pbrMetallicRoughness.baseColorTexture.extensions.KHR_texture_transform",
            {"rotation": [1]},
        ),
        r"KHR_texture_transform\.rotation: wrong type",
    ),
    "texture scale of 1e300": (
        put(
            "materials.0.normalTexture",
            {"index": 0, "extensions": {"KHR_texture_transform": {"scale": [1e300, 1]}}},
        ),
        r"KHR_texture_transform\.scale\[0\]: not finite",
    ),
    "emission of 1e300": (
        put("materials.0.emissiveFactor", [1e300, 0, 0]),
        M + r"emissiveFactor\[0\]: not finite",
    ),
    "ior of 1e300": (
        put(E + "KHR_materials_ior.ior", 1e300),
        M + r"extensions\.KHR_materials_ior\.ior: not finite",
    ),
    "alpha cutoff of 1e300": (
        put("materials.0.alphaCutoff", 1e300),
        M + r"alphaCutoff: not finite",
    ),
    "emission times strength": (
        both(
            put("materials.0.emissiveFactor", [1e30, 1, 1]),
            put(E + "KHR_materials_emissive_strength.emissiveStrength", 1e30),
        ),
        r"material 'material0': emissive: wanted",
    ),
}

#: Members of extensions that are numbers: name, a value out of range.
NUMBERS: dict[str, dict[str, float]] = {
    "KHR_materials_anisotropy": {"anisotropyStrength": 2},
    "KHR_materials_clearcoat": {"clearcoatFactor": -1, "clearcoatRoughnessFactor": 2},
    "KHR_materials_dispersion": {"dispersion": -1},
    "KHR_materials_emissive_strength": {"emissiveStrength": -1},
    "KHR_materials_ior": {"ior": 0.5},
    "KHR_materials_iridescence": {
        "iridescenceFactor": -1,
        "iridescenceIor": 0.5,
        "iridescenceThicknessMaximum": -1,
        "iridescenceThicknessMinimum": -1,
    },
    "KHR_materials_sheen": {"sheenRoughnessFactor": 2},
    "KHR_materials_specular": {"specularFactor": -1},
    "KHR_materials_transmission": {"transmissionFactor": 2},
    "KHR_materials_volume": {"thicknessFactor": -1, "attenuationDistance": 0},
}
COLORS = {
    "KHR_materials_sheen": "sheenColorFactor",
    "KHR_materials_specular": "specularColorFactor",
    "KHR_materials_volume": "attenuationColor",
}
TEXTURES = {
    "KHR_materials_anisotropy": ("anisotropyTexture",),
    "KHR_materials_clearcoat": (
        "clearcoatTexture",
        "clearcoatRoughnessTexture",
        "clearcoatNormalTexture",
    ),
    "KHR_materials_iridescence": ("iridescenceTexture", "iridescenceThicknessTexture"),
    "KHR_materials_sheen": ("sheenColorTexture", "sheenRoughnessTexture"),
    "KHR_materials_specular": ("specularTexture", "specularColorTexture"),
    "KHR_materials_transmission": ("transmissionTexture",),
}
#: A value for every number at once: the most that a material can be.
EVERYTHING = {
    "KHR_materials_anisotropy": {"anisotropyStrength": 1, "anisotropyRotation": 1e6},
    "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0},
    "KHR_materials_dispersion": {"dispersion": 1},
    "KHR_materials_emissive_strength": {"emissiveStrength": 1e30},
    "KHR_materials_ior": {"ior": 1e30},
    "KHR_materials_iridescence": {
        "iridescenceFactor": 1,
        "iridescenceIor": 1e6,
        "iridescenceThicknessMinimum": 1e6,
        "iridescenceThicknessMaximum": 0,
    },
    "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1], "sheenRoughnessFactor": 0},
    "KHR_materials_specular": {"specularFactor": 1, "specularColorFactor": [1e30, 0, 1]},
    "KHR_materials_transmission": {"transmissionFactor": 1},
    "KHR_materials_volume": {"thicknessFactor": 1e30, "attenuationDistance": 1e-30},
}


def extension_cases() -> dict[str, tuple[Change, str]]:
    """Every member of every extension with the wrong type, out of range, or to nowhere."""
    cases: dict[str, tuple[Change, str]] = {}
    for name, members in NUMBERS.items():
        where = rf"{M}extensions\.{name}"
        cases[f"{name} is a list"] = (put(E + name, []), where + ": wrong type")
        for member, value in members.items():
            place = where + r"\." + member
            cases[f"{member} is text"] = (put(f"{E}{name}.{member}", "1"), place + ": wrong type")
            cases[f"{member} is {value}"] = (
                put(f"{E}{name}.{member}", value),
                place + ": out of range",
            )
    for name, member in COLORS.items():
        place = rf"{M}extensions\.{name}\.{member}"
        cases[f"{member} of two"] = (put(f"{E}{name}.{member}", [1, 1]), place + ": wrong length")
        cases[f"{member} negative"] = (
            put(f"{E}{name}.{member}", [1, 1, -1]),
            place + r"\[2\]: out of range",
        )
    for name, textures in TEXTURES.items():
        for member in textures:
            place = rf"{M}extensions\.{name}\.{member}"
            cases[f"{member} to nowhere"] = (
                put(f"{E}{name}.{member}", {"index": 9}),
                place + r"\.index: index out of range",
            )
            cases[f"{member} is 0"] = (put(f"{E}{name}.{member}", 0), place + ": wrong type")
    return cases


def factors(value: float) -> Change:
    """Every factor of the metallic-roughness model at once."""
    pbr = "materials.0.pbrMetallicRoughness."
    return both(
        put(pbr + "baseColorFactor", [value] * 4),
        put(pbr + "metallicFactor", value),
        put(pbr + "roughnessFactor", value),
    )


def everything(b: Builder) -> None:
    b.json["materials"][0]["extensions"] = EVERYTHING


ODD: dict[str, tuple[Change, str]] = {
    "all 0": (factors(0), ""),
    "all 1": (factors(1), ""),
    "all denormal": (factors(1e-42), ""),
    "every extension": (everything, ""),
    **{f"only {name}": (put(E + name, members), "") for name, members in EVERYTHING.items()},
    **{f"empty {name}": (put(E + name, {}), "") for name in EVERYTHING},
    "emission of 1e38": (
        put("materials.0.emissiveFactor", [1e38, 1e38, 1e38]),
        "samples were NaN or infinite",
    ),
    "emission of 1e-300": (put("materials.0.emissiveFactor", [1e-300, 0, 0]), ""),
    "emission of a denormal": (put("materials.0.emissiveFactor", [1e-42, 0, 0]), ""),
    "ior of 1": (put(E + "KHR_materials_ior.ior", 1), ""),
    "normal scale of 1e30": (put("materials.0.normalTexture.scale", 1e30), ""),
    "normal scale of -1": (put("materials.0.normalTexture.scale", -1), ""),
    "texture scale of 1e30": (
        put(
            "materials.0.normalTexture.extensions",
            {"KHR_texture_transform": {"scale": [1e30, 1e30], "offset": [1e30, -1e30]}},
        ),
        "",
    ),
    "texture rotated by 1e30": (
        put(
            "materials.0.normalTexture.extensions",
            {"KHR_texture_transform": {"rotation": 1e30}},
        ),
        "",
    ),
    "texture set 2^40": (
        put("materials.0.normalTexture", {"index": 0, "texCoord": 2**40}),
        "other than sets 0 and 1 is left out",
    ),
    "unknown extension": (put(E + "VENDOR_glow", {"a": 1}), "VENDOR_glow.* is not supported"),
}
CASES: list[Case] = [
    *scenes("material", BAD, full),
    *scenes("material", extension_cases(), full),
    *drawn("surface", ODD, seen),
]
