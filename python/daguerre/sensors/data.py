"""Values of a sensor file, checked."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.checks import number
from daguerre.files.value import BriefRecord, Value

from .curve import Curve
from .mosaic import Mosaic

FloatArray = NDArray[np.float64]


@guarded
@dataclass(frozen=True)
class DarkCurrent:
    """Dark current of a photosite by temperature.

    Attributes:
        rate: Dark current at ``temperature``, e-/s.
        temperature: Temperature at which ``rate`` holds, deg C.
        doubling: Temperature rise that doubles the rate, K.
    """

    rate: float = 0.0
    temperature: float = 20.0
    doubling: float = 6.0

    def factor(self, temperature: float | None) -> float:
        """Returns the ratio to ``rate`` at a temperature (deg C; None: ``temperature``)."""
        if temperature is None:
            return 1.0
        number(temperature, "sensor: temperature", -273.15, 1000)
        return float(2.0 ** ((temperature - self.temperature) / self.doubling))


@guarded
@dataclass(frozen=True)
class HotPixels:
    """Hot pixels: photosites with a high dark current.

    Attributes:
        share: Share of all photosites, 0 to 1.
        rate: Mean dark current of hot pixels, e-/s, at the temperature of the dark current. Their
            rates have an exponential distribution.
    """

    share: float = 0.0
    rate: float = 0.0


@guarded
@dataclass(frozen=True)
class DualGain:
    """Second, higher conversion gain of a photosite.

    Attributes:
        iso: Lowest ISO at which it is used; the read noise table may have a step there.
        full_well: Full well with this gain, e-.
    """

    iso: float
    full_well: float


@dataclass(frozen=True, eq=False, repr=False)
class SensorData(Value, BriefRecord):
    """Values of a sensor; :class:`~daguerre.sensors.sensor.Sensor` lists each with its unit."""

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
    measured: tuple[str, ...] = ()
    fitted: tuple[str, ...] = ()

    @property
    def where(self) -> str:
        """Name of the sensor for messages."""
        return f"sensor {self.name}"

    @property
    def photosite_area(self) -> float:
        """Area of a photosite (pixel pitch squared, without fill factor), um2."""
        return self.pixel_pitch**2
