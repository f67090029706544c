"""MaterialX's gltf_pbr and surface_unlit as surfaces of the renderer.

Source: the definitions in MaterialX 1.39 (libraries/bxdf/gltf_pbr.mtlx), glTF 2.0.
"""

from __future__ import annotations

import math

from .channels import Value
from .evaluate import Arguments
from .inputs import constant, constants, normal_of, refraction_index
from .layers import is_set
from .surface import GltfInputs

_WHITE: Value = (1.0, 1.0, 1.0)
_BLACK: Value = (0.0, 0.0, 0.0)
_MODES = ("opaque", "mask", "blend")


def gltf_pbr(given: Arguments, metres_per_unit: float) -> GltfInputs:
    """Reads the inputs of a gltf_pbr; lengths are in scene units."""
    arithmetic, surface = given.context.math, GltfInputs()
    surface.base_color = given.value("base_color", _WHITE)
    surface.metallic = given.value("metallic", (1.0,))
    surface.roughness = given.value("roughness", (1.0,))
    surface.normal = normal_of(given, "normal")
    surface.alpha = given.value("alpha", (1.0,))
    mode = int(min(max(given.number("alpha_mode", 0.0), 0.0), 2.0))
    surface.alpha_mode = _MODES[mode]
    surface.alpha_cutoff = max(given.number("alpha_cutoff", 0.5), 0.0)
    surface.ior = refraction_index(given, constant(given, "ior", 1.5))
    surface.specular = given.value("specular", (1.0,))
    surface.specular_color = given.value("specular_color", _WHITE)
    surface.transmission = given.value("transmission", (0.0,))
    surface.volume = constant(given, "thickness", 0.0) > 0
    distance = constant(given, "attenuation_distance", 0.0) * metres_per_unit
    surface.attenuation_distance = distance if distance > 0 else math.inf
    surface.attenuation_color = constants(given, "attenuation_color", (1.0, 1.0, 1.0))
    surface.dispersion = max(constant(given, "dispersion", 0.0), 0.0)
    surface.sheen_color = given.value("sheen_color", _BLACK)
    surface.sheen_roughness = given.value("sheen_roughness", (0.0,))
    surface.clearcoat = given.value("clearcoat", (0.0,))
    surface.clearcoat_roughness = given.value("clearcoat_roughness", (0.0,))
    surface.clearcoat_normal = normal_of(given, "clearcoat_normal")
    surface.iridescence = given.value("iridescence", (0.0,))
    surface.iridescence_ior = max(constant(given, "iridescence_ior", 1.3), 1.0)
    surface.iridescence_thickness_nm = given.value("iridescence_thickness", (100.0,))
    surface.anisotropy = given.value("anisotropy_strength", (0.0,))
    if is_set(surface.anisotropy):
        turn = constant(given, "anisotropy_rotation", 0.0)
        surface.anisotropy_rotation = math.degrees(turn)
    surface.emissive = arithmetic.multiply(
        given.value("emissive", _BLACK), given.value("emissive_strength", (1.0,))
    )
    return surface


def surface_unlit(given: Arguments) -> GltfInputs:
    """Surface that emits to both sides and reflects nothing."""
    arithmetic = given.context.math
    surface = GltfInputs(base_color=_BLACK, specular=(0.0,), roughness=(1.0,), double_sided=True)
    surface.emissive = arithmetic.multiply(
        given.value("emission_color", _WHITE), given.value("emission", (1.0,))
    )
    opacity = given.value("opacity", (1.0,))
    if opacity != (1.0,):
        surface.alpha, surface.alpha_mode = opacity, "blend"
    if is_set(given.value("transmission", (0.0,))):
        given.context.notes.add("surface_unlit: 'transmission' is not supported")
    return surface
