"""Converts a frame, raw mosaic or camera file to linear three-channel data.

LibRaw demosaics, through rawpy, from a DNG in memory: adaptive homogeneity (Hirakawa and Parks
2005) for Bayer mosaics, Markesteijn's method for X-Trans. Figures are in ``docs/developing.md``.
"""

from __future__ import annotations

import dataclasses
import io
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import plain_light
from daguerre.color import illuminants
from daguerre.errors import UsageError, suggest
from daguerre.files import extras
from daguerre.files.value import BriefRecord
from daguerre.sensors.iso_speed import white_lx_s

from .binning import bayer_of, is_mono
from .dng import _LEAST, LEAST_XTRANS

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame
    from daguerre.frame.raw import Raw

FloatArray = NDArray[np.float64]
XY = tuple[float, float]
_TOP = 65535.0
#: Cells of X-Trans have 6 px.
MARGIN_XTRANS = 6
#: Methods for each pattern, by LibRaw's names.
_BAYER_METHODS = {"best": "DHT", "good": "AHD", "fast": "LINEAR"}
#: LibRaw runs Markesteijn's method in one pass for "PPG", in three for better methods.
_XTRANS_METHODS = {"best": "DHT", "good": "PPG", "fast": "LINEAR"}
DEMOSAICS = ("best", "good", "fast", "linear", "vng", "ppg", "ahd", "dcb", "dht")


def check_method(name: str) -> None:
    """Checks the name of a demosaicing method.

    Raises:
        UsageError: It is unknown; the message suggests the nearest.
    """
    if str(name) not in DEMOSAICS:
        raise UsageError(
            f"develop: demosaic: wanted one of {', '.join(DEMOSAICS)}, got {name!r}"
            f"{suggest(name, DEMOSAICS)}"
        )


@dataclass(frozen=True)
class Demosaic:
    """Options of demosaicing by LibRaw.

    Attributes:
        method: One of ``DEMOSAICS``.
        colour_noise: Passes of a median filter over colour differences.
        clip: Whether all channels are clipped at the lowest saturation before interpolation.
            Otherwise nothing is lost, but edges of highlights get false colours.
    """

    method: str = "good"
    colour_noise: int = 0
    clip: bool = False

    def scale(self, balance: FloatArray, span: float) -> FloatArray:
        """LibRaw's values per DN above black; ``span``: DN from black to white."""
        one = balance.min() if self.clip else balance.max()
        return np.asarray(_TOP / span * balance / one)

    def run(self, opened: Any, balance: FloatArray, xtrans: bool, turn: bool) -> NDArray[np.uint16]:
        """Demosaics; returns values (H, W, 3), balanced, linear, in the camera's colours.

        Args:
            opened: File opened by rawpy.
            balance: Factors of the channels.
            xtrans: Whether the mosaic is X-Trans.
            turn: Whether to turn the picture upright, as in the file's metadata.
        """
        import rawpy

        mode = rawpy.HighlightMode
        pixels = opened.postprocess(
            demosaic_algorithm=self._algorithm(xtrans),
            user_wb=[*balance, balance[1]],
            output_color=rawpy.ColorSpace.raw,
            output_bps=16,
            gamma=(1, 1),
            no_auto_bright=True,
            adjust_maximum_thr=0.0,
            highlight_mode=mode.Clip if self.clip else mode.Ignore,
            user_flip=None if turn else 0,
            median_filter_passes=self.colour_noise,
        )
        return np.asarray(pixels)

    def _algorithm(self, xtrans: bool) -> Any:
        import rawpy

        check_method(self.method)
        chosen = _XTRANS_METHODS if xtrans else _BAYER_METHODS
        return rawpy.DemosaicAlgorithm[chosen.get(self.method, self.method.upper())]


USUAL = Demosaic()


@dataclass(frozen=True, repr=False)
class Channels(BriefRecord):
    """Light in three channels, for development.

    Attributes:
        pixels: Values above black, uint16 or float32, shape (H, W, 3).
        unit: Value of each channel for developed white (1), shape (3,).
        full: Saturation of each channel, shape (3,); infinite: never.
        xyz_from: Function that returns the matrix from values to XYZ for a white (x, y), (3, 3).
        as_shot: White balance as shot.
        metadata: Metadata of the shot.
    """

    pixels: NDArray[Any]
    unit: FloatArray
    full: FloatArray
    xyz_from: Callable[[XY], FloatArray]
    as_shot: XY
    metadata: Mapping[str, Any]


def of_frame(frame: Frame) -> Channels:
    """Makes channels from a frame's XYZ, as from a perfect sensor, in its exposure mode."""
    from daguerre.exposure.lux_seconds import compensation, exposure_of_one, frame_iso

    facts = frame.metadata
    iso = frame_iso(facts) or 100.0
    unit = white_lx_s(iso) / (exposure_of_one(facts, iso) * compensation(facts))
    pixels = np.ascontiguousarray(_xyz(frame), np.float32)
    plain_light(pixels, "frame", infinite=True)  # infinite light is white
    return Channels(
        pixels=pixels,
        unit=np.full(3, unit),
        full=np.full(3, np.inf),
        xyz_from=lambda white: np.eye(3),
        as_shot=illuminants.white_xy(facts.get("white_balance")),
        metadata={**facts, "isoSpeed": iso},
    )


