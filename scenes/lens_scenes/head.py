"""A marble head, life-size: what a portrait lens is for."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.exporters.gltf import Shape
from kit import shapes, textures
from kit.pose import turn_y
from night.stage import Stage

Heights = NDArray[np.float64]

# Height above the eyes, half width, depth to the front, depth to the back, m: top to chin.
OUTLINE = np.array(
    [
        (0.132, 0.000, 0.000, 0.000),
        (0.129, 0.017, 0.018, 0.030),
        (0.119, 0.035, 0.038, 0.058),
        (0.102, 0.053, 0.058, 0.083),
        (0.074, 0.068, 0.076, 0.100),
        (0.040, 0.076, 0.085, 0.105),
        (0.000, 0.074, 0.082, 0.099),
        (-0.030, 0.070, 0.080, 0.084),
        (-0.060, 0.061, 0.077, 0.060),
        (-0.085, 0.049, 0.072, 0.036),
        (-0.105, 0.032, 0.058, 0.016),
        (-0.116, 0.014, 0.034, 0.005),
        (-0.120, 0.000, 0.000, 0.000),
    ]
)


def add_head(stage: Stage) -> None:
    """Head, neck and foot, turned a little away; the eyes are in the plane of focus."""
    marble = stage.matter(
        "marble",
        baseColorTexture=stage.glb.add_picture("marble", textures.jpeg(_marble())),
        roughnessFactor=0.45,
    )
    neck = shapes.lathe(
        shapes.smooth_profile(
            [(0.085, -0.215), (0.088, -0.198), (0.070, -0.188), (0.053, -0.162), (0.050, -0.05)]
        )
    )
    rotation = turn_y(14)
    place = {"translation": [-0.115, 0.0, -0.072], "rotation": rotation}
    stage.put("head", _face(), marble, **place)
    stage.put("neck", shapes.moved(neck, (0, 0, -0.012)), marble, **place)
    gold = stage.matter(
        "gold", baseColorFactor=[1.0, 0.77, 0.34, 1], metallicFactor=1.0, roughnessFactor=0.15
    )
    angle = np.linspace(0, 2 * np.pi, 30, endpoint=False)
    ring = np.stack([0.062 * np.sin(angle), -0.160 - 0.010 * np.cos(angle), 0 * angle], 1)
    ring[:, 2] = 0.062 * np.cos(angle) - 0.012
    bead = shapes.ball(0.0058, 10, 20)
    beads = shapes.join(*(shapes.moved(bead, at) for at in ring))
    stage.put("necklace", beads, gold, **place)


def _face(rows: int = 180, columns: int = 240) -> Shape:
    """The head without the neck: an egg by its outline, with features pushed in and out."""
    s = np.linspace(0, len(OUTLINE) - 1, rows)
    y, width, front, back = (_curve(s, OUTLINE[::-1, k])[:, None] for k in range(4))
    angle = np.linspace(-np.pi, np.pi, columns)[None, :]
    cos = np.cos(angle)
    x = width * np.sin(angle)
    depth = np.where(cos > 0, front, back) * cos
    outward = np.clip(cos, 0, 1) ** 0.5
    z = depth + outward * _features(x, y)
    hair = _hair(angle, y)
    out = np.maximum(np.hypot(x, depth), 1e-9)
    grid = np.stack([x * (1 + hair / out), y + 0 * x + 0.4 * hair, z + hair * depth / out], -1)
    grid[[0, -1]] = grid[[0, -1]].mean(axis=1, keepdims=True)
    return shapes.surface(grid, (2, 1))


def _curve(s: Heights, values: Heights) -> Heights:
    """A Catmull-Rom curve through `values` at 0, 1, 2 ..."""
    p = np.concatenate([[2 * values[0] - values[1]], values, [2 * values[-1] - values[-2]]])
    k = np.minimum(s.astype(int), len(values) - 2)
    t = s - k
    a, b, c, d = (p[k + j] for j in range(4))
    bend = (2 * a - 5 * b + 4 * c - d) * t**2 + (3 * b - a - 3 * c + d) * t**3
    return 0.5 * (2 * b + (c - a) * t + bend)


def _features(x: Heights, y: Heights) -> Heights:
    """Nose, brow, eyes, lips and chin: how far each stands out, m."""

    def bump(size: float, at: tuple[float, float], spread: tuple[float, float]) -> Heights:
        return size * np.exp(-(((x - at[0]) / spread[0]) ** 2) - (((y - at[1]) / spread[1]) ** 2))

    rise = np.clip((0.014 - y) / 0.056, 0, 1) ** 1.2
    tip = np.where(y < -0.042, np.exp(-(((y + 0.042) / 0.007) ** 2)), 1)
    nose = 0.026 * rise * tip * np.exp(-((x / (0.008 + 0.006 * rise)) ** 2))
    out = (
        nose
        + bump(-0.005, (0, -0.0715), (0.020, 0.0022))
        + bump(0.008, (0, -0.103), (0.018, 0.012))
    )
    out += bump(0.007, (0, -0.066), (0.017, 0.0055)) + bump(0.007, (0, -0.0775), (0.015, 0.006))
    for side in (-1, 1):
        out += bump(-0.013, (side * 0.031, 0.0), (0.017, 0.012))
        out += bump(0.008, (side * 0.031, 0.0), (0.011, 0.0075))
        out += bump(-0.002, (side * 0.031, -0.001), (0.013, 0.0012))
        out += bump(0.005, (side * 0.028, 0.019), (0.022, 0.006))
        out += bump(0.004, (side * 0.045, -0.032), (0.018, 0.018))
        out += bump(0.006, (side * 0.010, -0.044), (0.005, 0.005))
    return out


def _hair(angle: Heights, y: Heights) -> Heights:
    """Locks above the hairline, which is high in front and low at the back; m."""
    line = 0.072 - 0.14 * np.clip((np.abs(angle) - 0.55) / 1.6, 0, 1) ** 1.3
    amount = np.clip((y - line) / 0.010, 0, 1) * np.clip((0.131 - y) / 0.015, 0, 1)
    lock = np.sin(22 * angle + 5 * np.sin(90 * y)) + 0.4 * np.sin(61 * angle - 140 * y)
    return amount * (0.0075 + 0.0022 * lock)


def _marble(size: int = 256) -> NDArray[np.float64]:
    """White with grey veins."""
    vein = np.abs(textures.noise((size, size), (30, 14), 3))
    grain = textures.noise((size, size), (1.2, 1.2), 4)
    shade = 0.86 - 0.10 * np.exp(-8 * vein) + 0.012 * grain
    return np.asarray(shade[..., None] * np.array([1.0, 0.985, 0.955]))
