"""Applies skins: vertices follow joints by linear blending of the joints' transforms.

A skinned mesh is in world space; the transform of its node is ignored.
Source: glTF 2.0 specification, chapter 3.7.3.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.files.json_item import Item
from daguerre.files.notes import Notes
from daguerre.files.value import Value
from daguerre.scene.skinning import Influences, blended
from daguerre.scene.transforms import affine

from .accessors import Accessors
from .nodes import Tree
from .poses import Poses

FloatArray = NDArray[np.float32]
# Tolerance of sums of four or eight weights that were rounded to bytes.
_SLACK = 0.01


@dataclass(frozen=True, eq=False)
class SkinOverTime(Value):
    """The joints that move a mesh, over time.

    Attributes:
        poses: The nodes of the file.
        joints: Indices of the nodes that are joints.
        bind: Joint from mesh for each joint, shape (joints, 4, 4), or (4, 4) for all.
        still: World from mesh for each joint, if no joint moves.
        influences: Joints and weights of the vertices.
    """

    poses: Poses
    joints: list[int]
    bind: NDArray[np.float64]
    still: NDArray[np.float64] | None
    influences: Influences

    def at(self, time_s: float) -> NDArray[np.float64]:
        """World from mesh for each joint at a time, s, shape (joints, 4, 4)."""
        if self.still is not None:
            return self.still
        worlds = {joint: self.poses.world(joint, time_s) for joint in set(self.joints)}
        return np.stack([worlds[joint] for joint in self.joints]) @ self.bind

    def breaks(self, begin: float, end: float) -> NDArray[np.float64]:
        """Times of all keys that move the joints, inside of (begin, end), s."""
        return self.poses.breaks_of_all(self.joints, begin, end)


class Skins:
    """The skins of a file in the pose of its nodes.

    Args:
        root: The JSON object of the file.
        accessors: Accessors of the file.
        tree: Nodes of the file.
        poses: Nodes over time.
        notes: Receives notes on unsupported content.
    """

    def __init__(
        self, root: Item, accessors: Accessors, tree: Tree, poses: Poses, notes: Notes
    ) -> None:
        self._items = root.list_of("skins")
        self._accessors = accessors
        self._tree = tree
        self._poses = poses
        self._notes = notes
        self._matrices: dict[int, NDArray[np.float64]] = {}
        self._joint_nodes: dict[int, list[int]] = {}
        self._bind: dict[int, NDArray[np.float64]] = {}

    def index(self, use: Item) -> int:
        """Checked index of the skin that ``use`` names."""
        return use.index(len(self._items), "skins")

    def matrices(self, index: int) -> NDArray[np.float64]:
        """World from mesh for each joint, shape (joints, 4, 4)."""
        if index not in self._matrices:
            self._read(index)
            world = np.stack([self._tree.world(joint) for joint in self._joint_nodes[index]])
            self._matrices[index] = world @ self._bind[index]
        return self._matrices[index]

    def over_time(self, index: int, influences: Influences) -> SkinOverTime:
        """Joints over time, for a mesh with these influences."""
        still = None if self.moves(index) else self.matrices(index)
        joints, bind = self._joint_nodes[index], self._bind[index]
        return SkinOverTime(self._poses, joints, bind, still, influences)

    def moves(self, index: int) -> bool:
        """Whether a joint moves."""
        self.matrices(index)
        return any(map(self._poses.moves, self._joint_nodes[index]))

    def _read(self, index: int) -> None:
        item = self._items[index]
        tree, skeleton = self._tree, item.get("skeleton")
        if skeleton is not None:  # only a pivot for editors
            skeleton.index(len(tree.items), "nodes")
        joints = [use.index(len(tree.items), "nodes") for use in item.need("joints")]
        if not joints:
            item.need("joints").fail("the list is empty, wanted at least one joint")
        outside = sum(not tree.is_placed(joint) for joint in joints)
        if outside:
            self._notes.add("a joint of a skin is not in the scene", outside)
        bind = item.get("inverseBindMatrices")
        self._joint_nodes[index] = joints
        still = np.eye(4)[None]
        self._bind[index] = still if bind is None else self._inverse_bind(bind, len(joints))

    def _inverse_bind(self, use: Item, count: int) -> NDArray[np.float64]:
        if self._accessors.kind(use).component_type != 5126:
            use.fail("wrong accessor type: wanted matrices of component type 5126 (float)")
        values = self._accessors.floats(use, ("MAT4",), "matrix")
        if len(values) < count:
            use.fail(f"wrong count: wanted at least {count} like the joints, got {len(values)}")
        # Stored by columns.
        matrices = values[:count].astype(np.float64).reshape(-1, 4, 4).swapaxes(1, 2)
        return affine(matrices, use)

    def influences(self, attributes: dict[str, Item], skin: int, count: int) -> Influences:
        """Reads JOINTS_n and WEIGHTS_n of a mesh with JOINTS_0 and ``count`` vertices."""
        found = Influences([], [])
        while (joints := attributes.get(f"JOINTS_{len(found.joints)}")) is not None:
            weights = attributes.get(f"WEIGHTS_{len(found.joints)}")
            if weights is None:
                joints.fail(f"WEIGHTS_{len(found.joints)} is missing")
            assert weights is not None
            for use in (joints, weights):
                if self._accessors.count(use) != count:
                    use.fail(
                        f"wrong count: wanted {count} like POSITION, "
                        f"got {self._accessors.count(use)}"
                    )
            found.weights.append(self._weights(weights))
            found.joints.append(self._joints(joints, found.weights[-1], skin))
        _share(found, self._notes)
        return found

    def _weights(self, use: Item) -> FloatArray:
        _, component, normalized = self._accessors.kind(use)
        if component != 5126 and not (component in (5121, 5123) and normalized):
            use.fail(
                "wrong accessor type: wanted float or normalized unsigned byte or short, "
                f"got component type {component}{'' if normalized else ', not normalized'}"
            )
        weights = self._accessors.floats(use, ("VEC4",), "vertex")
        return np.asarray(np.maximum(weights, 0))

    def _joints(self, use: Item, weights: FloatArray, skin: int) -> NDArray[Any]:
        # A copy, so that a moving mesh does not keep the bytes of the whole file.
        joints, count = self._accessors.joints(use).copy(), len(self.matrices(skin))
        beyond = joints >= count
        if not beyond.any():
            return joints
        bad = np.argwhere(beyond & (weights > 0))
        if bad.size:
            vertex, k = bad[0]
            use.fail(
                f"vertex {vertex}: index out of range: wanted 0 .. {count - 1} (joints), "
                f"got {joints[vertex, k]} ({len(bad)} such)"
            )
        return np.where(beyond, 0, joints)  # without weight, any joint is valid


def _share(found: Influences, notes: Notes) -> None:
    """Scales the weights of each vertex to a sum of 1; without any, the first joint gets 1."""
    total = np.sum([w.sum(axis=1, dtype=np.float64) for w in found.weights], axis=0)
    odd = int((np.abs(total - 1) > _SLACK).sum())
    if odd:
        notes.add("joint weights of a vertex that do not add up to 1 are scaled", odd)
    lost = total == 0
    found.weights[0][lost, 0] = total[lost] = 1
    for weights in found.weights:
        weights /= total[:, None]


def skin(
    arrays: dict[str, FloatArray], found: Influences, matrices: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Moves positions, normals and tangents into the world, without exact normalisation.

    Args:
        arrays: Attributes of the mesh, by their names in glTF; replaced.
        found: Joints and weights of its vertices.
        matrices: World from mesh for each joint, shape (joints, 4, 4).

    Returns:
        Whether each vertex is mirrored, shape (N,).
    """
    for name in {"POSITION", "NORMAL", "TANGENT"} & arrays.keys():
        arrays[name] = arrays[name].copy()
    mirrored = np.zeros(len(arrays["POSITION"]), bool)
    for piece, blend in blended(found, matrices, len(mirrored)):
        linear = blend[:, :, :3]
        cofactors = _cofactors(linear)
        mirrored[piece] = np.einsum("ni,ni->n", linear[:, 0], cofactors[:, 0]) < 0
        side = np.where(mirrored[piece], -1, 1)
        points = arrays["POSITION"][piece]
        points[:] = _times(linear, points) + blend[:, :, 3]
        if "NORMAL" in arrays:
            # Cofactors, the inverse transpose times the determinant, exist without an inverse.
            normals = _times(cofactors, arrays["NORMAL"][piece]) * side[:, None]
            arrays["NORMAL"][piece] = _scaled(normals)
        if "TANGENT" in arrays:
            tangents = arrays["TANGENT"][piece]
            tangents[:, :3] = _scaled(_times(linear, tangents[:, :3]))
            tangents[:, 3] *= side
    return mirrored


def _cofactors(m: NDArray[np.float64]) -> NDArray[np.float64]:
    """Cofactors of matrices (N, 3, 3): each row is the cross product of the two others."""
    a, b, c = m[:, 0], m[:, 1], m[:, 2]
    return np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=1)


def _times(m: NDArray[np.float64], v: FloatArray) -> NDArray[np.float64]:
    return np.asarray(np.einsum("nij,nj->ni", m, v))


def _scaled(v: NDArray[np.float64]) -> NDArray[np.float64]:
    """Normalises vectors; 0 stays 0."""
    lengths = np.linalg.norm(v, axis=1, keepdims=True)
    return np.asarray(v / np.where(lengths > 0, lengths, 1))
