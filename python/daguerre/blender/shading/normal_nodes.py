"""Nodes that bend the normal: Normal Map and Bump.

Source: Blender 5.0 Manual, "Normal Map Node" and "Bump Node"; Blinn 1978, "Simulation of wrinkled
surfaces".
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from daguerre.shading.channels import Mapping as Lie
from daguerre.shading.channels import Texel, Value
from daguerre.shading.evaluate import Arguments, Operation

from .sockets import Sockets

FLAT: Value = (0.0, 0.0, 1.0)
Array = NDArray[np.float32]


def normal_map(given: Arguments) -> Value:
    """Normal Map in the frame of the texture coordinates; others are left out."""
    sockets = Sockets(given)
    if sockets.text("space", "TANGENT") != "TANGENT":
        sockets.note(f"normals in the space {sockets.text('space')} are left out")
        return FLAT
    arithmetic = sockets.math
    color, strength = sockets.value("Color"), sockets.one("Strength")
    normal = arithmetic.add(arithmetic.multiply(color, (2.0,)), (-1.0,))
    if strength == (1.0,):
        return normal
    # The strength interpolates from the surface's normal to the map's.
    x, y, z = normal
    slopes = arithmetic.multiply((x, y), arithmetic.clamp(strength, (0.0,), (np.inf,)))
    return (*slopes, *arithmetic.mix((1.0,), (z,), arithmetic.fraction(strength)))


def bump(size_of: Callable[[str], float]) -> Operation:
    """Bump: the node's operation.

    Args:
        size_of: Gives the length of one unit of texture coordinates, by their name, on the surface,
            in scene units.
    """

    def apply(given: Arguments) -> Value:
        sockets = Sockets(given)
        if sockets.is_linked("Normal"):
            sockets.note("the normal under a bump is left out")
        (height,) = sockets.one("Height")
        if not isinstance(height, Texel):
            return FLAT
        scale = sockets.number("Distance") * (-1.0 if sockets.flag("invert") else 1.0)
        strength = max(sockets.number("Strength"), 0.0)
        return _bumped(sockets, height, scale / size_of(height.mapping.primvar), strength)

    return apply


def _bumped(sockets: Sockets, height: Texel, scale: float, strength: float) -> Value:
    """Normal of a height, (-dh/du, -dh/dv, 1), mixed with the surface's by the strength."""
    lie = height.mapping

    def component(index: int) -> Callable[[Array], Array]:
        return lambda values: _normal(values, lie, scale, strength)[index]

    combined = sockets.math.baker.combined
    return tuple(combined(component(i), height) for i in range(3))


def _normal(values: Array, lie: Lie, scale: float, strength: float) -> tuple[Array, Array, Array]:
    """Components of the normal of a height at each texel; row 0 is on top."""
    rows, columns = values.shape
    across = _difference(values, 1, lie.wrap[0]) * columns
    up = -_difference(values, 0, lie.wrap[1]) * rows
    a, b, _, d, e, _ = lie.transform
    slope_u, slope_v = scale * (across * a + up * d), scale * (across * b + up * e)
    length = np.sqrt(1 + slope_u**2 + slope_v**2)
    x, y = -strength * slope_u / length, -strength * slope_v / length
    z = strength / length + 1 - strength
    norm = np.sqrt(x * x + y * y + z * z)
    return x / norm, y / norm, z / norm


def _difference(values: Array, axis: int, wrap: str) -> Array:
    """Central difference along an axis; one-sided at the border of a clamped picture."""
    if wrap == "repeat":
        return np.asarray((np.roll(values, -1, axis) - np.roll(values, 1, axis)) / 2, np.float32)
    if values.shape[axis] == 1:
        return values * 0
    return np.asarray(np.gradient(values, axis=axis), np.float32)
