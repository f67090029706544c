"""Writes raw pictures as DNG.

Tags and their numbers: Adobe, Digital Negative Specification 1.7.1, chapter 4. The first directory
has a small preview and tags of the whole photograph. Its child has the values of the photosites,
16 bits each, unchanged.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.color import illuminants
from daguerre.pictures import exif
from daguerre.pictures.exif import Tags
from daguerre.pictures.tiff import CFA, LINEAR_RAW, TiffImage, write_tiff
from daguerre.sensors.iso_speed import white_lx_s

from .binning import is_mono

if TYPE_CHECKING:
    from daguerre.frame.raw import Raw

MAKE = "Daguerre"
#: Smallest picture that LibRaw opens, px each way.
LEAST_OPENED = 22
#: Numbers of EXIF's light sources, in DNG's order: incandescent first.
_LAMP_A, _LAMP_D65 = 17, 21


def size_note(raw: Raw) -> str | None:
    """Returns a note if a picture is too small for LibRaw and programs that use it; else None.

    LibRaw opens no picture below 22 px, and its methods for X-Trans work in tiles of 512 px.
    """
    xtrans = raw.sensor.pattern.name == "xtrans"
    least = LEAST_XTRANS if xtrans else LEAST_OPENED
    height, width = raw.mosaic.shape
    if min(height, width) >= least:
        return None
    what = "develops X-Trans" if xtrans else "opens DNG"
    limit = f"LibRaw {what} from {least} x {least} px"
    return f"{limit}, the picture has {width} x {height}: other programs may fail to open it"


def put_dng(target: Path | IO[bytes], raw: Raw, preview: NDArray[np.uint8] | None = None) -> None:
    """Writes a raw picture into an existing file or a stream.

    Args:
        target: File or stream.
        raw: Raw picture with a pattern that DNG supports.
        preview: Small developed picture, shape (h, w, 3); None: no preview.
    """
    facts = shot_facts(raw)
    about = exif.main_tags(facts | body_facts(raw)) | photograph_tags(raw)
    mosaic = mosaic_tags(raw)
    photometric = LINEAR_RAW if is_mono(raw) else CFA
    exposure = exif.exposure_tags(facts)
    if preview is None:
        write_tiff(target, [TiffImage(raw.mosaic, photometric, about | mosaic)], exposure)
        return
    small = TiffImage(preview, "rgb", about, reduced=True)
    write_tiff(target, [small, TiffImage(raw.mosaic, photometric, mosaic)], exposure)


def shot_facts(raw: Raw) -> dict[str, Any]:
    """EXIF metadata of a raw picture: the frame's metadata, the sensor as body, and the ISO."""
    sensor = raw.sensor
    body = {"cameraMake": sensor.make, "cameraModel": sensor.model}
    return (
        body
        | {key: value for key, value in raw.metadata.items() if value is not None}
        | {"isoSpeed": raw.iso}
    )


def body_facts(raw: Raw) -> dict[str, str]:
    """Make and model for a DNG, which differ from the real camera's.

    With the real names, raw converters would apply their profile and crop of the real camera.
    """
    body = f"{raw.sensor.make} {raw.sensor.model}".strip()
    return {"cameraMake": MAKE, "cameraModel": body.removeprefix(f"{MAKE} ")}


def photograph_tags(raw: Raw) -> Tags:
    """Tags for colours and brightness: matrices for lamp light and daylight, neutral, exposure."""
    sensor = raw.sensor
    tags: Tags = {
        50706: (exif.BYTE, (1, 4, 0, 0)),
        50707: (exif.BYTE, (1, 3, 0, 0)),
        50708: (exif.ASCII, " ".join(body_facts(raw).values())),
        50730: (exif.SRATIONAL, exif.rational(baseline_exposure(raw))),
        50734: (exif.RATIONAL, (1, 1)),
        50735: (exif.ASCII, str(sensor.serial)),
    }
    if is_mono(raw):
        return tags
    lamp = sensor.colour_matrix(illuminants.A_KELVIN)
    tags[50721] = (exif.SRATIONAL, _matrix(lamp))
    tags[50722] = (exif.SRATIONAL, _matrix(sensor.colour_matrix()))
    tags[50778], tags[50779] = (exif.SHORT, (_LAMP_A,)), (exif.SHORT, (_LAMP_D65,))
    tags[50728] = (exif.RATIONAL, _rationals(raw.neutral))
    return tags


def mosaic_tags(raw: Raw) -> Tags:
    """Tags for the pattern of the mosaic, and its black and white levels."""
    height, width = raw.mosaic.shape
    tags: Tags = {
        50713: (exif.SHORT, (1, 1)),
        50714: (exif.LONG, (raw.black_level,)),
        50717: (exif.LONG, (raw.white_level,)),
        50719: (exif.LONG, (0, 0)),
        50720: (exif.LONG, (width, height)),
        50829: (exif.LONG, (0, 0, height, width)),
        51041: (exif.DOUBLE, noise_profile(raw)),
    }
    if not is_mono(raw):  # R, G, B are 0, 1, 2 of CFAPattern (ISO 12234-2) as of our channels
        cells = raw.sensor.pattern.cells
        tags[33421] = (exif.SHORT, cells.shape)
        tags[33422] = (exif.BYTE, tuple(int(cell) for cell in cells.ravel()))
        tags[50710], tags[50711] = (exif.BYTE, (0, 1, 2)), (exif.SHORT, (1,))
    return tags


def value_dn(raw: Raw) -> float:
    """DN above black for a developed value of 1 in the strongest channel, D65."""
    return raw.gain * float(raw.sensor.white_electrons().max()) * white_lx_s(raw.iso)


def baseline_exposure(raw: Raw) -> float:
    """Exposure compensation, EV, with which readers of the file show middle grey as 0.18.

    Readers take the white level as 1; ISO 12232 keeps half a stop above white.
    """
    return math.log2((raw.white_level - raw.black_level) / value_dn(raw))


def noise_profile(raw: Raw) -> tuple[float, float]:
    """Variance of values between black (0) and white (1): slope, and variance at black."""
    span = raw.white_level - raw.black_level
    read = raw.gain * raw.sensor.read_noise_at(raw.iso)
    return raw.gain / span, (read**2 + 1 / 12) / span**2


def _matrix(values: NDArray[np.float64]) -> tuple[int, ...]:
    """Rationals rounded to 1/10000, as cameras write them."""
    return tuple(part for value in values.ravel() for part in (round(float(value) * 10000), 10000))


def _rationals(values: NDArray[np.float64]) -> tuple[int, ...]:
    return tuple(part for value in values for part in (round(float(value) * 10**6), 10**6))


#: Smallest pictures that LibRaw demosaics, px each way.
_LEAST, LEAST_XTRANS = 32, 516
