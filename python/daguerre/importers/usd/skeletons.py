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
from daguerre.motion.values import Dynamic, Keys
from daguerre.motion.values import at as value_at
from daguerre.scene.over_time.joints import JointPoses, Matrices, Skinned
from daguerre.scene.over_time.quaternions import moving_turns
from daguerre.scene.over_time.surfaces import Array
from daguerre.scene.skinning import Influences

from .blend_shapes import read_blend_shapes
from .values import Clock

_PREDICATE = Usd.TraverseInstanceProxies(Usd.PrimDefaultPredicate)


@dataclass
class Skeletons:
    """Skeletons of a stage.

    Args:
        clock: Time codes of the stage.
        notes: Receives notes on unsupported content.
    """

    clock: Clock
    notes: Notes
    _cache: UsdSkel.Cache = field(default_factory=UsdSkel.Cache)
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
        """Skeleton that moves a mesh, with the space of the mesh's points; or None."""
        found = self._queries.get(str(prim.GetPath()))
        return found[1] if found is not None and found[0].HasJointInfluences() else None

    def animation_of(self, prim: Usd.Prim) -> str:
        """Paths of the skeleton and the animation that move a mesh; empty: not skinned."""
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

    def _skeleton(self, prim: Usd.Prim) -> UsdSkel.SkeletonQuery:
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

    def _read_joints(self, query: UsdSkel.SkeletonQuery, prim: Usd.Prim) -> JointPoses:
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
        animated, moved = self._animation(query.GetAnimQuery(), order)
        translations, rotations, scales = moved
        return JointPoses(translations, rotations, scales, animated, rest, parents, inverse)

    def _animation(
        self, animation: UsdSkel.AnimQuery, order: list[str]
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

        def rows(value: object, attribute: Usd.Attribute, columns: int) -> NDArray[np.float64]:
            found = np.asarray([] if value is None else value, np.float64).reshape(-1, columns)
            if len(found) != len(names) or not np.isfinite(found).all():
                got = len(found) if len(found) != len(names) else "others"
                raise InputError(
                    f"{self.clock.file}: {attribute.GetPath()}: wanted {len(names)} finite "
                    f"values, one for each joint, got {got}"
                )
            return found[chosen]

        def part(attribute: Usd.Attribute, columns: int) -> Any:
            value = self.clock.value(attribute, lambda v: rows(v, attribute, columns), large=True)
            return rows(None, attribute, columns) if value is None else value

        turns = part(source.GetRotationsAttr(), 4)
        if isinstance(turns, Keys):
            turns = moving_turns(turns)
        parts = part(source.GetTranslationsAttr(), 3), turns, part(source.GetScalesAttr(), 3)
        return np.array([places[names[i]] for i in chosen], np.int64), parts

    def _influences(
        self, query: UsdSkel.SkinningQuery, skeleton: Usd.Prim, count: int
    ) -> Influences:
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
    """Path of a prim, or of the prototype that all instances share."""
    return str((prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim).GetPath())


def _matrix(value: object) -> Matrices:
    return np.asarray(value, np.float64).T


def _matrices(values: object) -> Matrices:
    rows: Matrices = np.asarray([] if values is None else values, np.float64)
    return rows.reshape(-1, 4, 4).transpose(0, 2, 1)
