"""``daguerre match-plate``: the camera of a photograph, for compositing objects into it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from daguerre.errors import UsageError
from daguerre.files.reading import exists
from daguerre.plates.match.parameters import MATCH

from . import console
from .flags.from_table import TableFlags, made_of
from .flags.groups import option, with_flags

if TYPE_CHECKING:
    from daguerre.plates.match.plate_camera import PlateCamera


@made_of(MATCH)
class MatchFlags(TableFlags):
    """Flags for data that the photograph lacks."""


@with_flags(flags=MatchFlags)
def match_plate(
    photo: Annotated[
        Path,
        typer.Argument(metavar="PHOTO", help="Raw file, .jpg, .png, .tif, or linear .exr."),
    ],
    *,
    flags: MatchFlags,
    output: Annotated[
        Path | None,
        option(
            "-o",
            "--output",
            metavar="FILE.json",
            help="Camera file to write [PHOTO.camera.json].",
        ),
    ] = None,
    flat: Annotated[
        list[Path] | None,
        option(
            "--flat",
            metavar="FILE",
            help="Photo of an evenly lit surface at the same settings, to measure vignetting and "
            "noise; repeatable.",
        ),
    ] = None,
    json: Annotated[bool, option("--json", help="Print all numbers as one JSON object.")] = False,
    quiet: Annotated[bool, option("--quiet", "-q", help="Print errors only.")] = False,
) -> int:
    """Measures the camera that took a photo.

    It finds lens, exposure, noise, sharpness and vignetting, and writes them to a camera file for
    `render --like-plate`.
    """
    from daguerre.files.atomic import check_writable
    from daguerre.plates.match.match import match_plate as match

    console.quiet = quiet
    target = output or photo.with_name(f"{photo.stem}.camera.json")
    if target.suffix.lower() != ".json":
        raise UsageError(f"-o {target}: wanted a name ending in .json, got {target.suffix!r}")
    if (exists(photo) and output is None) or output is not None:
        check_writable(target)
    found = match(photo, flats=flat or (), **flags.given())
    found.save(target)
    for text in found.notes:
        console.note(text)
    console.note(f"wrote {target}")
    if json:
        from json import dumps

        from daguerre.plates.match.plate_camera import members

        console.show(dumps(members(found, _sensor_name(found, target)), indent=2))
    elif not quiet:
        _print(found)
    return 0


def _sensor_name(found: PlateCamera, target: Path) -> str | None:
    return None if found.sensor is None else f"{target.stem}.sensor.json"


def _print(found: PlateCamera) -> None:
    width, height = found.resolution
    console.show(f"{found.plate}: {width} x {height} px, {found.kind}")
    for what, text in {**_camera(found), **_measured(found)}.items():
        console.show(f"  {what:12} {text}")


def _camera(found: PlateCamera) -> dict[str, str]:
    camera = found.camera
    focal = camera.zoom or camera.focal_length or found.focal_length
    name = camera.lens if isinstance(camera.lens, str) else "thin lens"
    focus = camera.focus_distance
    told = "not known" if focus is None else "inf" if math.isinf(focus) else f"{focus:g} m"
    sides = " x ".join(f"{side:.4g}" for side in camera.sensor_size)
    return {
        "lens": name if focal is None else f"{name} at {focal:g} mm",
        "exposure": f"f/{camera.f_stop:.3g}, {_seconds(camera.shutter_time)}, ISO {camera.iso:g}",
        "focus": told,
        "sensor": f"{sides} mm",
    }


def _measured(found: PlateCamera) -> dict[str, str]:
    from daguerre.plates.match.plate_sensor import UNKNOWN
    from daguerre.plates.match.transfer import Transfer

    noise, sharp, even = found.noise, found.sharpness, found.falloff
    rows: dict[str, str] = {}
    if isinstance(noise, Transfer):
        rows["gain"] = f"{noise.gain:.4g} DN/e-, +-{noise.gain_error:.1%}"
        error = noise.read_noise_error
        sure = f"{noise.read_noise:.3g} e-, +-{error:.1%}"
        rows["read noise"] = sure if error < UNKNOWN else "not known"
    elif noise is not None:
        lowest, highest = noise.deviations[1].min(), noise.deviations[1].max()
        rows["noise"] = (
            f"{lowest:.2g} .. {highest:.2g} of white in green, grain {noise.size:.2g} px"
        )
    if sharp is not None:
        half = f"{sharp.mtf50:.3g} cycles/px" if math.isfinite(sharp.mtf50) else "beyond 0.5"
        rows["MTF50"] = f"{half}, by {sharp.edges} edges"
        rows["blur"] = f"{sharp.blur.sigma:.3g} px, sharpening {sharp.blur.sharpen:.2g}"
    if even is not None:
        rows["corners"] = f"{even.corner_ev:+.2f} EV"
    return rows


def _seconds(time: Any) -> str:
    return f"1/{1 / time:.4g} s" if time and time < 0.3 else f"{time:g} s"
