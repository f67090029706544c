"""Ghosts in a picture: how much light is followed by way of two reflections, and by which camera.

See ``docs/flare.md``.
"""

from __future__ import annotations

from typing import Any

import daguerre._core as _core

from .camera import Camera
from .checks import number, numbers, short
from .errors import UsageError

#: Paths per sample index that ``auto`` takes, for each pixel of the frame.
PER_PIXEL = 0.5


def check_highlights(value: object, where: str = "flare_highlights") -> bool:
    """Whether light that other things send to the lens has ghosts, too.

    Raises:
        UsageError: Neither on nor off.
    """
    if value in ("on", "off"):
        return value == "on"
    if isinstance(value, bool):
        return value
    raise UsageError(f"{where}: wanted on or off, got {short(value)}")


def check_used(given: dict[str, bool], *, flare: bool, scatter: bool) -> None:
    """Refuses parameters of flare or scatter where neither is on.

    Args:
        given: Parameters, and whether they differ from their defaults: of flare alone,
            then of flare or scatter.
        flare: Whether ghosts are drawn.
        scatter: Whether scatter is drawn.

    Raises:
        UsageError: A parameter would have no effect.
    """
    for (name, other), drawn in zip(given.items(), (flare, flare or scatter), strict=True):
        if other and not drawn:
            dashes = "--" if name.startswith("--") else ""
            also = f" or {dashes}scatter" if "highlights" in name else ""
            raise UsageError(f"{name}: needs {dashes}flare{also} to be on")


def stack_of(camera: Camera) -> _core.SensorStack:
    """Surfaces that the body adds to those of the lens.

    Raises:
        UsageError: Glass or a sensor that cannot be.
    """
    where = "camera: sensor_reflectance"
    reflectance = number(camera.sensor_reflectance, where)
    if not 0 <= reflectance <= 1:
        raise UsageError(
            f"{where}: wanted 0 .. 1 (no surface can send back more light than arrives), "
            f"got {reflectance:g}"
        )
    given: Any = camera.cover_glass
    if given is None:
        return _core.SensorStack(reflectance=reflectance)
    where = "camera: cover_glass"
    wanted = "(thickness, gap) or (thickness, gap, index), mm"
    if not isinstance(given, tuple | list) or len(given) not in (2, 3):
        raise UsageError(f"{where}: wanted {wanted}, got {short(given)}")
    thickness, gap, index = numbers((*given, 1.5168)[:3], where, 3, wanted)
    number(thickness, where, 0, 100, above=0)
    number(gap, where, 0, 100, above=0)
    number(index, where, 1, 4)
    return _core.SensorStack(thickness, index, gap, reflectance)


def stack_facts(camera: Camera) -> dict[str, Any]:
    """Facts of the body, for metadata and hashes; empty if it declares nothing."""
    facts: dict[str, Any] = {}
    if camera.cover_glass is not None:
        facts["cover_glass"] = list(camera.cover_glass)
    if camera.sensor_reflectance:
        facts["sensor_reflectance"] = camera.sensor_reflectance
    return facts
