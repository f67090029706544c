"""Writes the glTF twin of a stage from what OpenUSD's own functions report of it.

Meshes, their copies, materials, the one camera and distant lights go into the file; a dome does
not, as glTF has none. The stage is in metres with +y up, and has no subdivision surfaces.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from pxr import Gf, Usd, UsdGeom, UsdLux

from daguerre.exporters.gltf import ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER, FLOAT, U32, Glb

from .gltf_surfaces import Surfaces
from .stage_meshes import Part, drawn, parts_of


def write_twin(source: Path, path: Path) -> Path:
    """Writes the twin of a stage; returns its file."""
    stage = Usd.Stage.Open(str(source))
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    assert UsdGeom.GetStageUpAxis(stage) == "Y"
    glb = Glb("daguerre tests")
    cache = UsdGeom.XformCache()
    _add_meshes(glb, stage, cache)
    for prim in stage.Traverse():
        if prim.IsA(UsdGeom.Camera):
            _add_camera(glb, UsdGeom.Camera(prim), _matrix(cache.GetLocalToWorldTransform(prim)))
        elif prim.IsA(UsdLux.DistantLight):
            _add_sun(glb, UsdLux.DistantLight(prim), _matrix(cache.GetLocalToWorldTransform(prim)))
    glb.write(path)
    return path


def _add_meshes(glb: Glb, stage: Usd.Stage, cache: UsdGeom.XformCache) -> None:
    surfaces = Surfaces(glb, stage)
    for mesh, places in drawn(stage.GetPseudoRoot(), [Gf.Matrix4d(1)], cache):
        primitives = [
            _primitive(glb, part, surfaces.index(part.material)) for part in parts_of(mesh)
        ]
        name = str(mesh.GetPath())
        index = glb.add("meshes", {"name": name, "primitives": primitives})
        for place in places:
            glb.add_node(name, mesh=index, matrix=_matrix(place))


def _primitive(glb: Glb, part: Part, material: int) -> dict[str, Any]:
    def add(rows: Any, kind: str) -> int:
        return glb.add_accessor(rows, kind, FLOAT, target=ARRAY_BUFFER)

    attributes = {"POSITION": add(part.positions, "VEC3")}
    if part.normals is not None:
        lengths = np.linalg.norm(part.normals, axis=1, keepdims=True)
        attributes["NORMAL"] = add(part.normals / lengths, "VEC3")  # glTF wants unit vectors
    if part.uv is not None:
        attributes["TEXCOORD_0"] = add(part.uv * (1, -1) + (0, 1), "VEC2")
    indices = glb.add_accessor(
        part.triangles.reshape(-1), "SCALAR", U32, target=ELEMENT_ARRAY_BUFFER
    )
    return {"attributes": attributes, "indices": indices, "material": material}


def _matrix(transform: Gf.Matrix4d) -> list[float]:
    """Columns of the matrix that acts on columns: the rows of USD's, which acts on rows."""
    return np.asarray(transform, np.float64).reshape(-1).tolist()


def _add_camera(glb: Glb, camera: UsdGeom.Camera, matrix: list[float]) -> None:
    """Adds the camera; lengths of the stage are tenths of a metre."""
    wide, high, focal = (
        100.0 * attribute.Get()
        for attribute in (
            camera.GetHorizontalApertureAttr(),
            camera.GetVerticalApertureAttr(),
            camera.GetFocalLengthAttr(),
        )
    )
    name = camera.GetPrim().GetName()
    stop, distance = camera.GetFStopAttr().Get(), camera.GetFocusDistanceAttr().Get()
    index = glb.add_camera(name, focal, stop, distance, (wide, high))
    glb.add_node(name, camera=index, matrix=matrix)


def _add_sun(glb: Glb, sun: UsdLux.DistantLight, matrix: list[float]) -> None:
    """Adds a distant light; those of the tests have no size."""
    assert sun.GetAngleAttr().Get() == 0.0
    glb.use("KHR_lights_punctual")
    light = {
        "type": "directional",
        "intensity": sun.GetIntensityAttr().Get() * math.exp2(sun.GetExposureAttr().Get()),
        "color": [float(c) for c in sun.GetColorAttr().Get()],
    }
    lights = glb.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})
    lights["lights"].append(light)
    name = sun.GetPrim().GetName()
    number = {"KHR_lights_punctual": {"light": len(lights["lights"]) - 1}}
    glb.add_node(name, extensions=number, matrix=matrix)
