"""A resolved camera in the terms of other renderers: a pinhole, a thin lens, or a lens file."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from daguerre.camera.camera import Camera
from daguerre.camera.exposure_mode import AUTOMATIC
from daguerre.exporters.record import ExportedView, LensFile
from daguerre.exposure.lux_seconds import compensation, display_gain
from daguerre.files.notes import Notes
from daguerre.lenses import LensSurface
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM
from daguerre.setup.metadata import camera_metadata
from daguerre.setup.resolved import Glass, ResolvedCamera

#: Shares of the first and the last visible light, nm, between which glass may bend differently.
_BLUE_NM, _RED_NM = 486.13, 656.27
_LEFT_OUT = {
    "natural_vignetting": "fall-off by cos^4 of the field angle is left out",
    "front_mask": "dust on the front of the lens is left out",
    "iris_mask": "dust at the iris is left out",
    "cover_glass": "cover glass of the sensor is left out",
    "scatter": "scatter of the lens is left out",
}


def view_of(setup: ResolvedCamera, notes: Notes) -> ExportedView:
    """Makes the view of a camera at mid-exposure, and notes the properties that it lacks."""
    camera, lens = setup.camera, setup.lens
    _note_camera(setup, notes)
    view = ExportedView(
        np.asarray(setup.world_from_camera, np.float64),
        setup.frame_size_mm,
        setup.shift_mm,
        lens.pinhole_focal_length_mm,
        _radius_m(setup),
        math.inf if lens.focus_distance_m is None else lens.focus_distance_m,
        camera.near_clip,
        gain=_gain(setup, notes),
    )
    if camera.projection is not None:
        notes.add(
            f"projection {camera.projection.model} is written as a pinhole of its focal length"
        )
        film = camera.projection.film(setup.frame_size_mm[0])
        x, y = film["principal_mm"]
        shift = (camera.shift[0] - x, camera.shift[1] - y)
        return replace(view, film_distance_mm=film["focal_mm"][0], shift_mm=shift)
    if lens.glass is None or lens.model not in ("exact", "polynomial"):
        return view
    return _with_lens(view, setup, lens.glass, notes)


def _gain(setup: ResolvedCamera, notes: Notes) -> float:
    """Factor on the light of the picture, by the exposure mode."""
    facts = camera_metadata(setup.camera, setup, setup.resolution[0])
    mode = facts["exposure"]
    if mode not in AUTOMATIC:
        return display_gain(facts)
    notes.add(f"exposure {mode} is left out: the file has the mode light")
    return compensation(facts)


def _radius_m(setup: ResolvedCamera) -> float:
    """Radius of the entrance pupil, m; 0: a pinhole."""
    lens = setup.lens
    if lens.aperture_diameter_mm is not None:
        return lens.aperture_diameter_mm / 2e3
    if lens.f_stop is None or lens.model == "pinhole":
        return 0.0
    return lens.effective_focal_length_mm / lens.f_stop / 2e3


def _with_lens(
    view: ExportedView, setup: ResolvedCamera, glass: Glass, notes: Notes
) -> ExportedView:
    """Adds the prescription if pbrt can trace it; otherwise notes that a thin lens replaces it."""
    surfaces = glass.lens.surfaces
    if not all(_is_spherical(surface) for surface in surfaces) or any(setup.camera.tilt):
        notes.add(f"lens {glass.lens.name} is written as a thin lens: its surfaces are not spheres")
        return view
    assert setup.lens.f_stop is not None
    assert glass.lens.prescription is not None
    order = glass.lens.first_order()
    wide = order.efl / order.entrance_pupil.diameter  # f-number at which the stop is clear
    stop = 2 * order.stop_semi_diameter * wide / setup.lens.f_stop
    rows = np.array(_rows(surfaces))
    pupil = glass.entrance_pupil_offset_mm * 1e-3
    notes.add("coatings and absorption of a lens are left out: the light is scaled to match them")
    lens = LensFile(
        rows,
        stop,
        view.focus_distance_m + pupil,
        pupil,
        glass.transmittance / glass.h0,
        chromatic=any(_disperses(surface) for surface in surfaces),
    )
    return replace(view, lens=lens)


def _is_spherical(surface: LensSurface) -> bool:
    plain = surface.kind in ("spherical", "stop") and not surface.conic and not surface.asphere
    centred = not any(surface.decenter) and not any(surface.tilt)
    return (
        plain and centred and not surface.inner_semi_diameter and surface.semi_diameter is not None
    )


def _rows(surfaces: Sequence[LensSurface]) -> list[tuple[float, float, float, float]]:
    """Rows of radius, thickness, index and diameter, mm; the stop is a separate row."""
    rows, before = [], 1.0
    for surface in surfaces:
        assert surface.semi_diameter is not None
        diameter = 2 * surface.semi_diameter
        index = float(surface.core_glass.index(DESIGN_WAVELENGTH_NM))
        gap = surface.thickness or 0.0
        if surface.stop:
            rows.append((0.0, gap if surface.kind == "stop" else 0.0, before, diameter))
        if surface.kind != "stop":
            rows.append((surface.radius or _FLAT_MM, gap, index, diameter))
        before = index
    return rows


#: Radius of a sphere in place of a plane, mm, as a radius of 0 is the stop in pbrt.
_FLAT_MM = 1e6


def _disperses(surface: LensSurface) -> bool:
    glass = surface.core_glass
    return abs(float(glass.index(_BLUE_NM)) - float(glass.index(_RED_NM))) > 1e-6


def _note_camera(setup: ResolvedCamera, notes: Notes) -> None:
    camera: Camera = setup.camera
    if setup.changes:
        notes.add("motion of the camera is left out: it is written as it is at mid-exposure")
    if any(camera.tilt):
        notes.add("tilt of the lens is left out")
    if setup.lens.f_stop is not None and (camera.blades or camera.aperture_image is not None):
        notes.add("shape of the iris is left out: it is written as round")
    if setup.lens.squeeze != 1:
        notes.add("squeeze of an anamorphic lens is left out")
    for name, sentence in _LEFT_OUT.items():
        if getattr(camera, name):
            notes.add(sentence)
