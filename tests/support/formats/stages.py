"""Writes stages of USD for tests."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
from numpy.typing import ArrayLike
from pxr import Gf, Sdf, Usd, UsdGeom, Vt

import daguerre as dg

#: Corners of a square in the plane z = 0 that faces +z.
SQUARE = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
CUBE = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
CUBE_FACES = [0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5]


def new_stage(path: Path, *, metres: float = 1.0, up: str = "Y", rate: float = 24.0) -> Usd.Stage:
    """Makes a stage in a file; ``save`` writes it."""
    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageMetersPerUnit(stage, metres)
    UsdGeom.SetStageUpAxis(stage, up)
    stage.SetTimeCodesPerSecond(rate)
    return stage


def save(stage: Usd.Stage) -> Path:
    """Writes a stage; returns its file."""
    stage.GetRootLayer().Save()
    return Path(stage.GetRootLayer().realPath)


def mesh(
    stage: Usd.Stage,
    name: str,
    points: ArrayLike = SQUARE,
    sizes: Any = (4,),
    corners: Any = (0, 1, 2, 3),
    scheme: str = "none",
) -> UsdGeom.Mesh:
    """Adds a mesh, by default a square."""
    made = UsdGeom.Mesh.Define(stage, name)
    made.CreatePointsAttr(vectors(points))
    made.CreateFaceVertexCountsAttr(list(map(int, sizes)))
    made.CreateFaceVertexIndicesAttr(list(map(int, corners)))
    made.CreateSubdivisionSchemeAttr(scheme)
    return made


def cube(stage: Usd.Stage, name: str, scheme: str = "none") -> UsdGeom.Mesh:
    """Adds a cube of edge 2."""
    return mesh(stage, name, CUBE, [4] * 6, CUBE_FACES, scheme)


def primvar(
    prim: Any, name: str, values: ArrayLike, interpolation: str, indices: Any = None
) -> Any:
    """Adds a primvar of one to four components."""
    array = np.asarray(values, np.float32)
    columns = array.shape[1] if array.ndim == 2 else 1
    types = {1: "float[]", 2: "texCoord2f[]", 3: "color3f[]", 4: "float4[]"}
    api = UsdGeom.PrimvarsAPI(prim)
    made = api.CreatePrimvar(name, Sdf.ValueTypeNames.Find(types[columns]), interpolation)
    made.Set(vectors(array) if columns > 1 else Vt.FloatArray.FromNumpy(array.reshape(-1)))
    if indices is not None:
        made.SetIndices(Vt.IntArray([int(i) for i in indices]))
    return made


def vectors(values: ArrayLike) -> Any:
    """Converts rows of numbers to an array of USD."""
    array = np.ascontiguousarray(values, np.float32)
    kinds = {2: Vt.Vec2fArray, 3: Vt.Vec3fArray, 4: Vt.Vec4fArray}
    return kinds[array.shape[1]].FromNumpy(array)


def place(prim: Any, at: Any = (0, 0, 0), turn: Any = (0, 0, 0), scale: Any = (1, 1, 1)) -> None:
    """Places a prim: translation, degrees about x, y, z, and scale."""
    xform = UsdGeom.Xformable(prim)
    xform.AddTranslateOp().Set(Gf.Vec3d(*map(float, at)))
    xform.AddRotateXYZOp().Set(Gf.Vec3f(*map(float, turn)))
    xform.AddScaleOp().Set(Gf.Vec3f(*map(float, scale)))


def read(stage: Usd.Stage, **options: Any) -> Any:
    """Writes a stage and loads it."""
    return dg.load(save(stage), **options)


def seen(scene: Any, camera: Any = None, **options: Any) -> Any:
    """Mean luminance, RGB, of a small picture of a scene, as float64."""
    settings = {"resolution": (16, 16), "spp": 16, "filter": "box", "light_paths": "off"} | options
    return dg.render(scene, camera, **settings).rgb.astype(np.float64).mean(axis=(0, 1))


def looking(at: Any, eye: Any = (0, 0, 0), degrees: float = 1.0) -> dg.Camera:
    """A pinhole camera with a small square picture of this width."""
    size = 2 * 50 * float(np.tan(np.radians(degrees) / 2))
    pose = dg.look_at(tuple(map(float, eye)), tuple(map(float, at)))
    return dg.Camera(
        lens="pinhole", focal_length=50, sensor_size=(size, size), transform=pose, shutter_time=0
    )


def illuminance(
    scene: Any, at: Any = (0, 0, 0), normal: Any = (0, 0, 1), *, spp: int = 256, **options: Any
) -> Any:
    """Illuminance of a small white card that is added to a scene, RGB, lux.

    Luminance of a diffuse white is E / pi; the camera sees the card from close by, at a slant.
    """
    z = np.asarray(normal, float) / np.linalg.norm(normal)
    x = np.cross(z, (0.3, 0.5, 0.8))
    x /= np.linalg.norm(x)
    pose = np.eye(4)
    pose[:3, :4] = np.stack([x, np.cross(z, x), z, np.asarray(at, float)], axis=1)
    size = 1e-4
    corners = np.array(SQUARE, float) * size
    card = scene.add_mesh(corners, np.array([(0, 1, 2), (0, 2, 3)]))
    scene.add_instance(card, dg.Material(dg.Diffuse((1, 1, 1))), pose)
    eye = np.asarray(at, float) + 0.001 * (z + 1.5 * x)
    camera = looking(at, eye).with_(**options)
    return np.pi * seen(scene, camera, spp=spp, max_depth=2)


def quaternions(values: ArrayLike, kind: Any = Vt.QuathArray) -> Any:
    """Converts rows x, y, z, w to an array of quaternions of USD."""
    one = {Vt.QuathArray: Gf.Quath, Vt.QuatfArray: Gf.Quatf}[kind]
    rows = np.asarray(values, np.float64).tolist()
    return kind([one(w, x, y, z) for x, y, z, w in rows])


def instancer(
    stage: Usd.Stage, name: str, positions: ArrayLike, indices: Any = None, prototypes: Any = ()
) -> UsdGeom.PointInstancer:
    """Adds a point instancer, by default of a square below it."""
    made = UsdGeom.PointInstancer.Define(stage, name)
    if not prototypes:
        mesh(stage, f"{name}/card")
        prototypes = (f"{name}/card",)
    for path in prototypes:
        made.CreatePrototypesRel().AddTarget(path)
    count = len(np.asarray(positions))
    made.CreateProtoIndicesAttr(Vt.IntArray([0] * count if indices is None else list(indices)))
    made.CreatePositionsAttr(vectors(positions))
    return made


def picture(path: Path, pixels: ArrayLike) -> Path:
    """Writes a picture of linear light."""
    light = np.ascontiguousarray(pixels, np.float32)
    spec = oiio.ImageSpec(light.shape[1], light.shape[0], 3, oiio.FLOAT)
    out = oiio.ImageOutput.create(str(path))
    assert out.open(str(path), spec)
    assert out.write_image(light)
    assert out.close()
    return path
