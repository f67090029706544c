"""The camera of a pbrt scene, with film, sampler and integrator.

pbrt's cameras look along +z with +x on the right and +y up, so their frame is a mirror image of
ours; the world keeps our axes.
"""

from __future__ import annotations

import math

import numpy as np

from daguerre.exporters.outgoing.folder import OutgoingFolder, plain_name
from daguerre.exporters.record import ExportedView, LensFile, Outgoing

from .text import Text, floats, integer, string

#: Distance, m, for infinity.
_INFINITY = 1e8


def add_camera(text: Text, outgoing: Outgoing, folder: OutgoingFolder, stem: str) -> None:
    """Adds the directives before the world.

    Args:
        text: Text of the file.
        outgoing: Scene and camera.
        folder: Folder for the lens file.
        stem: Name of the picture, without its suffix.
    """
    view, lens = outgoing.view, outgoing.view.lens
    pose = np.array(view.world_from_camera, np.float64)
    if lens is not None:  # pbrt's origin is the middle of the film
        pose[:3, 3] += lens.pupil_from_film_m * pose[:3, 2]
    text.transform(np.diag([1.0, 1.0, -1.0, 1.0]) @ np.linalg.inv(pose))
    if view.near_m > 0:
        outgoing.notes.add("near clipping plane is left out: pbrt has none")
    if lens is None:
        _add_ideal(text, view)
    else:
        _add_realistic(text, lens, folder)
        if any(view.shift_mm):
            outgoing.notes.add("shift of a lens with a prescription is left out")
        if lens.chromatic:
            outgoing.notes.add("colour fringes of a lens are left out: its indices are at 587.6 nm")
    _add_film(text, outgoing, stem)


def _add_ideal(text: Text, view: ExportedView) -> None:
    left, right, bottom, top = view.window
    short = min(right - left, top - bottom)
    parameters = [floats("fov", math.degrees(2 * math.atan(short / 2)))]
    if any(view.shift_mm):  # in units of half the shorter side
        window = (2 * edge / short for edge in (left, right, bottom, top))
        parameters.append(floats("screenwindow", *window))
    if view.aperture_radius_m > 0:
        parameters.append(floats("lensradius", view.aperture_radius_m))
        parameters.append(floats("focaldistance", min(view.focus_distance_m, _INFINITY)))
    text.directive("Camera", "perspective", *parameters)


def _add_realistic(text: Text, lens: LensFile, folder: OutgoingFolder) -> None:
    rows = ["# radius, thickness, index, diameter: mm, front to rear"]
    rows += [" ".join(repr(float(v)) for v in row) for row in lens.rows]
    path = folder.add("lens", ".dat", ("\n".join(rows) + "\n").encode())
    text.directive(
        "Camera", "realistic", string("lensfile", path),
        floats("aperturediameter", lens.stop_diameter_mm),
        floats("focusdistance", min(lens.focus_from_film_m, _INFINITY)),
    )  # fmt: skip


def _add_film(text: Text, outgoing: Outgoing, stem: str) -> None:
    width, height = outgoing.resolution
    view = outgoing.view
    text.directive(
        "Film", "rgb", integer("xresolution", width), integer("yresolution", height),
        floats("diagonal", math.hypot(*view.film_mm)),
        string("sensor", "cie1931"),
        floats("iso", 100.0 * view.gain * (1.0 if view.lens is None else view.lens.gain)),
        string("filename", f"{plain_name(stem)}.exr"),
    )  # fmt: skip
    text.directive("PixelFilter", "box", floats("xradius", 0.5), floats("yradius", 0.5))
    text.directive("Sampler", "halton", integer("pixelsamples", outgoing.spp))
    text.directive("Integrator", "volpath", integer("maxdepth", outgoing.max_depth))
