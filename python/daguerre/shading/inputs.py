"""Inputs that several kinds of surface have in common."""

from __future__ import annotations

import numpy as np

from daguerre.shading.materialx.graph import Link

from .channels import UnsupportedError, Value, numbers_of
from .evaluate import Arguments

_FLAT = (0.0, 0.0, 1.0)
#: Largest ratio of the axes of stretched highlights (MaterialX, roughness_anisotropy).
_MOST_STRETCHED = 0.98


def normal_of(given: Arguments, name: str) -> Value | None:
    """Normal in the frame of texture coordinates; None: the mesh's."""
    if not isinstance(given.node.inputs.get(name), Link):
        return None
    found = given.given(name)
    if found is None or len(found) != 3:
        return None
    constant = numbers_of(found)
    if constant is None:
        return found
    if constant != _FLAT:
        given.context.notes.add("a constant normal of a material is not supported")
    return None


def noted_displacement(given: Arguments, name: str) -> None:
    """Adds a note if a surface is displaced."""
    found = given.node.inputs.get(name)
    if isinstance(found, Link) or (found is not None and given.number(name, 0.0) != 0.0):
        given.context.notes.add("displacement of a material is not supported")


def noted(given: Arguments, *names: str) -> None:
    """Adds a note for each input that is set to more than nothing and has no counterpart."""
    for name in names:
        found = given.node.inputs.get(name)
        numbers = None if isinstance(found, Link) else given.given(name)
        if isinstance(found, Link) or (numbers is not None and any(numbers)):
            given.context.notes.add(f"{given.node.kind}: '{name}' is not supported")


def constant(given: Arguments, name: str, default: float) -> float:
    """A number that the renderer has only as a constant; a picture is replaced by its mean."""
    return constants(given, name, (default,))[0]


def constants(given: Arguments, name: str, default: tuple[float, ...]) -> tuple[float, ...]:
    """Numbers that the renderer has only as constants; pictures are replaced by their means."""
    try:
        return given.numbers(name, default)
    except UnsupportedError:
        pass
    found = []
    for channel in given.value(name, default):
        mean = getattr(channel, "mean", None)
        found.append(float(mean()) if mean else float(channel) if isinstance(channel, float) else 0)
    given.context.notes.add(f"{given.node.kind}: the mean of the picture in '{name}' is used")
    return tuple(found)


def refraction_index(given: Arguments, ior: float) -> float:
    """Index of refraction that the renderer takes; below 1, the inverse, of equal reflectance."""
    if 0 < ior < 1:
        given.context.notes.add(
            "an index of refraction below 1 is inverted, which reflects the same"
        )
        return 1 / ior
    return max(ior, 0.0)


def stretched(given: Arguments, along: Value, across: Value) -> tuple[Value, Value]:
    """Roughness and anisotropy of glTF from the two GGX widths.

    glTF has the widths r^2 + (1 - r^2) s^2 along the tangent and r^2 across it
    (KHR_materials_anisotropy).

    Returns:
        r and s.
    """
    arithmetic = given.context.math
    share = arithmetic.each(_share, along, across)
    return arithmetic.each(lambda v: np.sqrt(np.maximum(v, 0)), across), share


def materialx_widths(given: Arguments, roughness: Value, anisotropy: Value) -> tuple[Value, Value]:
    """GGX widths by MaterialX's roughness_anisotropy: r^2 / q and r^2 q, q = sqrt(1 - a)."""
    arithmetic = given.context.math

    def aspect(a: object) -> object:
        return np.sqrt(1 - np.clip(np.asarray(a), 0, _MOST_STRETCHED))

    along = arithmetic.each(lambda r, a: np.minimum(r * r / aspect(a), 1), roughness, anisotropy)
    return along, arithmetic.each(lambda r, a: r * r * aspect(a), roughness, anisotropy)


def openpbr_widths(given: Arguments, roughness: Value, anisotropy: Value) -> tuple[Value, Value]:
    """GGX widths by OpenPBR 1.1: along = r^2 sqrt(2 / (1 + (1 - a)^2)), across = (1 - a) along."""
    arithmetic = given.context.math
    along = arithmetic.each(
        lambda r, a: np.minimum(r * r * np.sqrt(2 / (1 + (1 - a) ** 2)), 1), roughness, anisotropy
    )
    return along, arithmetic.each(lambda w, a: w * (1 - a), along, anisotropy)


def _share(along: object, across: object) -> object:
    wide, narrow = np.asarray(along), np.asarray(across)
    rest = np.maximum(1 - narrow, 1e-6)
    return np.sqrt(np.clip((wide - narrow) / rest, 0, 1))
