"""Makes the sensor of a raw photograph with the measured gain and noise."""

from __future__ import annotations

import math

import numpy as np

from daguerre import sensors
from daguerre.plates.photograph import RawNumbers
from daguerre.sensors import PATTERNS, DarkCurrent, HotPixels, Mosaic, Sensor
from daguerre.sensors.iso_speed import SATURATION_LX_S

from .transfer import Transfer

#: Sensors with colours that stand in for unknown cameras, by number of channels.
_STAND_INS = {1: "sony-imx571-mono", 3: "nikon-d5100"}
#: Relative standard error from which on a read noise counts as unknown.
UNKNOWN = 0.5
#: Most electrons per photon that efficiencies are scaled to.
_MOST_EFFICIENT = 1.0


def plate_sensor(
    raw: RawNumbers, body: Sensor | None, iso: float, width_mm: float, name: str
) -> tuple[Sensor, list[str]]:
    """Makes a sensor with the geometry and levels of a raw photograph; also returns notes.

    Args:
        raw: Values of the photograph.
        body: Library sensor of the camera; None: another sensor's colours are used.
        iso: ISO of the photograph.
        width_mm: Width of the sensor, mm.
        name: Name of the new sensor.
    """
    notes: list[str] = []
    stand_in = body is None or len(body.channels) != len(raw.channels)
    base = sensors.load(_STAND_INS[len(raw.channels)]) if stand_in or body is None else body
    rows, columns = raw.mosaic.shape
    low, high = base.iso_range
    pitch = 1e3 * width_mm / columns
    # A photosite holds as many electrons as the camera's, also if pixels of the picture are larger.
    efficiency = np.asarray(base.quantum_efficiency) * (base.pixel_pitch / pitch) ** 2
    made = base.with_(
        name=name,
        pattern=_pattern(raw, notes),
        resolution=(columns, rows),
        pixel_pitch=pitch,
        quantum_efficiency=efficiency / max(float(efficiency.max()), 1.0),
        bit_depth=math.ceil(math.log2(raw.white + 1)),
        black_level=round(float(raw.black[raw.cells].mean())),
        iso_range=(min(low, iso), max(high, iso)),
    )
    if stand_in:
        notes.append(
            f"the camera is not in the library; its colours are taken from the sensor {base.name}"
        )
        made = made.with_(
            make="", model="", dsnu=0.0, prnu=0.0, dual_gain=None,
            dark_current=DarkCurrent(), hot_pixels=HotPixels(),
            assumed=(f"quantum_efficiency: curves of {base.name}",),
        )  # fmt: skip
    return made, notes


def with_transfer(sensor: Sensor, measured: Transfer, iso: float, white: int) -> Sensor:
    """Returns the sensor with the measured gain, noise and full well, at the photograph's ISO.

    Gain and ISO determine the quantum efficiency (ISO 12232), which is scaled. The DSNU of the
    library's sensor is subtracted from the noise measured in the dark.
    """
    highest = 2**sensor.bit_depth - 1
    wanted = (highest - sensor.black_level) * iso / SATURATION_LX_S / measured.gain
    scale = wanted / float(sensor.white_electrons().max())
    dark = math.sqrt(max(measured.read_noise**2 - sensor.dsnu**2, 0.0))
    if measured.read_noise_error > UNKNOWN:
        dark = sensor.read_noise_at(iso)
    return sensor.with_(
        quantum_efficiency=np.asarray(sensor.quantum_efficiency) * scale,
        read_noise=((iso, dark),),
        prnu=measured.prnu or sensor.prnu,
        full_well=max((white - sensor.black_level) / measured.gain, 1.0),
        dual_gain=None,
        source="measured in a photograph",
        note=f"gain, read noise and well as measured at ISO {iso:g}",
    )


def responsivity(sensor: Sensor) -> float:
    """Ratio of the quantum efficiency to one electron per photon if it is above 1; else 1.

    No sensor exceeds 1. The ISO rating of such a camera is higher than by ISO 12232, so its
    pictures get more exposure than the rating implies.
    """
    return max(float(np.max(sensor.quantum_efficiency)) / _MOST_EFFICIENT, 1.0)


def _pattern(raw: RawNumbers, notes: list[str]) -> Mosaic:
    """Returns the pattern with these cells; if the cells are shifted, the unshifted pattern."""
    for name in PATTERNS:
        letters = set("".join(PATTERNS[name]))
        if letters == set(raw.channels):
            known = Mosaic.of(name, raw.channels)
            if np.array_equal(known.cells, raw.cells):
                return known
    side = len(raw.cells)
    name = {6: "xtrans", 4: "quad-bayer-rggb"}.get(side, "bayer-rggb")
    notes.append(f"the mosaic starts at another photosite of its pattern; it is taken as {name}")
    return Mosaic.of(name, raw.channels)
