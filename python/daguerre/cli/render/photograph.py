"""Flags of a photograph: exposure set by hand or by a meter, brackets, development."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from daguerre import units as q
from daguerre.errors import UsageError
from daguerre.rendering.photograph import Photograph, offset_name

if TYPE_CHECKING:
    from daguerre.plates.match.plate_camera import PlateCamera

#: Camera parameters that concern only exposure and development; any of them turns development on.
ASKING = (
    *("sensor", "iso", "exposure_compensation", "exposure_time", "exposure_f_stop"),
    *("responsivity", "white_balance"),
)
MOST_EV, MOST_SHOTS = 20.0, 15


def photograph_of(
    changes: dict[str, Any],
    exposure: str | None,
    bracket: str | None,
    look: str | None,
    seed: int,
    plate: PlateCamera | None = None,
) -> Photograph:
    """Makes the photograph from flags; ``plate``: camera whose look pictures imitate.

    Raises:
        UsageError: A flag is wrong, or excludes another.
    """
    iso, sensor = changes.get("iso"), changes.get("sensor")
    if plate is not None and exposure is not None:
        raise UsageError(
            "--exposure auto and --like-plate: wanted one of them, got both; the plate sets the ISO"
        )
    if exposure is not None and iso is not None:
        raise UsageError("--exposure auto and --iso: wanted one of them, got both")
    if iso is not None and not iso > 0:
        raise UsageError(f"--iso: wanted a number above 0, got {iso:g}")
    if sensor is not None:
        from daguerre.exposure.expose import check_can_expose

        check_can_expose(sensor, iso)
    asked = any(name in changes for name in ASKING) or any((exposure, bracket, look, plate))
    if look is not None:
        from daguerre.development.develop import Recipe

        Recipe.of(look=look)
    like = None
    if plate is not None:
        from daguerre.plates.match.like import PlateLook

        like, look = PlateLook(plate), look or plate.look
    return Photograph(
        asked,
        sensor,
        iso,
        None if exposure is None else _metering(exposure),
        changes.get("exposure_compensation", 0.0),
        () if bracket is None else _offsets(bracket),
        look,
        seed,
        changes.get("focus_at"),
        like,
    )


def _metering(text: str) -> str:
    from daguerre.exposure.metering import mode_of

    return mode_of("--exposure", text)


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
