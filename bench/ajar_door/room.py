"""A room that gets all its light through a door ajar: meshes, materials and camera, numpy only.

z is up, in metres. The lamp is a panel on the ceiling of a corridor behind the wall at y = 5; the
door's leaf stands between it and the gap, so next to all light in the room has met two surfaces or
more. Colours are mild, as renderers of three colours and of spectra part in saturated ones.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

Mesh = tuple[np.ndarray, np.ndarray]
Point = tuple[float, float, float]

MATERIALS: dict[str, tuple[str, Point]] = {
    "paint": ("diffuse", (0.72, 0.71, 0.69)),
    "floor": ("diffuse", (0.42, 0.38, 0.34)),
    "wood": ("diffuse", (0.45, 0.36, 0.28)),
    "cloth": ("diffuse", (0.30, 0.38, 0.48)),
    "brass": ("glossy", (0.85, 0.72, 0.50)),
    "steel": ("glossy", (0.72, 0.73, 0.75)),
}
ALPHA = 0.2  # of GGX, for what is glossy
LAMP = {"at": (4.3, 6.1, 2.58), "half": 0.3, "radiance": (5500.0, 5300.0, 5000.0)}
CAMERA: dict[str, Any] = {
    "origin": (0.9, 0.35, 1.5),
    "target": (2.3, 4.2, 0.9),
    "focal_mm": 28.0,
    "f_stop": 2.8,
}
DOOR_DEG = 45.0


def box(low: Point, high: Point) -> Mesh:
    """An axis-parallel box, its faces outward."""
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [f for a, b, c, d in quads for f in ((a, b, c), (a, c, d))]
    return np.asarray(low) + corners * np.subtract(high, low), np.array(faces, np.int32)


def ball(at: Point, radius: float, rows: int = 48) -> Mesh:
    """A faceted ball."""
    theta, phi = np.meshgrid(
        np.linspace(0, np.pi, rows + 1), np.linspace(0, 2 * np.pi, 2 * rows + 1), indexing="ij"
    )
    unit = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], -1)
    i, j = (k.ravel() for k in np.mgrid[0:rows, 0 : 2 * rows])
    a = i * (2 * rows + 1) + j
    b = a + 2 * rows + 1
    upper, lower = np.stack([a, b, a + 1], -1)[i > 0], np.stack([a + 1, b, b + 1], -1)[i < rows - 1]
    return np.asarray(at) + radius * unit.reshape(-1, 3), np.concatenate([upper, lower])


def joined(meshes: Iterable[Mesh]) -> Mesh:
    """One mesh of several."""
    points, faces, first = [], [], 0
    for v, f in meshes:
        points.append(v)
        faces.append(f + first)
        first += len(v)
    return np.concatenate(points), np.concatenate(faces).astype(np.int32)


def door() -> Mesh:
    """The leaf, hinged at x = 3.5 and opened into the corridor."""
    v, f = box((-0.9, 0, 0.005), (0, 0.04, 2.04))
    c, s = np.cos(np.radians(-DOOR_DEG)), np.sin(np.radians(-DOOR_DEG))
    return v @ np.array([(c, s, 0), (-s, c, 0), (0, 0, 1)]) + (3.5, 5.1, 0), f


def build() -> dict[str, tuple[Mesh, str]]:
    """Meshes and the names of their materials."""
    walls = [
        *(box((-0.1, -0.1, 0), (0, 7.2, 2.6)), box((5, -0.1, 0), (5.1, 7.2, 2.6))),
        *(box((-0.1, -0.1, 0), (5.1, 0, 2.6)), box((-0.1, 7.1, 0), (5.1, 7.2, 2.6))),
        *(box((0, 5, 0), (2.6, 5.1, 2.6)), box((3.5, 5, 0), (5, 5.1, 2.6))),
        box((2.6, 5, 2.05), (3.5, 5.1, 2.6)),
        box((-0.1, -0.1, 2.6), (5.1, 7.2, 2.7)),
    ]
    legs = [box((x, y, 0), (x + 0.05, y + 0.05, 0.7)) for x in (1.2, 2.35) for y in (2.6, 3.25)]
    table = [box((1.1, 2.5, 0.7), (2.5, 3.4, 0.74)), *legs]
    sofa = [
        box((0.15, 3.9, 0.1), (1.9, 4.75, 0.42)),
        box((0.15, 4.55, 0.42), (1.9, 4.8, 0.85)),
        box((3.9, 1.5, 0.1), (4.8, 3.2, 0.45)),
    ]
    return {
        "walls": (joined(walls), "paint"),
        "ground": (box((-0.1, -0.1, -0.1), (5.1, 7.2, 0)), "floor"),
        "door": (door(), "wood"),
        "table": (joined(table), "wood"),
        "sofa": (joined(sofa), "cloth"),
        "plaster": (ball((1.45, 2.85, 0.90), 0.16), "paint"),
        "brass": (ball((1.85, 3.1, 0.88), 0.14), "brass"),
        "steel": (ball((2.2, 2.75, 0.86), 0.12), "steel"),
    }


def lamp() -> Mesh:
    """The panel, which shines down."""
    x, y, z = LAMP["at"]
    h = LAMP["half"]
    v = [(x - h, y - h, z), (x + h, y - h, z), (x + h, y + h, z), (x - h, y + h, z)]
    return np.array(v), np.array([(0, 2, 1), (0, 3, 2)], np.int32)


def focus_distance() -> float:
    """Distance of the target along the axis, m."""
    return float(np.linalg.norm(np.subtract(CAMERA["target"], CAMERA["origin"])))


def camera_matrix() -> np.ndarray:
    """World from camera, which looks along -z with y up."""
    z = np.subtract(CAMERA["origin"], CAMERA["target"]) / focus_distance()
    x = np.cross((0, 0, 1), z)
    x /= np.linalg.norm(x)
    m = np.eye(4)
    m[:3, 0], m[:3, 1], m[:3, 2], m[:3, 3] = x, np.cross(z, x), z, CAMERA["origin"]
    return m
