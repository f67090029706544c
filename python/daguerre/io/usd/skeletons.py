"""Reads UsdSkel: skeletons that bend meshes, and blend shapes that shift their points.

USD interpolates translations, rotations and scales of joints between time samples, then multiplies
them along the skeleton. Skinned points are in the space of the skeleton.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdSkel

from daguerre.checks import short
from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.files.value import Value
from daguerre.motion.values import Dynamic, is_dynamic
from daguerre.motion.values import at as value_at
from daguerre.scene.skinning import Influences, blended
from daguerre.scene.transforms import compose

from .blend_shapes import BlendShapes, read_blend_shapes
from .primvars import Array
from .quaternions import moving_turns, normalized
from .values import Clock

Matrices = NDArray[np.float64]
_PREDICATE = Usd.TraverseInstanceProxies(Usd.PrimDefaultPredicate)


@dataclass(frozen=True, eq=False)
class JointPoses(Value):
    """The joints of a skeleton, over time or at rest.

    Attributes:
        translations: Places of the animated joints, shape (A, 3), constant or over time.
        rotations: Their quaternions x, y, z, w, shape (A, 4), constant or over time.
        scales: Their scales, shape (A, 3), constant or over time.
        animated: Joint of the skeleton for each animated one, shape (A,).
        rest: Local transform of each joint where it is not animated, shape (J, 4, 4).
        parents: Parent of each joint, or -1; parents come first.
        inverse_bind: Joint from skeleton in the bind pose, shape (J, 4, 4).
    """

    translations: Any
    rotations: Any
    scales: Any
    animated: NDArray[np.int64]
    rest: Matrices
    parents: NDArray[np.int64]
    inverse_bind: Matrices

    def at(self, time_s: float) -> Matrices:
        """Skeleton from bind pose for each joint at a time, s, shape (J, 4, 4)."""
        local = self.rest.copy()
        if len(self.animated):
            parts = (value_at(part, time_s) for part in (self.translations, self.scales))
            places, scales = (np.asarray(part, np.float64) for part in parts)
            turns = np.asarray(value_at(self.rotations, time_s), np.float64)
            local[self.animated] = compose(places, normalized(turns), scales)
        for joint, parent in enumerate(self.parents):
            if parent >= 0:
                local[joint] = local[parent] @ local[joint]
        made: Matrices = local @ self.inverse_bind
        return made

    def breaks(self, begin: float, end: float) -> list[float]:
        """Times of all keys, s."""
        parts = (self.translations, self.rotations, self.scales)
        moving = [part for part in parts if is_dynamic(part)]
        return sorted({float(t) for part in moving for t in part.breaks(begin, end)})

    @property
    def moves(self) -> bool:
        """Whether a joint moves."""
        return any(map(is_dynamic, (self.translations, self.rotations, self.scales)))


@dataclass(frozen=True, eq=False)
class Skinned(Value):
    """Points that follow joints, in the space of the skeleton.

    Attributes:
        points: Points of the mesh, constant or over time.
        shapes: Blend shapes that shift the points first, or None.
        joints: The joints, or None.
        influences: Joints and weights of the points.
        bind: Skeleton from mesh in the bind pose, shape (4, 4).
    """

    points: Array | Dynamic
    shapes: BlendShapes | None
    joints: JointPoses | None
    influences: Influences
    bind: Matrices

    def at(self, time_s: float) -> Array:
        """The points at a time, s, shape (N, 3)."""
        points = np.asarray(value_at(self.points, time_s), np.float32)
        if self.shapes is not None:
            points = self.shapes.shifted(points, time_s)
        if self.joints is None:
            return points
        matrices = self.joints.at(time_s) @ self.bind
        made = np.empty_like(points)
        for piece, blend in blended(self.influences, matrices, len(points)):
            turned = np.einsum("nij,nj->ni", blend[:, :, :3], points[piece])
            made[piece] = turned + blend[:, :, 3]
        return made

    def breaks(self, begin: float, end: float) -> list[float]:
        """Times of all keys, s."""
        parts: tuple[Any, ...] = (self.points, self.shapes, self.joints)
        moving = [part for part in parts if is_dynamic(part)]
        return sorted({float(t) for part in moving for t in part.breaks(begin, end)})

    @property
    def moves(self) -> bool:
        """Whether a point moves."""
        joints = self.joints is not None and self.joints.moves
        shapes = self.shapes is not None and is_dynamic(self.shapes.weights)
        return joints or shapes or is_dynamic(self.points)


@dataclass
class Skeletons:
    """Skeletons of a stage.

    Args:
        clock: Time codes of the stage.
        notes: Receives notes on unsupported content.
    """

    clock: Clock
    notes: Notes
    _cache: Any = field(default_factory=UsdSkel.Cache)
    _queries: dict[str, tuple[Any, Usd.Prim]] = field(default_factory=dict)
    _poses: dict[str, JointPoses] = field(default_factory=dict)

    def add_root(self, prim: Usd.Prim) -> None:
        """Finds the meshes that the skeletons below a root move."""
        root = UsdSkel.Root(prim)
        self._cache.Populate(root, _PREDICATE)
        for binding in self._cache.ComputeSkelBindings(root, _PREDICATE):
            skeleton = binding.GetSkeleton().GetPrim()
            for target in binding.GetSkinningTargets():
                self._queries[str(target.GetPrim().GetPath())] = (target, skeleton)

    def skeleton_of(self, prim: Usd.Prim) -> Usd.Prim | None:
        """Skeleton that moves a mesh, whose space its points are in; or None."""
        found = self._queries.get(str(prim.GetPath()))
        return found[1] if found is not None and found[0].HasJointInfluences() else None

    def animation_of(self, prim: Usd.Prim) -> str:
        """Paths of the skeleton and the animation that move a mesh; empty if none does."""
        found = self._queries.get(str(prim.GetPath()))
        if found is None:
            return ""
        animation = self._skeleton(found[1]).GetAnimQuery()
        moved = _shared(animation.GetPrim()) if animation else ""
        return f" {_shared(found[1])} {moved}"

    def skinned(self, prim: Usd.Prim, points: Array | Dynamic) -> Array | Dynamic:
        """Points of a mesh after blend shapes and joints, constant or over time.

        Raises:
            InputError: Joints and weights do not fit the mesh.
        """
        found = self._queries.get(str(prim.GetPath()))
        if found is None:
            return points
        query, skeleton = found
        count = len(value_at(points, self.clock.time))
        animation = self._skeleton(skeleton).GetAnimQuery()
        shapes = None
        if query.HasBlendShapes() and animation:
            shapes = read_blend_shapes(query, animation, count, self.clock, self.notes)
        joints, influences, bind = None, Influences([], []), np.eye(4)
        if query.HasJointInfluences():
            joints = self._joints(skeleton)
            influences = self._influences(query, skeleton, count)
            bind = _matrix(query.GetGeomBindTransform(self.clock.code))
            if str(query.GetSkinningMethod()) != "classicLinear":
                self.notes.add("a skin of dual quaternions is blended linearly")
        made = Skinned(points, shapes, joints, influences, bind)
        return made if made.moves else made.at(self.clock.time)

    def _skeleton(self, prim: Usd.Prim) -> Any:
        query = self._cache.GetSkelQuery(UsdSkel.Skeleton(prim))
        if not query:
            raise InputError(
                f"{self.clock.file}: {prim.GetPath()}.joints: each must appear once, after its "
                f"parent"
            )
        return query

    def _joints(self, prim: Usd.Prim) -> JointPoses:
        key = str(prim.GetPath())
        if key not in self._poses:
            self._poses[key] = self._read_joints(self._skeleton(prim), prim)
        return self._poses[key]

    def _read_joints(self, query: Any, prim: Usd.Prim) -> JointPoses:
        where = f"{self.clock.file}: {prim.GetPath()}"
        order = list(query.GetJointOrder())
        bind = _matrices(query.GetJointWorldBindTransforms())
        rest = _matrices(query.ComputeJointLocalTransforms(self.clock.code, True))
        if len(bind) != len(order):
            raise InputError(f"{where}.bindTransforms: wanted {len(order)}, got {len(bind)}")
        if len(rest) != len(order):
            raise InputError(f"{where}.restTransforms: wanted {len(order)}, got {len(rest)}")
        try:
            inverse = np.asarray(np.linalg.inv(bind), np.float64)
        except np.linalg.LinAlgError:
            raise InputError(f"{where}.bindTransforms: every matrix needs an inverse") from None
        if not (np.isfinite(inverse).all() and np.isfinite(rest).all()):
            raise InputError(f"{where}: transforms must be finite")
        parents = np.asarray(query.GetTopology().GetParentIndices(), np.int64)
        animated, parts = self._animation(query.GetAnimQuery(), order)
        return JointPoses(*parts, animated, rest, parents, inverse)

    def _animation(
        self, animation: Any, order: list[str]
    ) -> tuple[NDArray[np.int64], tuple[Any, Any, Any]]:
        """Animated joints, and their translations, rotations and scales."""
        nothing = np.zeros(0, np.int64), (None, None, None)
        if not animation:
            return nothing
        source = UsdSkel.Animation(animation.GetPrim())
        names = [str(name) for name in animation.GetJointOrder()]
        places = {str(name): i for i, name in enumerate(order)}
        chosen = np.array([i for i, name in enumerate(names) if name in places], np.int64)
        if not len(chosen):
            return nothing

        def rows(value: Any, attribute: Usd.Attribute, columns: int) -> NDArray[np.float64]:
            found = np.asarray([] if value is None else value, np.float64).reshape(-1, columns)
            if len(found) != len(names) or not np.isfinite(found).all():
                got = len(found) if len(found) != len(names) else "others"
                raise InputError(
                    f"{self.clock.file}: {attribute.GetPath()}: wanted {len(names)} finite "
                    f"values, one for each joint, got {got}"
                )
            return found[chosen]

        def part(attribute: Usd.Attribute, columns: int) -> Any:
            value = self.clock.value(attribute, lambda v: rows(v, attribute, columns))
            return rows(None, attribute, columns) if value is None else value

        turns = part(source.GetRotationsAttr(), 4)
        if is_dynamic(turns):
            turns = moving_turns(turns)
        parts = part(source.GetTranslationsAttr(), 3), turns, part(source.GetScalesAttr(), 3)
        return np.array([places[names[i]] for i in chosen], np.int64), parts

    def _influences(self, query: Any, skeleton: Usd.Prim, count: int) -> Influences:
        order = [str(name) for name in self._skeleton(skeleton).GetJointOrder()]
        where = f"{self.clock.file}: {query.GetPrim().GetPath()}"
        indices, weights = query.ComputeVaryingJointInfluences(count, self.clock.code) or ([], [])
        number = np.asarray(indices, np.int64).reshape(count, -1) if len(indices) else None
        share = np.asarray(weights, np.float32).reshape(count, -1) if len(weights) else None
        if number is None or share is None or number.shape != share.shape:
            raise InputError(
                f"{where}: primvars:skel:jointIndices and jointWeights: both need the same "
                f"number of elements for each of {count} points"
            )
        if not np.isfinite(share).all():
            raise InputError(f"{where}: primvars:skel:jointWeights: numbers must be finite")
        names = [str(name) for name in query.GetJointOrder() or order]
        unknown = sorted({*names} - {*order})
        if unknown:
            raise InputError(
                f"{where}: skel:joints: wanted joints of its skeleton, got {short(unknown[0])}"
            )
        places = {name: i for i, name in enumerate(order)}
        table = np.array([places[name] for name in names], np.int64)
        number = table[_checked(number, len(table), where)]
        share = np.maximum(share, 0)
        total = share.sum(axis=1, keepdims=True)
        share = np.where(total > 0, share / np.where(total > 0, total, 1), 1 / share.shape[1])
        return Influences([number], [share.astype(np.float32)])


def _checked(numbers: NDArray[np.int64], joints: int, where: str) -> NDArray[np.int64]:
    if numbers.size and not 0 <= numbers.min() <= numbers.max() < joints:
        raise InputError(
            f"{where}: primvars:skel:jointIndices: wanted 0 .. {joints - 1}, "
            f"got {numbers.min()} .. {numbers.max()}"
        )
    return numbers


def _shared(prim: Usd.Prim) -> str:
    """Path of a prim, or of the one that all instances share."""
    return str((prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim).GetPath())


def _matrix(value: Any) -> Matrices:
    return np.asarray(value, np.float64).T


def _matrices(values: Any) -> Matrices:
    rows: Matrices = np.asarray([] if values is None else values, np.float64)
    return rows.reshape(-1, 4, 4).transpose(0, 2, 1)
