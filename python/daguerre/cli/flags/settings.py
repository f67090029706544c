"""Flags of render settings, from the rows with flags in the table of parameters."""

from daguerre.errors import UsageError
from daguerre.rendering.diffraction import Diffraction
from daguerre.rendering.parameters import DEFAULT, FLAGS, of_flags
from daguerre.rendering.settings import RenderSettings

from .from_table import TableFlags, made_of


@made_of(FLAGS)
class SettingsFlags(TableFlags):
    """Render settings; those not given have the defaults of the table."""

    crop: str | None

    def settings(self, **more: object) -> RenderSettings:
        """Makes the settings, with parameters from other flags.

        Raises:
            UsageError: A value is wrong, or excludes another; the message names the flag.
        """
        given = self.given()
        bands, wanted = given.get("bands", DEFAULT["bands"]), given.get("diffraction_bands")
        if bands and wanted not in (None, Diffraction.bands, bands):
            raise UsageError(
                f"--bands and --diffraction-bands: wanted the same number, got {bands} and {wanted}"
            )
        return RenderSettings.read(of_flags(given) | more, FLAGS.flag)
