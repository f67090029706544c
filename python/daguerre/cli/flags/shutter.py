"""Flags of the shutter, for every command that looks through a camera."""

from typing import Any

from daguerre.camera.parameters import CAMERA, SHUTTER

from .from_table import TableFlags, made_of


@made_of(SHUTTER, names=CAMERA)
class ShutterFlags(TableFlags):
    """When the film is exposed; what is not given stays as the file says, else 180 degrees."""

    def changes(self) -> dict[str, Any]:
        """The parameters of ``Camera.with_`` that were given."""
        given = self.given()
        self.table.refuse_rivals(given)
        return given
