"""Reads exposure and shutter of a camera of USD.

``fStop`` and the shutter make blur, ``exposure:*`` makes brightness: USD shows radiance x time x
iso / 100 x responsivity x 2^exposure / fStop^2. A stage that has one of ``exposure:*`` itself is
in the exposure mode ``manual``, with the schema's fallbacks for the rest; else it is in
``light``. ``daguerre:exposure:mode`` names the mode.

Source: OpenUSD, UsdGeomCamera, "Exposure" and "Shutter".
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from daguerre.camera import shutter
from daguerre.camera.camera import Camera
from daguerre.camera.exposure import ideal_h0
from daguerre.camera.exposure_mode import AUTOMATIC, CHOICES, chosen_by
from daguerre.motion.values import Keys, at, keys
from daguerre.sensors.iso_speed import GREY, GREY_LX_S

from .checked import Checked
from .optics import exposed_stop

#: Attributes of USD's scale: the parameter of ``Camera``, and the schema's fallback.
SCALE = {
    "exposure:iso": ("iso", 100.0),
    "exposure:time": ("exposure_time", 1.0),
    "exposure:fStop": ("exposure_f_stop", 1.0),
    "exposure:responsivity": ("responsivity", 1.0),
}
EV = "exposure"
#: USD's responsivity of a camera with a responsivity of 1. At ISO 100, 1 s and f/1, 1 cd/m2 gives
#: the film pi / 4 lux s, and a picture 0.18 where it gets 10 / ISO lux s (ISO 12232).
RESPONSIVITY = 100 * GREY / GREY_LX_S * ideal_h0(1.0)
#: Relative difference below which two numbers are equal, as USD has single precision.
_SINGLE = 1e-6


def read_exposure(read: Checked, named: str | None) -> dict[str, Any]:
    """Parameters of brightness, with the mode.

    Args:
        read: The camera.
        named: Mode by name; None: the stage has none.

    Raises:
        InputError: A value is wrong, or is chosen by the named mode.
    """
    found: dict[str, Any] = {}
    if read.is_authored(EV):
        field = "exposure_compensation"
        found[field] = read.accepted(EV, field, read.moving(EV, float))
    authored = [name for name in SCALE if read.is_authored(name)]
    mode = named or "manual"
    for name in authored:
        field, _ = SCALE[name]
        if field in chosen_by(mode):
            read.fail(name, f"none, as exposure {mode} chooses {CHOICES[mode]}", "one")
        found[field] = read.accepted(name, field, read.moving(name, float))
    if authored and mode not in AUTOMATIC:
        found = dict(SCALE.values()) | found
    if "responsivity" in found:
        found["responsivity"] = _ours(found["responsivity"])
    return found | ({"exposure": "manual"} if authored else {})


def _ours(responsivity: float | Keys) -> float | Keys:
    """Our responsivity for USD's, to the digits that single precision has."""
    if not isinstance(responsivity, Keys):
        return float(f"{responsivity / RESPONSIVITY:.7g}")
    pairs = zip(responsivity.times.tolist(), map(_ours, responsivity.values), strict=True)
    return keys(pairs, responsivity.interpolation)


def unsplit(camera: Camera) -> Camera:
    """Lets shutter and f-stop set the brightness, too, where ``exposure:*`` has their numbers.

    Stages that we write have these numbers for other programs.
    """
    time, stop = (_over_time(camera, name) for name in ("exposure_time", "exposure_f_stop"))
    same = {
        "exposure_time": _is_same(time, camera, ("shutter_time",), shutter.shutter_time),
        "exposure_f_stop": _is_same(stop, camera, ("f_stop", "t_stop"), exposed_stop),
    }
    gone = {name: None for name, drops in same.items() if drops}
    return camera.with_(**gone) if gone else camera


def _over_time(camera: Camera, name: str) -> Any:
    return camera.motion.get(name, getattr(camera, name))


def _is_same(
    value: float | Keys | None,
    camera: Camera,
    sources: tuple[str, ...],
    of: Callable[[Camera], float | None],
) -> bool:
    """Whether a value equals the camera's at each time: both constant, or with the same keys."""
    if value is None:
        return False
    moving = [camera.motion[name] for name in sources if name in camera.motion]
    if not isinstance(value, Keys):
        current = of(camera)
        return not moving and current is not None and math.isclose(current, value, rel_tol=_SINGLE)
    return any(
        isinstance(keyed, Keys)
        and keyed.interpolation == value.interpolation
        and np.array_equal(keyed.times, value.times)
        and np.allclose(keyed.values, value.values, rtol=_SINGLE, atol=0)
        for keyed in moving
    )


def never_opens(read: Checked) -> bool:
    """Whether the shutter closes before it opens: the picture is black."""
    shut = _shutter(read, lambda opens, closes: closes - opens)
    return bool(min(shut.values if isinstance(shut, Keys) else (shut,)) < 0)


def read_shutter(read: Checked) -> dict[str, Any]:
    """Shutter that the stage has: time in s, and where it opens in frames.

    ``shutter:open`` and ``shutter:close`` are in time codes, relative to the frame's. Both 0
    is no blur.
    """
    rate = read.stage.frame_rate
    found: dict[str, Any] = {"fps": rate}
    if not (read.is_authored("shutter:open") or read.is_authored("shutter:close")):
        return found
    code_s = 1 / read.stage.clock.rate
    time = _shutter(read, lambda opens, closes: (closes - opens) * code_s)
    offset = _shutter(read, lambda opens, closes: opens * code_s * rate)
    return found | {
        "shutter_time": read.accepted("shutter:close", "shutter_time", time),
        "shutter_offset": read.accepted("shutter:open", "shutter_offset", offset),
    }


def _shutter(read: Checked, combined: Callable[[float, float], float]) -> Any:
    """Number of both ends of the shutter's opening, in time codes: a constant or keys."""
    ends = [read.moving(f"shutter:{end}", lambda value: value) or 0.0 for end in ("open", "close")]
    moving = [end for end in ends if isinstance(end, Keys)]
    if not moving:
        return combined(*ends)
    times = sorted({time for end in moving for time in end.times.tolist()})
    pairs = [(time, combined(*(at(end, time) for end in ends))) for time in times]
    return keys(pairs, moving[0].interpolation)
