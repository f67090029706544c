"""Writes cameras as UsdGeomCamera, NVIDIA's attributes, and ours for the rest.

The stage has metres and +y up, so camera lengths, which are tenths of a unit, are in units of
100 mm. Values over time become time samples.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pxr import Gf, Tf, Usd, UsdGeom

from daguerre.camera.camera import Camera
from daguerre.camera.parameters import CAMERA
from daguerre.compiled import __version__
from daguerre.errors import OutputError
from daguerre.files.atomic import atomic_path
from daguerre.importers.usd.over_time import miss_of_poses, pose, sample_times

from .film import write_film
from .ours import write_ours
from .shutter import write_exposure, write_shutter
from .stage import Output

_ROOT = "World"
#: Clipping planes, m: other programs need them, and USD's default hides the nearest metre.
_NEAR, _FAR = 1e-3, 1e6


def write_cameras(
    path: str | os.PathLike[str],
    cameras: Mapping[str, Camera],
    *,
    times: tuple[float, float] | None = None,
) -> None:
    """Writes cameras as a stage, whole or not at all.

    Args:
        path: File, .usda, .usdc or .usd.
        cameras: Cameras by name.
        times: Begin and end of animated values, s; None: the first and last key.

    Raises:
        UsageError: A camera has a part that no stage can hold.
        OutputError: The file cannot be written.
    """
    stage = Usd.Stage.CreateInMemory()
    stage.GetRootLayer().documentation = f"Cameras by Daguerre {__version__}"
    rate = next(iter(cameras.values())).fps
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    stage.SetTimeCodesPerSecond(rate)
    stage.SetFramesPerSecond(rate)
    root = UsdGeom.Xform.Define(stage, f"/{_ROOT}")
    stage.SetDefaultPrim(root.GetPrim())
    folder = Path(path).resolve().parent
    codes: set[float] = set()
    for place, (name, camera) in zip(_places(cameras), cameras.items(), strict=True):
        prim = UsdGeom.Camera.Define(stage, place)
        if prim.GetPrim().GetName() != name:
            prim.GetPrim().SetDisplayName(name)
        codes |= write_camera(prim, camera, Output(prim.GetPrim(), camera, rate, folder, times))
    if codes:
        stage.SetStartTimeCode(min(codes))
        stage.SetEndTimeCode(max(codes))
    with atomic_path(path) as temp:
        try:
            stage.GetRootLayer().Export(str(temp))
        except Tf.ErrorException as error:
            raise OutputError(f"{path}: cannot write: {error}") from None


def write_camera(prim: UsdGeom.Camera, camera: Camera, output: Output) -> set[float]:
    """Writes all of a camera; returns the time codes of its samples."""
    CAMERA.check(camera, "camera")
    _place(prim, camera, output)
    write_film(output)
    write_exposure(output)
    write_shutter(output)
    write_ours(output)
    near = camera.near_clip or _NEAR
    prim.CreateClippingRangeAttr(Gf.Vec2f(near, max(_FAR, 1e3 * near)))
    return output.codes


def _place(prim: UsdGeom.Camera, camera: Camera, output: Output) -> None:
    moving = camera.motion.get("transform")
    translate = prim.AddTranslateOp(UsdGeom.XformOp.PrecisionDouble)
    orient = prim.AddOrientOp(UsdGeom.XformOp.PrecisionDouble)
    times = [] if moving is None else sample_times(moving, output.times, miss_of_poses)
    steps: list[float | None] = [*times] if times else [None]
    for time in steps:
        world = camera.transform if moving is None or time is None else moving.at(time)
        position, turn = pose(output.rigid(world))
        x, y, z, w = (turn + 0.0).tolist()  # no negative zeros
        code = output.code(time)
        translate.Set(Gf.Vec3d(*position.tolist()), code)
        orient.Set(Gf.Quatd(w, x, y, z), code)


def _places(names: Mapping[str, Any]) -> list[str]:
    """Paths of prims by the names of cameras, each once."""
    taken: dict[str, None] = {}
    for name in names:
        word = Tf.MakeValidIdentifier(name) or "camera"
        free = word
        number = 2
        while f"/{_ROOT}/{free}" in taken:
            free, number = f"{word}_{number}", number + 1
        taken[f"/{_ROOT}/{free}"] = None
    return list(taken)
