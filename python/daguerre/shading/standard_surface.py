"""MaterialX's standard_surface as a surface of the renderer.

Coat and diffuse colours are multiplied where the coat is; subsurface scattering is diffuse light
of its colour; a transmission colour without a depth tints, with a depth it absorbs.

Source: Georgiev et al., "Autodesk Standard Surface" 1.0.1
(https://autodesk.github.io/standard-surface/); its definition in MaterialX 1.39.
"""

from __future__ import annotations

from .channels import Value, numbers_of
from .evaluate import Arguments
from .inputs import (
    constant,
    constants,
    materialx_widths,
    normal_of,
    noted,
    refraction_index,
    stretched,
)
from .layers import (
    coated,
    is_set,
    opaque_share,
    scattered,
    transmitted,
    with_film,
)
from .surface import GltfInputs

_COAT_IOR = 1.5


def standard_surface(given: Arguments, metres_per_unit: float) -> GltfInputs:
    """Reads the inputs of a standard_surface; lengths are in scene units."""
    arithmetic, surface = given.context.math, GltfInputs()
    white: Value = (1.0, 1.0, 1.0)
    surface.metallic = given.value("metalness", (0.0,))
    base = arithmetic.multiply(
        given.value("base_color", (0.8, 0.8, 0.8)), given.value("base", (1.0,))
    )
    thin = bool(given.number("thin_walled", 0.0))
    _reflection(given, surface)
    scatter = given.value("subsurface", (0.0,)), given.value("subsurface_color", white)
    surface.base_color = scattered(given, surface, base, scatter, thin=thin)
    coat, tint = given.value("coat", (0.0,)), given.value("coat_color", white)
    surface.base_color = coated(given, surface.base_color, coat, tint)
    surface.clearcoat = coat
    surface.clearcoat_roughness = given.value("coat_roughness", (0.1,))
    surface.transmission = given.value("transmission", (0.0,))
    depth = constant(given, "transmission_depth", 0.0) * metres_per_unit
    transmitted(given, surface, "transmission_color", depth, thin=thin)
    abbe = constant(given, "transmission_dispersion", 0.0)
    surface.dispersion = 20 / abbe if abbe > 0 else 0.0
    surface.sheen_color = arithmetic.multiply(
        given.value("sheen_color", white), given.value("sheen", (0.0,))
    )
    surface.sheen_roughness = given.value("sheen_roughness", (0.3,))
    surface.emissive = arithmetic.multiply(
        given.value("emission_color", white), given.value("emission", (0.0,))
    )
    thickness = given.value("thin_film_thickness", (0.0,))
    share: Value = (1.0 if numbers_of(thickness) != (0.0,) else 0.0,)
    with_film(surface, share, thickness, constant(given, "thin_film_IOR", 1.5))
    opaque_share(given, surface, given.value("opacity", white))
    _noted(given, surface)
    return surface


def _reflection(given: Arguments, surface: GltfInputs) -> None:
    surface.specular = given.value("specular", (1.0,))
    surface.specular_color = given.value("specular_color", (1.0, 1.0, 1.0))
    surface.ior = refraction_index(given, constant(given, "specular_IOR", 1.5))
    roughness = given.value("specular_roughness", (0.2,))
    anisotropy = given.value("specular_anisotropy", (0.0,))
    surface.roughness = roughness
    if is_set(anisotropy):
        widths = materialx_widths(given, roughness, anisotropy)
        surface.roughness, surface.anisotropy = stretched(given, *widths)
        turns = constants(given, "specular_rotation", (0.0,))[0]
        surface.anisotropy_rotation = -360.0 * turns
    surface.normal = normal_of(given, "normal")
    surface.clearcoat_normal = normal_of(given, "coat_normal")


def _noted(given: Arguments, surface: GltfInputs) -> None:
    """Notes on inputs without a counterpart, where they would be seen."""
    noted(given, "diffuse_roughness")
    if is_set(surface.transmission):
        noted(given, "transmission_scatter", "transmission_extra_roughness")
    if is_set(surface.clearcoat):
        noted(given, "coat_anisotropy", "coat_affect_color", "coat_affect_roughness")
        if constant(given, "coat_IOR", _COAT_IOR) != _COAT_IOR:
            given.context.notes.add(f"{given.node.kind}: a coat has the index of refraction 1.5")
