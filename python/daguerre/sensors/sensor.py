"""A sensor: how many electrons light makes in each photosite, and what number is read of them."""

from __future__ import annotations

import dataclasses
import hashlib
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.color import illuminants
from daguerre.errors import UsageError
from daguerre.files.value import Value

from . import fit
from .checking import check
from .curve import Curve
from .mosaic import Mosaic

FloatArray = NDArray[np.float64]
#: ISO 12232: the luminance exposure that just saturates is 78 / S lux s, half a stop above that of
#: a white surface; that of middle grey of a developed picture is 10 / S.
SATURATION_LX_S, GREY_LX_S = 78.0, 10.0


@dataclass(frozen=True)
class DarkCurrent:
    """Electrons that heat makes in a photosite without light.

    Attributes:
        rate: e-/s at that temperature.
        temperature: deg C.
        doubling: Kelvin in which the rate doubles.
    """

    rate: float = 0.0
    temperature: float = 20.0
    doubling: float = 6.0

    def factor(self, temperature: float | None) -> float:
        """How much faster it is at a temperature (deg C; None: as stated)."""
        if temperature is None:
            return 1.0
        return float(2.0 ** ((temperature - self.temperature) / self.doubling))


@dataclass(frozen=True)
class HotPixels:
    """Photosites with much dark current.

    Attributes:
        share: Of all photosites.
        rate: Mean of theirs, e-/s at the temperature of the dark current; exponentially
            distributed.
    """

    share: float = 0.0
    rate: float = 0.0


@dataclass(frozen=True)
class DualGain:
    """The second, higher conversion gain of a photosite.

    Attributes:
        iso: From which on it is used; the table of read noise may step there.
        full_well: What the photosite holds then, e-.
    """

    iso: float
    full_well: float


