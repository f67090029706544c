# SPDX-License-Identifier: GPL-3.0-or-later
"""Exposure mode of a camera's panel; a meter chooses once for all frames and eyes of a render."""

from typing import Any

import bpy

from daguerre.camera.camera import Camera
from daguerre.camera.exposure_mode import is_automatic
from daguerre.rendering.auto_exposure import Chosen, choose
from daguerre.rendering.session import Session

from .choices import OLD_METERS
from .translation import Shot

#: Choices of the render under way, by the camera's name.
_chosen: dict[str, Chosen] = {}


def session_of(shot: Shot, middle: Camera, name: str) -> Session:
    """Session of a picture, whose camera is exposed as the meter says.

    Args:
        shot: The picture.
        middle: Its camera; of a stereo pair that between the eyes, which is metered.
        name: Name of the camera.
    """
    if not is_automatic(shot.camera.exposure):
        return Session(shot.scene, shot.camera, settings=shot.settings)
    built = None
    if name not in _chosen:
        _chosen[name], built = choose(shot.scene, middle, shot.settings)
    chosen = _chosen[name]
    session = Session(shot.scene, chosen.of(shot.camera), settings=shot.settings, built=built)
    session.metering = chosen.facts
    return session


def words_of(name: str) -> list[str]:
    """What a meter chose for a camera in this render, and what is missing."""
    chosen = _chosen.get(name)
    return [] if chosen is None else [text for text in (chosen.note, chosen.warning) if text]


def old_meter(group: Any) -> str | None:
    """Metering pattern that a file of before 1.0 names as the exposure mode; None: it does not."""
    kept = group.bl_system_properties_get()
    return None if kept is None else OLD_METERS.get(kept.get("exposure_mode"))


@bpy.app.handlers.persistent  # type: ignore[untyped-decorator]
def _forget(*_: Any) -> None:
    """Forgets choices before a render, which may be of many frames."""
    _chosen.clear()


def register() -> None:
    """Meters anew in each render."""
    bpy.app.handlers.render_init.append(_forget)


def unregister() -> None:
    """Removes the handler."""
    bpy.app.handlers.render_init.remove(_forget)
