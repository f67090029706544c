"""Files that are drawn: their endings, and whether they can be written, before there is work."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from daguerre.errors import UsageError

FORMATS = (".svg", ".png", ".pdf")


def check_drawing(
    flag: str, path: Path | None, *, plotted: bool = True, formats: Sequence[str] = FORMATS
) -> None:
    """Refuses a drawing that cannot be made or written.

    Args:
        flag: That named it.
        path: The file; None: no drawing.
        plotted: By the extra ``plot``, whatever the ending.
        formats: Endings that it may have.
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
