"""Lights and cameras at several moments, as values over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any

from daguerre.camera.camera import Camera
from daguerre.camera.parameters import OPTICS
from daguerre.files.value import same
from daguerre.motion.values import Composite, keys
from daguerre.scene.scene import Scene

#: Pairs (time in s, value).
Moments = Sequence[tuple[float, Any]]
#: Optics that may change while the shutter is open.
_OPTICS = tuple(row.name for row in OPTICS if row.movable)


def camera_over_time(moments: Moments) -> dict[str, Any]:
    """Parameters of a camera that change, as values over time, by name."""
    return _changing(moments, _OPTICS)


def moving_camera(camera: Camera, moments: Moments, time: float) -> Camera:
    """A camera with its motion, at a time, s."""
    changes = camera_over_time(moments)
    return camera.with_(**changes).evaluated_at(time) if changes else camera


def _changing(moments: Moments, names: Sequence[str]) -> dict[str, Any]:
    """Fields that differ between moments, as keys; a field that is None at a moment is constant."""
    found = {}
    for name in names:
        pairs = [(t, getattr(value, name)) for t, value in moments]
        first = pairs[0][1]
        if any(value is None for _, value in pairs) or all(same(first, v) for _, v in pairs):
            continue
        found[name] = keys(pairs)
    return found


def _at_all(value: Any, moments: Moments) -> Any:
    """A light or a material with values over time where it changes."""
    return replace(value, **_changing(moments, [one.name for one in fields(value)]))


def move_lights(scene: Scene, first: tuple[int, int], moments: Moments) -> bool:
    """Moves the lights and instances that a light became.

    Args:
        scene: The scene.
        first: Number of lights and of instances before it was added.
        moments: Pairs (time in s, a scene of this light alone).

    Returns:
        Whether each moment has as many of both.
    """
    lights, instances = len(scene.lights) - first[0], len(scene.instances) - first[1]
    scenes = [one for _, one in moments]
    if any(len(x.lights) != lights or len(x.instances) != instances for x in scenes):
        return False
    for k in range(lights):
        shine = [(t, one.lights[k][0]) for t, one in moments]
        place = [(t, one.lights[k][1]) for t, one in moments]
        if not _rests(shine) or not _rests(place):
            light = _at_all(scene.lights[first[0] + k][0], shine)
            scene.motion.lights[first[0] + k] = Composite((light, keys(place)))
    for k in range(instances):
        place = [(t, one.instances[k].transform) for t, one in moments]
        if not _rests(place):
            scene.motion.instances[first[1] + k] = keys(place)
    return True


def _rests(moments: Moments) -> bool:
    return all(same(moments[0][1], value) for _, value in moments)
