"""The triangles that a scene shows, in the world, to compare two scenes."""

import numpy as np
from scipy.spatial import cKDTree


def of(scene, names=None):
    """Corners of all triangles: positions, normals and texture coordinates, shape (T, 3, 8)."""
    wanted = range(len(scene.instances))
    if names is not None:
        wanted = sorted({i for name in names for i in scene.nodes[name]})
    return np.concatenate([_triangles(scene, scene.instances[i]) for i in wanted])


def _triangles(scene, instance):
    mesh, world = scene.meshes[instance.mesh], instance.transform
    points = mesh.positions.astype(float) @ world[:3, :3].T + world[:3, 3]
    corners = points[mesh.indices]
    if mesh.normals is None:
        faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        faces *= np.sign(np.linalg.det(world[:3, :3]))  # a mirror turns the order of corners
        normals = np.repeat(faces[:, None], 3, axis=1)
    else:
        normals = (mesh.normals.astype(float) @ np.linalg.inv(world[:3, :3]))[mesh.indices]
    normals /= np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-30)
    uv = np.zeros((len(points), 2)) if mesh.uv is None else mesh.uv
    return np.concatenate([corners, normals, uv[mesh.indices]], axis=-1)


def farthest(a, b):
    """Largest differences of positions, normals and uv of triangles, each with its partner.

    Partners are those whose middles are nearest; each has one, else an error.
    """
    assert len(a) == len(b)
    middles = [t[..., :3].mean(axis=1) for t in (a, b)]
    near = cKDTree(middles[1]).query(middles[0])[1]
    assert len(np.unique(near)) == len(b)
    turns = np.stack([np.roll(b[near], k, axis=1) for k in range(3)])
    best = np.abs(turns - a)[..., :3].max(axis=(2, 3)).argmin(axis=0)
    apart = np.abs(turns[best, np.arange(len(a))] - a)
    return tuple(float(apart[..., part].max()) for part in (slice(3), slice(3, 6), slice(6, 8)))
