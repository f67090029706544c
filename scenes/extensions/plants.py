"""Plants of the garden, and how one thing comes to stand at thousands of places."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.exporters.gltf import ARRAY_BUFFER, FLOAT, Shape
from extensions.studio import Studio
from kit import shapes


def scatter(
    studio: Studio, name: str, mesh: int, places: ArrayLike, turns: ArrayLike, sizes: ArrayLike
) -> None:
    """One mesh at many places: (N, 3) m, quaternions (N, 4), scales (N,)."""
    glb = studio.glb
    columns: list[tuple[str, str, NDArray[Any]]] = [
        ("TRANSLATION", "VEC3", np.asarray(places)),
        ("ROTATION", "VEC4", np.asarray(turns)),
        ("SCALE", "VEC3", np.asarray(sizes)[:, None] * np.ones(3)),
    ]
    accessors = {
        key: glb.add_accessor(values, kind, FLOAT, target=ARRAY_BUFFER)
        for key, kind, values in columns
    }
    glb.use("EXT_mesh_gpu_instancing")
    glb.add_node(name, mesh=mesh, extensions={"EXT_mesh_gpu_instancing": {"attributes": accessors}})


def any_turn(rng: np.random.Generator, count: int, tilt: float) -> NDArray[np.float64]:
    """Quaternions about the vertical, then tilted by up to `tilt` rad."""
    yaw, lean = rng.uniform(0, 2 * math.pi, count) / 2, rng.normal(0, tilt, count) / 2
    y, w, x = np.sin(yaw), np.cos(yaw), np.sin(lean)
    return np.stack([w * x, y * np.cos(lean), -y * x, w * np.cos(lean)], 1)


def leafy(studio: Studio, name: str, color: ArrayLike, through: ArrayLike, **more: Any) -> int:
    """Thin matter that lets half of the light through, in a colour of its own."""
    glow = {
        "diffuseTransmissionFactor": 0.5,
        "diffuseTransmissionColorFactor": np.asarray(through, float).tolist(),
    }
    return studio.matter(
        name,
        np.asarray(color, float).tolist(),
        0.55,
        doubleSided=True,
        extensions={"diffuse_transmission": glow},
        **more,
    )


def blade(height: float, width: float) -> Shape:
    """A blade of grass that bends forward, m."""
    t = np.linspace(0, 1, 5)
    half = width / 2 * (1 - t**1.5)[:, None] * [-1, 1]
    bend = 0.45 * height * t**2
    grid = np.stack(
        [half, np.broadcast_to((height * t)[:, None], half.shape), bend[:, None] + 0 * half], -1
    )
    return shapes.surface(grid)


def leaf() -> NDArray[np.floating]:
    """A leaf with veins; alpha cuts its outline."""
    y, x = (np.mgrid[0:128, 0:64] + 0.5) / [[[128]], [[64]]] * 2 - 1
    width = np.clip(1 - y**2, 0, 1) ** 0.8 * (0.85 + 0.08 * np.cos(26 * y))
    vein = (np.abs(x) < 0.05) | (np.abs((y + 0.6 * np.abs(x)) * 5 % 1 - 0.5) < 0.06)
    color = np.where(vein[..., None], (0.62, 0.75, 0.4), (0.33, 0.52, 0.2))
    return np.concatenate([color, (np.abs(x) < width)[..., None].astype(float)], -1)


def stones(seed: int, size: int = 28) -> NDArray[np.floating]:
    """Little stones in the pattern of a flower."""
    y, x = (np.mgrid[0:size, 0:size] + 0.5) / size * 2 - 1
    r, a = np.hypot(x, y), np.arctan2(y, x)
    petal = r < 0.45 + 0.3 * np.cos((5 + seed % 3) * a)
    rings = ((r * 9).astype(int) % 2)[..., None]
    blue, white = np.array([0.12, 0.3, 0.5]), np.array([0.85, 0.8, 0.7])
    color = np.where(petal[..., None], (0.75, 0.3, 0.12), blue * rings + white * (1 - rings))
    color = np.where((r < 0.16)[..., None], (0.9, 0.7, 0.25), color)
    return color + np.random.default_rng(seed).normal(0, 0.05, color.shape)
