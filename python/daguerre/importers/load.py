"""Loads scene files of any format; a scene without a camera gets one."""

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
            variants, each as ``/prim:set=name``. Default: those of the file.
        allow_dirs: Folders, besides the file's own, from which it may read files.
        strict: Whether content that would be left out, with a note, is an error.
        **options: Options of the format; None and empty ones count as absent. USD has ``purpose``,
            names of purposes to draw besides ``default`` (default: ``("render",)``), and
            ``camera_units``, the unit of focal lengths and apertures in mm (default: a tenth of a
            scene unit), ``moments``, begin and end of the time that will be drawn, s, motion
            vectors included (default: any may be; samples of points, joints and copies that it does
            not need are not read), and ``in_process``: read the stage in this process, which a
            damaged one can end. glTF has ``animated``: other moments than ``time`` will be drawn,
            too. pbrt and Mitsuba have ``unit_m``, the length of a unit in m (default: 1), and
            Mitsuba ``define``, values of the file's parameters by name or as ``name=value``.

    Raises:
        InputError: The file cannot be used; the message names the file and the place in it. Or
            it is ``strict``, and something would be left out.
        UsageError: The file's format has no such option.
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
