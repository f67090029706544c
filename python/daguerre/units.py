"""Quantities as people type them: ``250cm``, ``2in``, ``1/48``, ``16.6ms``, ``f/2.8``, ``36x24``.

Messages of a parser name its flag. A number without a unit is in the unit of the parameter.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

from .errors import UsageError, suggest

#: metres
LENGTHS = {
    "nm": 1e-9,
    "um": 1e-6,
    "mm": 1e-3,
    "cm": 1e-2,
    "m": 1.0,
    "km": 1e3,
    "in": 0.0254,
    "ft": 0.3048,
}
#: seconds
TIMES = {"us": 1e-6, "ms": 1e-3, "s": 1.0, "min": 60.0, "m": 60.0, "h": 3600.0}
#: degrees
ANGLES = {"deg": 1.0, "rad": 180 / math.pi}
#: The helium d line to the digits that users type and commands print, nm: the default of
#: ``--wavelength``. The lens code has all its digits (``lenses.lens.DESIGN_WAVELENGTH_NM``).
TYPED_D_LINE_NM = 587.56
#: Edges of a region of a picture, in the order in which four plain numbers give them.
EDGES = ("left", "top", "right", "bottom")
#: Width x height, mm. s35: the camera aperture of 35 mm film, 4 perforations (SMPTE ST 59).
SENSORS = {
    "ff": (36.0, 24.0),
    "apsc": (23.6, 15.7),
    "apsc-canon": (22.3, 14.9),
    "mft": (17.3, 13.0),
    "1inch": (13.2, 8.8),
    "s35": (24.89, 18.66),
    "s16": (12.52, 7.41),
    "645": (56.0, 41.5),
}

#: f-numbers and T-numbers, for messages.
F_NUMBER = "an f-stop such as 2.8, f/2.8 or f2.8"
_T_NUMBER = "a T-stop such as 2.8, T/2.8 or T2.8"

_NUMBER = re.compile(
    r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?:/\d+\.?\d*)?|[-+]?inf)\s*([a-z]*)"
)


def length_mm(flag: str, text: str) -> float:
    """Parses a length, mm; a number without a unit is in mm."""
    return _quantity(flag, text, LENGTHS, "mm", "a length such as 50, 50mm, 5cm or 2in") * 1e3


def pitch_um(flag: str, text: str) -> float:
    """Parses a pixel pitch, um; a number without a unit is in um."""
    wanted = "a pixel pitch such as 3.45, 3.45um or 0.00345mm"
    return _finite(flag, text, _quantity(flag, text, LENGTHS, "um", wanted)) * 1e6


def distance_m(flag: str, text: str) -> float:
    """Parses a distance, m, or ``inf``; a number without a unit is in m."""
    return _quantity(flag, text, LENGTHS, "m", "a distance such as 2.5, 250cm, 8ft or inf")


def unit_m(flag: str, text: str) -> float:
    """Parses the length of a unit, m, such as ``mm`` or ``25mm``."""
    wanted = "a unit such as mm, 25mm or 0.001"
    if text.isalpha() and text not in LENGTHS:
        raise _bad(flag, wanted, text)
    value = _quantity(flag, f"1{text}" if text.isalpha() else text, LENGTHS, "m", wanted)
    if not 1e-9 <= value <= 1e9:
        raise _bad(flag, wanted, text)
    return value


def time_s(flag: str, text: str) -> float:
    """Parses a time, s; a number without a unit is in s."""
    return _finite(
        flag, text, _quantity(flag, text, TIMES, "s", "a time such as 1/48, 0.02 or 16.6ms")
    )


def angle_deg(flag: str, text: str) -> float:
    """Parses an angle, degrees; a number without a unit is in degrees."""
    value = _quantity(flag, text, ANGLES, "deg", "an angle such as 30, 30deg or 0.5rad")
    return _finite(flag, text, value)


def plain_number(flag: str, text: str, wanted: str) -> float:
    """Parses a number without a unit, or a fraction of two numbers."""
    return _finite(flag, text, _quantity(flag, text, {"": 1.0}, "", wanted))


def f_number(flag: str, text: str) -> float:
    """Parses an f-number: ``2.8``, ``f/2.8`` or ``f2.8``."""
    return _stop(flag, text, "f", F_NUMBER)


def t_number(flag: str, text: str) -> float:
    """Parses a T-number: ``2.8``, ``T/2.8`` or ``T2.8``."""
    return _stop(flag, text, "T", _T_NUMBER)


def _stop(flag: str, text: str, letter: str, wanted: str) -> float:
    """Parses an f-number or T-number; a fraction such as a shutter time is an error."""
    number = re.fullmatch(rf"(?:{letter}/?)?([^/:]*)", text.strip(), re.IGNORECASE)
    if number is None:
        ratio = re.fullmatch(r"1[/:](\d+\.?\d*)", text.strip())
        near = f" (did you mean {letter}/{ratio[1]}?)" if ratio and float(ratio[1]) <= 64 else ""
        raise UsageError(f"{flag}: wanted {wanted}; got {text!r}{near}")
    try:
        value = _quantity(flag, number[1], {"": 1.0}, "", wanted)
    except UsageError:
        raise _bad(flag, wanted, text) from None
    return _finite(flag, text, value)


def white(flag: str, text: str) -> float | tuple[float, float]:
    """Parses a white: a colour temperature, K, such as ``5600`` or ``5600K``, or x,y."""
    if "," in text:
        x, y = numbers(flag, text, 2, "0.3127,0.3290")
        return x, y
    wanted = "a colour temperature such as 5600, or x,y such as 0.3127,0.3290"
    kelvin = text.strip().removesuffix("K").removesuffix("k")
    return _finite(flag, text, _quantity(flag, kelvin, {"": 1.0}, "", wanted))


def decenter(
    flag: str, text: str
) -> tuple[tuple[int, int], tuple[float, float], tuple[float, float]]:
    """Parses ``FIRST-LAST:X,Y[,AX,AY]``: surfaces (0 is the front), mm, degrees."""
    wanted = "surfaces, mm and degrees such as 3-5:0.1,0 or 3-5:0,0,0.2,0"
    match = re.fullmatch(r"\s*(\d+)(?:-(\d+))?\s*:(.*)", text)
    if not match:
        raise _bad(flag, wanted, text)
    first = int(match[1])
    count = 2 if match[3].count(",") == 1 else 4
    try:
        x, y, a, b = (*numbers(flag, match[3], count, ""), 0.0, 0.0)[:4]
    except UsageError:
        raise _bad(flag, wanted, text) from None
    return (first, int(match[2] or first)), (x, y), (a, b)


def numbers(flag: str, text: str, count: int, example: str) -> tuple[float, ...]:
    """Parses ``count`` finite numbers between commas."""
    wanted = f"{count} numbers such as {example}" if count > 1 else f"numbers such as {example}"
    parts = text.split(",")
    if len(parts) != count:
        raise _bad(flag, wanted, text)
    values = tuple(_quantity(flag, part, {"": 1.0}, "", wanted) for part in parts)
    return tuple(_finite(flag, text, value) for value in values)


def integers(flag: str, text: str, count: int, example: str) -> tuple[int, ...]:
    """Parses ``count`` whole numbers between commas."""
    values = numbers(flag, text, count, example)
    if any(value != int(value) for value in values):
        raise _bad(flag, f"{count} whole numbers such as {example}", text)
    return tuple(int(value) for value in values)


def edges(flag: str, text: str) -> tuple[int | None, ...]:
    """Parses edges of a region, px: ``left=100,right=400``, or all of them in the order of EDGES.

    Returns:
        Left, top, right and bottom; None: not given.
    """
    wanted = "edges such as left=100,top=50,right=400,bottom=300"
    if "=" not in text:
        try:
            return integers(flag, text, 4, "100,50,400,300")
        except UsageError:
            raise _bad(flag, f"{wanted}, or 100,50,400,300", text) from None
    found: dict[str, int] = {}
    for part in text.split(","):
        name, _, value = (word.strip() for word in part.partition("="))
        if name not in EDGES:
            raise UsageError(f"{flag}: wanted {wanted}; got {name!r}{suggest(name, EDGES)}")
        if name in found:
            raise UsageError(f"{flag}: {name} appears twice")
        try:
            (found[name],) = integers(flag, value, 1, "100")
        except UsageError:
            raise _bad(f"{flag}: {name}", "a whole number of pixels", value) from None
    return tuple(found.get(name) for name in EDGES)


def edges_text(edges: Sequence[int | None]) -> str:
    """Text from which :func:`edges` reads the same edges."""
    named = zip(EDGES, edges, strict=True)
    return ",".join(f"{name}={value}" for name, value in named if value is not None)


def sensor_mm(flag: str, text: str) -> tuple[float, float]:
    """Parses a sensor size: ``36x24``, mm, or the name of a common size."""
    name = text.strip().lower()
    if name in SENSORS:
        return SENSORS[name]
    parts = name.split("x")
    if len(parts) != 2 or not name[:1].isdigit():
        raise UsageError(
            f"{flag}: wanted a size in mm such as 36x24, or one of {', '.join(SENSORS)}; "
            f"got {text!r}{suggest(name, SENSORS)}"
        )
    try:
        width, height = (length_mm(flag, part) for part in parts)
    except UsageError:
        raise _bad(flag, "a size in mm such as 36x24", text) from None
    if not (0 < width < math.inf and 0 < height < math.inf):
        raise _bad(flag, "a size above 0 such as 36x24", text)
    return width, height


def resolution(flag: str, text: str, default: tuple[int, int]) -> tuple[int, int]:
    """Parses a picture size, px: ``960x540``, or a share of the default such as ``50%``."""
    wanted = "a size in pixels such as 960x540, or a share such as 50%"
    share = re.fullmatch(r"\s*(\d+\.?\d*)\s*%\s*", text)
    if share:
        factor = float(share[1]) / 100
        size = (round(default[0] * factor), round(default[1] * factor))
    else:
        match = re.fullmatch(r"\s*(\d+)\s*[xX]\s*(\d+)\s*", text)
        if not match:
            raise _bad(flag, wanted, text)
        size = (int(match[1]), int(match[2]))
    if not all(1 <= value <= 65536 for value in size):
        raise _bad(flag, "1 to 65536 pixels each way", text)
    return size


def sample_range(flag: str, text: str) -> tuple[int, int]:
    """Parses ``a:b``: the samples from a up to, not including, b."""
    match = re.fullmatch(r"\s*(\d+)\s*:\s*(\d+)\s*", text)
    if not match or not int(match[1]) < int(match[2]):
        raise _bad(flag, "a range a:b with a < b, such as 32:64", text)
    return int(match[1]), int(match[2])


def memory_bytes(flag: str, text: str) -> float:
    """Parses an amount of memory, bytes, or a share up to 1: 8GB, 512MiB, 50%."""
    wanted = "an amount of memory above 0 such as 8GB, 512MiB or 50%"
    plain = text.strip().lower()
    share = plain.endswith("%")
    units = {"b": 1.0, "kb": 1e3, "mb": 1e6, "gb": 1e9, "tb": 1e12}
    units |= {"kib": 2.0**10, "mib": 2.0**20, "gib": 2.0**30, "tib": 2.0**40}
    units = {"share": 0.01} if share else units
    value = _quantity(flag, plain.removesuffix("%"), units, "share" if share else "", wanted)
    if not (0 < value <= 1 if share else 1 < value < math.inf):
        raise _bad(flag, wanted, text)
    return value


def _quantity(flag: str, text: str, units: dict[str, float], default: str, wanted: str) -> float:
    match = _NUMBER.fullmatch(text.strip())
    unit = (match[2] or default) if match else ""
    if not match or unit not in units:
        raise _bad(flag, wanted, text)
    number = match[1]
    try:
        if "/" in number:
            from fractions import Fraction

            top, bottom = number.split("/")
            value = float(Fraction(top) / Fraction(bottom))
        else:
            value = float(number)
    except ZeroDivisionError:
        raise _bad(flag, wanted, text) from None
    # Divide where the factor is a whole reciprocal: 16.6ms is then the float nearest to 0.0166.
    factor = units[unit]
    inverse = round(1 / factor) if factor < 1 else 0
    return value / inverse if inverse and math.isclose(inverse * factor, 1) else value * factor


def _finite(flag: str, text: str, value: float) -> float:
    if not math.isfinite(value):
        raise _bad(flag, "a finite number", text)
    return value


def _bad(flag: str, wanted: str, text: str) -> UsageError:
    return UsageError(f"{flag}: wanted {wanted}; got {text!r}")
