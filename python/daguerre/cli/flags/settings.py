"""Flags of render settings, from the rows with flags in the table of parameters."""

from typing import Any

from daguerre.errors import UsageError
from daguerre.rendering.diffraction import Diffraction
from daguerre.rendering.parameters import DEFAULT, DIFFRACTION_ROWS, FLAGS
from daguerre.rendering.settings import RenderSettings

from .from_table import TableFlags, made_of


@made_of(FLAGS)
class SettingsFlags(TableFlags):
    """Render settings; those not given have the defaults of the table."""

    crop: str | None

    def settings(self, **more: Any) -> RenderSettings:
        """Makes the settings, with parameters from other flags.

        Raises:
            UsageError: A value is wrong, or excludes another; the message names the flag.
        """
        given = self.given()
        waves = {
            row.name: row.check(given.pop(row.name, row.default), row.flag)
            for row in DIFFRACTION_ROWS
        }
        bands, wanted = given.get("bands", DEFAULT["bands"]), waves["diffraction_bands"]
        if bands and wanted not in (Diffraction.bands, bands):
            raise UsageError(
                f"--bands and --diffraction-bands: wanted the same number, got {bands} and {wanted}"
            )
        if given.get("diffraction"):
            given["diffraction"] = Diffraction(*waves.values())
        elif any(waves[row.name] != row.default for row in DIFFRACTION_ROWS):
            raise UsageError("--diffraction-bands and --diffraction-zones need --diffraction")
        return RenderSettings.read(given | more, FLAGS.flag)
