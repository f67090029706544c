"""Matched camera of a plate, for objects that should look as if taken with it."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

from daguerre.argument_checks import guarded
from daguerre.camera.camera import Camera
from daguerre.files.value import Value
from daguerre.plates.photograph import Kind
from daguerre.sensors import Sensor

from .falloff import Falloff
from .grain import Grain
from .sharpness import Sharpness
from .transfer import Transfer
from .writer import SCHEMA, camera_members, falloff_members, noise_members, sharpness_members, write

#: Camera parameters that a match sets.
FOUND = (
    *("lens", "focal_length", "zoom", "f_stop", "exposure_f_stop", "focus_distance"),
    *("shutter_time", "iso", "responsivity", "sensor_size", "white_balance"),
)


@guarded
@dataclass(frozen=True, eq=False)
class PlateCamera(Value):
    """A matched camera.

    Attributes:
        plate: File name of the plate.
        sha256: SHA-256 of the plate's file.
        kind: ``raw``, ``display`` or ``linear``.
        resolution: Width and height of the upright plate, px.
        camera: Lens, f-stop, shutter, ISO and sensor size.
        sensor: Sensor with the measured gain and noise for a raw plate; else None.
        noise: Photon transfer for a raw plate, else grain; None: no part of the plate is flat.
        sharpness: Sharpness measured at edges; None: no edge was good enough.
        falloff: Vignetting measured in a flat; None: no flat.
        focal_length: Focal length from the plate's metadata, mm; None: unknown.
        look: Tone curve for development.
        notes: Assumptions made in the match.
    """

    plate: str
    sha256: str
    kind: Kind
    resolution: tuple[int, int]
    camera: Camera
    sensor: Sensor | None = None
    noise: Transfer | Grain | None = None
    sharpness: Sharpness | None = None
    falloff: Falloff | None = None
    focal_length: float | None = None
    look: str = "neutral"
    notes: tuple[str, ...] = ()

    def changes(self) -> dict[str, Any]:
        """Arguments of ``Camera.with_`` that give another camera this one's settings.

        Its exposure mode is ``manual``, as the plate was exposed.
        """
        defaults = Camera()
        found = {name: getattr(self.camera, name) for name in FOUND}
        kept = {name: value for name, value in found.items() if value != getattr(defaults, name)}
        always = {"sensor_size": self.camera.sensor_size, "iso": self.camera.iso}
        always["exposure"] = "manual"
        return kept | always | ({} if self.sensor is None else {"sensor": self.sensor})

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a camera file, and a sensor file beside it for a raw plate.

        Args:
            path: Path of the camera file, usually ``.json``; the sensor of ``x.json`` is in
                ``x.sensor.json``.

        Raises:
            OutputError: A file cannot be written.
        """
        write(path, self.sensor, lambda beside: members(self, beside))

    def __repr__(self) -> str:
        width, height = self.resolution
        return f"<PlateCamera {self.plate}: {width}x{height}, {self.kind}>"


def members(plate: PlateCamera, sensor: str | None) -> dict[str, Any]:
    """Members of the file; ``sensor``: name of the sensor's own."""
    return {
        "schema": SCHEMA,
        "plate": {
            "file": plate.plate,
            "sha256": plate.sha256,
            "kind": plate.kind,
            "resolution": list(plate.resolution),
            "focal_length_mm": plate.focal_length,
        },
        "camera": camera_members(plate.camera),
        "sensor": sensor,
        "noise": noise_members(plate.noise),
        "sharpness": sharpness_members(plate.sharpness),
        "vignetting": falloff_members(plate.falloff),
        "development": {"look": plate.look},
        "notes": list(plate.notes),
    }
