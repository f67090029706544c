"""Flags of the camera, for every command with a camera."""

from typing import Any

from daguerre.camera.lens_scatter import LensScatter
from daguerre.camera.parameters import CAMERA, CAMERA_FLAGS
from daguerre.camera.placement import Placement

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
        _parts(given, "place.")
        if parts := _parts(given, "scatter."):
            given["scatter"] = LensScatter(**parts)
        self.table.refuse_rivals(given)
        return given

    @property
    def placement(self) -> Placement:
        """Place of the camera; parts not given stay as in the scene."""
        return Placement(**_parts(self.given(), "place."))


def _parts(given: dict[str, Any], prefix: str) -> dict[str, Any]:
    """Takes the parts of one field out of given parameters."""
    names = [name for name in given if name.startswith(prefix)]
    return {name.removeprefix(prefix): given.pop(name) for name in names}
