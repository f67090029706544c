"""Ideal sensors: no noise except shot noise, and no colour error."""

from __future__ import annotations

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.color import illuminants

from .iso_speed import SATURATION_LX_S
from .mosaic import Mosaic
from .sensor import Sensor

NAMES = ("ideal", "ideal-mono")
_SOURCE = "computed: CIE 1931 colour matching functions"


@guarded
def ideal(name: str = "ideal") -> Sensor:
    """Returns an ideal full-frame sensor of 24 MP, with colour or monochrome.

    Args:
        name: ``ideal``: red, green and blue respond as the CIE colour matching functions x, y, z,
            each with one electron per photon at its peak. So a matrix converts raw values to exact
            colours (Luther's condition). ``ideal-mono``: one electron per photon at all
            wavelengths.
    """
    nm = np.arange(380.0, 781.0)
    if name == "ideal-mono":
        curves, pattern = np.ones((1, nm.size)), "mono"
    else:
        rows = [
            np.interp(nm, illuminants.NM, row / illuminants.NM) for row in illuminants.observer().T
        ]
        curves = np.stack([row / row.max() for row in rows])
        pattern = "bayer-rggb"
    channels = ("Y",) if pattern == "mono" else ("R", "G", "B")
    sensor = Sensor(
        name=name,
        make="Daguerre",
        model="ideal" if name == "ideal" else "ideal monochrome",
        source=_SOURCE if name == "ideal" else "one electron per photon",
        licence="Apache-2.0",
        pixel_pitch=6.0,
        resolution=(6000, 4000),
        pattern=Mosaic.of(pattern, channels),
        channels=channels,
        wavelengths=nm,
        quantum_efficiency=curves,
        full_well=1e6,
        bit_depth=16,
        base_iso=100,
        iso_range=(1, 1e6),
    )
    # The full well gives a saturation-based speed of ISO 100.
    return sensor.with_(full_well=SATURATION_LX_S / 100 * float(sensor.white_electrons().max()))
