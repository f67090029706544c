"""Exposure modes and metering patterns: their names, and texts of them."""

from __future__ import annotations

from daguerre.checks import short
from daguerre.errors import UsageError, suggest

#: Exposure modes; the last four let a meter choose ISO, time, f-stop, or time and f-stop.
LIGHT = "light"
MODES = (LIGHT, "manual", "auto", "A", "S", "P")
AUTOMATIC = MODES[2:]
#: Parameters of a camera that set exposure time and f-stop, which a mode may choose.
TIMES = ("shutter_time", "shutter_angle", "exposure_time")
STOPS = ("f_stop", "t_stop", "aperture_diameter", "exposure_f_stop")
CHOSEN: dict[str, tuple[str, ...]] = {
    "auto": ("iso",), "A": TIMES, "S": STOPS, "P": (*TIMES, *STOPS)
}  # fmt: skip
#: Choice of a mode, in words.
CHOICES = {
    "auto": "the ISO", "A": "the exposure time", "S": "the f-stop", "P": "the time and the f-stop"
}  # fmt: skip
#: Modes that a picture can have after it is taken: modes without a choice of time or stop.
RETAKEN = (LIGHT, "manual", "auto")
METERS = ("centre", "spot", "matrix", "highlight")


def mode_of(where: str, text: str) -> str:
    """Parses an exposure mode.

    Raises:
        UsageError: There is no such mode.
    """
    if str(text) not in MODES:
        known = {name.lower(): name for name in MODES}
        hint = suggest(known.get(str(text).lower(), str(text)), MODES, few=True)
        raise UsageError(f"{where}: wanted {', '.join(MODES)}; got {short(text)}{hint}")
    return text


def retaken_mode(where: str, text: str) -> str:
    """Parses the exposure mode of a picture that is already taken.

    Raises:
        UsageError: There is no such mode, or it chooses time or stop.
    """
    wanted = f"{', '.join(RETAKEN[:-1])} or {RETAKEN[-1]}"
    if text in RETAKEN:
        return text
    if text in MODES:
        raise UsageError(f"{where} {text}: the picture is already taken; wanted {wanted}")
    hint = suggest(str(text).lower(), RETAKEN, few=True)
    raise UsageError(f"{where}: wanted {wanted}; got {short(text)}{hint}")


def meter_of(where: str, text: str) -> str:
    """Parses a metering pattern; ``center`` is valid, too.

    Raises:
        UsageError: There is no such pattern.
    """
    pattern, colon, place = str(text).partition(":")
    pattern = "centre" if pattern == "center" else pattern
    if pattern not in METERS or (colon and (pattern != "spot" or not place.strip())):
        raise UsageError(
            f"{where}: wanted {', '.join(METERS)}, spot:X,Y or spot:NODE; got {short(text)}"
            f"{suggest(pattern, METERS)}"
        )
    return f"{pattern}{colon}{place}"


def is_automatic(exposure: str) -> bool:
    """Whether a meter chooses the exposure in a mode of a camera.

    Raises:
        UsageError: There is no such mode.
    """
    return mode_of("camera: exposure", exposure) in AUTOMATIC


def chosen_by(exposure: str) -> tuple[str, ...]:
    """Names of the parameters that a mode chooses; empty: none."""
    return CHOSEN.get(exposure, ())


def split_pattern(pattern: str) -> tuple[str, str]:
    """Returns the kind of a metering pattern and the position of its spot; empty: not given."""
    kind, _, place = pattern.partition(":")
    return kind, place
