"""Principled BSDF as a surface of the renderer.

Source: Blender 5.2 Manual, "Principled BSDF"; Burley 2012, "Physically-based shading at Disney"
(anisotropy). Light that is transmitted is tinted by the square root of the base colour at each
interface, so that a closed body has the colour. A thin wall, which Blender has since 5.2, tints
once and bends nothing.
"""

from __future__ import annotations

import numpy as np

from daguerre.blender.settings import LUMENS_PER_WATT
from daguerre.shading.channels import Value
from daguerre.shading.inputs import refraction_index, stretched
from daguerre.shading.layers import coated, is_set, with_film
from daguerre.shading.surface import GltfInputs

from .closures import WHITE, Closure
from .sockets import Sockets

_COAT_IOR = 1.5
#: Factor on the anisotropy in the aspect ratio sqrt(1 - 0.9 anisotropic) (Burley 2012).
_STRETCH = 0.9


def principled(sockets: Sockets) -> Closure:
    """Reads the sockets of a Principled BSDF."""
    math = sockets.math
    surface = GltfInputs(double_sided=True)
    surface.metallic = math.fraction(sockets.one("Metallic"))
    base = sockets.value("Base Color")
    _reflection(sockets, surface)
    thin = sockets.number("Thin Wall") > 0
    _subsurface(sockets, surface, base, thin=thin)
    surface.transmission = math.fraction(sockets.one("Transmission Weight"))
    if is_set(surface.transmission) and not thin:
        root = math.each(lambda c: np.sqrt(np.maximum(c, 0)), base)
        clear = math.multiply(surface.transmission, math.subtract((1.0,), surface.metallic))
        base, surface.volume = math.mix(base, root, clear), True
    surface.clearcoat = math.fraction(sockets.one("Coat Weight"))
    surface.base_color = coated(sockets.given, base, surface.clearcoat, sockets.value("Coat Tint"))
    _coat(sockets, surface)
    weight = sockets.one("Sheen Weight")
    surface.sheen_color = math.multiply(sockets.value("Sheen Tint"), weight)
    surface.sheen_roughness = sockets.one("Sheen Roughness")
    thickness = sockets.one("Thin Film Thickness")
    if is_set(thickness):
        with_film(surface, (1.0,), thickness, sockets.number("Thin Film IOR"))
    if is_set(sockets.one("Diffuse Roughness")):
        sockets.note("'Diffuse Roughness' is not supported")
    return Closure(surface, emitted(sockets, "Emission "), math.fraction(sockets.one("Alpha")))


def emitted(sockets: Sockets, prefix: str = "") -> Value:
    """Luminance of a colour and a strength, cd/m2."""
    strength = sockets.one(f"{prefix}Strength")
    if not is_set(strength):
        return (0.0, 0.0, 0.0)
    light = sockets.math.multiply(sockets.value(f"{prefix}Color"), strength)
    return sockets.math.multiply(light, (LUMENS_PER_WATT,))


def normal_of(sockets: Sockets, name: str = "Normal") -> Value | None:
    """Normal in the frame of the texture coordinates; None: the mesh's normal."""
    found = sockets.linked(name)
    if found is None or len(found) != 3:
        return None
    if all(isinstance(channel, float) for channel in found):
        return None
    return found


def anisotropic(sockets: Sockets, surface: GltfInputs, name: str, rotation: str) -> None:
    """Stretches highlights: GGX widths r^2 / q and r^2 q, q = sqrt(1 - 0.9 a) (Burley 2012)."""
    amount = sockets.one(name)
    if not is_set(amount):
        return
    if not sockets.is_linked("Tangent"):
        sockets.note("highlights are stretched along the texture coordinates")

    def aspect(a: object) -> object:
        return np.sqrt(1 - _STRETCH * np.clip(np.asarray(a), 0, 1))

    each, roughness = sockets.math.each, surface.roughness
    along = each(lambda r, a: np.minimum(r * r / aspect(a), 1), roughness, amount)
    across = each(lambda r, a: r * r * aspect(a), roughness, amount)
    surface.roughness, surface.anisotropy = stretched(sockets.given, along, across)
    surface.anisotropy_rotation = 360.0 * sockets.number(rotation)


def _reflection(sockets: Sockets, surface: GltfInputs) -> None:
    """Specular light: the level scales reflectance at normal incidence, 0.5 changing nothing."""
    math = sockets.math
    surface.roughness = math.fraction(sockets.one("Roughness"))
    surface.ior = refraction_index(sockets.given, sockets.number("IOR"))
    level = sockets.one("Specular IOR Level")
    tint = sockets.value("Specular Tint")
    surface.specular = (1.0,) if is_set(level) else (0.0,)
    surface.specular_color = math.multiply(tint, math.multiply(level, (2.0,)))
    if is_set(surface.metallic) and tint != WHITE:
        sockets.note("'Specular Tint' does not colour the edges of metals")
    surface.normal = normal_of(sockets)
    anisotropic(sockets, surface, "Anisotropic", "Anisotropic Rotation")


def _subsurface(sockets: Sockets, surface: GltfInputs, base: Value, *, thin: bool) -> None:
    """Scattering below the surface; out of a thin wall a share of (1 + g) / 2 goes on.

    g is the anisotropy. Cycles of Blender 5.2 shows these shares within 0.1 %.
    """
    weight = sockets.math.fraction(sockets.one("Subsurface Weight"))
    if not is_set(weight):
        return
    if not thin:
        sockets.note("subsurface scattering is shown as diffuse light of its colour")
        return
    onward = (1 + sockets.number("Subsurface Anisotropy")) / 2
    surface.diffuse_transmission = sockets.math.multiply(weight, (onward,))
    surface.diffuse_transmission_color = base


def _coat(sockets: Sockets, surface: GltfInputs) -> None:
    surface.clearcoat_roughness = sockets.math.fraction(sockets.one("Coat Roughness"))
    surface.clearcoat_normal = normal_of(sockets, "Coat Normal")
    if is_set(surface.clearcoat) and sockets.number("Coat IOR") != _COAT_IOR:
        sockets.note("a coat has the index of refraction 1.5")
