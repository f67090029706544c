"""A house front without end, flat and evenly lit, with pale plaster and coloured shutters.

Straight lines show distortion, the even plaster shows vignetting, and fine louvers show where a
picture is sharp. Each camera stands where its lens sees 13.5 x 9 m of the wall.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.exporters.gltf import Glb
from imperfections.glow import Glow
from kit import shapes, textures

#: Focal lengths, mm, that the cameras are named after.
CAMERAS = (8, 15, 17, 25, 35, 50, 85, 100, 200)
HIGH = 9.0  # m of the wall in 24 mm
BAY, FLOOR = 260, 300  # px of 1 cm
SHUTTERS = ((0.10, 0.36, 0.36), (0.62, 0.14, 0.10), (0.78, 0.55, 0.12), (0.16, 0.26, 0.52))
Picture = NDArray[np.float64]


def make() -> Glb:
    """The wall and its cameras."""
    glow = Glow()
    wide, high = 208.0, 144.0
    tile = _tile()
    repeat = (wide / (0.01 * tile.shape[1]), high / (0.01 * tile.shape[0]))
    glow.hang("wall", shapes.square(wide, high, (0, 0, *repeat)), tile, (0, 0, 0))
    for focal_length in CAMERAS:
        away = HIGH * focal_length / 24
        camera = glow.glb.add_camera(f"{focal_length} mm", focal_length, 8, round(away, 4))
        glow.glb.add_node(f"{focal_length} mm", camera=camera, translation=(0.0, 0.45, away))
    return glow.glb


def _tile() -> Picture:
    """Two floors of four bays, sRGB; the shutters of the upper one are two further."""
    rows = []
    for floor in range(2):
        bays = [_bay(SHUTTERS[(k + 2 * floor) % 4], 4 * floor + k) for k in range(4)]
        rows.append(np.concatenate(bays, axis=1))
    return np.concatenate(rows)


def _bay(color: tuple[float, float, float], seed: int) -> Picture:
    """A window with open shutters and a box of flowers; joints in the plaster, a cornice below."""
    bay = np.full((FLOOR, BAY, 3), (0.86, 0.81, 0.72))
    bay += 0.012 * textures.noise((FLOOR, BAY), (6, 6), seed)[..., None]
    bay[::50] *= 0.80
    bay[1::50] *= 0.86
    for course in range(6):  # upright joints, staggered
        at = BAY // 4 + BAY // 2 * (course % 2)
        bay[50 * course : 50 * course + 50, at : at + 2] *= 0.84
    bay[270:286] = (0.93, 0.90, 0.84)
    bay[286:290] = (0.52, 0.48, 0.44)
    _window(bay[72:238, 80:180])
    for left in (28, 184):
        _shutter(bay[76:234, left : left + 48], color)
    _flowers(bay[226:262, 74:186], seed)
    return bay


def _window(part: Picture) -> None:
    """White frame and bars, panes that mirror the sky."""
    part[:] = (0.94, 0.93, 0.90)
    high, wide = part.shape[:2]
    fall = np.linspace(0, 1, high)[:, None] * np.ones(wide)
    panes = textures.ramp(fall, [(0.42, 0.50, 0.58), (0.16, 0.19, 0.23), (0.10, 0.11, 0.13)])
    y, x = np.mgrid[:high, :wide]
    glass = (y > 7) & (y < high - 7) & (x > 7) & (x < wide - 7)
    glass &= (np.abs(x - wide / 2) > 4) & (np.abs(y - 0.38 * high) > 3)
    part[glass] = panes[glass]


def _shutter(part: Picture, color: tuple[float, float, float]) -> None:
    """Louvers in a frame."""
    part[:] = color
    inside = part[8:-8, 7:-7]
    lines = 0.72 + 0.38 * (np.arange(len(inside)) % 8 / 7.0)
    inside *= lines[:, None, None]
    part[[0, -1]] *= 0.5
    part[:, [0, -1]] *= 0.5


def _flowers(part: Picture, seed: int) -> None:
    """Leaves and blossoms over a box of clay."""
    part[22:] = (0.58, 0.33, 0.22)
    part[22:24] *= 0.7
    rng = np.random.default_rng(seed)
    y, x = np.mgrid[: part.shape[0], : part.shape[1]]
    for k in range(160):
        at = rng.uniform(4, 24), rng.uniform(3, part.shape[1] - 3)
        green = (0.20, 0.36 + 0.12 * rng.random(), 0.14)
        color = green if k < 110 else ((0.82, 0.16, 0.18), (0.93, 0.86, 0.88))[k % 2]
        part[np.hypot(y - at[0], x - at[1]) < rng.uniform(1.5, 3.6)] = color
