"""White light: D65, other whites by colour temperature or chromaticity, and photon counts."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

import daguerre._core as _core
from daguerre.checks import numbers, short, shown
from daguerre.errors import UsageError

FloatArray = NDArray[np.float64]
#: Planck's constant (J s) and the speed of light (m/s), exact in the SI of 2019.
PLANCK, LIGHT = 6.62607015e-34, 299792458.0
#: Boltzmann's constant, J/K.
BOLTZMANN = 1.380649e-23
#: Luminous efficacy of 540 THz, lm/W (SI).
EFFICACY = 683.0
#: Chromaticity of D65 from Daguerre's tables (CIE, steps of 5 nm). Computations adapt to it, so
#: that a grey world stays exactly grey.
D65_XY = (0.31275676, 0.32907241)
#: Chromaticity of D65 as RGB standards state it (IEC 61966-2-1, ITU-R BT.709-6), for matrices of
#: primaries, profiles and headers, where other programs expect these digits.
D65_STATED = (0.3127, 0.3290)
#: Correlated colour temperatures of DNG's illuminants 21 and 17, K.
D65_KELVIN, A_KELVIN = 6504.0, 2856.0
LOWEST_KELVIN, HIGHEST_KELVIN = 1000.0, 25000.0
#: Step of sums over the spectrum, nm.
STEP = 0.5
#: Wavelengths of sums over the spectrum, nm: middles of equal steps.
NM = np.arange(380 + STEP / 2, 780, STEP)
NM.flags.writeable = False


@cache
def _color_tables() -> FloatArray:
    return np.asarray(_core.colour_tables(NM.tolist()))


def observer() -> FloatArray:
    """CIE 1931 colour matching at ``NM``, so that its sum with a radiance is XYZ, shape (L, 3).

    Radiance has the unit of ``d65()``, which has Y = 1.
    """
    return np.asarray(_color_tables()[:, :3] * STEP)


def d65() -> FloatArray:
    """D65 at ``NM``, W/m2/nm for 1 lux, times 683, so that Y is 1; shape (L,)."""
    table = _color_tables()
    return np.asarray(table[:, 3] / (table[:, 1] @ table[:, 3] * STEP))


def rgb_reflectances() -> FloatArray:
    """Reflectances of upsampled red, green and blue at ``NM``, shape (L, 3)."""
    return np.asarray(_color_tables()[:, 4:])


def _planck_shape(nm: FloatArray, kelvin: float) -> FloatArray:
    with np.errstate(over="ignore"):
        rise = np.expm1(PLANCK * LIGHT / (nm * 1e-9 * BOLTZMANN * kelvin))
    return np.asarray(nm**-5.0 / rise)


def blackbody(nm: FloatArray, kelvin: float) -> FloatArray:
    """Radiance of a black body at wavelengths, W / (m2 sr nm), shape (L,); Planck's law."""
    return 2e36 * PLANCK * LIGHT**2 * _planck_shape(nm, kelvin)


def planck(kelvin: float) -> FloatArray:
    """Black body with Y = 1 at ``NM``, shape (L,)."""
    shape = _planck_shape(NM, kelvin)
    return np.asarray(shape / (observer()[:, 1] @ shape))


def photons_per_lux_s(radiance: FloatArray) -> FloatArray:
    """Photons per um2 and nm for 1 lux s of a light with Y = 1, at ``NM``."""
    radiance = np.asarray(radiance)
    if radiance.shape != NM.shape or radiance.dtype.kind not in "iuf":
        wanted = f"a spectrum at {len(NM)} wavelengths"
        raise UsageError(f"white: wanted {wanted}, got {shown(radiance)}")
    watts = radiance / EFFICACY / (observer()[:, 1] @ radiance)
    return np.asarray(watts * NM * 1e-9 / (PLANCK * LIGHT) * 1e-12)


def integral(values: ArrayLike) -> float:
    """Integrates values at ``NM`` over wavelength (nm)."""
    return float(np.asarray(values).sum() * STEP)


def xy_of(spectrum: FloatArray) -> tuple[float, float]:
    """Chromaticity of a light at ``NM``."""
    x, y, z = observer().T @ spectrum
    return float(x / (x + y + z)), float(y / (x + y + z))


def white_xy(white: Any = None, where: str = "white_balance") -> tuple[float, float]:
    """Returns the chromaticity of a white.

    Args:
        white: None (D65), a colour temperature, K, or a chromaticity (x, y). From 4000 K on the
            temperature means daylight, below a black body.
        where: Place for messages.

    Raises:
        UsageError: ``white`` is none of these, or outside 1000 .. 25000 K.
    """
    if white is None:
        return D65_XY
    if not isinstance(white, tuple | list) and np.ndim(white) == 0:
        return _of_kelvin(white, where)
    x, y = numbers(white, where, 2, "a temperature in K or a chromaticity (x, y)")
    if not (x > 0 and y > 0 and x + y < 1):
        raise UsageError(
            f"{where}: wanted a chromaticity (x, y) with x, y > 0, x + y < 1, got {(x, y)}"
        )
    return x, y


def _of_kelvin(value: Any, where: str) -> tuple[float, float]:
    try:
        kelvin = math.nan if isinstance(value, str | bytes | bool) else float(value)
    except (TypeError, ValueError, OverflowError):
        kelvin = math.nan
    if not LOWEST_KELVIN <= kelvin <= HIGHEST_KELVIN:
        raise UsageError(
            f"{where}: wanted {LOWEST_KELVIN:g} .. {HIGHEST_KELVIN:g} K or a chromaticity (x, y), "
            f"got {short(value)}"
        )
    if kelvin == D65_KELVIN:
        return D65_XY
    return _daylight_xy(kelvin) if kelvin >= 4000 else xy_of(planck(kelvin))


def _daylight_xy(kelvin: float) -> tuple[float, float]:
    """Chromaticity on the daylight locus. Source: CIE 015:2018, 4.1.2 (two cubics in 1000/K)."""
    t = 1000 / kelvin
    if kelvin <= 7000:
        x = 0.244063 + 0.09911 * t + 2.9678 * t**2 - 4.6070 * t**3
    else:
        x = 0.237040 + 0.24748 * t + 1.9018 * t**2 - 2.0064 * t**3
    return x, -3.0 * x**2 + 2.870 * x - 0.275


def kelvin_of(xy: tuple[float, float]) -> float:
    """Correlated colour temperature of a white, K.

    Source: McCamy 1992, Correlated color temperature as an explicit function of chromaticity
    coordinates: a cubic, good to some K between 2856 and 6500 K.
    """
    n = (xy[0] - 0.3320) / (0.1858 - xy[1])
    return 449.0 * n**3 + 3525.0 * n**2 + 6823.3 * n + 5520.33


def xyz_of_xy(xy: tuple[float, float]) -> FloatArray:
    """XYZ of a chromaticity, with Y = 1."""
    x, y = xy
    return np.array([x / y, 1.0, (1 - x - y) / y])
