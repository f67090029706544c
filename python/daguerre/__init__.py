"""Daguerre: a physically based camera renderer."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from . import compiled, forks  # noqa: F401
from .compiled import __version__
from .errors import DaguerreError, InputError, MismatchError, OutputError, UsageError

if TYPE_CHECKING:
    from . import (
        analysis,
        calibration,
        charts,
        development,
        distortion,
        errors,
        export,
        exposure,
        files,
        labels,
        lenses,
        polynomial,
        post,
        rendering,
        scene,
        sensors,
        stocks,
    )
    from .analysis.calibrate import calibrate, calibrate_all
    from .camera.camera import Camera
    from .camera.lens_scatter import LensScatter
    from .camera.placement import look_at
    from .camera.projection import Projection
    from .camera.rolling_shutter import RollingShutter
    from .cluster.session import ClusterSession
    from .exporters.export_camera import export_camera
    from .exposure import metering
    from .frame.frame import Frame
    from .frame.raw import Raw
    from .importers.load import load
    from .labels.annotations import annotate
    from .labels.categories import Categories
    from .maps.ray_map import RayMap, raymap
    from .maps.st_maps import StMaps, stmaps
    from .motion.values import Keys, Spin, keys, spin
    from .pictures.exr.read import load_frame
    from .plates.composite.composite import composite
    from .plates.match.match import match_plate
    from .plates.match.plate_camera import PlateCamera
    from .plates.match.reader import read_plate_camera
    from .plates.probe.probe import light_probe
    from .rendering.diffraction import Diffraction
    from .rendering.export_scene import export_scene
    from .rendering.merged import merge
    from .rendering.render import iter_render, render
    from .rendering.rig import render_rig, stereo_pair
    from .rendering.session import Session
    from .rendering.settings import RenderSettings
    from .scene.light_profile import LightProfile
    from .scene.lights import DirectionalLight, PointLight, SphereLight, SpotLight
    from .scene.materials import (
        Boundary,
        Coated,
        Conductor,
        Dielectric,
        Diffuse,
        Gltf,
        Material,
        Mix,
        TextureSlot,
    )
    from .scene.media import DensityGrid, Medium
    from .scene.scene import Scene
    from .scene.spectrum import Spectrum
    from .viewfinder.notebook import view

__all__ = [
    "Boundary",
    "Camera",
    "Categories",
    "ClusterSession",
    "Coated",
    "Conductor",
    "DaguerreError",
    "DensityGrid",
    "Dielectric",
    "Diffraction",
    "Diffuse",
    "DirectionalLight",
    "Frame",
    "Gltf",
    "InputError",
    "Keys",
    "LensScatter",
    "LightProfile",
    "Material",
    "Medium",
    "MismatchError",
    "Mix",
    "OutputError",
    "PlateCamera",
    "PointLight",
    "Projection",
    "Raw",
    "RayMap",
    "RenderSettings",
    "RollingShutter",
    "Scene",
    "Session",
    "Spectrum",
    "SphereLight",
    "Spin",
    "SpotLight",
    "StMaps",
    "TextureSlot",
    "UsageError",
    "__version__",
    "analysis",
    "annotate",
    "calibrate",
    "calibrate_all",
    "calibration",
    "charts",
    "composite",
    "development",
    "distortion",
    "errors",
    "export",
    "export_camera",
    "export_scene",
    "exposure",
    "files",
    "iter_render",
    "keys",
    "labels",
    "lenses",
    "light_probe",
    "load",
    "load_frame",
    "look_at",
    "match_plate",
    "merge",
    "metering",
    "polynomial",
    "post",
    "raymap",
    "read_plate_camera",
    "render",
    "render_rig",
    "rendering",
    "scene",
    "sensors",
    "spin",
    "stereo_pair",
    "stmaps",
    "stocks",
    "view",
]

# Imported on first use, so that `import daguerre` and the command line start quickly.
_LAZY = {
    "Camera": "camera.camera",
    "LensScatter": "camera.lens_scatter",
    "look_at": "camera.placement",
    "ClusterSession": "cluster.session",
    "view": "viewfinder.notebook",
    "Projection": "camera.projection",
    "RollingShutter": "camera.rolling_shutter",
    "Keys": "motion.values",
    "Spin": "motion.values",
    "keys": "motion.values",
    "spin": "motion.values",
    "LightProfile": "scene.light_profile",
    "DirectionalLight": "scene.lights",
    "PointLight": "scene.lights",
    "SphereLight": "scene.lights",
    "SpotLight": "scene.lights",
    "Boundary": "scene.materials",
    "Coated": "scene.materials",
    "Conductor": "scene.materials",
    "Dielectric": "scene.materials",
    "Diffuse": "scene.materials",
    "Gltf": "scene.materials",
    "Material": "scene.materials",
    "Mix": "scene.materials",
    "DensityGrid": "scene.media",
    "Medium": "scene.media",
    "Spectrum": "scene.spectrum",
    "TextureSlot": "scene.materials",
    "Scene": "scene.scene",
    "Categories": "labels.categories",
    "annotate": "labels.annotations",
    "calibrate": "analysis.calibrate",
    "calibrate_all": "analysis.calibrate",
    "Diffraction": "rendering.diffraction",
    "load": "importers.load",
    "export_camera": "exporters.export_camera",
    "export_scene": "rendering.export_scene",
    "load_frame": "pictures.exr.read",
    "Frame": "frame.frame",
    "Raw": "frame.raw",
    "RayMap": "maps.ray_map",
    "raymap": "maps.ray_map",
    "StMaps": "maps.st_maps",
    "stmaps": "maps.st_maps",
    "PlateCamera": "plates.match.plate_camera",
    "composite": "plates.composite.composite",
    "match_plate": "plates.match.match",
    "read_plate_camera": "plates.match.reader",
    "light_probe": "plates.probe.probe",
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
        "analysis", "calibration", "charts", "development", "distortion", "errors", "export",
        "exposure", "files", "labels", "lenses", "polynomial", "post", "rendering", "scene",
        "sensors", "stocks",
    )
} | {"metering": "exposure.metering"}  # fmt: skip


if not TYPE_CHECKING:  # checkers know the names above, and report all others

    def __getattr__(name: str) -> Any:
        if name in _MODULES:
            return import_module("." + _MODULES[name], __name__)
        if name in _LAZY:
            value = getattr(import_module("." + _LAZY[name], __name__), name)
            globals()[name] = value
            return value
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
