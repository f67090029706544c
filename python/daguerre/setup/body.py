"""Camera body: cover glass and sensor, which add ghosts, and parts that scatter light.

See ``docs/flare.md``.
"""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import daguerre._core as _core
from daguerre.camera.camera import Camera
from daguerre.camera.lens_scatter import LensScatter, core_parts
from daguerre.camera.parameters import CAMERA
from daguerre.checks import number, numbers, short
from daguerre.errors import UsageError

if TYPE_CHECKING:
    from daguerre.camera.camera import Camera


def stack_of(camera: Camera) -> _core.SensorStack:
    """Makes the surfaces of the camera body behind the lens.

    Raises:
        UsageError: A value of cover glass or sensor is out of its range.
    """
    CAMERA["sensor_reflectance"].check(camera.sensor_reflectance, "camera: sensor_reflectance")
    reflectance = float(camera.sensor_reflectance)
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
    """Data of the body for metadata and hashes; empty without cover glass and reflectance."""
    facts: dict[str, Any] = {}
    if camera.cover_glass is not None:
        facts["cover_glass"] = list(camera.cover_glass)
    if camera.sensor_reflectance:
        facts["sensor_reflectance"] = camera.sensor_reflectance
    return facts


def parts_of(camera: Camera) -> _core.LensScatter:
    """Makes the core's record of the parts that scatter.

    Raises:
        UsageError: A value is out of its range.
    """
    return core_parts(camera.scatter)


def scatter_facts(camera: Camera) -> dict[str, Any]:
    """Scatter of the lens for metadata and hashes, if scatter is drawn."""
    return asdict(camera.scatter or LensScatter())
