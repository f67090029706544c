"""Values over time that a packed scene may hold, besides keys and spins.

Readers and meshes make them. They are plain records of arrays, numbers and one another; their users
check the shape of their values at a time.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from importlib import import_module
from typing import Any

_OVER_TIME, _SUBDIVISION = "daguerre.scene.over_time", "daguerre.scene.subdivision"
#: Names of classes by their module, which is imported on first use.
_RECORDS = {
    f"{_OVER_TIME}.operations": ("Operation", "Place", "Rigid", "Transform"),
    f"{_OVER_TIME}.points": ("Ballistic", "ChosenOverTime"),
    f"{_OVER_TIME}.surfaces": ("Faces", "LimitOverTime"),
    f"{_OVER_TIME}.joints": ("JointPoses", "Skinned"),
    f"{_OVER_TIME}.shapes": ("BlendShape", "BlendShapes"),
    f"{_OVER_TIME}.crowds": ("Crowd", "OneOfCrowd"),
    f"{_OVER_TIME}.emission": ("Emission", "Shown", "Strength"),
    f"{_OVER_TIME}.quaternions": ("QuaternionKeys",),
    f"{_SUBDIVISION}.faces": ("Faces",),
    f"{_SUBDIVISION}.rules": ("Rules",),
    "daguerre.scene.motion": ("Vertices",),
    "daguerre.scene.polygon_mesh": ("Picked", "SurfaceOverTime"),
    "daguerre.scene.skinning": ("Influences",),
}
_SUBDIVIDED, _REFINER = f"{_OVER_TIME}.surfaces:Subdivided", f"{_SUBDIVISION}.refiner:Refiner"
#: Names of all classes, as ``module:class``.
NAMES = frozenset(
    {f"{module}:{name}" for module, names in _RECORDS.items() for name in names}
    | {_SUBDIVIDED, _REFINER}
)


def make(name: str, state: Mapping[str, Any]) -> Any:
    """Makes a value from the name of its class, one of ``NAMES``, and its attributes.

    Raises:
        ValueError: The class has other attributes.
        InputError: A surface has wrong faces or rules.
    """
    module, _, kind = name.partition(":")
    found = getattr(import_module(module), kind)
    if name == _SUBDIVIDED:
        return found(state["_faces"], state["_refiner"])
    if name == _REFINER:
        return _refiner(found, **state)
    wanted = {field.name for field in dataclasses.fields(found)}
    if {*state} != wanted:
        raise ValueError(f"attributes of {kind}: wanted {sorted(wanted)}")
    return found(**state)


def _refiner(
    kind: Any, *, _faces: Any, scheme: object, level: object, rules: object, where: object
) -> Any:
    return kind(_faces.count, _faces.sizes, _faces.vertices, scheme, level, rules, where)
