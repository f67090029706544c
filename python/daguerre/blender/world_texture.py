"""Environment textures of a world, resampled to a panorama of the scene.

Cycles looks along a direction d, after the Mapping node, at u = 1/2 - atan2(d_y, d_x) / (2 pi) and
v = 1/2 + asin(d_z) / pi of an equirectangular picture. A mirror ball shows, at a point of its disc,
the direction into which a ball reflects the gaze along +y. A panorama of the scene has -z, which is
Blender's +y, at its centre.

Source: Blender manual, Environment Texture and Mapping nodes; ``tests/blender/test_world.py``
holds both against Cycles.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from daguerre.files.notes import Notes

from .pictures import LINEAR, pixels_of

if TYPE_CHECKING:
    import bpy


Array = NDArray[np.float64]
Picture = NDArray[np.float32]
#: Most rows of a panorama, and pixels that are looked up at once.
_MOST_ROWS, _CHUNK = 4096, 1 << 18
#: Samples across a pixel of the panorama.
_FINE = 2


def environment_texture(node: bpy.types.ShaderNode, notes: Notes) -> Picture | None:
    """Panorama of an environment texture, shape (H, W, 3); None: the nodes need a bake.

    Args:
        node: Node that gives the colour of a background.
        notes: Receives notes on unsupported content.
    """
    if node.bl_idname != "ShaderNodeTexEnvironment":
        return None
    found = _mapping(node.inputs["Vector"])
    if found is None:
        return None
    pixels = pixels_of(node.image)
    if pixels is None:
        notes.add("the picture of a world is missing: the world is black")
        return np.zeros((1, 2, 3), np.float32)
    name = node.image.colorspace_settings.name
    if not node.image.is_float and name not in ("sRGB", *LINEAR):
        notes.add(f"the colour space {name} of a world's picture is read as linear")
    mirrored = node.projection == "MIRROR_BALL"
    rows = min(len(pixels) if not mirrored else len(pixels) // 2, _MOST_ROWS)
    return resampled(pixels, max(rows, 8), found, mirrored=mirrored)


def _mapping(socket: bpy.types.NodeSocket) -> tuple[Array, Array] | None:
    """Matrix and shift of the direction that is looked up; None: the nodes need a bake."""
    if not socket.is_linked:
        return np.eye(3), np.zeros(3)
    link = socket.links[0]
    if link.from_node.bl_idname == "ShaderNodeTexCoord":
        return (np.eye(3), np.zeros(3)) if link.from_socket.name == "Generated" else None
    node = link.from_node
    if node.bl_idname != "ShaderNodeMapping":
        return None
    parts = [node.inputs.get(name) for name in ("Location", "Rotation", "Scale")]
    if any(part is not None and part.is_linked for part in parts):
        return None
    inner = _mapping(node.inputs["Vector"])
    if inner is None or not node.inputs["Vector"].is_linked:
        return None
    outer = _matrix(node.vector_type, *(_values(part) for part in parts))
    if outer is None:
        return None
    return outer[0] @ inner[0], outer[0] @ inner[1] + outer[1]


def _values(part: bpy.types.NodeSocket | None) -> Array:
    return np.zeros(3) if part is None else np.array(part.default_value, np.float64)


def _matrix(kind: str, place: Array, angles: Array, scale: Array) -> tuple[Array, Array] | None:
    """Matrix and shift of a Mapping node; None: it normalizes."""
    turn = _euler(angles)
    if kind == "POINT":
        return turn @ np.diag(scale), place
    if kind == "VECTOR":
        return turn @ np.diag(scale), np.zeros(3)
    if kind == "TEXTURE":
        back = np.diag(1 / np.where(scale == 0, np.inf, scale)) @ turn.T
        return back, -back @ place
    return None


def _euler(angles: Array) -> Array:
    """Rotation about x, then y, then z, radians."""
    (sx, sy, sz), (cx, cy, cz) = np.sin(angles), np.cos(angles)
    about_x = np.array([(1, 0, 0), (0, cx, -sx), (0, sx, cx)])
    about_y = np.array([(cy, 0, sy), (0, 1, 0), (-sy, 0, cy)])
    about_z = np.array([(cz, -sz, 0), (sz, cz, 0), (0, 0, 1)])
    return np.asarray(about_z @ about_y @ about_x)


def resampled(
    pixels: Picture, rows: int, mapping: tuple[Array, Array], *, mirrored: bool = False
) -> Picture:
    """Resamples a picture of a world to a panorama of the scene.

    Args:
        pixels: Picture, shape (H, W, 3), row 0 on top.
        rows: Rows of the panorama.
        mapping: Matrix, shape (3, 3), and shift of the direction that is looked up.
        mirrored: Whether it is a mirror ball.

    Returns:
        Shape (rows, 2 * rows, 3).
    """
    columns = 2 * rows * _FINE
    longitude = ((np.arange(columns) + 0.5) / columns - 0.5) * 2 * math.pi
    made = np.empty((rows, 2 * rows, 3), np.float32)
    step = max(1, _CHUNK // (columns * _FINE))
    for first in range(0, rows, step):
        fine = np.arange(first * _FINE, min(first + step, rows) * _FINE)
        latitude = (0.5 - (fine + 0.5) / (rows * _FINE)) * math.pi
        level = np.cos(latitude)[:, None]
        high = np.broadcast_to(np.sin(latitude)[:, None], (len(fine), columns))
        ways = np.stack([level * np.sin(longitude), level * np.cos(longitude), high], axis=-1)
        ways = ways @ mapping[0].T + mapping[1]
        seen = _looked_up(pixels, *(_on_ball if mirrored else _on_globe)(ways), around=not mirrored)
        boxes = seen.reshape(len(fine) // _FINE, _FINE, 2 * rows, _FINE, 3)
        made[first : first + step] = boxes.mean(axis=(1, 3))
    return made


def _on_globe(ways: Array) -> tuple[Array, Array]:
    """Place in an equirectangular picture, right and up, 0 to 1."""
    x, y, z = np.moveaxis(ways, -1, 0)
    across = 0.5 - np.arctan2(y, x) / (2 * math.pi)
    return across, 0.5 + np.arctan2(z, np.hypot(x, y)) / math.pi


def _on_ball(ways: Array) -> tuple[Array, Array]:
    """Place in a picture of a mirror ball, right and up, 0 to 1.

    The normal that reflects the gaze g = (0, 1, 0) into a direction d is (d - g) / |d - g|.
    """
    unit = ways / np.maximum(np.linalg.norm(ways, axis=-1, keepdims=True), 1e-30)
    normal = unit - (0.0, 1.0, 0.0)
    normal /= np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-12)
    return 0.5 + 0.5 * normal[..., 0], 0.5 + 0.5 * normal[..., 2]


def _looked_up(pixels: Picture, across: Array, up: Array, *, around: bool) -> Array:
    """Pixels at places, interpolated; the picture repeats to the side if it goes around."""
    height, width = pixels.shape[:2]
    x = across * width - 0.5
    y = np.clip((1 - up) * height - 0.5, 0, height - 1)
    x = x if around else np.clip(x, 0, width - 1)
    left, top = np.floor(x), np.floor(y)
    right_share, down_share = (x - left)[..., None], (y - top)[..., None]
    first, second = (np.asarray(left + k, np.int64) % width for k in (0, 1))
    upper = np.asarray(top, np.int64)
    lower = np.minimum(upper + 1, height - 1)
    above = pixels[upper, first] * (1 - right_share) + pixels[upper, second] * right_share
    below = pixels[lower, first] * (1 - right_share) + pixels[lower, second] * right_share
    return np.asarray(above * (1 - down_share) + below * down_share)
