"""Sensor: conversion of light to electrons, and of electrons to digital numbers."""

from __future__ import annotations

import dataclasses
import hashlib
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.argument_checks import guarded
from daguerre.checks import number
from daguerre.color import illuminants
from daguerre.errors import UsageError

from . import fit
from .checking import check
from .iso_speed import SATURATION_LX_S
from .mosaic import Mosaic
from .response import Response

FloatArray = NDArray[np.float64]


@guarded(init=True)
@dataclass(frozen=True, eq=False)
class Sensor(Response):
    """An image sensor, with values from its maker or from measurements.

    Attributes:
        name: Name by which it is loaded.
        make: Make of the camera or sensor.
        model: Model of the camera or sensor.
        source: Source of the values.
        licence: Licence of the values.
        pixel_pitch: Pixel pitch, um.
        resolution: Number of photosites, columns and rows.
        pattern: Colour filter array.
        channels: Names of the channels, ``("R", "G", "B")`` or ``("Y",)``.
        wavelengths: Wavelengths of the quantum efficiency, nm, shape (L,); beyond them it is 0.
        quantum_efficiency: Electrons per photon on the photosite's area (times the fill factor, if
            one is stated), shape (C, L).
        full_well: Full-well capacity of a photosite, e-.
        bit_depth: Bits of the digital numbers (DN).
        base_iso: Lowest ISO that the maker recommends.
        iso_range: Lowest and highest ISO that can be set.
        size: Width and height of the light-sensitive area, mm; default: resolution times pitch.
        fill_factor: Share of a photosite's area to which the quantum efficiency applies.
        infrared_cut: Transmittance of the infrared-cut filter; None: no filter, or included in the
            quantum efficiency.
        cover_glass: Transmittance of the cover glass; None: no glass, or included in the quantum
            efficiency.
        read_noise: Read noise as (ISO, e-), ascending by ISO, interpolated linearly in log ISO.
        dual_gain: Second conversion gain; None: there is none.
        dark_current: Dark current by temperature.
        prnu: Photo response non-uniformity: relative standard deviation of the response.
        dsnu: Dark signal non-uniformity: standard deviation of the offsets, e-.
        hot_pixels: Photosites with a high dark current.
        black_level: DN without light.
        crosstalk: Share of the electrons that go to the four neighbours.
        low_pass: Separation of the two images that the optical low-pass filter makes along each
            axis, um; 0: no filter.
        serial: Serial number, which seeds PRNU, DSNU and hot pixels.
        assumed: Names of the values without a source.
        note: Remark.
        measured: Names of the values that a source gives; a remark may follow after a colon.
        fitted: Names of the values that were changed to agree with another measurement, and how.
    """

    def __post_init__(self) -> None:
        if self.size == (0.0, 0.0):
            columns, rows = self.resolution
            pitch_mm = self.pixel_pitch / 1000
            object.__setattr__(self, "size", (columns * pitch_mm, rows * pitch_mm))
        check(self)

    def __repr__(self) -> str:
        columns, rows = self.resolution
        return f"<Sensor {self.name}: {columns}x{rows}, {self.pattern.name}>"

    def with_(self, **changes: object) -> Sensor:
        """Returns a copy with other values, such as ``serial`` or ``infrared_cut=None``.

        ``pattern`` may be a name, ``read_noise`` one number for all ISO values.

        Raises:
            UsageError: Unknown name of a value.
            InputError: A value is out of range.
        """
        known = [field.name for field in dataclasses.fields(self)]
        for name in changes:
            if name not in known:
                raise UsageError(f"sensor: wanted one of {', '.join(known)}; got {name!r}")
        given: dict[str, Any] = changes
        if isinstance(given.get("pattern"), str):
            channels = given.get("channels", self.channels)
            given["pattern"] = Mosaic.of(given["pattern"], channels, self.where)
        if "read_noise" in given and np.ndim(given["read_noise"]) == 0:
            given["read_noise"] = ((self.base_iso, given["read_noise"]),)
        if {"resolution", "pixel_pitch"} & set(given) and "size" not in given:
            given["size"] = (0.0, 0.0)
        return dataclasses.replace(self, **given)

    def sensitivity(self, nm: ArrayLike) -> FloatArray:
        """Returns the spectral weights of a frame's channels, shape (C, L).

        They are efficiency times wavelength, scaled so that the integral over nm with D65 of
        Y = 1, ``illuminants.d65()``, is 1.

        Args:
            nm: Wavelengths, nm, shape (L,).
        """
        at = np.asarray(nm, np.float64)
        fine = illuminants.NM
        rows = self.efficiency(fine) * fine * illuminants.d65()
        totals = np.array([illuminants.integral(row) for row in rows])
        return np.asarray(self.efficiency(at) * at / totals[:, None])

    def band_weights(self, count: int) -> FloatArray:
        """Returns the matrix from a frame's ``bands`` to channels, shape (count, C)."""
        from .bands import weights_of_bands

        return weights_of_bands(self, count)

    @property
    def hash(self) -> str:
        """Hash of all values on which a frame's channels depend; equal hashes, equal channels."""
        digest = hashlib.sha256(" ".join(self.channels).encode())
        curves = self.sensitivity(illuminants.NM)
        digest.update(np.round(curves, 9).tobytes())
        return digest.hexdigest()[:16]

    # Electrons to numbers -------------------------------------------------------------------

    @property
    def highest_dn(self) -> int:
        """Highest digital number of the analogue-digital converter, DN."""
        return int(2**self.bit_depth - 1)

    @property
    def saturation_iso(self) -> float:
        """Saturation-based speed S of ISO 12232: D65 of 78 / S lux s just fills a photosite."""
        return float(SATURATION_LX_S * self.white_electrons().max() / self.full_well)

    def gain(self, iso: float) -> float:
        """Returns the gain, DN/e-, with which D65 of 78 / ISO lux s reaches the highest DN."""
        self.check_iso(iso)
        electrons = SATURATION_LX_S / iso * float(self.white_electrons().max())
        return (self.highest_dn - self.black_level) / electrons

    def full_well_at(self, iso: float) -> float:
        """Returns the full well of a photosite at an ISO, e-."""
        if self.dual_gain is not None and iso >= self.dual_gain.iso:
            return self.dual_gain.full_well
        return self.full_well

    def white_level(self, iso: float) -> int:
        """Returns the DN at which a photosite saturates, by the converter or by the full well."""
        full = self.black_level + self.gain(iso) * self.full_well_at(iso)
        return int(min(self.highest_dn, math.floor(full + 0.5)))

    def read_noise_at(self, iso: float) -> float:
        """Returns the read noise at an ISO: its standard deviation, e-."""
        number(iso, "sensor: iso", above=0)
        rows = self.read_noise
        if self.dual_gain is not None:
            high = iso >= self.dual_gain.iso
            rows = tuple(row for row in rows if (row[0] >= self.dual_gain.iso) == high) or rows
        isos, noises = zip(*rows, strict=True)
        return float(np.interp(math.log2(iso), np.log2(isos), noises))

    def dynamic_range(self, iso: float) -> float:
        """Returns the dynamic range in stops, from signal equal to dark noise to saturation."""
        gain = self.gain(iso)
        most = (self.white_level(iso) - self.black_level) / gain
        dark = math.hypot(self.read_noise_at(iso), math.sqrt(1 / 12) / gain)
        return math.log2(most / dark)

    def check_iso(self, iso: float) -> None:
        """Raises ``UsageError`` for an ISO that cannot be set."""
        low, high = self.iso_range
        try:
            fits = not isinstance(iso, str | bool) and low <= float(iso) <= high
        except (TypeError, ValueError):
            fits = False
        if not fits:
            raise UsageError(f"{self.where}: iso: wanted {low:g} .. {high:g}, got {iso}")

    # Colour -----------------------------------------------------------------------------------

    def channels_from_xyz(self) -> FloatArray:
        """Returns the fitted matrix from XYZ to a frame's channels, (C, 3); exact for D65."""
        return fit.channels_from_xyz(self)

    def colour_matrix(self, white: object = None) -> FloatArray:
        """Returns DNG's ColorMatrix: the matrix from XYZ to raw values under a white, (C, 3).

        It is scaled so that the strongest channel of D65 white is 1, and includes crosstalk. The
        matrix is fitted for D65 and for illuminant A, and interpolated by reciprocal colour
        temperature, as in DNG.

        Args:
            white: Colour temperature, K, or chromaticity (x, y), as in ``illuminants.white_xy``;
                None: D65.
        """
        return fit.colour_matrix(self, illuminants.white_xy(white))

    def neutral(self, white: object = None) -> FloatArray:
        """Returns the raw values of a white surface in a light, strongest channel 1, shape (C,)."""
        xy = illuminants.white_xy(white)
        raw = fit.colour_matrix(self, xy) @ illuminants.xyz_of_xy(xy)
        return np.asarray(raw / raw.max())

    def rgb_from_channels(self, white: object = None) -> FloatArray:
        """Returns the matrix from channels to linear Rec.709, (3, C); white becomes (1, 1, 1)."""
        return fit.rgb_from_channels(self, illuminants.white_xy(white))
