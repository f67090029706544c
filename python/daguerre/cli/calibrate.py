"""``daguerre calibrate``: fits a projection model of camera calibration to a lens."""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from daguerre.camera.parameters import CAMERA
from daguerre.camera.parameters.bench import MODEL, SEEN, TERMS
from daguerre.errors import UsageError, suggest
from daguerre.parameters.table import Table
from daguerre.units import TYPED_D_LINE_NM

from . import console
from .drawings import check_drawing, write_drawing
from .flags.from_table import TableFlags, made_of
from .flags.groups import option, with_flags
from .flags.map import MapFlags

if TYPE_CHECKING:
    from daguerre.analysis.calibrate import ProjectionFit

FORMATS = ("opencv", "ros", "kalibr", "opentrackio", "usd")
PICTURES = (".png", ".svg", ".pdf")
ALL = "all"
WELL = 1.0  # px; larger errors give a note
USUAL = {"resolution": (1920, 1280), "wavelength_nm": TYPED_D_LINE_NM}


@made_of(Table(MODEL, TERMS, SEEN))
class CalibrateFlags(TableFlags):
    """Parameters of ``dg.calibrate``."""


@with_flags(map_flags=MapFlags, flags=CalibrateFlags)
def calibrate(
    name: Annotated[str, typer.Argument(metavar="LENS", help="Library name or lens file.")],
    *,
    map_flags: MapFlags,
    flags: CalibrateFlags,
    output: Annotated[
        Path | None, option("-o", "--output", metavar="FILE", help="Calibration file to write.")
    ] = None,
    file_format: Annotated[
        str | None,
        option(
            "--format",
            metavar="opencv|ros|kalibr|opentrackio|usd",
            help="Format of the calibration file [opencv].",
        ),
    ] = None,
    residuals: Annotated[
        Path | None,
        option(
            "--residuals",
            metavar="FILE.png|svg|pdf",
            help="Plot the residuals of the fit over the picture (needs extra `plot`).",
        ),
    ] = None,
    json: Annotated[bool, option("--json", help="Print all numbers as one JSON object.")] = False,
) -> int:
    """Fits a projection model of camera calibration to a lens.

    The models are OpenCV's and fisheyes; the fit uses the chief rays of the lens.
    """
    from daguerre.analysis.calibrate import calibrate as fit
    from daguerre.analysis.calibrate import calibrate_all
    from daguerre.files.atomic import check_writable
    from daguerre.lenses.engraved import stop_remark

    use: dict[str, Any] = USUAL | flags.given()
    CAMERA["focus_by"].check(use.get("focus_by"), "--focus-by")
    _check_files(output, file_format, residuals)
    map_flags.check()
    for path in map_flags.files:
        check_writable(path)
    written = [os.path.realpath(path) for path in (output, residuals, *map_flags.files) if path]
    if len(set(written)) < len(written):
        raise UsageError("-o: the same file is named twice")
    model = use.pop("model", MODEL.default)
    if model == ALL:
        if "terms" in use or output or residuals or map_flags.files:
            raise UsageError(
                "--model all compares models and writes no file: leave out -o, --residuals, "
                "--export-... and --terms"
            )
        _compare(calibrate_all(name, **use), json=json)
        return 0
    if file_format == "kalibr" and model == "opencv":
        use.setdefault("terms", 4)  # Kalibr's radtan has no k3
    made = fit(name, model, **use)
    bench = made.bench
    if text := stop_remark(bench.lens, f_stop=use.get("f_stop"), widest=bench.f_stop):
        console.note(text)
    if made.largest > WELL:
        console.note(
            f"note: {made.projection.model} is up to {made.largest:.3g} px off; --model all shows "
            "how well other models fit"
        )
    _write(made, output, file_format or FORMATS[0], residuals)
    if map_flags.files:
        _write_maps(map_flags, made)
    if json:
        from json import dumps

        console.show(dumps(_facts(made), indent=2))
    else:
        _print(made)
    return 0


def _compare(fits: list[ProjectionFit], *, json: bool) -> None:
    """Prints the fits, the best first."""
    if json:
        from json import dumps

        console.show(dumps([_facts(made) for made in fits], indent=2))
        return
    console.show(f"{'model':16} {'terms':>5} {'RMS, px':>9} {'at most':>9}")
    for made in fits:
        model = made.projection
        console.show(
            f"{model.model:16} {len(model.parameters):5} {made.rms:9.3g} {made.largest:9.3g}"
        )


def _check_files(output: Path | None, file_format: str | None, residuals: Path | None) -> None:
    from daguerre.files.atomic import check_writable

    if file_format is not None and file_format not in FORMATS:
        raise UsageError(
            f"--format: wanted {', '.join(FORMATS)}; got {file_format!r}"
            f"{suggest(file_format, FORMATS)}"
        )
    if file_format is not None and output is None:
        raise UsageError("--format needs -o FILE")
    if output is not None:
        check_writable(output)
    check_drawing("--residuals", residuals, formats=PICTURES)


def _write(
    made: ProjectionFit, output: Path | None, file_format: str, residuals: Path | None
) -> None:
    from daguerre.calibration import Calibration, write

    if output is not None:
        write(output, Calibration(made.projection, pixel_pitch=made.pixel_pitch_um), file_format)
        console.note(f"wrote {output}")
    if residuals is not None:
        from daguerre.plots.residual_plot import plot_residuals

        write_drawing(residuals, plot_residuals(made, residuals.suffix.lower()[1:]))


def _write_maps(map_flags: MapFlags, made: ProjectionFit) -> None:
    """Writes maps of the lens itself, not of its fit."""
    from daguerre import Scene
    from daguerre.camera.overscan import NONE

    map_flags.write(Scene(), made.camera, made.projection.size, NONE)


def _facts(made: ProjectionFit) -> dict[str, Any]:
    bench = made.bench
    return {
        **made.projection.facts(),
        "pixel_pitch_um": made.pixel_pitch_um,
        "lens": bench.lens.name,
        "f_stop": bench.f_stop,
        "focus_m": None if math.isinf(bench.focus_mm) else bench.focus_mm / 1e3,
        "rms_px": made.rms,
        "largest_px": made.largest,
        "chief_rays": len(made.pixels),
        "unseen": made.unseen,
    }


def _print(made: ProjectionFit) -> None:
    from daguerre.camera.projection import MODELS

    model = made.projection
    bench = made.bench
    focus = "inf" if math.isinf(bench.focus_mm) else f"{bench.focus_mm / 1e3:g} m"
    width, height = model.size
    console.show(f"{bench.lens.name}, f/{bench.f_stop:.3g}, focus {focus}, {width} x {height} px")
    rows = [
        ("model", model.model),
        ("focal lengths", "{:.6f}, {:.6f} px".format(*model.focal)),
        ("principal point", "{:.4f}, {:.4f} px".format(*model.center)),
        *zip(MODELS[model.model], (f"{k:.9g}" for k in model.parameters), strict=False),
        ("residual", f"{made.rms:.3g} px RMS, {made.largest:.3g} px at most"),
        ("chief rays", f"{len(made.pixels)}"),
    ]
    if made.unseen:
        rows.append(("unseen", f"{made.unseen} points of the picture"))
    for what, value in rows:
        console.show(f"  {what:16} {value}")
