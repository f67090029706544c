"""Facts about a sensor as plain values, for JSON and for the terminal."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any

import numpy as np

from daguerre.color import illuminants

from .iso_speed import GREY_LX_S, SATURATION_LX_S
from .sensor import Sensor


def isos(sensor: Sensor) -> list[float]:
    """ISO values in whole stops from the base ISO to both ends of the range."""
    low, high = sensor.iso_range
    first = -math.floor(math.log2(sensor.base_iso / low) + 1e-9)
    last = math.floor(math.log2(high / sensor.base_iso) + 1e-9)
    return [sensor.base_iso * 2.0**stop for stop in range(first, last + 1)]


def snr_db(sensor: Sensor, iso: float, lux_s: float) -> float:
    """SNR of the strongest channel in uniform D65 light, with PRNU, dB: 20 log10(signal / noise).

    EMVA 1288 4.0 Linear, equation 18; NaN where the channel saturates.
    """
    electrons = lux_s * float(sensor.white_electrons().max())
    if electrons > min(sensor.full_well_at(iso), SATURATION_LX_S / iso * electrons / lux_s):
        return math.nan
    gain = sensor.gain(iso)
    variance = electrons + sensor.read_noise_at(iso) ** 2 + 1 / 12 / gain**2
    variance += sensor.dsnu**2 + (sensor.prnu * electrons) ** 2
    return 20 * math.log10(electrons / math.sqrt(variance))


def row(sensor: Sensor, iso: float) -> dict[str, float]:
    """Facts about a sensor at one ISO."""
    gain = sensor.gain(iso)
    return {
        "iso": iso,
        "gain_dn_per_e": gain,
        "read_noise_e": sensor.read_noise_at(iso),
        "full_well_e": sensor.full_well_at(iso),
        "saturation_e": (sensor.white_level(iso) - sensor.black_level) / gain,
        "white_level_dn": sensor.white_level(iso),
        "dynamic_range_stops": sensor.dynamic_range(iso),
        "grey_snr_db": snr_db(sensor, iso, GREY_LX_S / iso),
    }


def basis(sensor: Sensor) -> str:
    """One line: which values were measured, fitted and assumed, by their keys in the file."""
    kinds = {"measured": sensor.measured, "fitted": sensor.fitted, "assumed": sensor.assumed}
    keys = {kind: ", ".join(text.split(":")[0] for text in texts) for kind, texts in kinds.items()}
    return "; ".join(f"{kind} {listed}" for kind, listed in keys.items() if listed)


def facts(sensor: Sensor) -> dict[str, Any]:
    """All facts about a sensor."""
    names = sensor.channels
    per_lux_s = sensor.electrons_per_lux_s()
    peaks = sensor.efficiency(illuminants.NM)
    return {
        "name": sensor.name,
        "make": sensor.make,
        "model": sensor.model,
        "source": sensor.source,
        "licence": sensor.licence,
        "basis": basis(sensor),
        "measured": list(sensor.measured),
        "fitted": list(sensor.fitted),
        "assumed": list(sensor.assumed),
        "note": sensor.note,
        "size_mm": list(sensor.size),
        "resolution": list(sensor.resolution),
        "pixel_pitch_um": sensor.pixel_pitch,
        "fill_factor": sensor.fill_factor,
        "pattern": sensor.pattern.name,
        "channels": list(names),
        "bit_depth": sensor.bit_depth,
        "black_level_dn": sensor.black_level,
        "base_iso": sensor.base_iso,
        "iso_range": list(sensor.iso_range),
        "saturation_iso": sensor.saturation_iso,
        "full_well_e": sensor.full_well,
        "dual_gain": None if sensor.dual_gain is None else asdict(sensor.dual_gain),
        "dark_current": asdict(sensor.dark_current),
        "prnu": sensor.prnu,
        "dsnu_e": sensor.dsnu,
        "hot_pixels": asdict(sensor.hot_pixels),
        "crosstalk": sensor.crosstalk,
        "low_pass_um": sensor.low_pass,
        "peak_quantum_efficiency": dict(zip(names, peaks.max(axis=1).tolist(), strict=True)),
        "electrons_per_lux_s": dict(zip(names, per_lux_s.tolist(), strict=True)),
        "neutral_d65": dict(zip(names, sensor.neutral().tolist(), strict=True)),
        "colour_matrix_d65": np.round(sensor.colour_matrix(), 6).tolist(),
        "colour_matrix_a": np.round(sensor.colour_matrix(illuminants.A_KELVIN), 6).tolist(),
        "hash": sensor.hash,
        "by_iso": [row(sensor, iso) for iso in isos(sensor)],
    }
