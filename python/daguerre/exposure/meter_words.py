"""Readings and choices of a meter, in words."""

from __future__ import annotations

import math

from .metering import ev100_of

NO_LIGHT = "no light to meter, so the exposure mode is light"
#: Largest difference in stops that is not visible.
_SLIGHT = 0.05


def reading(pattern: str, luminance: float, ev: float, words: str) -> str:
    """Note on a reading, and the flags that give the same picture.

    Args:
        pattern: Metering pattern.
        luminance: Luminance taken for middle grey, cd/m2.
        ev: Exposure compensation, EV.
        words: Flags of the command line.
    """
    compensated = f", {ev:+g} EV" if ev else ""
    return (
        f"metered ({pattern}): {luminance:.3g} cd/m2, EV100 {ev100_of(luminance):.1f}"
        f"{compensated}; the same picture: {words}"
    )


def missing(ends: str, share: float) -> str:
    """Note on an exposure that the limits of a mode do not allow; empty: they do.

    Args:
        ends: Limits of the mode, such as ``ISO 100 .. 6400``.
        share: Exposure over the wanted exposure.
    """
    stops = math.log2(share)
    if abs(stops) <= _SLIGHT:
        return ""
    side = "dark" if stops < 0 else "bright"
    return f"{ends} cannot expose this: the picture is {abs(stops):.1f} EV too {side}"


def distance(mode: str, stops: float | None, part: str = "") -> str:
    """Mode of a picture and its distance from the meter.

    Args:
        mode: Exposure mode.
        stops: Distance, EV; None: there is nothing to meter.
        part: Part of the picture that was metered, such as `` in this crop``.
    """
    if stops is None:
        return f"{mode}, nothing to meter"
    if abs(stops) < _SLIGHT:
        return f"{mode}, as metered"
    return f"{mode}, {abs(stops):.1f} EV {'over' if stops > 0 else 'under'} the meter{part}"
