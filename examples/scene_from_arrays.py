"""Builds a scene from NumPy arrays: a rippled pond, a lamp above it, a camera at its edge.

    python examples/scene_from_arrays.py [FOLDER]        (default: out)

Shows: meshes as vertices and triangles, materials, lights, and where a camera stands. The
world is in metres with +y up; transforms are 4x4 matrices; a camera looks along its own -z.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import daguerre as dg

EYE, TARGET = np.array([0.0, 0.9, 1.9]), np.array([0.0, 0.0, 0.0])


def pond(n: int = 120) -> tuple[np.ndarray, np.ndarray]:
    """A square of 2 x 2 m: vertices (n * n, 3), m, and triangles (2 (n - 1)^2, 3)."""
    x, z = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n))
    r = np.hypot(x, z)
    height = 0.04 * np.cos(25 * r) * np.exp(-2 * r)
    k = np.arange(n * n).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]))
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return np.stack([x, height, z], axis=2).reshape(-1, 3), triangles


def look_at(eye: np.ndarray, target: np.ndarray) -> np.ndarray:
    """World from camera, shape (4, 4)."""
    back = (eye - target) / np.linalg.norm(eye - target)
    right = np.cross((0, 1, 0), back)
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3] = np.column_stack([right, np.cross(back, right), back, eye])
    return pose


def main(folder: str = "out", width: int = 480, spp: int = 32) -> None:
    """Builds, renders and saves."""
    scene, lamp = dg.Scene(), np.eye(4)
    water = dg.Gltf(base_color=(0.05, 0.2, 0.3), metallic=0.0, roughness=0.15)
    scene.add_instance(scene.add_mesh(*pond()), water, name="pond")
    lamp[:3, 3] = -0.5, 1.5, -1.0
    scene.add_light(dg.SphereLight(luminance=(200, 180, 150), radius=0.1), lamp)
    scene.set_environment(color=(0.2, 0.25, 0.4))
    distance = float(np.linalg.norm(EYE - TARGET))
    camera = dg.Camera(look_at(EYE, TARGET), focal_length=50, f_stop=4, focus_distance=distance)
    frame = dg.render(scene, camera, resolution=(width, 2 * width // 3), spp=spp, aovs=True)
    Path(folder).mkdir(parents=True, exist_ok=True)
    frame.save(f"{folder}/scene_from_arrays.exr")
    frame.save(f"{folder}/scene_from_arrays.png", tone="soft")


if __name__ == "__main__":
    main(*sys.argv[1:2])
