"""Reads materials of pbrt-v3 with names that pbrt-v4 does not have.

Materials that are sums of lobes have no exact twin here; a note names the nearest.

Source: pbrt-v3's file format; Pharr, Jakob and Humphreys 2016, section 9.2.
"""

from __future__ import annotations

import math

from daguerre.scene.materials import Coated, Conductor, Dielectric, Diffuse, Gltf, Kind

from .materials import OF_V4, Appearance, Reader, Tools, measured, metal, mixed, subsurface
from .spectra import Color, luminance
from .state import Entity
from .textures import Shade

_HALF, _QUARTER, _WHITE = (0.5,) * 3, (0.25,) * 3, (1.0,) * 3


def matte(entity: Entity, tools: Tools) -> Kind:
    """Reads ``matte``."""
    shade = tools.textures.color(entity, "Kd", _HALF)
    if tools.textures.mean(entity, "sigma", 0.0) != 0:
        tools.note("'sigma' of a matte material is left out: the material is Lambertian")
    return Diffuse(shade.color, shade.slot)


def plastic(entity: Entity, tools: Tools) -> Kind:
    """Reads ``plastic`` as a coated diffuse surface."""
    _tell(tools, "plastic", "a coated diffuse surface")
    return _coated(entity, tools, _QUARTER, _QUARTER, 1.5)


def uber(entity: Entity, tools: Tools) -> Kind | Appearance:
    """Reads ``uber`` as a coated diffuse surface, partly transparent."""
    _tell(tools, "uber", "a coated diffuse surface")
    for name in ("Kr", "Kt"):
        if max(tools.textures.color(entity, name, (0.0, 0.0, 0.0)).color) > 0:
            tools.note(f"{name!r} of an uber material is left out")
    entity.parameters.find("index" if tools.textures.has(entity, "eta") else "eta")
    ior = tools.indices.glass(entity, ("eta", "index"), 1.5)
    kind = _coated(entity, tools, _QUARTER, _QUARTER, ior if isinstance(ior, float) else 1.5)
    shade = tools.textures.color(entity, "opacity", _WHITE)
    if shade.slot is None and min(shade.color) == 1:
        return kind
    return Appearance(kind, opacity=min(luminance(shade.color), 1.0), opacity_slot=shade.slot)


def substrate(entity: Entity, tools: Tools) -> Kind:
    """Reads ``substrate`` as a coated diffuse surface; ``Ks`` is the coat's reflectance head on."""
    _tell(tools, "substrate", "a coated diffuse surface")
    shade = tools.textures.color(entity, "Ks", _HALF)
    root = math.sqrt(min(luminance(shade.color), 0.6))
    ior = (1 + root) / (1 - root)
    base = tools.textures.color(entity, "Kd", _HALF)
    rough = tools.roughness(entity, 0.1)
    return Coated(Diffuse(base.color, base.slot), ior, rough.alpha, rough.alpha_v, rough.slot)


def mirror(entity: Entity, tools: Tools) -> Kind:
    """Reads ``mirror``."""
    shade = tools.textures.color(entity, "Kr", (0.9, 0.9, 0.9))
    return Conductor(shade.color, 0.0, shade.slot)


def glass(entity: Entity, tools: Tools) -> Kind:
    """Reads ``glass``."""
    through = _untextured(tools, tools.textures.color(entity, "Kt", _WHITE), "Kt")
    back = _untextured(tools, tools.textures.color(entity, "Kr", _WHITE), "Kr")
    ior = tools.indices.glass(entity, ("eta", "index"), 1.5)
    rough = tools.roughness(entity)
    return Dielectric(
        ior,
        rough.alpha,
        through,
        alpha_v=rough.alpha_v,
        alpha_texture=rough.slot,
        reflection_tint=back,
    )


def of_metal(entity: Entity, tools: Tools) -> Kind:
    """Reads ``metal``."""
    return metal(entity, tools, "", 0.01)


def translucent(entity: Entity, tools: Tools) -> Kind:
    """Reads ``translucent`` as a diffuse surface that light passes through."""
    _tell(tools, "translucent", "a diffuse surface that lets light through")
    shade = tools.textures.color(entity, "Kd", _QUARTER)
    back = _untextured(tools, tools.textures.color(entity, "reflect", _HALF), "reflect")
    through = _untextured(tools, tools.textures.color(entity, "transmit", _HALF), "transmit")
    for name in ("Ks", "roughness", "remaproughness"):
        entity.parameters.find(name)
    return Diffuse(
        _product(shade.color, back), shade.slot, _product(shade.color, through), shade.slot
    )


def disney(entity: Entity, tools: Tools) -> Kind:
    """Reads ``disney`` as the material model of glTF, which is its near relative."""
    _tell(tools, "disney", "the material of glTF")
    shade = tools.textures.color(entity, "color", _HALF)
    mean = tools.textures.mean
    ior = tools.indices.glass(entity, ("eta",), 1.5)
    for name in ("anisotropic", "spectint", "sheentint", "scatterdistance", "thin", "flatness"):
        entity.parameters.find(name)
    return Gltf(
        base_color=shade.color,
        base_color_texture=shade.slot,
        metallic=_share(mean(entity, "metallic", 0.0)),
        roughness=_share(mean(entity, "roughness", 0.5)),
        transmission=_share(mean(entity, "spectrans", 0.0)),
        clearcoat=_share(mean(entity, "clearcoat", 0.0)),
        clearcoat_roughness=1 - _share(mean(entity, "clearcoatgloss", 1.0)),
        sheen_color=(_share(mean(entity, "sheen", 0.0)),) * 3,
        ior=ior if isinstance(ior, float) else 1.5,
        double_sided=True,
    )


def mix(entity: Entity, tools: Tools) -> Kind | Appearance:
    """Reads ``mix``; in pbrt-v3 ``amount`` is the share of the first material."""
    if tools.textures.has(entity, "materials"):
        return OF_V4["mix"](entity, tools)
    names = [entity.parameters.text(name) for name in ("namedmaterial1", "namedmaterial2")]
    if not all(names):
        entity.place.fail("namedmaterial1, namedmaterial2: both are needed")
    return mixed(entity, tools, names[1], names[0])


def _coated(entity: Entity, tools: Tools, base: Color, coat: Color, ior: float) -> Coated:
    shade = tools.textures.color(entity, "Kd", base)
    tint = _untextured(tools, tools.textures.color(entity, "Ks", coat), "Ks")
    rough = tools.roughness(entity, 0.1)
    return Coated(
        Diffuse(shade.color, shade.slot),
        ior,
        rough.alpha,
        rough.alpha_v,
        rough.slot,
        specular_tint=tint,
    )


def _untextured(tools: Tools, shade: Shade, name: str) -> Color:
    if shade.slot is not None:
        tools.note(f"a texture of {name!r} is left out")
    return shade.color


def _product(first: Color, second: Color) -> Color:
    red, green, blue = (a * b for a, b in zip(first, second, strict=True))
    return red, green, blue


def _share(value: float) -> float:
    return min(max(value, 0.0), 1.0)


def _tell(tools: Tools, kind: str, twin: str) -> None:
    tools.note(f"a material of kind {kind!r} of pbrt-v3 is drawn as {twin}")


OF_V3: dict[str, Reader] = {
    "matte": matte,
    "plastic": plastic,
    "uber": uber,
    "substrate": substrate,
    "mirror": mirror,
    "glass": glass,
    "metal": of_metal,
    "translucent": translucent,
    "disney": disney,
    "kdsubsurface": subsurface,
    "fourier": measured,
    "mix": mix,
}
