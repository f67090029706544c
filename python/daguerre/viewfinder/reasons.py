"""Reasons: texts of errors for pages."""

from __future__ import annotations

from daguerre.errors import DaguerreError
from daguerre.lenses.errors import LensError


def reason_of(error: Exception) -> str:
    """Message of an error; an error that a user cannot correct names the place to report it."""
    match error:
        case LensError(code="lens-focus-near"):
            return "The lens does not focus that near: focus farther away, or move the camera back."
        case DaguerreError():
            return str(error)
        case MemoryError():
            return "out of memory: use a smaller picture"
        case OSError(strerror=str(reason)):
            return f"{error.filename}: {reason}"
    what = f"{type(error).__name__}: {error}"
    return f"internal error: {what}; this is a bug in daguerre: please report it"
