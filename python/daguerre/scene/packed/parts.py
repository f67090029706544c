"""Takes a scene apart: plain lists, arrays, and values of the classes in ``values.py``."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np

from daguerre.camera.camera import Camera
from daguerre.checks import short
from daguerre.errors import UsageError
from daguerre.files.packing import name_of
from daguerre.motion.values import Composite, Keys, Spin
from daguerre.scene.curves import MovingCurves
from daguerre.scene.parts import Curves, Mesh, Plate
from daguerre.scene.point_cache import PointCache
from daguerre.scene.scene import Scene

from .gathered import Gathered
from .moving import NAMES
from .optics import parted

#: Arrays of a mesh, and the arrays that change when its points move.
ARRAYS = ("positions", "indices", "normals", "uv", "uv1", "tangents", "colors")
OF_MOMENT = ("positions", "normals", "tangents")
#: Further attributes of a mesh of curves.
OF_CURVES = ("radii", "starts", "ends", "cubic", "closed")


def parts_of(scene: Scene) -> dict[str, Any]:
    """Parts of a scene; ``rebuild.py`` makes a scene from them with bit-identical pictures.

    Args:
        scene: The scene.

    Raises:
        InputError: A camera's lens or sensor is a file that cannot be read.
        UsageError: A value over time cannot be packed, or the lens of a camera differs from its
            file.
    """
    motion = scene.motion
    return {
        "time": scene.time,
        "textures": [_fields(texture) for texture in scene.textures],
        "materials": _with_motion(scene.materials, motion.materials, "materials"),
        "meshes": [_mesh(mesh, motion.meshes.get(i)) for i, mesh in enumerate(scene.meshes)],
        "instances": _instances(scene),
        "lights": _with_motion(scene.lights, motion.lights, "lights"),
        "cameras": [[name, *_camera(one, name)] for name, one in scene.cameras.items()],
        "default camera": scene.default_camera,
        "camera aliases": [list(pair) for pair in scene.camera_aliases.items()],
        "film sizes": [[name, list(size)] for name, size in scene.film_sizes.items()],
        "environment": scene.environment,
        "environment motion": _known(motion.environment, "environment"),
        "fog": scene.fog,
        "plate": scene.plate and _plate(scene.plate),
        "nodes": _nodes(scene),
        "duration": scene.duration,
        "moments": scene.moments,
        "variants": list(scene.variants),
        "warnings": list(scene.warnings),
    }


def _camera(camera: Camera, name: str) -> tuple[Any, ...]:
    return parted(camera, f"camera {short(name)}")


def _plate(plate: Plate) -> list[Any]:
    return [plate.pixels, *(parted(plate.camera, "plate") if plate.camera else (None,) * 3)]


def _fields(value: Any) -> dict[str, Any]:
    return {one.name: getattr(value, one.name) for one in fields(value)}


def _with_motion(values: list[Any], motion: dict[int, Any], what: str) -> list[Any]:
    """Pairs (value, its motion or None)."""
    return [[one, _known(motion.get(i), f"{what}[{i}]")] for i, one in enumerate(values)]


def _known(motion: object, where: str) -> Any:
    kind = type(motion)
    if not isinstance(motion, Keys | Spin | Composite | None) and name_of(kind) not in NAMES:
        raise UsageError(
            f"packed scene: {where}: motion: wanted keys, spins, or values over time of readers of "
            f"USD, got {kind.__name__}"
        )
    return motion


def _mesh(mesh: Mesh, motion: object) -> dict[str, Any]:
    found = {"name": mesh.name, **{name: getattr(mesh, name) for name in ARRAYS}}
    if any(mesh.origin):
        found["origin"] = mesh.origin
    if isinstance(mesh, Curves):
        found["curves"] = {name: getattr(mesh, name) for name in OF_CURVES}
    if motion is None:
        return found
    where = f"mesh {mesh.name!r}"
    if isinstance(motion, MovingCurves):
        path = _known(motion.points, where)
        return found | {"motion": {"path": path, "layout": _fields(motion.layout)}}
    if not isinstance(motion, PointCache):
        return found | {"motion": _known(motion, where)}
    rest = {name: getattr(motion.rest, name) for name in OF_MOMENT}
    path, normals = _known(motion.positions, where), _known(motion.normals, where)
    return found | {"motion": {"path": path, "normals": normals, "rest": rest}}


def _instances(scene: Scene) -> dict[str, Any]:
    motion = scene.motion
    over = {
        "motion": [[i, _known(one, f"instances[{i}]")] for i, one in motion.instances.items()],
        "shown": [[i, _known(one, f"instances[{i}]")] for i, one in motion.shown.items()],
    }
    if isinstance(scene, Gathered):
        return scene.instances.columns() | over
    placed, names = scene.instances, dict[str, int]()
    named = [names.setdefault(one.name, len(names)) for one in placed]
    return {
        "meshes": np.array([one.mesh for one in placed], np.int64),
        "materials": np.array([one.material for one in placed], np.int64),
        "transforms": np.array([one.transform for one in placed], np.float64).reshape(-1, 4, 4),
        "names": list(names),
        "named": np.array(named, np.int64),
        "hidden": [i for i, one in enumerate(placed) if not one.shown],
        "catchers": [[i, one.catcher] for i, one in enumerate(placed) if one.catcher is not None],
    } | over


def _nodes(scene: Scene) -> list[Any]:
    """Rows (name, position or None, its motion or None, instances)."""
    places, motion = scene.node_positions, scene.motion.node_positions
    return [
        [
            *(name, places.get(name), _known(motion.get(name), f"node {name!r}")),
            np.array(members, np.int64),
        ]
        for name, members in scene.nodes.items()
    ]
