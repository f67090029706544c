"""Plots a sensor: efficiency by wavelength, dynamic range and noise by ISO."""

from __future__ import annotations

from typing import Any

import numpy as np

from daguerre.color import illuminants
from daguerre.sensors.facts import isos, row, snr_db
from daguerre.sensors.iso_speed import GREY_LX_S, SATURATION_LX_S
from daguerre.sensors.sensor import Sensor

from .sheet import saved

COLORS = {"R": "#c0392b", "G": "#27ae60", "B": "#2e5fa3", "Y": "#444444"}


def page(sensor: Sensor, kind: str) -> bytes:
    """Draws the page of a sensor; returns the bytes of a file.

    Args:
        sensor: The sensor.
        kind: "svg", "png" or "pdf".
    """
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10, 7.2), layout="constrained")
    axes = figure.subplots(2, 2)
    _efficiency(axes[0, 0], sensor)
    _by_iso(axes[0, 1], axes[1, 1], sensor)
    _signal_to_noise(axes[1, 0], sensor)
    figure.suptitle(f"{sensor.make} {sensor.model} ({sensor.name})")
    with rc_context({"svg.hashsalt": "daguerre", "text.parse_math": False}):
        return saved(figure, kind, sensor.name)


def _efficiency(axes: Any, sensor: Sensor) -> None:
    for name, curve in zip(sensor.channels, sensor.efficiency(illuminants.NM), strict=True):
        axes.plot(illuminants.NM, curve, color=COLORS.get(name, "k"), label=name)
    axes.set(xlabel="wavelength, nm", ylabel="electrons per photon", ylim=(0, 1), xlim=(380, 780))
    axes.legend()
    axes.set_title("Quantum efficiency")
    axes.grid(alpha=0.3)


def _by_iso(upper: Any, lower: Any, sensor: Sensor) -> None:
    rows = [row(sensor, iso) for iso in _fine_isos(sensor)]
    at = [r["iso"] for r in rows]
    upper.plot(at, [r["dynamic_range_stops"] for r in rows], color="k")
    upper.set(ylabel="stops", title="Dynamic range")
    lower.plot(at, [r["read_noise_e"] for r in rows], color="k")
    lower.set(ylabel="e-", title="Read noise", ylim=(0, None))
    for axes in (upper, lower):
        axes.set_xscale("log", base=2)
        axes.set_xlabel("ISO")
        shown = isos(sensor)
        step = -(-len(shown) // 6)
        axes.set_xticks(shown[::step], [f"{iso:.0f}" for iso in shown[::step]])
        axes.grid(alpha=0.3)


def _fine_isos(sensor: Sensor) -> list[float]:
    low, high = sensor.iso_range
    return [float(v) for v in np.geomspace(low, high, 200)]


def _signal_to_noise(axes: Any, sensor: Sensor) -> None:
    chosen = isos(sensor)
    chosen = chosen[:: max(1, -(-len(chosen) // 4))]
    lowest = SATURATION_LX_S
    for i, iso in enumerate(chosen):
        lux_s = np.geomspace(1e-6, 1, 400) * SATURATION_LX_S / iso
        ratio = np.array([snr_db(sensor, iso, h) for h in lux_s])
        lowest = min(lowest, float(lux_s[ratio > 0].min()))
        # Thin lines of high ISOs stay visible on thick ones of low ISOs where they agree.
        axes.plot(lux_s, ratio, linewidth=4.5 - i, label=f"ISO {iso:.0f}")
        grey = GREY_LX_S / iso
        axes.plot(grey, snr_db(sensor, iso, grey), "k.", markersize=5, zorder=9)
    axes.set(xscale="log", xlabel="exposure, lux s (dot: middle grey)", ylabel="dB", ylim=(0, None))
    axes.set_xlim(lowest, 2 * SATURATION_LX_S / chosen[0])
    axes.set_title("Signal to noise")
    axes.legend()
    axes.grid(alpha=0.3)
