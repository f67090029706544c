"""Rows of a COLMAP model, whether its files are text or binary."""

from __future__ import annotations

from typing import NamedTuple

#: Numbers of files are smaller.
MOST = 1e15


class CameraRow(NamedTuple):
    """A camera: its number as a name, its model, width and height (px), and its parameters."""

    where: str
    name: str
    model: str
    size: tuple[float, float]
    numbers: list[float]


class ImageRow(NamedTuple):
    """A picture: quaternion (w, x, y, z) and translation, camera from world; camera; name."""

    where: str
    pose: list[float]
    camera: str
    name: str
