"""A sensor: how many electrons light makes in each photosite, and what number is read of them."""

from __future__ import annotations

import dataclasses
import hashlib
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.checks import number
from daguerre.color import illuminants
from daguerre.doors import guarded
from daguerre.errors import UsageError

from . import fit
from .checking import check
from .mosaic import Mosaic
from .response import Response

FloatArray = NDArray[np.float64]
#: ISO 12232: the luminance exposure that just saturates is 78 / S lux s, half a stop above that of
#: a white surface; that of middle grey of a developed picture is 10 / S.
SATURATION_LX_S, GREY_LX_S = 78.0, 10.0


@guarded(init=True)
@dataclass(frozen=True, eq=False)
class Sensor(Response):
    """An image sensor, with the numbers of its maker or of a laboratory.

    Attributes:
        name: Name by which it is loaded.
        make: Make of the camera or sensor.
        model: Model of the camera or sensor.
        source: Source of the numbers.
        licence: Licence of the numbers.
        pixel_pitch: Pixel pitch, um.
        resolution: Photosites, columns and rows.
        pattern: The colour filter array.
        channels: Names, ``("R", "G", "B")`` or ``("Y",)``.
        wavelengths: Wavelengths of the quantum efficiency, nm, shape (L,); 0 beyond its ends.
        quantum_efficiency: Electrons per photon that falls on the photosite's area (its fill
            factor times that area, if one is stated), shape (C, L).
        full_well: Electrons that a photosite holds, e-.
        bit_depth: Bits of the digital numbers.
        base_iso: Lowest ISO that the maker recommends.
        iso_range: Lowest and highest ISO that can be set.
        size: Width and height of the light-sensitive area, mm; default: resolution times pitch.
        fill_factor: Share of a photosite's area that the quantum efficiency is about.
        infrared_cut: Transmittance of the filter before the sensor; None: none, or in the quantum
            efficiency already.
        cover_glass: Transmittance of the cover glass, likewise.
        read_noise: (ISO, e-) in rising order, linear in log ISO in between.
        dual_gain: The second conversion gain, if there is one.
        dark_current: Dark current by temperature.
        prnu: Standard deviation of the photosites' response, relative.
        dsnu: Standard deviation of the photosites' offsets, e-.
        hot_pixels: Photosites with much dark current.
        black_level: DN of no light.
        crosstalk: Share of the electrons that go to the four neighbours.
        low_pass: Distance of the two images that the optical low-pass filter makes of each point
            along either axis, um; 0: there is none.
        serial: Serial number; it seeds PRNU, DSNU and hot pixels.
        assumed: Names of the values without a source.
        note: A remark.
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

    def with_(self, **changes: Any) -> Sensor:
        """Returns a copy with other values, such as ``serial`` or ``infrared_cut=None``.

        ``pattern`` may be a name; ``read_noise`` one number for every ISO.

        Raises:
            UsageError: There is no such value.
            InputError: A value that no sensor has.
        """
        known = [field.name for field in dataclasses.fields(self)]
        for name in changes:
            if name not in known:
                raise UsageError(f"sensor: no {name!r}; there are {', '.join(known)}")
        if isinstance(changes.get("pattern"), str):
            channels = changes.get("channels", self.channels)
            changes["pattern"] = Mosaic.of(changes["pattern"], channels, self.where)
        if "read_noise" in changes and np.ndim(changes["read_noise"]) == 0:
            changes["read_noise"] = ((self.base_iso, changes["read_noise"]),)
        if {"resolution", "pixel_pitch"} & set(changes) and "size" not in changes:
            changes["size"] = (0.0, 0.0)
        return dataclasses.replace(self, **changes)

    def sensitivity(self, nm: ArrayLike) -> FloatArray:
        """Weights by which a frame's channels sum light: efficiency times wavelength, shape (C, L).

        Scaled so that the integral (nm) with D65 of Y = 1, ``illuminants.d65()``, is 1.
        """
        at = np.asarray(nm, np.float64)
        fine = illuminants.NM
        rows = self.efficiency(fine) * fine * illuminants.d65()
        totals = np.array([illuminants.integral(row) for row in rows])
        return np.asarray(self.efficiency(at) * at / totals[:, None])

    def band_weights(self, count: int) -> FloatArray:
        """Channels of a frame from its ``bands``, shape (count, C): ``daguerre.color.spectra``."""
        from .bands import weights_of_bands

        return weights_of_bands(self, count)

    @property
    def hash(self) -> str:
        """Hash of all that a frame's channels depend on: sensors with one hash see the same."""
        digest = hashlib.sha256(" ".join(self.channels).encode())
        curves = self.sensitivity(illuminants.NM)
        digest.update(np.round(curves, 9).tobytes())
        return digest.hexdigest()[:16]

    # Electrons to numbers -------------------------------------------------------------------

    @property
    def highest_dn(self) -> int:
        """Highest number of the analogue-digital converter, DN."""
        return int(2**self.bit_depth - 1)

    @property
    def saturation_iso(self) -> float:
        """ISO 12232's speed by saturation: D65 of 78 / S lux s just fills a photosite."""
        return float(SATURATION_LX_S * self.white_electrons().max() / self.full_well)

    def gain(self, iso: float) -> float:
        """DN per electron: D65 of 78 / ISO lux s reaches the highest number."""
        self.check_iso(iso)
        electrons = SATURATION_LX_S / iso * float(self.white_electrons().max())
        return (self.highest_dn - self.black_level) / electrons

    def full_well_at(self, iso: float) -> float:
        """Full well of a photosite at an ISO, e-."""
        if self.dual_gain is not None and iso >= self.dual_gain.iso:
            return self.dual_gain.full_well
        return self.full_well

    def white_level(self, iso: float) -> int:
        """Number of a full photosite, DN: the limit of the converter or of the full well."""
        full = self.black_level + self.gain(iso) * self.full_well_at(iso)
        return int(min(self.highest_dn, math.floor(full + 0.5)))

    def read_noise_at(self, iso: float) -> float:
        """Standard deviation of the noise that reading adds, e-."""
        number(iso, "sensor: iso", above=0)
        rows = self.read_noise
        if self.dual_gain is not None:
            high = iso >= self.dual_gain.iso
            rows = tuple(row for row in rows if (row[0] >= self.dual_gain.iso) == high) or rows
        isos, noises = zip(*rows, strict=True)
        return float(np.interp(math.log2(iso), np.log2(isos), noises))

    def dynamic_range(self, iso: float) -> float:
        """Stops between saturation and a signal as strong as the noise in the dark."""
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
        """Matrix from XYZ to a frame's channels, (C, 3), fitted; D65 is exact. See ``fit``."""
        return fit.channels_from_xyz(self)

    def colour_matrix(self, white: Any = None) -> FloatArray:
        """ColorMatrix of DNG: raw values from XYZ under a white, shape (C, 3).

        Scaled so that the strongest channel of D65 white is 1; crosstalk is in it.

        Args:
            white: D65 (None), or K or (x, y) as in ``illuminants.white_xy``. Fitted for D65 and for
                illuminant A; between them by reciprocal colour temperature, as DNG does.
        """
        return fit.colour_matrix(self, illuminants.white_xy(white))

    def neutral(self, white: Any = None) -> FloatArray:
        """Raw values of a white surface in a light, its strongest channel 1, shape (C,)."""
        xy = illuminants.white_xy(white)
        raw = fit.colour_matrix(self, xy) @ illuminants.xyz_of_xy(xy)
        return np.asarray(raw / raw.max())

    def rgb_from_channels(self, white: Any = None) -> FloatArray:
        """Matrix from channels to linear Rec.709, (3, C), balanced: white is (1, 1, 1)."""
        return fit.rgb_from_channels(self, illuminants.white_xy(white))
