"""Files of drawings: early checks of suffixes and of whether they can be written, and writing."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from daguerre.errors import UsageError

from . import console

FORMATS = (".svg", ".png", ".pdf")


def check_drawing(
    flag: str, path: Path | None, *, plotted: bool = True, formats: Sequence[str] = FORMATS
) -> None:
    """Checks that a drawing can be made and written.

    Args:
        flag: Flag of the drawing, for messages.
        path: The file; None: no drawing.
        plotted: Whether it needs the extra ``plot`` for any suffix.
        formats: Suffixes that it may have.
    """
    from daguerre.files.atomic import check_writable
    from daguerre.plots.lens_file import check_available

    if path is None:
        return
    suffix = path.suffix.lower()
    if suffix not in formats:
        raise UsageError(
            f"{flag}: wanted a name ending in {' or '.join(formats)}, got {str(path)!r}"
        )
    check_available(suffix, needed=plotted)
    check_writable(path)


def write_drawing(path: Path, data: bytes) -> None:
    """Writes the bytes of a drawing atomically, and says so."""
    from daguerre.files.atomic import write_bytes

    write_bytes(path, data)
    console.note(f"wrote {path}")
