"""UsdPreviewSurface as a surface of the renderer.

Opacity: with a threshold, a mask. In the mode "presence", or with a picture of opacity, the covered
share of the surface. A constant opacity in the mode "transparent" is a clear thin sheet that keeps
its highlights, as the specification asks: its diffuse colour is multiplied by the opacity, and the
rest goes straight through.

Source: OpenUSD, "UsdPreviewSurface Specification"
(https://openusd.org/release/spec_usdpreviewsurface.html).
"""

from __future__ import annotations

from .channels import Value, numbers_of
from .evaluate import Arguments
from .inputs import normal_of, noted_displacement, refraction_index
from .surface import GltfInputs

#: Inputs that no picture needs: light transport makes the shadows of corners itself.
IGNORED = frozenset({"occlusion", "displacement"})


def preview_surface(given: Arguments) -> GltfInputs:
    """Reads the inputs of a UsdPreviewSurface."""
    diffuse = given.value("diffuseColor", (0.18, 0.18, 0.18))
    surface = GltfInputs(base_color=diffuse)
    surface.ior = refraction_index(given, given.number("ior", 1.5))
    surface.roughness = given.value("roughness", (0.5,))
    if given.number("useSpecularWorkflow", 0.0):
        surface.ior = 0.0  # reflects all light; specularColor scales it
        surface.specular_color = given.value("specularColor", (0.0, 0.0, 0.0))
    else:
        surface.metallic = given.value("metallic", (0.0,))
    surface.emissive = given.value("emissiveColor", (0.0, 0.0, 0.0))
    surface.clearcoat = given.value("clearcoat", (0.0,))
    surface.clearcoat_roughness = given.value("clearcoatRoughness", (0.01,))
    surface.normal = normal_of(given, "normal")
    _opacity(given, surface)
    noted_displacement(given, "displacement")
    return surface


def _opacity(given: Arguments, surface: GltfInputs) -> None:
    surface.alpha = given.value("opacity", (1.0,))
    threshold = given.number("opacityThreshold", 0.0)
    found = numbers_of(surface.alpha)
    if found == (1.0,):
        return
    if threshold > 0:
        surface.alpha_mode, surface.alpha_cutoff = "mask", threshold
    elif found is None or _is_presence(given):
        if not _is_presence(given):
            given.context.notes.add("highlights fade where an opacity texture is transparent")
        surface.alpha_mode = "blend"
    else:
        _sheet(given, surface, min(max(found[0], 0.0), 1.0))


def _is_presence(given: Arguments) -> bool:
    """Whether opacity is a share of surface; MaterialX has a number in place of the name."""
    mode = given.text("opacityMode")
    return mode == "presence" if mode else given.number("opacityMode", 0.0) == 1.0


def _sheet(given: Arguments, surface: GltfInputs, opacity: float) -> None:
    """Clear sheet with diffuse light: exact for grey; for other colours, exact in sum."""
    arithmetic = given.context.math
    clear = (1.0 - opacity,) * 3
    total = arithmetic.add(arithmetic.multiply(surface.base_color, (opacity,)), clear)
    mean = arithmetic.multiply(arithmetic.dot(total, (1.0, 1.0, 1.0)), (1 / 3,))
    share: Value = arithmetic.divide((1.0 - opacity,), mean)
    surface.base_color, surface.transmission = total, arithmetic.fraction(share)
    surface.alpha = (1.0,)
