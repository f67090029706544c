"""Manufacturing imperfections of a lens: decentred elements, and grooves in aspheres."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from daguerre.camera.camera import Camera, Decenter
from daguerre.checks import number, numbers, short, whole
from daguerre.errors import UsageError

if TYPE_CHECKING:
    from daguerre.lenses import Lens

#: height, nm; period, um; seed
Ripple = tuple[float, float, int]


def imperfect(lens: Lens, camera: Camera) -> Lens:
    """Returns the lens with the imperfections of a camera.

    Raises:
        UsageError: A value is out of its range, or a lens with ripple has no aspheric surface.
    """
    for surfaces, place, angles in decenters(camera):
        lens = lens.decentered(surfaces, place, angles)
    ripple = ripple_of(camera)
    return lens if ripple is None else _rippled(lens, ripple)


def decenters(camera: Camera) -> list[Decenter]:
    """Checks the decentred elements."""
    wanted = "((first, last), (x, y)) or ((first, last), (x, y), (about x, about y))"
    found: list[Decenter] = []
    given: Any = camera.decenter
    if not isinstance(given, tuple | list):
        raise UsageError(f"camera: decenter: wanted a list of {wanted}, got {short(given)}")
    for i, one in enumerate(given):
        where = f"camera: decenter[{i}]"
        if not isinstance(one, tuple | list) or len(one) not in (2, 3):
            raise UsageError(f"{where}: wanted {wanted}, got {short(one)}")
        first, last = numbers(one[0], where, 2, "the first and last surface")
        x, y = numbers(one[1], where, 2, "two finite numbers (mm)")
        a, b = numbers(one[2], where, 2, "two angles (deg)") if len(one) == 3 else (0.0, 0.0)
        found.append(((int(first), int(last)), (x, y), (a, b)))
    return found


def ripple_of(camera: Camera) -> Ripple | None:
    """Checks the ripple; None: smooth."""
    given: Any = camera.ripple
    if given is None:
        return None
    if not isinstance(given, tuple | list) or len(given) not in (2, 3):
        raise UsageError(f"camera: ripple: wanted (nm, um) or (nm, um, seed), got {short(given)}")
    height, period, seed = numbers((*given, 0)[:3], "camera: ripple", 3, "nm, um and a seed")
    number(height, "camera: ripple", 0, 1000)
    number(period, "camera: ripple", 5, 10000)
    return height, period, whole(int(seed), "camera: ripple: seed", 0, 2**32 - 1)


def _rippled(lens: Lens, ripple: Ripple) -> Lens:
    """Returns the lens with different grooves in each of its aspheric surfaces."""
    height, period, seed = ripple
    if not any(s.kind == "aspheric" for s in lens.surfaces):
        raise UsageError(f"camera: ripple: {lens.name} has no aspheric surface")
    return lens.rebuilt(
        [
            s.replaced(ripple=(height, period, seed + i)) if s.kind == "aspheric" else s
            for i, s in enumerate(lens.surfaces)
        ]
    )