@dataclass(frozen=True, eq=False)
class Sensor(Value):
    """A sensor, as its maker or a laboratory measured it.

    Attributes:
        name: By which it is loaded.
        make: Of the camera or sensor.
        model: Of the camera or sensor.
        source: Where the numbers come from.
        licence: Under which they may be passed on.
        pixel_pitch: um.
        resolution: Photosites, columns and rows.
        pattern: The colour filter array.
        channels: Names, ``("R", "G", "B")`` or ``("Y",)``.
        wavelengths: Of the quantum efficiency, nm, shape (L,); beyond its ends it is 0.
        quantum_efficiency: Electrons per photon that falls on the photosite's area (its fill
            factor times that area, if one is stated), shape (C, L).
        full_well: What a photosite holds, e-.
        bit_depth: Of the digital numbers.
        base_iso: The lowest that the maker recommends.
        iso_range: Lowest and highest that can be set.
        size: Of the light-sensitive area, mm; by default resolution times pitch.
        fill_factor: Share of a photosite's area that the quantum efficiency is about.
        infrared_cut: Transmittance of the filter before the sensor; None: none, or in the quantum
            efficiency already.
        cover_glass: Likewise.
        read_noise: (ISO, e-) in rising order, linear in log ISO in between.
        dual_gain: The second conversion gain, if there is one.
        dark_current: By heat.
        prnu: Standard deviation of the photosites' response, relative.
        dsnu: Standard deviation of the photosites' offsets, e-.
        hot_pixels: Photosites with much dark current.
        black_level: DN of no light.
        crosstalk: Share of the electrons that the four neighbours get.
        low_pass: Distance of the two images that the optical low-pass filter makes of each point
            along either axis, um; 0: there is none.
        serial: Number of the copy; PRNU, DSNU and hot pixels are fixed by it.
        assumed: Names of the values that no source has.
        note: A remark.
    """

    name: str
    make: str
    model: str
    source: str
    licence: str
    pixel_pitch: float
    resolution: tuple[int, int]
    pattern: Mosaic
    channels: tuple[str, ...]
    wavelengths: FloatArray
    quantum_efficiency: FloatArray
    full_well: float
    bit_depth: int
    base_iso: float
    iso_range: tuple[float, float]
    size: tuple[float, float] = (0.0, 0.0)
    fill_factor: float = 1.0
    infrared_cut: Curve | None = None
    cover_glass: Curve | None = None
    read_noise: tuple[tuple[float, float], ...] = ((100.0, 0.0),)
    dual_gain: DualGain | None = None
    dark_current: DarkCurrent = DarkCurrent()
    prnu: float = 0.0
    dsnu: float = 0.0
    hot_pixels: HotPixels = HotPixels()
    black_level: int = 0
    crosstalk: float = 0.0
    low_pass: float = 0.0
    serial: int = 0
    assumed: tuple[str, ...] = ()
    note: str = ""

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
        """A copy with other values, such as ``read_noise``, ``serial`` or ``infrared_cut=None``.

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

    @property
    def where(self) -> str:
        """For messages."""
        return f"sensor {self.name}"

    @property
    def photosite_area(self) -> float:
        """um2, without fill factor."""
        return self.pixel_pitch**2

    # Light to electrons ---------------------------------------------------------------------

    def efficiency(self, nm: ArrayLike) -> FloatArray:
        """Electrons per photon on the photosite's whole area, with all filters, (C, L).

        Args:
            nm: Wavelengths, shape (L,).
        """
        at = np.asarray(nm, np.float64)
        curves = [
            np.interp(at, self.wavelengths, row, left=0, right=0) for row in self.quantum_efficiency
        ]
        out = np.stack(curves) * self.fill_factor
        for curve in (self.infrared_cut, self.cover_glass):
            if curve is not None:
                out = out * curve.at(at)
        return out

    def electrons_per_lux_s(self, white: FloatArray | None = None) -> FloatArray:
        """Electrons that 1 lux s of a light makes in each channel's photosites, shape (C,).

        Args:
            white: Radiance at ``illuminants.NM``, of any scale; None is D65.
        """
        return self._of_d65.copy() if white is None else self._electrons_of(white)

    @cached_property
    def _of_d65(self) -> FloatArray:
        return self._electrons_of(illuminants.d65())

    def _electrons_of(self, light: FloatArray) -> FloatArray:
        photons = illuminants.photons_per_lux_s(light) * self.photosite_area
        curves = self.efficiency(illuminants.NM)
        return np.array([illuminants.integral(curve * photons) for curve in curves])

    @property
    def mixing(self) -> FloatArray:
        """What crosstalk makes of even light: channels from channels, shape (C, C)."""
        unmixed = np.eye(len(self.channels))
        return (1 - self.crosstalk) * unmixed + self.crosstalk * self.pattern.neighbours()

    def white_electrons(self, white: FloatArray | None = None) -> FloatArray:
        """As :meth:`electrons_per_lux_s`, with crosstalk from the neighbours."""
        return self.mixing @ self.electrons_per_lux_s(white)

    def sensitivity(self, nm: ArrayLike) -> FloatArray:
        """What a frame's channels are sums of: efficiency times wavelength, shape (C, L).

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
        """Of what a frame's channels depend on: two sensors of one hash see the same."""
        digest = hashlib.sha256(" ".join(self.channels).encode())
        curves = self.sensitivity(illuminants.NM)
        digest.update(np.round(curves, 9).tobytes())
        return digest.hexdigest()[:16]

    # Electrons to numbers -------------------------------------------------------------------

    @property
    def highest_dn(self) -> int:
        """Of the analogue-digital converter."""
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
        """What a photosite holds, e-."""
        if self.dual_gain is not None and iso >= self.dual_gain.iso:
            return self.dual_gain.full_well
        return self.full_well

    def white_level(self, iso: float) -> int:
        """The number of a full photosite, DN: of the converter or of the full well."""
        full = self.black_level + self.gain(iso) * self.full_well_at(iso)
        return int(min(self.highest_dn, math.floor(full + 0.5)))

    def read_noise_at(self, iso: float) -> float:
        """Standard deviation of the noise that reading adds, e-."""
        rows = self.read_noise
        if self.dual_gain is not None:
            high = iso >= self.dual_gain.iso
            rows = tuple(row for row in rows if (row[0] >= self.dual_gain.iso) == high) or rows
        isos, noises = zip(*rows, strict=True)
        return float(np.interp(math.log2(iso), np.log2(isos), noises))

    def dynamic_range(self, iso: float) -> float:
        """Stops between what saturates and what is as strong as the noise in the dark."""
        gain = self.gain(iso)
        most = (self.white_level(iso) - self.black_level) / gain
        dark = math.hypot(self.read_noise_at(iso), math.sqrt(1 / 12) / gain)
        return math.log2(most / dark)

    def check_iso(self, iso: float) -> None:
        """Raises ``UsageError`` for what cannot be set."""
        low, high = self.iso_range
        try:
            fits = not isinstance(iso, str | bool) and low <= float(iso) <= high
        except (TypeError, ValueError):
            fits = False
        if not fits:
            raise UsageError(f"{self.where}: iso: wanted {low:g} .. {high:g}, got {iso}")

    # Colour -----------------------------------------------------------------------------------

    def channels_from_xyz(self) -> FloatArray:
        """A frame's channels from its XYZ, (C, 3), fitted; D65 white is exact. See ``fit``."""
        return fit.channels_from_xyz(self)

    def colour_matrix(self, white: Any = None) -> FloatArray:
        """What DNG calls a ColorMatrix: raw values from XYZ under a white, shape (C, 3).

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
        """Linear Rec.709 from a frame's channels, (3, C), balanced: that white is (1, 1, 1)."""
        return fit.rgb_from_channels(self, illuminants.white_xy(white))
