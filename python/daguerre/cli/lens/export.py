"""Files of ``daguerre lens``; ``--export`` writes the lens as code for other programs."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daguerre.camera.parameters import CAMERA
from daguerre.cli import console
from daguerre.cli.drawings import check_drawing
from daguerre.cli.flags.from_table import TableFlags, made_of
from daguerre.errors import UsageError
from daguerre.parameters.parameter import Parameter
from daguerre.parameters.table import Table
from daguerre.units import SENSORS

if TYPE_CHECKING:
    from daguerre._core import Iris
    from daguerre.lenses import Lens
    from daguerre.polynomial import LensFit

_BLADES = ("blades", "blade_rotation", "blade_curvature")
# fmt: off
_FIT = (
    replace(CAMERA["degree"], meaning="Degree of the exported polynomials, odd, 1 to 13"),
    replace(
        CAMERA["sensor_size"], meaning="Size of the film for --export and --flare, mm",
        flags=("--sensor",), metavar="WxH|" + "|".join(SENSORS), tells_default=False,
        default_words="the lens's format",
    ),
    replace(
        CAMERA["blades"], meaning="Number of iris blades of the exported lens; 0 is round",
    ),
    replace(
        CAMERA["blade_rotation"], meaning="Rotation of the exported lens's iris blades, degrees",
    ),
    replace(
        CAMERA["blade_curvature"],
        meaning="Curvature of the exported lens's iris blades, -1 to 1; 0 is straight, 1 round",
    ),
)
_FILES = Table(
    Parameter(
        "plot", "Write a one-page data sheet; with --psf or --flare their plots (needs extra "
        "`plot`)", kind="output", flags=("--plot", "-o"), metavar="FILE.svg|png|pdf",
    ),
    Parameter(
        "drawing", "Write a section with rays of three field points (.png and .pdf need extra "
        "`plot`)", kind="output", flags=("--drawing",), metavar="FILE.svg|png|pdf",
    ),
    Parameter(
        "export", "Write the lens as polynomials: OSL for Blender's camera, C, GLSL, NumPy or "
        "JSON data", kind="output", flags=("--export",), metavar="FILE.osl|c|glsl|py|json",
    ),
    _FIT,
)
# fmt: on


@made_of(_FILES, panel="Files written")
class FileFlags(TableFlags):
    """Files, and parameters of the fit for ``--export``; None: not given."""

    plot: Path | None
    drawing: Path | None
    export: Path | None

    def check(self, *, film_serves: bool) -> None:
        """Checks the flags before anything is computed.

        Args:
            film_serves: Whether another flag uses ``--sensor``.
        """
        check_drawing("--plot", self.plot)
        check_drawing("--drawing", self.drawing, plotted=False)
        if self.export is None:
            for row in _FIT:
                served = film_serves and row.name == "sensor_size"
                if getattr(self, row.field) is not None and not served:
                    raise UsageError(f"{row.flag} needs --export FILE")
            return
        from daguerre.export import check_suffix
        from daguerre.files.atomic import check_writable

        check_suffix(self.export, "--export")
        check_writable(self.export)

    def write(self, item: Lens, path: Path, setting: dict[str, Any]) -> None:
        """Fits the lens and writes the file; notes the error of the fit."""
        from daguerre.polynomial.segments import fewest, weak_region

        fitted = fewest(lambda segments: self._fitted(item, setting, segments))
        fitted.save(path)
        error = fitted.error
        console.note(
            f"wrote {path} (degree {fitted.degree}, direction {error.direction_rad[0]:.2g} rad "
            f"RMS, {error.direction_rad[1]:.2g} at most; {error.film_um[0]:.2g} um RMS on the film)"
        )
        if weak := weak_region(fitted):
            console.note(f"{path}: {weak}: a higher --degree fits better")

    def _fitted(self, item: Lens, setting: dict[str, Any], segments: int) -> LensFit:
        from daguerre.polynomial import fit

        given = self.given()
        return fit(
            item,
            given.get("degree", CAMERA["degree"].usual),
            film=self.film,
            f_stop=setting.get("f_stop"),
            focus=setting.get("focus_m", math.inf),
            focus_by=setting["by"],
            zoom=setting.get("zoom_mm"),
            segments=segments,
            iris=_iris(given),
        )

    @property
    def film(self) -> tuple[float, float] | None:
        """Width and height of the film, mm; None: not given."""
        return self.given().get("sensor_size")


def _iris(given: dict[str, Any]) -> Iris:
    from daguerre.camera.camera import Camera
    from daguerre.setup.iris import iris_of

    return iris_of(Camera(**{name: given[name] for name in _BLADES if name in given}))