def _xyz(frame: Frame) -> NDArray[np.float32]:
    if frame.xyz is not None:
        return frame.xyz
    from daguerre.color.spectra import rgb_from_xyz

    matrix = np.linalg.inv(rgb_from_xyz()).T.astype(np.float32)
    with np.errstate(invalid="ignore"):  # infinite light
        return np.asarray(frame.rgb @ matrix, np.float32)


def of_raw(raw: Raw, demosaic: Demosaic = USUAL) -> Channels:
    """Makes channels from a raw picture, by demosaicing."""
    raw = bayer_of(raw)
    if is_mono(raw):
        return _of_pixels(raw, _grey(raw), np.ones(3))
    pixels, scale = _demosaiced(raw, demosaic)
    return _of_pixels(raw, pixels, scale)


def of_cells(raw: Raw, means: NDArray[np.float32]) -> Channels:
    """Makes channels from means of DN above black in cells of the pattern, shape (h, w, C)."""
    return _of_pixels(
        raw, np.ascontiguousarray(np.broadcast_to(means, (*means.shape[:2], 3))), np.ones(3)
    )


def _of_pixels(raw: Raw, pixels: NDArray[Any], scale: FloatArray) -> Channels:
    """Makes channels from DN above black times ``scale``."""
    from .dng import shot_facts, value_dn

    return Channels(
        pixels=pixels,
        unit=value_dn(raw) * scale,
        full=np.minimum((raw.white_level - raw.black_level) * scale, _TOP),
        xyz_from=_grey_matrix if is_mono(raw) else _inverse_matrix(raw),
        as_shot=raw.white_balance,
        metadata=shot_facts(raw),
    )


def _inverse_matrix(raw: Raw) -> Callable[[XY], FloatArray]:
    return lambda white: np.asarray(np.linalg.inv(raw.sensor.colour_matrix(white)), np.float64)


def _grey_matrix(white: XY) -> FloatArray:
    """Matrix of a monochrome mosaic, from the white's XYZ."""
    return np.asarray(np.diag(illuminants.xyz_of_xy(white)))


def _grey(raw: Raw) -> NDArray[np.uint16]:
    above = np.maximum(raw.mosaic, np.uint16(raw.black_level)) - np.uint16(raw.black_level)
    return np.repeat(above[:, :, None], 3, axis=2)


def _demosaiced(raw: Raw, demosaic: Demosaic) -> tuple[NDArray[np.uint16], FloatArray]:
    """Returns values (H, W, 3) and their scale to DN above black, by channel."""
    extras.need("rawpy", "develop: demosaic")
    import rawpy

    from .dng import put_dng

    file = io.BytesIO()
    xtrans = raw.sensor.pattern.name == "xtrans"
    put_dng(file, _with_margin(raw) if xtrans else _large_enough(raw))
    file.seek(0)
    balance = 1 / np.clip(raw.neutral, 0.05, 1)
    with rawpy.imread(file) as opened:
        pixels = demosaic.run(opened, balance, xtrans, turn=False)
    scale = demosaic.scale(balance, raw.white_level - raw.black_level)
    corner = MARGIN_XTRANS if xtrans else 0
    rows, columns = (slice(corner, corner + count) for count in raw.mosaic.shape)
    return np.ascontiguousarray(pixels[rows, columns]), scale


def _large_enough(raw: Raw) -> Raw:
    return raw if min(raw.mosaic.shape) >= _LEAST else _extended(raw, 0, _LEAST)


def _with_margin(raw: Raw) -> Raw:
    """Adds a margin, as LibRaw leaves holes at the border of X-Trans mosaics."""
    return _extended(raw, MARGIN_XTRANS, LEAST_XTRANS)


def _extended(raw: Raw, margin: int, least: int) -> Raw:
    """Adds a margin, and extends to at least ``least`` px each way, by repeating cells."""
    rows, columns = (
        _places(count, margin, least, period)
        for count, period in zip(raw.mosaic.shape, raw.sensor.pattern.cells.shape, strict=True)
    )
    return dataclasses.replace(raw, mosaic=raw.mosaic[np.ix_(rows, columns)], clipped=None)


def _places(count: int, margin: int, least: int, period: int) -> NDArray[np.intp]:
    """Indices 0 .. count - 1, padded by the nearest indices at the same place in the pattern."""
    at = np.arange(-margin, max(count + margin, least - margin))
    last = count - 1 - (count - 1 - at) % period
    inside = np.where(at < 0, at % period, np.where(at < count, at, last))
    return np.clip(inside, 0, count - 1)
