"""Further calls with what a call made, where a value is only looked at when it is used."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import daguerre as dg

from .world import SIZE, TRIANGLE, World, moved

Use = Callable[[World, Any], object]


def _seen_by(world: World, camera: Any) -> None:
    dg.render(world.scene, camera, resolution=SIZE, spp=1)


def _made_of(world: World, kind: Any) -> None:
    scene = world.scene
    scene.add_instance(scene.add_mesh(TRIANGLE, [(0, 1, 2)]), kind, moved(z=-2))
    dg.render(scene, resolution=SIZE, spp=1)


def _lit_by(world: World, light: Any) -> None:
    scene = world.scene
    scene.add_light(light, moved(y=1))
    dg.render(scene, resolution=SIZE, spp=1)


def _textured(world: World, slot: Any) -> None:
    _made_of(world, dg.Gltf(base_color_texture=slot))


def _rendered(world: World, settings: Any) -> None:
    dg.render(world.scene, settings=settings.with_(resolution=SIZE), spp=1)


def _exposed(world: World, sensor: Any) -> None:
    world.frame.expose(sensor)


def _at(world: World, keys: Any) -> None:
    keys.at(0.5)
    keys.breaks(0.0, 1.0)


#: By the path of the call.
USES: dict[str, Use] = {
    "dg.Camera": _seen_by,
    "dg.Camera.with_": _seen_by,
    "dg.Boundary": _made_of,
    "dg.Coated": _made_of,
    "dg.Conductor": _made_of,
    "dg.Conductor.of_metal": _made_of,
    "dg.Dielectric": _made_of,
    "dg.Diffuse": _made_of,
    "dg.Gltf": _made_of,
    "dg.Material": _made_of,
    "dg.Spectrum": lambda w, spectrum: _made_of(w, dg.Diffuse(spectrum)),
    "dg.DirectionalLight": _lit_by,
    "dg.PointLight": _lit_by,
    "dg.SphereLight": _lit_by,
    "dg.SpotLight": _lit_by,
    "dg.TextureSlot": _textured,
    "dg.RenderSettings.of": _rendered,
    "dg.RenderSettings.with_": _rendered,
    "dg.iter_render": lambda w, frames: list(frames),
    "dg.keys": _at,
    "dg.spin": _at,
    "dg.RollingShutter": lambda w, v: _seen_by(w, dg.Camera(shutter_time=0.01, rolling_shutter=v)),
    "dg.LensScatter": lambda w, v: w.traced.with_(scatter=v),
    "dg.sensors.Sensor.with_": _exposed,
    "dg.stocks.Stock.with_": lambda w, stock: stock.expose(w.frame),
    "dg.Projection": lambda w, p: p.unproject([(4.0, 3.0)]),
    "dg.distortion.BrownConrady": lambda w, d: d.undistort(d.distort([(0.1, 0.2)])),
    "dg.distortion.Division": lambda w, d: d.undistort(d.distort([(0.1, 0.2)])),
    "dg.distortion.OpenCV": lambda w, d: d.undistort(d.distort([(0.1, 0.2)])),
    "dg.distortion.OpenCVFisheye": lambda w, d: d.undistort(d.distort([(0.1, 0.2)])),
}
