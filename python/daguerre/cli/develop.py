"""``daguerre develop``: photographs of what was recorded."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from daguerre import units as q
from daguerre.errors import InputError, UsageError

from . import console
from .flags.groups import option

if TYPE_CHECKING:
    from daguerre.development import Picture
    from daguerre.development.channels import Channels
    from daguerre.frame.frame import Frame
    from daguerre.frame.raw import Raw

_SENSOR, _LOOK, _FILE = "The sensor (of IN.exr)", "The picture", "The file"


def develop(
    source: Annotated[
        Path, typer.Argument(metavar="IN.exr|IN.dng", help="Frame, or a camera's raw file.")
    ],
    output: Annotated[
        list[Path],
        option(
            "-o", "--output", metavar="OUT.jpg|png|tif|exr|dng", help="File to write; repeatable."
        ),
    ],
    sensor: Annotated[
        str | None,
        option(
            "--sensor",
            metavar="NAME|FILE",
            help="Sensor that takes the picture, with its noise [a perfect one].",
            panel=_SENSOR,
        ),
    ] = None,
    stock: Annotated[
        str | None,
        option(
            "--stock",
            metavar="NAME|FILE",
            help="Film stock that takes the picture, then printed; see `daguerre stocks`.",
            panel=_SENSOR,
        ),
    ] = None,
    iso: Annotated[
        str | None,
        option(
            "--iso", metavar="N", help="ISO of the sensor [the frame's, else 100].", panel=_SENSOR
        ),
    ] = None,
    seed: Annotated[
        int, option("--seed", metavar="N", help="Seed of noise and grain [0].", panel=_SENSOR)
    ] = 0,
    ev: Annotated[
        str | None,
        option(
            "--ev",
            metavar="EV",
            help="Exposure compensation, EV: on the sensor with --sensor, else in development.",
            panel=_LOOK,
        ),
    ] = None,
    wb: Annotated[
        str,
        option(
            "--wb",
            metavar="as-shot|auto|K|X,Y",
            help="White that becomes neutral [as-shot].",
            panel=_LOOK,
        ),
    ] = "as-shot",
    look: Annotated[
        str,
        option(
            "--look",
            metavar="neutral|standard|film|filmic|ocio:VIEW",
            help="Tone curve [neutral]; OCIO: extra `color`.",
            panel=_LOOK,
        ),
    ] = "neutral",
    highlights: Annotated[
        str,
        option(
            "--highlights",
            metavar="clip|blend|reconstruct",
            help="Treatment of saturated channels [clip].",
            panel=_LOOK,
        ),
    ] = "clip",
    sharpen: Annotated[
        float,
        option("--sharpen", metavar="X", help="Strength of an unsharp mask [0].", panel=_LOOK),
    ] = 0.0,
    grain: Annotated[
        str,
        option("--grain", metavar="UM", help="Diameter of the film's grains, um [0].", panel=_LOOK),
    ] = "0",
    demosaic: Annotated[
        str,
        option(
            "--demosaic",
            metavar="best|good|fast",
            help="Demosaicing method, or one of LibRaw's by name [good].",
            panel=_LOOK,
        ),
    ] = "good",
    colour_noise: Annotated[
        int,
        option(
            "--colour-noise",
            metavar="N",
            help="Passes of a median filter over color differences, for raw pictures [0].",
            panel=_LOOK,
        ),
    ] = 0,
    colorspace: Annotated[
        str,
        option(
            "--colorspace",
            metavar="srgb|p3|rec2020",
            help="Color space of the file [srgb].",
            panel=_FILE,
        ),
    ] = "srgb",
    quality: Annotated[
        int, option("--quality", metavar="N", help="JPEG quality, 1 to 100 [95].", panel=_FILE)
    ] = 95,
    bits: Annotated[
        int | None,
        option("--bits", metavar="8|16", help="Bits per channel: PNG [8], TIFF [16].", panel=_FILE),
    ] = None,
    quiet: Annotated[bool, option("--quiet", "-q", help="Print errors only.")] = False,
) -> int:
    """Makes photographs of a frame or of a raw file."""
    console.quiet = quiet
    wanted = {
        "wb": wb,
        "look": look,
        "highlights": highlights,
        "sharpen": sharpen,
        "grain": q.plain_number("--grain", grain, "a diameter in um such as 2"),
        "colour_space": colorspace,
        "seed": seed,
        "demosaic": demosaic,
        "colour_noise": colour_noise,
    }
    extra = 0.0 if ev is None else q.plain_number("--ev", ev, "an exposure in EV such as -0.5")
    speed = None if iso is None else q.plain_number("--iso", iso, "a number such as 400")
    _check(source, output, sensor, quality)
    if stock is not None:
        _check_stock(source, output, sensor, iso)
    with _named(source):
        taken: Raw | Frame | Channels
        if source.suffix.lower() == ".exr":
            light = _frame(source)
            if stock is not None:
                taken = _on_film(light, stock, extra, seed)
            else:
                taken = _taken(light, source, sensor, speed, ev=extra, seed=seed, wb=wb)
        else:
            taken = _shot(source, sensor, speed, wanted)
        exposed = hasattr(taken, "mosaic") or stock is not None
        wanted |= {"exposure": 0.0 if exposed else extra}
        picture: Picture | None = None
        for path in output:
            if path.suffix.lower() == ".dng":
                _save_dng(path, taken, source)
            else:
                picture = picture or _developed(taken, wanted)
                picture.save(path, quality=quality, bits=bits)
            console.note(f"wrote {path}")
    return 0


@contextmanager
def _named(source: Path) -> Iterator[None]:
    """Errors of a frame say from which file it is."""
    try:
        yield
    except InputError as error:
        if not str(error).startswith("frame: "):
            raise
        raise InputError(f"{source}: {str(error).removeprefix('frame: ')}") from None


def _check(source: Path, outputs: list[Path], sensor: str | None, quality: int) -> None:
    """Refuses wrong flags before anything is read."""
    from daguerre.files.atomic import check_writable
    from daguerre.files.formats import check_written, written

    if not 1 <= quality <= 100:
        raise UsageError(f"--quality: wanted 1 to 100, got {quality}")
    for path in outputs:
        check_written(path, (*written("picture"), ".dng"))
        if path.exists() and source.exists() and path.samefile(source):
            raise UsageError(f"{path}: wanted another file than the one that is developed")
        check_writable(path)
        if path.suffix.lower() == ".dng" and source.suffix.lower() != ".exr":
            raise UsageError(f"{path}: {source} is a raw file already; wanted a picture of it")


def _check_stock(source: Path, outputs: list[Path], sensor: str | None, iso: str | None) -> None:
    """Film stands in the place of a sensor, and has a speed of its own."""
    for flag, value in (("--sensor", sensor), ("--iso", iso)):
        if value is not None:
            raise UsageError(f"--stock: wanted without {flag}: film has a speed of its own")
    if source.suffix.lower() != ".exr":
        raise UsageError(f"--stock: {source} was taken already; wanted a frame, .exr")
    for path in outputs:
        if path.suffix.lower() == ".dng":
            raise UsageError(f"{path}: film has no raw stage; wanted another format")


def _on_film(frame: Frame, stock: str, ev: float, seed: int) -> Frame:
    """The print of film that was exposed."""
    from daguerre.exposure.lux_seconds import frame_iso
    from daguerre.stocks import load

    own = float(frame.metadata.get("exposure_compensation") or 0.0)
    film = load(stock)
    if not ev:
        _tell_speed(film.iso, frame_iso(frame.metadata))
    return film.expose(frame, ev=own + ev, seed=seed).shown()


def _tell_speed(film: float, camera: float | None) -> None:
    """A camera that was set to another ISO than its film has exposed it wrongly."""
    stops = 0.0 if camera is None else math.log2(film / camera)
    if abs(stops) >= 0.5:
        console.note(
            f"the film is of ISO {film:g}, the camera was set to ISO {camera:g}: {abs(stops):.1f} "
            f"EV too {'much' if stops > 0 else 'little'} light; --ev {-stops:+.1f} makes up for it"
        )


def _frame(path: Path) -> Frame:
    from daguerre.io.exr.read import read_frame

    return read_frame(path)


def _taken(
    frame: Frame,
    path: Path,
    sensor: str | None,
    iso: float | None,
    *,
    ev: float,
    seed: int,
    wb: str,
) -> Raw | Frame:
    """Exposes the sensor to the frame; without a sensor returns the frame itself."""
    from daguerre.development.white import numbers_of
    from daguerre.exposure.lux_seconds import luminance_exposure

    luminance_exposure(frame.metadata)  # complains of what is missing, before all else
    if sensor is None and frame.metadata.get("sensor") is None:
        if iso is not None:
            if iso <= 0:
                raise UsageError(f"--iso: wanted above 0, got {iso:g}")
            frame.metadata["isoSpeed"] = iso
        return frame
    own = float(frame.metadata.get("exposure_compensation") or 0.0)
    white = None if wb in ("as-shot", "auto") else numbers_of(wb)
    raw = frame.expose(sensor, iso, seed=seed, ev=own + ev, white_balance=white)
    for remark in raw.notes:
        console.note(remark)
    return raw


def _shot(path: Path, sensor: str | None, iso: float | None, wanted: dict[str, Any]) -> Channels:
    for flag, value in (("--sensor", sensor), ("--iso", iso)):
        if value is not None:
            raise UsageError(f"{flag}: {path} was taken with a sensor and ISO of its own")
    from daguerre.development.camera_raw import read_shot
    from daguerre.development.channels import Demosaic

    passes, clip = wanted["colour_noise"], wanted["highlights"] == "clip"
    if not 0 <= passes <= 20:
        raise UsageError(f"--colour-noise: wanted 0 to 20, got {passes}")
    return read_shot(path, Demosaic(wanted["demosaic"], passes, clip))


def _save_dng(path: Path, taken: Any, source: Path) -> None:
    if not hasattr(taken, "mosaic"):
        raise UsageError(
            f"{path}: {source} has no raw stage: wanted --sensor NAME, which takes the picture"
        )
    from daguerre.development.dng import size_note

    taken.save(path)
    if remark := size_note(taken):
        console.note(f"{path}: {remark}")


def _developed(taken: Any, wanted: dict[str, Any]) -> Picture:
    from daguerre.development import develop as make

    return make(taken, **wanted)
