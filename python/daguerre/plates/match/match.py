"""Matches a photograph automatically: camera, noise, sharpness and vignetting."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Unpack

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.camera.camera import Camera
from daguerre.checks import shown
from daguerre.development.looks import look_of
from daguerre.errors import InputError, UsageError
from daguerre.parameters.keywords import takes
from daguerre.plates.files import read
from daguerre.plates.photograph import Photograph
from daguerre.sensors import Sensor

from .blocks import joined
from .blur import fitted
from .cut import blocks_of
from .falloff import Falloff, falloff_of
from .grain import Grain
from .grain_measure import grain_of
from .lens_model import bench_of, lens_falloff, lens_response
from .likely import white_electrons
from .parameters import MATCH, MatchKeywords
from .plate_camera import PlateCamera
from .plate_sensor import UNKNOWN, plate_sensor, responsivity, with_transfer
from .settings import settings_of
from .sharpness import Sharpness, sharpness_of
from .transfer import Transfer, transfer_of

Path = str | os.PathLike[str]
#: Relative standard error of the read noise above which there is a note.
_UNSURE = 0.1
#: Relative standard error of the gain above which there is a note.
_UNSURE_GAIN = 0.05
#: Look nearest to the JPEGs of cameras.
_USUAL_LOOK = "standard"


@takes(MATCH, MatchKeywords)
@guarded
def match_plate(
    photo: Path, *, flats: Sequence[Path] = (), **keywords: Unpack[MatchKeywords]
) -> PlateCamera:
    """Matches the camera of a photograph, its noise, sharpness and vignetting.

    Lens, f-stop, exposure time, ISO and sensor come from EXIF, noise from flat parts of the
    photograph (or of ``flats``), sharpness from edges, vignetting from ``flats``.

    Args:
        photo: A raw file (``.dng`` and others), ``.jpg``, ``.png``, ``.tif``, or linear ``.exr``.
        flats: Photographs of an even surface with the same camera and settings.
        {keywords}

    Raises:
        InputError: A file cannot be used, or lacks metadata that is needed.
        UsageError: A parameter is wrong.
    """
    given = MATCH.filled(keywords, "match_plate")
    photograph = read(photo)
    even = [_flat(read(path), photograph) for path in flats]
    found = settings_of(photograph, given)
    notes = [*photograph.notes, *found.notes]
    camera, sensor, noise = _noise(photograph, even, found.camera, found.body, notes)
    if photograph.raw is not None and camera.white_balance is None:
        camera = camera.with_(white_balance=photograph.raw.white_balance)
    bench = bench_of(camera)
    pitch = camera.sensor_size[0] / photograph.size[0]
    sharpness = _sharpness(photograph, bench, pitch, notes)
    if sharpness is not None and sensor is not None:
        sensor = sensor.with_(low_pass=0.0)  # included in the measured sharpness
    falloff = _falloff(even, bench, camera, notes)
    return PlateCamera(
        plate=photograph.path.name,
        sha256=photograph.sha256(),
        kind=photograph.kind,
        resolution=photograph.size,
        camera=camera,
        sensor=sensor,
        noise=noise,
        sharpness=sharpness,
        falloff=falloff,
        focal_length=found.focal_length,
        look=_look(given["look"], photograph, notes),
        notes=tuple(notes),
    )


def _flat(flat: Photograph, photograph: Photograph) -> Photograph:
    """Checks that a flat fits the photograph."""
    if flat.kind != photograph.kind or flat.size != photograph.size:
        width, height = photograph.size
        raise InputError(
            f"{flat.path}: flat: wanted a {photograph.kind} picture of {width}x{height} px like "
            f"the plate, got a {flat.kind} one of {flat.size[0]}x{flat.size[1]}"
        )
    return flat


def _noise(
    photograph: Photograph,
    flats: list[Photograph],
    camera: Camera,
    body: Sensor | None,
    notes: list[str],
) -> tuple[Camera, Sensor | None, Transfer | Grain | None]:
    """Returns the camera with its exposure, its sensor, and the noise."""
    if photograph.raw is None:
        return camera, None, _grain(photograph, flats, camera, body, notes)
    iso = float(camera.iso)
    sensor, more = plate_sensor(
        photograph.raw, body, iso, camera.sensor_size[0], f"{photograph.path.stem}-sensor"
    )
    notes += more
    measured = _transfer(photograph, flats, body, notes)
    if measured is None:
        return camera, sensor, None
    sensor = with_transfer(sensor, measured, iso, photograph.raw.white)
    beyond = responsivity(sensor)
    if beyond > 1:
        notes.append(
            f"the camera's ISO rating is {np.log2(beyond):.2f} EV higher than ISO 12232 allows"
        )
        efficiency = np.asarray(sensor.quantum_efficiency) / beyond
        sensor = sensor.with_(quantum_efficiency=efficiency)
        camera = camera.with_(iso=iso / beyond, responsivity=beyond)
    return camera, sensor, measured


def _grain(
    photograph: Photograph,
    flats: list[Photograph],
    camera: Camera,
    body: Sensor | None,
    notes: list[str],
) -> Grain | None:
    """Grain of a developed photograph, else of the first flat that has some."""
    pixel = 1e3 * camera.sensor_size[0] / photograph.size[0]
    if body is not None:  # a crop seems to have larger pixels
        pixel = min(pixel, body.pixel_pitch)
    found = grain_of(photograph, white_electrons(float(camera.iso), pixel), notes)
    if found is not None:
        return found
    for flat in flats:
        found = grain_of(flat)
        if found is not None:
            notes.append(f"noise: taken from {flat.path.name}")
            return found
    notes.append(
        "noise: objects get no grain; add a photograph of an even surface with --flat FILE"
    )
    return None


def _transfer(
    photograph: Photograph, flats: list[Photograph], body: Sensor | None, notes: list[str]
) -> Transfer | None:
    """Photon transfer; None: it cannot be measured, and the library has the camera."""
    pictures = [one.raw for one in (photograph, *flats) if one.raw is not None]
    main = pictures[0]
    blocks = joined([blocks_of(raw, 1 / len(pictures)) for raw in pictures])
    black = float(main.black.max())
    try:
        span = (-black, main.white - black)
        found = transfer_of(blocks, span, len(main.channels), str(photograph.path))
    except InputError as error:
        if body is None:
            raise
        notes.append(f"{error}; gain and noise are taken from the library's {body.name}")
        return None
    if found.gain_error > _UNSURE_GAIN:
        notes.append(
            "noise: few parts are flat, or some have texture, so the gain has an error of "
            f"{found.gain_error:.0%}; add a photograph of an even surface with --flat FILE"
        )
    if found.read_noise_error > UNKNOWN:
        notes.append(
            "read noise: taken from the library's sensor, as no part of the picture is dark"
        )
    elif found.read_noise_error > _UNSURE:
        sure = f"{found.read_noise_error:.0%}"
        notes.append(f"read noise: uncertain by {sure}, as little of the picture is dark")
    return found


def _sharpness(
    photograph: Photograph, bench: Any, pitch_mm: float, notes: list[str]
) -> Sharpness | None:
    found = sharpness_of(photograph)
    if found is None:
        notes.append(
            "sharpness: not measured, as no edge is good enough; objects keep the sharpness "
            "of the render"
        )
        return None
    if bench is None:
        return found
    lens = lens_response(bench, pitch_mm, found.frequency)
    model = np.sinc(found.frequency) * lens
    return replace(found, blur=fitted(found.frequency, found.response, model))


def _falloff(
    flats: list[Photograph], bench: Any, camera: Camera, notes: list[str]
) -> Falloff | None:
    if not flats:
        return None
    found = falloff_of(flats[0])
    if bench is None:
        return found
    found = replace(found, lens=lens_falloff(bench, camera.sensor_size))
    own = found.lens_corner_ev or 0.0
    notes.append(
        f"vignetting: measured corners {found.corner_ev:+.2f} EV, library's lens {own:+.2f} EV"
    )
    return found


def _look(given: str | None, photograph: Photograph, notes: list[str]) -> str:
    """Tone curve, which cannot be measured in a photograph."""
    if given is not None:
        if not isinstance(given, str):
            raise UsageError(f"match-plate: look: wanted a name, got {shown(given)}")
        if not given.startswith("ocio:"):
            look_of(given)
        return given
    if photograph.kind != "display":
        return "neutral"
    notes.append(f"tone: the tone curve is taken as {_USUAL_LOOK}; --look sets another")
    return _USUAL_LOOK
