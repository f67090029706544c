"""Focal length and f-stop of a camera, as USD has them."""

from __future__ import annotations

from daguerre.camera.camera import Camera
from daguerre.camera.ideal import IDEAL, WITHOUT_IRIS
from daguerre.camera.parameters import CAMERA
from daguerre.lenses import Lens, load


def focal_mm(camera: Camera) -> float:
    """Focal length, mm; for a prescription the lens's."""
    if camera.projection is not None:
        pair = camera.projection.film(camera.sensor_size[0])["focal_mm"]
        return float(sum(pair) / 2)
    if camera.lens is None or camera.lens in IDEAL:
        usual = CAMERA["focal_length"].usual
        return float(usual if camera.focal_length is None else camera.focal_length)
    lens: Lens = load(camera.lens)
    if camera.zoom is not None:
        lens = lens.at_zoom(camera.zoom)
    return float(lens.first_order().efl)


def stop_of(camera: Camera) -> float | None:
    """F-stop; 0 without an iris; None: the default."""
    hole = camera.lens in WITHOUT_IRIS or camera.lens_model in WITHOUT_IRIS
    if hole or (camera.projection is not None and camera.f_stop is None):
        return 0.0
    if camera.aperture_diameter is not None:
        return focal_mm(camera) / camera.aperture_diameter
    return camera.t_stop if camera.f_stop is None else camera.f_stop


def exposed_stop(camera: Camera) -> float | None:
    """F-stop that the lens of a camera has; None: no iris."""
    stop = stop_of(camera)
    if stop is not None:
        return stop or None
    usual = float(CAMERA["f_stop"].usual)
    if camera.lens is None or camera.lens in IDEAL:
        return usual
    lens: Lens = load(camera.lens)
    return max(usual, lens.first_order().f_number)
