"""Pictures that lamps project, as profiles of point lights: one lamp for each of red, green, blue.

A profile is a table over the angles from and about the axis. Each of its values is the mean over
the directions around it, so that the light of a picture is kept; its edges are as soft as the
steps of the table.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from daguerre.scene.light_profile import LightProfile
from daguerre.scene.materials import Color
from daguerre.shading import lookup
from daguerre.shading.channels import Channel, Texel, Value, broadcast

Array = NDArray[np.float64]
#: Steps from the axis and around it, and samples of each along both.
_THETA, _PHI, _FINE = 640, 1600, 3
#: Color by directions in Mitsuba's frame of the lamp, x, y and z, each of shape (N,): shape (N, 3).
Shine = Callable[[Array, Array, Array], Array]


def lamps(shine: Shine, widest: float) -> list[tuple[Color, LightProfile]]:
    """Intensities and profiles of lamps in one place; their sum is the light.

    Args:
        shine: Intensity by direction, cd.
        widest: Largest angle from the axis at which light leaves, radians.
    """
    table = _table(shine, widest)
    theta = np.degrees(_centres(widest, _THETA))
    phi = np.arange(_PHI) * (360 / _PHI)
    if np.array_equal(table[:, :, 0], table[:, :, 1]) and np.array_equal(
        table[:, :, 0], table[:, :, 2]
    ):
        return [((1.0, 1.0, 1.0), LightProfile.table(theta, table[:, :, 0], phi))]
    found: list[tuple[Color, LightProfile]] = []
    for channel, color in enumerate(((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))):
        if table[:, :, channel].any():
            found.append((color, LightProfile.table(theta, table[:, :, channel], phi)))
    return found


def _centres(widest: float, steps: int) -> Array:
    """Angles of the table: from the axis to half a step beyond the widest."""
    return np.linspace(0, min(widest * (1 + 0.5 / steps), math.pi), steps)


def _table(shine: Shine, widest: float) -> Array:
    """Means around the angles of a table, shape (T, P, 3)."""
    centres = _centres(widest, _THETA)
    step = centres[1] - centres[0]
    offsets = (np.arange(_FINE) + 0.5) / _FINE - 0.5
    turn = 2 * math.pi / _PHI
    phi = (np.arange(_PHI)[:, None] + offsets).reshape(-1) * turn
    made = np.empty((_THETA, _PHI, 3))
    for i, centre in enumerate(centres):
        theta = np.abs(centre + step * offsets)
        sine, cosine = np.sin(theta)[:, None], np.cos(theta)[:, None]
        # our lamps shine along -z: Mitsuba's x and z are turned around
        x, y = -sine * np.cos(phi), sine * np.sin(phi)
        z = np.broadcast_to(cosine, x.shape)
        colors = shine(x.reshape(-1), y.reshape(-1), z.reshape(-1))
        made[i] = colors.reshape(_FINE, _PHI, _FINE, 3).mean(axis=(0, 2))
    return made


def looked_up(value: Value, u: Array, v: Array) -> Array:
    """Colours of a texture at coordinates from the top left, shape (N, 3)."""
    return np.stack([_channel(channel, u, v) for channel in broadcast(value, 3)], axis=1)


def _channel(channel: Channel, u: Array, v: Array) -> Array:
    if not isinstance(channel, Texel):
        return np.full(len(u), channel if isinstance(channel, float) else 1.0)
    return np.asarray(lookup.looked_up(channel, u, 1 - v), np.float64)
