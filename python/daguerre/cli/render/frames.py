"""``--frames``: frame numbers of a sequence, and names of their files."""

from __future__ import annotations

import re
from pathlib import Path

from daguerre.errors import UsageError
from daguerre.rendering.names import has_frame

MOST = 1_000_000
_RANGE = re.compile(r"\s*(-?\d{1,9})(?:-(-?\d{1,9})(?:x(\d{1,9}))?)?\s*")


def frame_numbers(flag: str, text: str) -> list[int]:
    """Parses ``1-48``, ``1-48x2`` (every second frame), ``7``, or several with commas between."""
    wanted = "frames such as 1-48, 1-48x2 or 1,5,9-12"
    found: dict[int, None] = {}
    for part in text.split(","):
        match = _RANGE.fullmatch(part)
        if not match:
            raise UsageError(f"{flag}: wanted {wanted}; got {text!r}")
        first = int(match[1])
        last = int(match[2]) if match[2] else first
        step = int(match[3]) if match[3] else 1
        if last < first or step < 1:
            raise UsageError(f"{flag}: wanted {wanted}, each range from low to high; got {text!r}")
        if len(found) + (last - first) // step >= MOST:
            raise UsageError(f"{flag}: wanted at most {MOST} frames; got {text!r}")
        found |= dict.fromkeys(range(first, last + 1, step))
    return list(found)


def check_names(outputs: list[Path], frames: list[int] | None) -> None:
    """Checks that several frames have # in their file names, and that # has frames.

    Raises:
        UsageError: Names without # for several frames, or with # and no frames.
    """
    for path in outputs:
        has_place = has_frame(path)
        if frames is None and has_place:
            raise UsageError(f"-o {path}: # stands for the frame number and needs --frames")
        if frames is not None and len(frames) > 1 and not has_place:
            raise UsageError(
                f"-o {path}: wanted a name with # for {len(frames)} frames, "
                f"such as {path.stem}.####{path.suffix}"
            )
