"""Small scenes that tests share, built from arrays."""

from __future__ import annotations

import numpy as np

import daguerre as dg


def sphere(segments: int = 32, radius: float = 1.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions, triangles and normals of a UV sphere, seen from outside."""
    theta = np.linspace(0, np.pi, segments + 1)
    phi = np.linspace(0, 2 * np.pi, 2 * segments + 1)
    t, p = np.meshgrid(theta, phi, indexing="ij")
    normals = np.stack([np.sin(t) * np.cos(p), np.cos(t), np.sin(t) * np.sin(p)], -1).reshape(-1, 3)
    columns = 2 * segments + 1
    triangles = []
    for i in range(segments):
        for j in range(2 * segments):
            a, b = i * columns + j, (i + 1) * columns + j
            if i > 0:
                triangles.append((a, a + 1, b + 1))
            if i < segments - 1:
                triangles.append((a, b + 1, b))
    return normals * radius, np.array(triangles), normals


def quad(size: float, z: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """A square in the plane z, facing +z."""
    corners = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], float) * size
    return corners + np.array((0, 0, z)), np.array([(0, 1, 2), (0, 2, 3)])


def furnace(material: dg.Material | None = None) -> dg.Scene:
    """A white sky of luminance 1, and a ball of the material 3 m in front of the camera."""
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    if material is not None:
        points, triangles, normals = sphere()
        transform = np.eye(4)
        transform[2, 3] = -3
        scene.add_instance(scene.add_mesh(points, triangles, normals), material, transform)
    return scene


def lamp_room() -> dg.Scene:
    """A floor and two balls under an area light, a small lamp and a dim sky."""
    scene = dg.Scene()
    floor, faces = quad(8)
    tilt = np.array([[1, 0, 0, 0], [0, 0, 1, -1], [0, -1, 0, -4], [0, 0, 0, 1.0]])
    scene.add_instance(
        scene.add_mesh(floor, faces), dg.Material(dg.Diffuse((0.6, 0.5, 0.4))), tilt, name="floor"
    )
    points, triangles, normals = sphere(16)
    ball = scene.add_mesh(points, triangles, normals)
    for x, kind in ((-1.1, dg.Conductor((0.9, 0.7, 0.4), 0.2)), (1.1, dg.Diffuse((0.2, 0.5, 0.7)))):
        transform = np.eye(4)
        transform[:3, 3] = (x, 0, -5)
        scene.add_instance(ball, dg.Material(kind), transform, name=f"ball {x}")
    lamp, faces = quad(0.7)
    # +z of the quad turns to -y
    down = np.array([[1, 0, 0, 0.5], [0, 0, -1, 3], [0, 1, 0, -4], [0, 0, 0, 1.0]])
    scene.add_instance(
        scene.add_mesh(lamp, faces),
        dg.Material(dg.Diffuse((0, 0, 0)), emission=(12, 11, 9)),
        down,
        name="lamp",
    )
    scene.add_light(dg.SphereLight((40, 60, 90), 0.05, name="bulb"), at(-1.5, 1.5, -4))
    scene.set_environment(color=(0.05, 0.06, 0.08))
    return scene


def at(x: float, y: float, z: float) -> np.ndarray:
    """A translation."""
    transform = np.eye(4)
    transform[:3, 3] = (x, y, z)
    return transform
