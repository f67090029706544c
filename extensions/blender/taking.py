# SPDX-License-Identifier: GPL-3.0-or-later
"""Takes the picture that F12 would draw, without drawing it.

Modifiers, particles and visibility have values of their own for a render, and Blender evaluates
those only within one. So a render begins, and ends when its scene is translated.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import bpy

from daguerre.errors import InputError

from . import translation

#: Who takes the next picture; None: it is drawn.
taker: "Taker | None" = None


class Taker:
    """Receives one picture, or the error that prevents it."""

    def __init__(self, layer: str) -> None:
        self.shot: translation.Shot | None = None
        self.error: Exception | None = None
        self._layer = layer

    def take(self, depsgraph: Any, go: translation.FrameSet) -> None:
        """Translates a view layer: the first one, or that of the window."""
        if self.shot is not None and depsgraph.view_layer.name != self._layer:
            return
        try:
            scene = translation.scene_of(depsgraph, go)
            self.shot = translation.shot_of(depsgraph, scene, depsgraph.scene.camera)
        except Exception as error:  # the operator tells it
            self.error = error


def shot_of(context: Any, engine: str) -> translation.Shot:
    """Picture of the scene's camera, as F12 would draw it.

    Args:
        context: Context with the scene.
        engine: Name of the engine that calls the taker.

    Raises:
        InputError: Nothing is rendered.
    """
    global taker
    taker = found = Taker(context.view_layer.name)
    render = context.scene.render
    try:
        with _set(render, engine=engine, use_sequencer=False, use_compositing=False), _aside():
            bpy.ops.render.render()
    finally:
        taker = None
    if found.error is not None:
        raise found.error
    if found.shot is None:
        raise InputError("scene: wanted a view layer that is rendered, got none")
    return found.shot


@contextmanager
def _aside() -> Iterator[None]:
    """Lets a render go to the last slot of Blender's pictures, so that the one shown stays."""
    shown = next((one for one in bpy.data.images if one.type == "RENDER_RESULT"), None)
    slots = None if shown is None else shown.render_slots
    if slots is None or len(slots) < 2:
        yield
        return
    before = slots.active_index
    slots.active_index = len(slots) - 1 if before < len(slots) - 1 else 0
    try:
        yield
    finally:
        slots.active_index = before


@contextmanager
def _set(owner: Any, **values: Any) -> Iterator[None]:
    """Sets properties for a while; those that have the value already are left alone."""
    before = {name: getattr(owner, name) for name in values}
    changed = {name: value for name, value in values.items() if before[name] != value}
    try:
        for name, value in changed.items():
            setattr(owner, name, value)
        yield
    finally:
        for name in changed:
            setattr(owner, name, before[name])
