"""Flags of the shutter, for every command that uses a camera."""

from typing import Any

from daguerre.camera.parameters import CAMERA, SHUTTER

from .from_table import TableFlags, made_of


@made_of(SHUTTER, names=CAMERA)
class ShutterFlags(TableFlags):
    """Parameters of the shutter; those not given stay as in the scene, else 180 degrees."""

    def changes(self) -> dict[str, Any]:
        """Given parameters, for ``Camera.with_``."""
        given = self.given()
        self.table.refuse_rivals(given)
        return given
