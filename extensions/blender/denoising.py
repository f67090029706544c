# SPDX-License-Identifier: GPL-3.0-or-later
"""The denoiser: that of Daguerre's package if it is installed, else the one that Blender has."""

from functools import cache
from pathlib import Path

import bpy

from daguerre.errors import UsageError
from daguerre.files import extras
from daguerre.rendering.denoise import MODULE
from daguerre.rendering.denoiser import Denoiser, of_library

#: Blender's library; its parts have other names.
_NAME = "libOpenImageDenoise.so.?"


def is_there() -> bool:
    """Whether there is a denoiser."""
    return not extras.missing(MODULE) or of_blender() is not None


def of_blender() -> Denoiser | None:
    """Blender's own denoiser; None: there is none, or the package serves."""
    return _loaded() if extras.missing(MODULE) else None


@cache
def _loaded() -> Denoiser | None:
    for path in libraries():
        try:
            return of_library(path)
        except UsageError:
            continue
    return None


def libraries() -> list[Path]:
    """Libraries of Open Image Denoise that this Blender comes with."""
    local = bpy.utils.resource_path("LOCAL")  # empty if Blender is a part of the system
    return sorted((Path(local).parent / "lib").glob(_NAME)) if local else []
