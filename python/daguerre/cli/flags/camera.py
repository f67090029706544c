"""Flags of the camera, for every command that uses one."""

from typing import Any

from daguerre.camera.lens_scatter import LensScatter
from daguerre.camera.parameters import CAMERA, CAMERA_FLAGS

from .from_table import TableFlags, made_of


@made_of(CAMERA_FLAGS, names=CAMERA)
class CameraFlags(TableFlags):
    """Parameters of the camera; those not given stay as in the scene."""

    camera: str | None

    def changes(self) -> dict[str, Any]:
        """Given parameters, for ``Camera.with_``."""
        given = self.given()
        given.pop("camera", None)
        if isinstance(given.get("sensor"), tuple):
            given["sensor_size"] = given.pop("sensor")
        parts = {name: given.pop(name) for name in list(given) if name.startswith("scatter.")}
        if parts:
            given["scatter"] = LensScatter(
                **{name.removeprefix("scatter."): value for name, value in parts.items()}
            )
        self.table.refuse_rivals(given)
        return given
