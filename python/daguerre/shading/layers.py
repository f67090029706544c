"""Layers that standard_surface and OpenPBR have in common."""

from __future__ import annotations

from .channels import Value, numbers_of
from .evaluate import Arguments
from .inputs import constants
from .surface import GltfInputs


def is_set(value: Value) -> bool:
    """Whether a weight is a picture, or above 0."""
    numbers = numbers_of(value)
    return numbers is None or any(number > 0 for number in numbers)


def scattered(
    given: Arguments, surface: GltfInputs, base: Value, scatter: tuple[Value, Value], *, thin: bool
) -> Value:
    """Colour of diffuse light with subsurface scattering of a share and colour.

    Light scatters out of a thin sheet on its other side; elsewhere it leaves as diffuse light
    where it entered, with a note. Metal keeps its colour.
    """
    share, color = scatter
    if not is_set(share):
        return base
    if thin:
        surface.diffuse_transmission, surface.diffuse_transmission_color = share, color
        return base
    given.context.notes.add("subsurface scattering is shown as diffuse light of its colour")
    arithmetic = given.context.math
    if is_set(surface.metallic):
        plain = arithmetic.subtract((1.0,), surface.metallic)
        share = share if _alike(base, color) else arithmetic.multiply(share, plain)
    return arithmetic.mix(base, color, share)


def coated(given: Arguments, base: Value, coat: Value, tint: Value) -> Value:
    """Colour of a base under a tinted coat."""
    if not is_set(coat) or numbers_of(tint) == (1.0, 1.0, 1.0):
        return base
    arithmetic = given.context.math
    return arithmetic.multiply(base, arithmetic.mix((1.0, 1.0, 1.0), tint, coat))


def transmitted(
    given: Arguments, surface: GltfInputs, name: str, depth_m: float, *, thin: bool
) -> None:
    """Colour of transmitted light: a tint, or absorption that reaches it at a depth."""
    if not is_set(surface.transmission):
        return
    surface.volume = not thin
    arithmetic, white = given.context.math, (1.0, 1.0, 1.0)
    tint: Value = given.value(name, white)
    if depth_m > 0 and not thin:
        surface.attenuation_color = constants(given, name, white)
        surface.attenuation_distance, tint = depth_m, white
    surface.base_color = arithmetic.mix(surface.base_color, tint, surface.transmission)


def with_film(surface: GltfInputs, share: Value, thickness_nm: Value, ior: float) -> None:
    """Adds an iridescent film."""
    if is_set(share):
        surface.iridescence, surface.iridescence_ior = share, max(ior, 1.0)
        surface.iridescence_thickness_nm = thickness_nm


def opaque_share(given: Arguments, surface: GltfInputs, opacity: Value) -> None:
    """Reads opacity as the covered share of the surface."""
    numbers = numbers_of(opacity)
    if numbers is not None and all(number >= 1 for number in numbers):
        return
    if len(opacity) == 3 and not _grey(opacity):
        given.context.notes.add(f"{given.node.kind}: coloured opacity is averaged")
        arithmetic = given.context.math
        opacity = arithmetic.multiply(arithmetic.dot(opacity, (1.0, 1.0, 1.0)), (1 / 3,))
    surface.alpha, surface.alpha_mode = opacity[:1], "blend"


def _grey(value: Value) -> bool:
    return all(_alike(value[:1], (channel,)) for channel in value[1:])


def _alike(a: Value, b: Value) -> bool:
    from .channels import same

    return same(a, b)
