"""Shaders of Blender besides the Principled BSDF.

Source: Blender 5.0 Manual, "Shader Nodes".
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from daguerre.blender.settings import LUMENS_PER_WATT
from daguerre.shading.channels import numbers_of
from daguerre.shading.inputs import refraction_index
from daguerre.shading.layers import is_set, with_film
from daguerre.shading.surface import GltfInputs

from .closures import BLACK, WHITE, Closure, mirror
from .principled import anisotropic, emitted, normal_of, principled
from .sockets import Sockets

Shader = Callable[[Sockets], Closure]


def diffuse(sockets: Sockets) -> Closure:
    """Diffuse BSDF."""
    if "Roughness" in sockets.given.node.inputs and is_set(sockets.one("Roughness")):
        sockets.note("'Roughness' is not supported")
    return Closure(_matte(sockets))


def subsurface(sockets: Sockets) -> Closure:
    """Subsurface Scattering: diffuse light of its colour."""
    sockets.note("subsurface scattering is shown as diffuse light of its colour")
    return Closure(_matte(sockets))


def other(sockets: Sockets) -> Closure:
    """Shader without a counterpart: diffuse light of its colour, or nothing."""
    if "Color" not in sockets.given.node.inputs:
        sockets.note("the shader is not supported: it is black")
        return Closure()
    sockets.note("the shader is not supported: it is diffuse light of its colour")
    return Closure(_matte(sockets))


def translucent(sockets: Sockets) -> Closure:
    """Translucent BSDF: diffuse light on the other side."""
    surface = _matte(sockets)
    surface.diffuse_transmission = (1.0,)
    surface.diffuse_transmission_color = surface.base_color
    return Closure(surface)


def glossy(sockets: Sockets) -> Closure:
    """Glossy BSDF: gloss of a constant reflectance."""
    roughness = sockets.math.fraction(sockets.one("Roughness"))
    surface = mirror(sockets.math, sockets.math.fraction(sockets.value("Color")), roughness)
    surface.normal = normal_of(sockets)
    if is_set(sockets.one("Anisotropy")):
        anisotropic(sockets, surface, "Anisotropy", "Rotation")
    return Closure(surface)


def metallic(sockets: Sockets) -> Closure:
    """Metallic BSDF: by the colour at normal incidence, or by complex indices."""
    surface = GltfInputs(metallic=(1.0,), double_sided=True)
    surface.roughness = sockets.math.fraction(sockets.one("Roughness"))
    if sockets.text("fresnel_type") == "PHYSICAL_CONDUCTOR":
        n, k = sockets.value("IOR"), sockets.value("Extinction")
        surface.base_color = sockets.math.each(_conductor, n, k)
    else:
        surface.base_color = sockets.math.fraction(sockets.value("Base Color"))
        if sockets.value("Edge Tint") != WHITE:
            sockets.note("'Edge Tint' is not supported")
    surface.normal = normal_of(sockets)
    if is_set(sockets.one("Anisotropy")):
        anisotropic(sockets, surface, "Anisotropy", "Rotation")
    return Closure(surface)


def _conductor(n: object, k: object) -> object:
    """Reflectance of a metal at normal incidence (Born and Wolf, section 14.2)."""
    index, extinction = np.asarray(n), np.asarray(k)
    square = extinction**2
    return ((index - 1) ** 2 + square) / ((index + 1) ** 2 + square)


def glass(sockets: Sockets) -> Closure:
    """Glass BSDF: each interface tints reflected and transmitted light."""
    surface = _clear(sockets)
    surface.specular_color = surface.base_color
    if "Thin Film Thickness" in sockets.given.node.inputs:
        thickness = sockets.one("Thin Film Thickness")
        if is_set(thickness):
            with_film(surface, (1.0,), thickness, sockets.number("Thin Film IOR"))
    return Closure(surface)


def refraction(sockets: Sockets) -> Closure:
    """Refraction BSDF: glass that reflects nothing."""
    surface = _clear(sockets)
    surface.specular = (0.0,)
    return Closure(surface)


def sheen(sockets: Sockets) -> Closure:
    """Sheen BSDF, over black."""
    surface = GltfInputs(base_color=BLACK, specular=(0.0,), double_sided=True)
    surface.sheen_color = sockets.math.fraction(sockets.value("Color"))
    surface.sheen_roughness = sockets.math.fraction(sockets.one("Roughness"))
    return Closure(surface)


def specular(sockets: Sockets) -> Closure:
    """Specular BSDF: a diffuse colour, and the reflectance at normal incidence."""
    math = sockets.math
    surface = GltfInputs(ior=0.0, double_sided=True)
    surface.base_color = sockets.value("Base Color")
    surface.specular_color = sockets.value("Specular")
    surface.roughness = math.fraction(sockets.one("Roughness"))
    surface.clearcoat = math.fraction(sockets.one("Clear Coat"))
    surface.clearcoat_roughness = math.fraction(sockets.one("Clear Coat Roughness"))
    surface.normal = normal_of(sockets)
    light = math.multiply(sockets.value("Emissive Color"), (LUMENS_PER_WATT,))
    cover = math.subtract((1.0,), math.fraction(sockets.one("Transparency")))
    return Closure(surface, light, cover)


def emission(sockets: Sockets) -> Closure:
    """Emission."""
    return Closure(None, emitted(sockets))


def transparent(sockets: Sockets) -> Closure:
    """Transparent BSDF: a colour is averaged."""
    color = sockets.math.fraction(sockets.value("Color"))
    numbers = numbers_of(color)
    if numbers is None or len(set(numbers)) > 1:
        sockets.note("the colour of transmitted light is averaged")
    mean = sockets.math.multiply(sockets.math.dot(color, WHITE), (1 / 3,))
    return Closure(None, BLACK, sockets.math.fraction(sockets.math.subtract((1.0,), mean)))


def _matte(sockets: Sockets) -> GltfInputs:
    surface = GltfInputs(specular=(0.0,), roughness=(1.0,), double_sided=True)
    surface.base_color = sockets.value("Color")
    surface.normal = normal_of(sockets)
    return surface


def _clear(sockets: Sockets) -> GltfInputs:
    surface = GltfInputs(transmission=(1.0,), volume=True, double_sided=True)
    surface.base_color = sockets.math.fraction(sockets.value("Color"))
    surface.roughness = sockets.math.fraction(sockets.one("Roughness"))
    surface.ior = refraction_index(sockets.given, sockets.number("IOR"))
    surface.normal = normal_of(sockets)
    return surface


#: Functions of the shaders, by kind.
SHADERS: dict[str, Shader] = {
    "ShaderNodeBsdfPrincipled": principled,
    "ShaderNodeBsdfDiffuse": diffuse,
    "ShaderNodeSubsurfaceScattering": subsurface,
    "ShaderNodeBsdfTranslucent": translucent,
    "ShaderNodeBsdfGlossy": glossy,
    "ShaderNodeBsdfAnisotropic": glossy,
    "ShaderNodeBsdfMetallic": metallic,
    "ShaderNodeBsdfGlass": glass,
    "ShaderNodeBsdfRefraction": refraction,
    "ShaderNodeBsdfSheen": sheen,
    "ShaderNodeEeveeSpecular": specular,
    "ShaderNodeEmission": emission,
    "ShaderNodeBackground": emission,
    "ShaderNodeBsdfTransparent": transparent,
}
