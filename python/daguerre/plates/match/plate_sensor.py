"""The sensor of a raw photograph, with the gain and the noise that were measured in it."""

from __future__ import annotations

import math

import numpy as np

from daguerre import sensors
from daguerre.plates.photograph import RawNumbers
from daguerre.sensors import PATTERNS, DarkCurrent, HotPixels, Mosaic, Sensor
from daguerre.sensors.sensor import SATURATION_LX_S

from .transfer import Transfer

#: Sensors whose colours stand in for those of unknown cameras.
_STAND_INS = {1: "sony-imx571-mono", 3: "nikon-d5100"}
#: Relative standard error from which on a read noise is not known.
UNKNOWN = 0.5
#: Most electrons per photon that efficiencies are scaled to.
_MOST_EFFICIENT = 1.0


def plate_sensor(
    raw: RawNumbers, body: Sensor | None, iso: float, width_mm: float, name: str
) -> tuple[Sensor, list[str]]:
    """A sensor with the geometry and the levels of a raw photograph, and notes.

    Args:
        raw: The photograph's numbers.
        body: The library's sensor of that camera; None: another's colours stand in.
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
    # A photosite has as many electrons as the body's own, whatever a pixel of the picture spans.
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
        notes.append(f"colours of the sensor are those of {base.name}: the library has no other")
        made = made.with_(
            make="", model="", dsnu=0.0, prnu=0.0, dual_gain=None,
            dark_current=DarkCurrent(), hot_pixels=HotPixels(),
            assumed=(f"quantum_efficiency: curves of {base.name}",),
        )  # fmt: skip
    return made, notes


def with_transfer(sensor: Sensor, measured: Transfer, iso: float, white: int) -> Sensor:
    """The sensor with a measured gain, noise and well, at the ISO of the photograph.

    Gain and ISO tell the efficiency (ISO 12232), so that is scaled. Offsets of the photosites that
    the library knows are taken out of what was measured in the dark.
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
    """How much its efficiency is above one electron per photon, which no sensor has; else 1.

    Such a camera's ISO promises more than ISO 12232 does: it is exposed longer than it says.
    """
    return max(float(np.max(sensor.quantum_efficiency)) / _MOST_EFFICIENT, 1.0)


def _pattern(raw: RawNumbers, notes: list[str]) -> Mosaic:
    """The pattern with these cells; of one that starts elsewhere the usual one."""
    for name in PATTERNS:
        letters = set("".join(PATTERNS[name]))
        if letters == set(raw.channels):
            known = Mosaic.of(name, raw.channels)
            if np.array_equal(known.cells, raw.cells):
                return known
    side = len(raw.cells)
    name = {6: "xtrans", 4: "quad-bayer-rggb"}.get(side, "bayer-rggb")
    notes.append(f"the mosaic begins at another place of its pattern: taken for {name}")
    return Mosaic.of(name, raw.channels)
