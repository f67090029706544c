"""OpenPBR as a surface of the renderer.

Source: "OpenPBR Surface" 1.1 (https://academysoftwarefoundation.github.io/OpenPBR/); its definition
in MaterialX 1.39. Emission is in nits there, too.
"""

from __future__ import annotations

from .channels import Value
from .evaluate import Arguments
from .inputs import constant, normal_of, noted, openpbr_widths, refraction_index, stretched
from .layers import coated, is_set, opaque_share, scattered, transmitted, with_film
from .surface import GltfInputs

_NM = 1000.0  # nm in the um of OpenPBR
_WHITE: Value = (1.0, 1.0, 1.0)


def open_pbr_surface(given: Arguments, metres_per_unit: float) -> GltfInputs:
    """Reads the inputs of an open_pbr_surface; lengths are in scene units."""
    arithmetic, surface = given.context.math, GltfInputs()
    surface.metallic = given.value("base_metalness", (0.0,))
    base = arithmetic.multiply(
        given.value("base_color", (0.8, 0.8, 0.8)), given.value("base_weight", (1.0,))
    )
    thin = bool(given.number("geometry_thin_walled", 0.0))
    _reflection(given, surface)
    grey: Value = (0.8, 0.8, 0.8)
    scatter = given.value("subsurface_weight", (0.0,)), given.value("subsurface_color", grey)
    surface.base_color = scattered(given, surface, base, scatter, thin=thin)
    coat = given.value("coat_weight", (0.0,))
    tint = given.value("coat_color", _WHITE)
    surface.base_color = coated(given, surface.base_color, coat, tint)
    surface.clearcoat = coat
    surface.clearcoat_roughness = given.value("coat_roughness", (0.0,))
    surface.transmission = given.value("transmission_weight", (0.0,))
    depth = constant(given, "transmission_depth", 0.0) * metres_per_unit
    transmitted(given, surface, "transmission_color", depth, thin=thin)
    abbe = constant(given, "transmission_dispersion_abbe_number", 20.0)
    scale = constant(given, "transmission_dispersion_scale", 0.0)
    surface.dispersion = max(20 * scale / abbe, 0.0) if abbe > 0 else 0.0
    surface.sheen_color = arithmetic.multiply(
        given.value("fuzz_color", _WHITE), given.value("fuzz_weight", (0.0,))
    )
    surface.sheen_roughness = given.value("fuzz_roughness", (0.5,))
    surface.emissive = arithmetic.multiply(
        given.value("emission_color", _WHITE), given.value("emission_luminance", (0.0,))
    )
    thickness = arithmetic.multiply(given.value("thin_film_thickness", (0.5,)), (_NM,))
    film = given.value("thin_film_weight", (0.0,))
    with_film(surface, film, thickness, constant(given, "thin_film_ior", 1.4))
    opaque_share(given, surface, given.value("geometry_opacity", (1.0,)))
    _noted(given, surface)
    return surface


def _reflection(given: Arguments, surface: GltfInputs) -> None:
    surface.specular = given.value("specular_weight", (1.0,))
    surface.specular_color = given.value("specular_color", _WHITE)
    surface.ior = refraction_index(given, constant(given, "specular_ior", 1.5))
    surface.roughness = given.value("specular_roughness", (0.3,))
    anisotropy = given.value("specular_roughness_anisotropy", (0.0,))
    if is_set(anisotropy):
        widths = openpbr_widths(given, surface.roughness, anisotropy)
        surface.roughness, surface.anisotropy = stretched(given, *widths)
    surface.normal = normal_of(given, "geometry_normal")
    surface.clearcoat_normal = normal_of(given, "geometry_coat_normal")


def _noted(given: Arguments, surface: GltfInputs) -> None:
    """Notes on inputs without a counterpart, where they would be seen."""
    noted(given, "base_diffuse_roughness")
    if is_set(surface.transmission):
        noted(given, "transmission_scatter")
    if is_set(surface.clearcoat):
        noted(given, "coat_roughness_anisotropy")
        given.context.notes.add(
            "open_pbr_surface: a coat has the index of refraction 1.5, and does not darken"
        )
