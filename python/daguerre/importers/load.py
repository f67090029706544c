"""Loads scene files of any format; adds a camera to a scene without cameras."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from daguerre.argument_checks import guarded
from daguerre.checks import number
from daguerre.errors import InputError
from daguerre.files import formats
from daguerre.scene import framing
from daguerre.scene.scene import Scene


@guarded
def load(
    path: str | Path,
    *,
    time: float = 0.0,
    variant: str | Sequence[str] | None = None,
    allow_dirs: Sequence[str | Path] = (),
    strict: bool = False,
    **options: object,
) -> Scene:
    """Reads a scene (.glb, .gltf, .usd, .usda, .usdc, .usdz, .pbrt, .xml, or a registered format).

    A file without a camera gets a camera named ``framing`` that has everything in view.

    Args:
        path: The file.
        time: Time at which animations are evaluated, s.
        variant: Material variant of glTF, one of ``Scene.variants``; or selections of USD's
            variants, each as ``/prim:set=name``. Default: selections of the file.
        allow_dirs: Further folders from which the file may read other files.
        strict: Whether a note on content that is left out is an error.
        **options: Options of the format; None and empty values count as absent. USD: ``purpose``,
            names of purposes to draw besides ``default`` (default: ``("render",)``);
            ``camera_units``, unit of focal lengths and apertures, mm (default: a tenth of a scene
            unit); ``moments``, begin and end of the time that will be drawn, s, including the time
            that motion vectors need (default: any time; samples of points, joints and copies
            outside of it are not read); ``in_process``, whether to read the stage in this process,
            which a damaged stage can crash. glTF: ``animated``, whether moments other than ``time``
            will be drawn. pbrt and Mitsuba: ``unit_m``, length of a unit, m (default: 1). Mitsuba:
            ``define``, values of the file's parameters by name or as ``name=value``.

    Raises:
        InputError: The file cannot be used; the message names the file and the place in it. Or
            it is ``strict``, and something would be left out.
        UsageError: The file's format lacks an option.
    """
    time = number(time, "time")
    options |= {"variant": variant, "allow_dirs": allow_dirs}
    given: dict[str, Any] = {
        name: value for name, value in options.items() if value not in (None, (), [])
    }
    scene: Scene = formats.read("scene", path, time=time, **given)
    if strict and scene.warnings:
        more = f", and {len(scene.warnings) - 1} more" if len(scene.warnings) > 1 else ""
        raise InputError(f"{path}: strict: the file has notes: {scene.warnings[0]}{more}")
    if not scene.cameras and (camera := framing.frame_everything(scene)) is not None:
        scene.add_camera(framing.NAME, camera)
        scene.note("the file has no usable camera; the camera 'framing' shows everything")
    return scene
