"""Daguerre: a physically based camera renderer."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ._core import __version__
from .camera.camera import Camera
from .camera.lens_scatter import LensScatter
from .camera.projection import Projection
from .camera.rolling_shutter import RollingShutter
from .errors import DaguerreError, InputError, MismatchError, OutputError, UsageError
from .motion.values import Keys, Spin, keys, spin
from .scene.lights import DirectionalLight, PointLight, SphereLight, SpotLight
from .scene.materials import Conductor, Dielectric, Diffuse, Gltf, Material, TextureSlot
from .scene.scene import Scene

if TYPE_CHECKING:
    from . import (
        calibration,
        charts,
        development,
        distortion,
        exposure,
        lenses,
        polynomial,
        post,
        rendering,
        sensors,
        stocks,
    )
    from .analysis.calibrate import calibrate, calibrate_all
    from .exposure import metering
    from .frame.frame import Frame
    from .frame.raw import Raw
    from .labels.annotations import annotate
    from .labels.categories import Categories
    from .maps.ray_map import RayMap, raymap
    from .maps.st_maps import StMaps, stmaps
    from .rendering.diffraction import Diffraction
    from .rendering.merged import merge
    from .rendering.render import iter_render, render
    from .rendering.rig import render_rig, stereo_pair
    from .rendering.session import Session
    from .rendering.settings import RenderSettings

__all__ = [
    "Camera",
    "Categories",
    "Conductor",
    "DaguerreError",
    "Dielectric",
    "Diffraction",
    "Diffuse",
    "DirectionalLight",
    "Frame",
    "Gltf",
    "InputError",
    "Keys",
    "LensScatter",
    "Material",
    "MismatchError",
    "OutputError",
    "PointLight",
    "Projection",
    "Raw",
    "RayMap",
    "RenderSettings",
    "RollingShutter",
    "Scene",
    "Session",
    "SphereLight",
    "Spin",
    "SpotLight",
    "StMaps",
    "TextureSlot",
    "UsageError",
    "__version__",
    "annotate",
    "calibrate",
    "calibrate_all",
    "calibration",
    "charts",
    "development",
    "distortion",
    "exposure",
    "iter_render",
    "keys",
    "lenses",
    "load",
    "load_frame",
    "merge",
    "metering",
    "polynomial",
    "post",
    "raymap",
    "render",
    "render_rig",
    "rendering",
    "sensors",
    "spin",
    "stereo_pair",
    "stmaps",
    "stocks",
]

# Imported on first use, so that `import daguerre` and the command line start quickly.
_LAZY = {
    "Categories": "labels.categories",
    "annotate": "labels.annotations",
    "calibrate": "analysis.calibrate",
    "calibrate_all": "analysis.calibrate",
    "Diffraction": "rendering.diffraction",
    "Frame": "frame.frame",
    "Raw": "frame.raw",
    "RayMap": "maps.ray_map",
    "raymap": "maps.ray_map",
    "StMaps": "maps.st_maps",
    "stmaps": "maps.st_maps",
    "RenderSettings": "rendering.settings",
    "Session": "rendering.session",
    "iter_render": "rendering.render",
    "merge": "rendering.merged",
    "render": "rendering.render",
    "render_rig": "rendering.rig",
    "stereo_pair": "rendering.rig",
}


_MODULES = {
    name: name
    for name in (
        "calibration", "charts", "development", "distortion", "exposure", "lenses",
        "polynomial", "post", "rendering", "sensors", "stocks",
    )
} | {"metering": "exposure.metering"}  # fmt: skip


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return import_module("." + _MODULES[name], __name__)
    if name in _LAZY:
        value = getattr(import_module("." + _LAZY[name], __name__), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def load(
    path: str | Path,
    *,
    time: float = 0.0,
    variant: str | None = None,
    allow_dirs: Sequence[str | Path] = (),
) -> Scene:
    """Reads a scene file (.glb or .gltf) at a time in seconds.

    A file without a camera gets one, named ``framing``, that has everything in view.

    Args:
        path: The file.
        time: Where the animations are evaluated, s.
        variant: One of the file's ``variants`` of materials; absent: as the file stands.
        allow_dirs: Folders outside the file's own that it may refer to.

    Raises:
        InputError: The file cannot be used; the message names the file and the place in it.
    """
    from .io.gltf import reader as gltf
    from .scene.framing import frame_everything

    suffix = Path(path).suffix.lower()
    if suffix not in (".glb", ".gltf"):
        raise InputError(f"{path}: format: wanted .glb or .gltf, got {suffix or 'no suffix'}")
    scene = gltf.read(path, time=time, variant=variant, allow_dirs=allow_dirs)
    if not scene.cameras and (camera := frame_everything(scene)) is not None:
        scene.add_camera("framing", camera)
        scene.warnings.append("no camera in the file; 'framing' has everything in view")
    return scene


def load_frame(path: str | Path) -> Frame:
    """Reads a picture (.exr) with all its channels and facts, of Daguerre or another program.

    Raises:
        InputError: It cannot be read; the message names the file.
    """
    from .io.exr.write import read_frame

    return read_frame(path)
