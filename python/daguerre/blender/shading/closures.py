"""Closures of a tree of shaders: coverage, surface parameters and emission.

Blender's shaders are weighted sums of closures; the renderer has a single layered surface. So a mix
becomes a surface with mixed parameters, which is exact for diffuse and glossy light, and for
mixes with a transparent or an emissive surface.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from daguerre.shading.arithmetic import Arithmetic
from daguerre.shading.assemble import LAYERS
from daguerre.shading.channels import Texel, Value, broadcast, numbers_of
from daguerre.shading.layers import is_set
from daguerre.shading.surface import GltfInputs

BLACK: Value = (0.0, 0.0, 0.0)
WHITE: Value = (1.0, 1.0, 1.0)
#: Share that a transparent surface covers so that it can shine.
_LEAST_COVER = 0.1
#: Parameters that count only where their weight does.
_LAYERS = LAYERS | {
    "transmission": ("volume", "attenuation_distance", "attenuation_color", "dispersion"),
}


@dataclass(frozen=True)
class Closure:
    """Sum of shaders.

    Attributes:
        surface: Surface that scatters light; None: it is black.
        emission: Luminance of the share that is covered, cd/m2.
        cover: Share of the surface that is there; light passes straight through the rest.
    """

    surface: GltfInputs | None = None
    emission: Value = BLACK
    cover: Value = (1.0,)


def mirror(arithmetic: Arithmetic, color: Value, roughness: Value) -> GltfInputs:
    """Gloss of a constant reflectance; its largest channel is also that at grazing angles."""
    most = arithmetic.baker.combined(lambda *c: np.maximum(np.maximum(c[0], c[1]), c[2]), *color)
    share = arithmetic.divide(color, (most,))
    surface = GltfInputs(base_color=BLACK, roughness=roughness, ior=0.0, double_sided=True)
    surface.specular, surface.specular_color = (most,), broadcast(share, 3)
    return surface


def is_diffuse(surface: GltfInputs) -> bool:
    """Whether a surface has nothing but diffuse light, on one or both sides."""
    weights = (surface.specular, surface.metallic, surface.transmission, surface.clearcoat)
    return not any(is_set(weight) for weight in (*weights, surface.sheen_color))


def is_mirror(surface: GltfInputs) -> bool:
    """Whether a surface has nothing but gloss of a constant reflectance."""
    clear = is_set(surface.transmission) or is_set(surface.metallic)
    return surface.ior == 0.0 and not clear and surface.base_color == BLACK


def mixed(math: Arithmetic, a: Closure, b: Closure, share: Value) -> tuple[Closure, bool]:
    """Mix of two closures by the share of the second, and whether the mix is exact."""
    cover = math.mix(a.cover, b.cover, share)
    if a.cover == (0.0,):
        share = (1.0,)
    elif b.cover == (0.0,):
        share = (0.0,)
    elif a.cover != b.cover:
        share = math.divide(math.multiply(share, b.cover), cover)
    emission = math.mix(a.emission, b.emission, share)
    surface, exact = _one_surface(math, a.surface, b.surface, share)
    return Closure(surface, emission, cover), exact


def _one_surface(
    math: Arithmetic, a: GltfInputs | None, b: GltfInputs | None, share: Value
) -> tuple[GltfInputs | None, bool]:
    if share == (0.0,) or share == (1.0,) or (a is None and b is None):
        return (b if share == (1.0,) else a), True
    if a is None or b is None:
        one = a if b is None else b
        assert one is not None
        rest = math.subtract((1.0,), share) if b is None else share
        return dimmed(math, one, rest), not is_set(one.metallic)
    if is_diffuse(a) and is_mirror(b):
        return _glossed(math, a, b, share), True
    if is_diffuse(b) and is_mirror(a):
        return _glossed(math, b, a, math.subtract((1.0,), share)), True
    alike = (is_diffuse(a) and is_diffuse(b)) or (is_mirror(a) and is_mirror(b))
    if not alike:
        a, b = as_metal(math, a), as_metal(math, b)
    return parameters_mixed(math, a, b, share), alike


def _glossed(math: Arithmetic, diffuse: GltfInputs, gloss: GltfInputs, share: Value) -> GltfInputs:
    """Diffuse light under gloss: (1 - share) of the diffuse lobe, share of the glossy lobe.

    The renderer dims layers below gloss of reflectance f by 1 - f, which is undone here.
    """
    specular = math.multiply(gloss.specular, share)
    rest = math.divide(math.subtract((1.0,), share), math.subtract((1.0,), specular))
    return replace(
        diffuse,
        base_color=math.multiply(diffuse.base_color, rest),
        roughness=gloss.roughness,
        normal=gloss.normal if diffuse.normal is None else diffuse.normal,
        ior=0.0,
        specular=specular,
        specular_color=gloss.specular_color,
        anisotropy=gloss.anisotropy,
        anisotropy_rotation=gloss.anisotropy_rotation,
    )


def dimmed(math: Arithmetic, surface: GltfInputs, share: Value) -> GltfInputs:
    """Surface that scatters a share of its light."""
    names = ("base_color", "specular", "sheen_color", "clearcoat", "diffuse_transmission_color")
    less: dict[str, Any] = {name: math.multiply(getattr(surface, name), share) for name in names}
    return replace(surface, **less)


def as_metal(math: Arithmetic, surface: GltfInputs) -> GltfInputs:
    """Gloss in the form of a metal, for a mix with a surface of another kind."""
    if not is_mirror(surface):
        return surface
    color = math.multiply(surface.specular_color, surface.specular)
    plain = GltfInputs()
    return replace(
        surface, base_color=color, metallic=(1.0,), ior=plain.ior,
        specular=plain.specular, specular_color=plain.specular_color,
    )  # fmt: skip


def parameters_mixed(math: Arithmetic, a: GltfInputs, b: GltfInputs, share: Value) -> GltfInputs:
    """Surface with mixed parameters; the heavier surface gives parameters that are no values."""
    a, b = _with_layers(a, b), _with_layers(b, a)
    heavier = b if _mean(share) > 0.5 else a
    if not is_set(a.specular) and is_set(b.specular):
        heavier = b  # the index of refraction of the only one that reflects
    elif not is_set(b.specular) and is_set(a.specular):
        heavier = a
    found: dict[str, Any] = {}
    for field in fields(GltfInputs):
        first, second = getattr(a, field.name), getattr(b, field.name)
        if isinstance(first, tuple) and isinstance(second, tuple) and first != second:
            found[field.name] = math.mix(first, second, share)
    return replace(heavier, **found)


def _with_layers(surface: GltfInputs, other: GltfInputs) -> GltfInputs:
    """Surface with parameters of the other surface in its layers without weight."""
    taken = {
        name: getattr(other, name)
        for weight, names in _LAYERS.items()
        if not is_set(getattr(surface, weight))
        for name in names
    }
    if not (is_set(surface.specular) or is_set(surface.metallic)):
        taken["roughness"] = other.roughness
    if surface.diffuse_transmission == (1.0,) and is_diffuse(surface):
        taken["base_color"] = other.base_color
    return replace(surface, **taken)


def _mean(share: Value) -> float:
    numbers = numbers_of(share)
    if numbers:
        return numbers[0]
    return share[0].mean() if isinstance(share[0], Texel) else 0.5


def added(math: Arithmetic, a: Closure, b: Closure) -> tuple[Closure, bool]:
    """Sum of two closures, and whether it is exact; else the stronger one scatters."""
    if a.cover != (1.0,) or b.cover != (1.0,):
        return _added_clear(math, a, b)
    emission = math.add(a.emission, b.emission)
    if a.surface is None or b.surface is None:
        return Closure(a.surface or b.surface, emission), True
    first, second = a.surface, b.surface
    if is_diffuse(second):
        first, second = second, first
    if is_diffuse(first) and is_diffuse(second) and not _passes(first) and not _passes(second):
        total = math.add(first.base_color, second.base_color)
        return Closure(replace(first, base_color=total), emission), True
    if is_diffuse(first) and is_mirror(second):
        doubled = replace(first, base_color=math.multiply(first.base_color, (2.0,)))
        twice = replace(second, specular=math.multiply(second.specular, (2.0,)))
        return Closure(_glossed(math, doubled, twice, (0.5,)), emission), True
    stronger = max(a.surface, b.surface, key=_strength)
    return Closure(stronger, emission), False


def _added_clear(math: Arithmetic, a: Closure, b: Closure) -> tuple[Closure, bool]:
    """Sum with a closure that lets light pass: exact if the other one only shines.

    Nothing that is absent can shine, so a clear surface covers a little.
    """
    clear, other = (a, b) if _mean(a.cover) <= _mean(b.cover) else (b, a)
    exact = other.surface is None and other.cover == (1.0,) and clear.cover != (0.0,)
    cover = clear.cover if other.surface is None else other.cover
    cover = math.clamp(cover, (_LEAST_COVER,), (1.0,))
    lights = (math.multiply(one.emission, one.cover) for one in (a, b))
    emission = math.divide(math.add(*lights), cover)
    return Closure(other.surface or clear.surface, emission, cover), exact


def _passes(surface: GltfInputs) -> bool:
    return is_set(surface.diffuse_transmission)


def _strength(surface: GltfInputs) -> float:
    """Rough measure of the light that a surface scatters."""
    diffuse = sum(_level(channel) for channel in surface.base_color) / len(surface.base_color)
    return diffuse + (_level(surface.specular[0]) if surface.ior == 0.0 else 0.0)


def _level(channel: object) -> float:
    if isinstance(channel, Texel):
        return channel.mean()
    return channel if isinstance(channel, float) else 0.5
