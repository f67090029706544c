# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors as texts for Blender's reports."""

import logging

from daguerre.errors import DaguerreError

_log = logging.getLogger("daguerre.blender")


def told(error: Exception) -> str:
    """Text of an error for the user, who may not know where it comes from."""
    return f"Daguerre: {text_of(error)}"


def text_of(error: Exception) -> str:
    """Text of an error for the user; that of a fault of ours asks to report it."""
    if isinstance(error, DaguerreError | OSError):
        return str(error)
    if isinstance(error, MemoryError):
        return "picture: wanted more memory than there is"
    _log.debug("internal error", exc_info=error)
    return f"internal error ({type(error).__name__}: {error}); please report it"
