"""Reads materials of pbrt-v3 with names that pbrt-v4 does not have.

Materials that are sums of lobes have no exact twin here; a note names the nearest.

Source: pbrt-v3's file format; Pharr, Jakob and Humphreys 2016, section 9.2.
"""

from __future__ import annotations

import math

from daguerre.scene.materials import Coated, Conductor, Dielectric, Diffuse, Gltf, Kind

from .materials import OF_V4, Appearance, Reader, Tools, measured, metal, mixed, subsurface
from .spectra import Color, luminance
from .state import Made
from .textures import Shade

_HALF, _QUARTER, _WHITE = (0.5,) * 3, (0.25,) * 3, (1.0,) * 3


def matte(made: Made, tools: Tools) -> Kind:
    """Reads ``matte``."""
    shade = tools.textures.color(made, "Kd", _HALF)
    if tools.textures.mean(made, "sigma", 0.0) != 0:
        tools.note("'sigma' of a matte material is left out: the material is Lambertian")
    return Diffuse(shade.color, shade.slot)


def plastic(made: Made, tools: Tools) -> Kind:
    """Reads ``plastic`` as a coated diffuse surface."""
    _tell(tools, "plastic", "a coated diffuse surface")
    return _coated(made, tools, _QUARTER, _QUARTER, 1.5)


def uber(made: Made, tools: Tools) -> Kind | Appearance:
    """Reads ``uber`` as a coated diffuse surface, partly transparent."""
    _tell(tools, "uber", "a coated diffuse surface")
    for name in ("Kr", "Kt"):
        if max(tools.textures.color(made, name, (0.0, 0.0, 0.0)).color) > 0:
            tools.note(f"{name!r} of an uber material is left out")
    made.parameters.find("index" if tools.textures.has(made, "eta") else "eta")
    ior = tools.indices.glass(made, ("eta", "index"), 1.5)
    kind = _coated(made, tools, _QUARTER, _QUARTER, ior if isinstance(ior, float) else 1.5)
    shade = tools.textures.color(made, "opacity", _WHITE)
    if shade.slot is None and min(shade.color) == 1:
        return kind
    return Appearance(kind, opacity=min(luminance(shade.color), 1.0), opacity_slot=shade.slot)


def substrate(made: Made, tools: Tools) -> Kind:
    """Reads ``substrate`` as a coated diffuse surface; ``Ks`` is the coat's reflectance head on."""
    _tell(tools, "substrate", "a coated diffuse surface")
    shade = tools.textures.color(made, "Ks", _HALF)
    root = math.sqrt(min(luminance(shade.color), 0.6))
    ior = (1 + root) / (1 - root)
    base = tools.textures.color(made, "Kd", _HALF)
    rough = tools.roughness(made, 0.1)
    return Coated(Diffuse(base.color, base.slot), ior, rough.alpha, rough.alpha_v, rough.slot)


def mirror(made: Made, tools: Tools) -> Kind:
    """Reads ``mirror``."""
    shade = tools.textures.color(made, "Kr", (0.9, 0.9, 0.9))
    return Conductor(shade.color, 0.0, shade.slot)


def glass(made: Made, tools: Tools) -> Kind:
    """Reads ``glass``."""
    through = _untextured(tools, tools.textures.color(made, "Kt", _WHITE), "Kt")
    back = _untextured(tools, tools.textures.color(made, "Kr", _WHITE), "Kr")
    ior = tools.indices.glass(made, ("eta", "index"), 1.5)
    rough = tools.roughness(made)
    return Dielectric(
        ior,
        rough.alpha,
        through,
        alpha_v=rough.alpha_v,
        alpha_texture=rough.slot,
        reflection_tint=back,
    )


def of_metal(made: Made, tools: Tools) -> Kind:
    """Reads ``metal``."""
    return metal(made, tools, "", 0.01)


def translucent(made: Made, tools: Tools) -> Kind:
    """Reads ``translucent`` as a diffuse surface that light passes through."""
    _tell(tools, "translucent", "a diffuse surface that lets light through")
    shade = tools.textures.color(made, "Kd", _QUARTER)
    back = _untextured(tools, tools.textures.color(made, "reflect", _HALF), "reflect")
    through = _untextured(tools, tools.textures.color(made, "transmit", _HALF), "transmit")
    for name in ("Ks", "roughness", "remaproughness"):
        made.parameters.find(name)
    return Diffuse(
        _product(shade.color, back), shade.slot, _product(shade.color, through), shade.slot
    )


def disney(made: Made, tools: Tools) -> Kind:
    """Reads ``disney`` as the material model of glTF, which is its near relative."""
    _tell(tools, "disney", "the material of glTF")
    shade = tools.textures.color(made, "color", _HALF)
    mean = tools.textures.mean
    ior = tools.indices.glass(made, ("eta",), 1.5)
    for name in ("anisotropic", "spectint", "sheentint", "scatterdistance", "thin", "flatness"):
        made.parameters.find(name)
    return Gltf(
        base_color=shade.color,
        base_color_texture=shade.slot,
        metallic=_share(mean(made, "metallic", 0.0)),
        roughness=_share(mean(made, "roughness", 0.5)),
        transmission=_share(mean(made, "spectrans", 0.0)),
        clearcoat=_share(mean(made, "clearcoat", 0.0)),
        clearcoat_roughness=1 - _share(mean(made, "clearcoatgloss", 1.0)),
        sheen_color=(_share(mean(made, "sheen", 0.0)),) * 3,
        ior=ior if isinstance(ior, float) else 1.5,
        double_sided=True,
    )


def mix(made: Made, tools: Tools) -> Kind | Appearance:
    """Reads ``mix``; in pbrt-v3 ``amount`` is the share of the first material."""
    if tools.textures.has(made, "materials"):
        return OF_V4["mix"](made, tools)
    names = [made.parameters.text(name) for name in ("namedmaterial1", "namedmaterial2")]
    if not all(names):
        made.place.fail("namedmaterial1, namedmaterial2: both are needed")
    return mixed(made, tools, names[1], names[0])


def _coated(made: Made, tools: Tools, base: Color, coat: Color, ior: float) -> Coated:
    shade = tools.textures.color(made, "Kd", base)
    tint = _untextured(tools, tools.textures.color(made, "Ks", coat), "Ks")
    rough = tools.roughness(made, 0.1)
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
