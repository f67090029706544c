"""Numbers of light paths (from the lights to the film): reads and checks the parameters.

See ``docs/light-paths.md``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from daguerre.checks import short
from daguerre.errors import UsageError

#: Numbers of light paths per sample index: from a light directly to the lens, and with bounces.
Plan = tuple[float, float]
OFF: Plan = (0.0, 0.0)
TECHNIQUES = ("both", "camera", "light")
MOST = 1e9
#: Paths per sample index that ``auto`` uses, for each pixel of the frame.
PER_PIXEL = {"flare": 0.5, "scatter": 2.0}
WANTED = f"auto, off, or one or two numbers of paths for each sample, 0 .. {MOST:g}"


def check_light_paths(value: object, where: str = "light_paths") -> Plan | None:
    """Reads the numbers of light paths; None: a pilot render chooses them.

    Args:
        value: ``"auto"``, ``"off"``, M1, (M1, M2), or numbers as text: ``"2000,500"``.
        where: Name of the parameter, for messages.

    Raises:
        UsageError: Another value, or a number out of range.
    """
    if isinstance(value, str) and value == "auto":
        return None
    if isinstance(value, str) and value == "off":
        return OFF
    parts: Sequence[Any] = value.split(",") if isinstance(value, str) else _pair(value)
    numbers = _path_counts(parts, 2)
    if numbers is None:
        raise UsageError(f"{where}: wanted {WANTED}; got {short(value)}")
    return numbers[0], numbers[1] if len(numbers) == 2 else 0.0


def check_paths(value: object, where: str) -> float | None:
    """Reads the number of paths of one kind per sample index; 0: off; None: automatic.

    Args:
        value: ``"auto"``, ``"off"``, or a number, which may be text.
        where: Name of the parameter, for messages.

    Raises:
        UsageError: Another value, or a number out of range.
    """
    if isinstance(value, str) and value == "auto":
        return None
    if isinstance(value, str) and value == "off":
        return 0.0
    paths = _path_counts([value], 1)
    if paths is None:
        wanted = f"auto, off, or a number of paths for each sample, 0 .. {MOST:g}"
        raise UsageError(f"{where}: wanted {wanted}; got {short(value)}")
    return paths[0]


def _path_counts(parts: Sequence[Any], most: int) -> list[float] | None:
    """Reads one to ``most`` numbers of paths per sample index, which may be text; None: invalid."""
    try:
        if any(isinstance(part, bool | bytes) for part in parts):
            return None
        numbers = [float(part) for part in parts]
    except (TypeError, ValueError, OverflowError):
        return None
    fit = 1 <= len(numbers) <= most and all(math.isfinite(m) and 0 <= m <= MOST for m in numbers)
    return numbers if fit else None


def _pair(value: object) -> Sequence[Any]:
    return value if isinstance(value, list | tuple) else [value]


def show_plan(plan: Plan) -> str | None:
    """Numbers of light paths as text, in the form of ``--light-paths``; None if off."""
    return None if plan == OFF else ",".join(f"{m:.17g}" for m in plan)


def check_highlights(value: object, where: str = "flare_highlights") -> bool:
    """Reads whether light that reaches the lens by mirrors, glass and walls has ghosts.

    Raises:
        UsageError: The value is neither on nor off.
    """
    if isinstance(value, str) and value in ("on", "off"):
        return value == "on"
    if isinstance(value, bool):
        return value
    raise UsageError(f"{where}: wanted on or off, got {short(value)}")
