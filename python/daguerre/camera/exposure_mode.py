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
    """Parses an exposure mode; ``auto:PATTERN``, as before version 1.0, is valid, too.

    Raises:
        UsageError: There is no such mode.
    """
    mode, colon, pattern = str(text).partition(":")
    if colon and mode == "auto":
        return f"auto:{meter_of(where, pattern)}"
    if str(text) not in MODES:
        known = {name.lower(): name for name in MODES}
        hint = suggest(known.get(mode.lower(), mode), MODES, few=True)
        raise UsageError(f"{where}: wanted {', '.join(MODES)}; got {short(text)}{hint}")
    return text


def retaken_mode(where: str, text: str) -> str:
    """Parses the exposure mode of a picture that is already taken.

    Raises:
        UsageError: There is no such mode, or it chooses time or stop.
    """
    wanted = f"{', '.join(RETAKEN[:-1])} or {RETAKEN[-1]}"
    mode = mode_of(where, text)
    if mode in AUTOMATIC and mode not in RETAKEN:
        raise UsageError(f"{where} {mode}: the picture is already taken; wanted {wanted}")
    if mode not in RETAKEN:
        raise UsageError(f"{where}: wanted {wanted}; got {short(text)}")
    return mode


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


def split_mode(exposure: str, meter: str = "") -> tuple[str, str]:
    """Returns the mode and the pattern, which ``auto:PATTERN`` names, too."""
    mode, colon, pattern = exposure.partition(":")
    return mode, pattern if colon else meter


def is_automatic(exposure: str) -> bool:
    """Whether a meter chooses the exposure in a mode of a camera.

    Raises:
        UsageError: There is no such mode.
    """
    return split_mode(mode_of("camera: exposure", exposure))[0] in AUTOMATIC


def chosen_by(exposure: str) -> tuple[str, ...]:
    """Names of the parameters that a mode chooses; empty: none."""
    return CHOSEN.get(split_mode(exposure)[0], ())


def split_pattern(pattern: str) -> tuple[str, str]:
    """Returns the kind of a metering pattern and the position of its spot; empty: not given."""
    kind, _, place = pattern.partition(":")
    return kind, place
