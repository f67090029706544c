"""The camera of a plate, as it was matched: for objects that shall look as if it had seen them."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

from daguerre.camera.camera import Camera
from daguerre.doors import guarded
from daguerre.files.value import Value
from daguerre.plates.photograph import Kind
from daguerre.sensors import Sensor

from .falloff import Falloff
from .grain import Grain
from .sharpness import Sharpness
from .transfer import Transfer

#: Parameters of a camera that a match finds.
FOUND = (
    *("lens", "focal_length", "zoom", "f_stop", "exposure_f_stop", "focus_distance"),
    *("shutter_time", "iso", "responsivity", "sensor_size", "white_balance"),
)


@guarded
@dataclass(frozen=True, eq=False)
class PlateCamera(Value):
    """A matched camera.

    Attributes:
        plate: Name of the plate's file.
        sha256: Its hash.
        kind: ``raw``, ``display`` or ``linear``.
        resolution: Width and height of the plate, upright, px.
        camera: Lens, stop, shutter, ISO and size of the sensor.
        sensor: The sensor with gain and noise as measured, of a raw plate; None of others.
        noise: Photon transfer of a raw plate, grain of others; None: no part of it is flat.
        sharpness: Sharpness by edges; None: none was good enough.
        falloff: Vignetting by a flat; None: there was none.
        focal_length: Focal length that the plate tells, mm; None: it tells none.
        look: Tone curve that pictures are developed by.
        notes: Decisions that were made on the user's behalf.
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
        """Parameters of ``Camera.with_`` that make another camera this one."""
        defaults = Camera()
        found = {name: getattr(self.camera, name) for name in FOUND}
        kept = {name: value for name, value in found.items() if value != getattr(defaults, name)}
        always = {"sensor_size": self.camera.sensor_size, "iso": self.camera.iso}
        return kept | always | ({} if self.sensor is None else {"sensor": self.sensor})

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a camera file, and that of its sensor beside it.

        Args:
            path: Its name should end in ``.json``; ``x.json`` has its sensor in ``x.sensor.json``.

        Raises:
            OutputError: A file cannot be written.
        """
        from .writer import write

        write(path, self)

    def __repr__(self) -> str:
        width, height = self.resolution
        return f"<PlateCamera {self.plate}: {width}x{height}, {self.kind}>"
