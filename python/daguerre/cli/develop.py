"""``daguerre develop``: photographs from frames and raw files."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from daguerre.camera.parameters import typed
from daguerre.development.parameters import DEVELOP, FILE, SENSOR
from daguerre.errors import InputError, UsageError
from daguerre.parameters.parameter import Parameter
from daguerre.parameters.table import Table

from . import console
from .develop_mode import in_mode
from .flags.from_table import TableFlags, made_of
from .flags.groups import option, with_flags

if TYPE_CHECKING:
    from daguerre.development import Picture
    from daguerre.development.channels import Channels
    from daguerre.frame.frame import Frame
    from daguerre.frame.raw import Raw

# fmt: off
_SENSOR = Table(
    Parameter(
        "sensor", "Sensor that takes the picture, with its noise", kind="text",
        flags=("--sensor",), metavar="SENSOR", default_words="a perfect sensor",
    ),
    Parameter(
        "stock", "Film stock to expose and print, instead of a sensor; see `daguerre stocks`",
        kind="text", flags=("--stock",), metavar="STOCK",
    ),
    Parameter(
        "iso", "ISO of the sensor", flags=("--iso",), metavar="N",
        parse=typed.number("a number such as 400"),
        default_words="the frame's, else 100",
    ),
)
_FILE = Table(
    Parameter(
        "quality", "JPEG quality, 1 to 100", default=95, kind="whole", low=1, high=100,
        wants="1 to 100", flags=("--quality",), metavar="N", tells_default=True,
    ),
    Parameter(
        "bits", "Bits per channel of a .png or .tif", kind="whole",
        flags=("--bits",), metavar="8|16", default_words=".png: 8, .tif: 16",
    ),
)
# fmt: on


@made_of(_SENSOR, panel=SENSOR)
class SensorFlags(TableFlags):
    """Flags of sensor or film that takes the picture."""


@made_of(DEVELOP)
class RecipeFlags(TableFlags):
    """Flags of development."""


@made_of(_FILE, panel=FILE)
class FileFlags(TableFlags):
    """Flags of the output file."""


@with_flags(taker=SensorFlags, recipe=RecipeFlags, file=FileFlags)
def develop(
    source: Annotated[
        Path, typer.Argument(metavar="IN.exr|IN.dng", help="Frame, or raw file of a camera.")
    ],
    output: Annotated[
        list[Path],
        option(
            "-o", "--output", metavar="OUT.jpg|png|tif|exr|dng", help="Photo to write; repeatable."
        ),
    ],
    taker: SensorFlags,
    recipe: RecipeFlags,
    file: FileFlags,
    quiet: Annotated[bool, option("--quiet", "-q", help="Print errors only.")] = False,
) -> int:
    """Develops a frame or a raw file into photographs."""
    console.quiet = quiet
    wanted, used, saved = recipe.given(), taker.given(), file.given()
    _FILE["quality"].check(saved.get("quality"), "--quality")
    _check(source, output)
    from daguerre.pictures.picture_files import check_space

    for path in output if "colour_space" in wanted else ():
        if path.suffix.lower() != ".dng":
            check_space(path, wanted["colour_space"])
    if used.get("stock") is not None:
        _check_stock(source, output, used)
    with _named(source):
        taken: Raw | Frame | Channels
        notes: list[str] = []
        if source.suffix.lower() != ".exr":
            taken = _shot(source, used, wanted)
        else:
            frame, notes = in_mode(_frame(source), source, used, wanted)
            notes += frame.metadata.get("notes", [])
            taken = _taken(frame, used, wanted)
        picture: Picture | None = None
        for path in output:
            if path.suffix.lower() == ".dng":
                _save_dng(path, taken, source)
            else:
                picture = picture or _developed(taken, wanted)
                picture.save(path, **saved)
            while notes:  # of a picture that succeeds
                console.note(notes.pop(0))
            console.note(f"wrote {path}")
    return 0


@contextmanager
def _named(source: Path) -> Iterator[None]:
    """Context in which errors of a frame name its file."""
    try:
        yield
    except InputError as error:
        if not str(error).startswith("frame: "):
            raise
        raise InputError(f"{source}: {str(error).removeprefix('frame: ')}") from None


def _check(source: Path, outputs: list[Path]) -> None:
    """Refuses wrong flags before anything is read."""
    from daguerre.files.atomic import check_writable
    from daguerre.files.formats import check_written, written

    _check_source(source)
    for path in outputs:
        check_written(path, (*written("picture"), ".dng"))
        check_writable(path)
        if path.suffix.lower() == ".dng" and source.suffix.lower() != ".exr":
            raise UsageError(
                f"-o {path}: {source} is a raw file already; write a picture, such as "
                f"{path.stem}.png"
            )


def _check_source(source: Path) -> None:
    """Refuses files that are no frame and no raw file, as far as their suffix says so."""
    from daguerre.files.formats import formats
    from daguerre.files.reading import size_of

    size_of(source)
    suffix = source.suffix.lower()
    takes = "develop reads .exr frames of `render` and camera raw files"
    if suffix in (".png", ".jpg", ".jpeg", ".webp"):  # a raw file may end in .tif
        raise InputError(f"{source} is already developed: {takes}")
    if any(suffix in row.suffixes for row in formats("scene")):
        raise InputError(f"{source} is a scene: {takes}; render it first")


def _check_stock(source: Path, outputs: list[Path], used: dict[str, Any]) -> None:
    """Checks flags with ``--stock``: film replaces a sensor and has its own speed."""
    for name in ("sensor", "iso"):
        if name in used:
            raise UsageError(f"--stock and --{name}: wanted one of them, got both")
    if source.suffix.lower() != ".exr":
        raise UsageError(
            f"--stock needs a frame of `render` (.exr); {source} is a finished exposure"
        )
    for path in outputs:
        if path.suffix.lower() == ".dng":
            raise UsageError(
                f"-o {path}: film has no raw data; write a picture, such as {path.stem}.png"
            )


def _on_film(frame: Frame, stock: str, seed: int) -> Frame:
    """Exposes film and prints it."""
    from daguerre.exposure.lux_seconds import frame_iso, in_light
    from daguerre.stocks import load

    film = load(stock)
    if not in_light(frame.metadata) and not frame.metadata.get("exposure_compensation"):
        _tell_speed(film.iso, frame_iso(frame.metadata))
    return film.expose(frame, seed=seed).shown()


def _tell_speed(film: float, camera: float | None) -> None:
    """Notes that the camera was set to another ISO than its film, if so."""
    stops = 0.0 if camera is None else math.log2(film / camera)
    if abs(stops) >= 0.5:
        console.note(
            f"the film is ISO {film:g}, but the camera was set to ISO {camera:g}: the picture "
            f"is {abs(stops):.1f} EV {'over' if stops > 0 else 'under'}exposed; --ev "
            f"{-stops:+.1f} compensates"
        )


def _frame(path: Path) -> Frame:
    from daguerre.pictures.exr.read import load_frame

    return load_frame(path)


def _taken(frame: Frame, used: dict[str, Any], wanted: dict[str, Any]) -> Raw | Frame:
    """Exposes the sensor or film to the frame; without one returns the frame itself."""
    from daguerre.development.white import numbers_of

    sensor, iso, seed = used.get("sensor"), used.get("iso"), wanted.get("seed", 0)
    if (stock := used.get("stock")) is not None:
        return _on_film(frame, stock, seed)
    if sensor is None and frame.metadata.get("sensor") is None:
        if iso is not None:
            if iso <= 0:
                raise UsageError(f"--iso: wanted a number above 0, got {iso:g}")
            frame.metadata["isoSpeed"] = iso
        return frame
    wb = wanted.get("wb", "as-shot")
    white = None if wb in ("as-shot", "auto") else numbers_of(wb)
    raw = frame.expose(sensor, iso, seed=seed, white_balance=white)
    for remark in raw.notes:
        console.note(remark)
    return raw


def _shot(path: Path, used: dict[str, Any], wanted: dict[str, Any]) -> Channels:
    for name in (*used, *(name for name in ("exposure", "meter") if name in wanted)):
        raise UsageError(
            f"--{name} applies to frames of `render` (.exr): {path} has its own sensor and ISO"
        )
    from daguerre.development.camera_raw import read_shot
    from daguerre.development.recipe import Recipe

    passes = wanted.get("colour_noise", 0)
    if not 0 <= passes <= 20:
        raise UsageError(f"--colour-noise: wanted 0 to 20, got {passes}")
    return read_shot(path, Recipe.of(**wanted).demosaicing)


def _save_dng(path: Path, taken: Any, source: Path) -> None:
    if not hasattr(taken, "mosaic"):
        raise UsageError(f"-o {path}: {source} has no raw data; add --sensor NAME to make them")
    from daguerre.development.dng import size_note

    taken.save(path)
    if remark := size_note(taken):
        console.note(f"{path}: {remark}")


def _developed(taken: Any, wanted: dict[str, Any]) -> Picture:
    from daguerre.development import develop as make

    return make(taken, **wanted)
