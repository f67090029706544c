"""Flags of a photograph: sensor, brackets, development."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from daguerre import units as q
from daguerre.camera.parameters import CAMERA
from daguerre.cli.exposure_flags import before_1_0, check_mode
from daguerre.errors import UsageError
from daguerre.rendering.photograph import Photograph, offset_name

if TYPE_CHECKING:
    from daguerre.camera.camera import Camera
    from daguerre.plates.match.plate_camera import PlateCamera

#: Camera parameters that exposed the picture before version 1.0.
_EXPOSED = (
    *("iso", "exposure_compensation", "exposure_time", "exposure_f_stop", "responsivity"),
    *("white_balance", "sensor"),
)
MOST_EV, MOST_SHOTS = 20.0, 15


def photograph_of(
    changes: dict[str, Any],
    bracket: str | None,
    look: str | None,
    seed: int,
    plate: PlateCamera | None = None,
) -> Photograph:
    """Makes the photograph from flags; pictures imitate the look of the camera ``plate``.

    Raises:
        UsageError: A flag is wrong, or excludes another.
    """
    check_mode(changes)
    iso, sensor = changes.get("iso"), changes.get("sensor")
    if iso is not None and not iso > 0:
        raise UsageError(f"--iso: wanted a number above 0, got {iso:g}")
    if sensor is not None:
        from daguerre.exposure.expose import check_can_expose

        check_can_expose(sensor, iso)
    if look is not None:
        from daguerre.development.recipe import Recipe

        Recipe.of(look=look)
    like = None
    if plate is not None:
        from daguerre.plates.match.like import PlateLook

        like, look = PlateLook(plate), look or plate.look
    offsets = () if bracket is None else _offsets(bracket)
    return Photograph(sensor, iso, offsets, look, seed, like)


def mode_notes(
    camera: Camera, changes: dict[str, Any], *, looks: bool, brackets: bool
) -> list[str]:
    """Notes on flags that had another meaning before version 1.0.

    Args:
        camera: Camera of the picture.
        changes: Parameters from flags.
        looks: Whether --look is given.
        brackets: Whether --bracket is given.
    """
    found = []
    asked = [CAMERA[name].flag for name in _EXPOSED if name in changes]
    asked += ["--look"] * looks + ["--bracket"] * brackets
    if camera.exposure == "light" and asked and changes.get("exposure") is None:
        found.append(before_1_0(asked[0]))
    return found


def _offsets(text: str) -> tuple[float, ...]:
    wanted = f"exposures in EV such as -2,0,2, {MOST_SHOTS} at most"
    parts = text.split(",")
    if not 1 <= len(parts) <= MOST_SHOTS:
        raise UsageError(f"--bracket: wanted {wanted}; got {text!r}")
    found = tuple(q.plain_number("--bracket", part, wanted) for part in parts)
    if len({offset_name(ev) for ev in found}) < len(found) or max(map(abs, found)) > MOST_EV:
        raise UsageError(
            f"--bracket: wanted {wanted}, each once, within {MOST_EV:g} EV; got {text!r}"
        )
    return found
