"""Film stock: sensitivity, characteristic curves, spread of light and grain."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.argument_checks import guarded
from daguerre.checks import number, short
from daguerre.color import illuminants
from daguerre.errors import InputError
from daguerre.files.value import BriefRecord, Value
from daguerre.sensors.checking import tells_colors
from daguerre.sensors.curve import rising

from .curve import CharacteristicCurve

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame

    from .negative import Negative

FloatArray = NDArray[np.float64]
KINDS = ("negative", "reversal")
#: RMS granularity is measured with a round aperture of 48 um (ISO 10505), at density 1 above base.
HOLE_UM, GRAIN_DENSITY = 48.0, 1.0


@guarded(init=True)
@dataclass(frozen=True)
class Halation:
    """Halation: light that passes the emulsion is reflected at the back and exposes it again.

    Attributes:
        base: Thickness of the film's base, mm.
        index: Refractive index of the base.
        share: Share of the light on each layer that passes the emulsion, scattered, and is not
            absorbed by the backing; one number for each layer.
    """

    base: float
    share: tuple[float, ...]
    index: float = 1.5


@guarded(init=True)
@dataclass(frozen=True, eq=False, repr=False)
class Layer(Value, BriefRecord):
    """A layer of emulsion.

    Attributes:
        name: ``R``, ``G`` or ``B``; ``Y`` for black-and-white film.
        sensitivity: Response per watt at the stock's wavelengths, of any scale, shape (L,).
        curve: Characteristic curve.
    """

    name: str
    sensitivity: FloatArray
    curve: CharacteristicCurve


@guarded(init=True)
@dataclass(frozen=True, eq=False)
class Stock(Value):
    """A film stock.

    Attributes:
        name: Name by which it is loaded.
        kind: ``negative`` or ``reversal``.
        source: Source of the values.
        iso: Film speed, ISO.
        wavelengths: Wavelengths of the sensitivities, nm, shape (L,).
        layers: Three layers (R, G, B) or one (Y).
        balance: Colour temperature of the light that the film renders neutral, K.
        granularity: RMS granularity: 1000 times the standard deviation of density through an
            aperture of 48 um, at density 1 above base.
        spread: Standard deviation of the spread of light in the emulsion, um.
        halation: Halation; None: the backing absorbs all light.
        paper: Characteristic curve of the paper for printing negatives; x is log10 of the paper's
            exposure.
    """

    name: str
    kind: str
    source: str
    iso: float
    wavelengths: FloatArray
    layers: tuple[Layer, ...]
    balance: float = illuminants.D65_KELVIN
    granularity: float = 0.0
    spread: float = 0.0
    halation: Halation | None = None
    paper: CharacteristicCurve | None = None

    def __post_init__(self) -> None:
        _check(self)

    def __repr__(self) -> str:
        return f"<Stock {self.name}: {self.kind}, ISO {self.iso:g}>"

    def with_(self, **changes: object) -> Stock:
        """Returns a copy with other values, such as ``balance=3200`` or ``halation=None``."""
        return replace(self, **dict[str, Any](changes))

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the layers."""
        return tuple(layer.name for layer in self.layers)

    def sensitivity(self, nm: ArrayLike) -> FloatArray:
        """Returns the sensitivity, scaled so that D65 of Y = 1 is 1 in each layer, shape (C, L)."""
        fine = illuminants.NM
        rows, at = [], np.asarray(nm, np.float64)
        for layer in self.layers:
            seen = np.interp(fine, self.wavelengths, layer.sensitivity, left=0, right=0)
            total = illuminants.integral(seen * illuminants.d65())
            rows.append(np.interp(at, fine, seen) / total)
        return np.stack(rows)

    @property
    def hash(self) -> str:
        """Hash of all values on which a frame's channels depend."""
        digest = hashlib.sha256(" ".join(self.channels).encode())
        digest.update(np.round(self.sensitivity(illuminants.NM), 9).tobytes())
        return digest.hexdigest()[:16]

    def white(self) -> FloatArray:
        """Channels of white in the stock's balance, where D65 white is 1, shape (C,)."""
        if self.balance == illuminants.D65_KELVIN:
            return np.ones(len(self.layers))
        light = illuminants.planck(self.balance)
        rows = self.sensitivity(illuminants.NM) * light
        return np.array([illuminants.integral(row) for row in rows])

    def grain_area(self) -> float:
        """Area of a grain or dye cloud that gives the granularity, um2, for randomly placed grains.

        By Nutting's law, N grains of area a on an area A have the mean density
        D = log10(e) N a / A. The variance of N is its mean, so the variance of D is
        log10(e) a D / A (Siedentopf).
        """
        hole = math.pi * (HOLE_UM / 2) ** 2
        return (self.granularity / 1000) ** 2 * hole / (math.log10(math.e) * GRAIN_DENSITY)

    def expose(self, frame: Frame, *, ev: float | None = None, seed: int = 0) -> Negative:
        """Exposes the film to a frame and develops it.

        In the exposure mode ``light`` a value of 1 is white: 10 / 0.18 / ISO lux s. In the others
        the frame's time and stop set the exposure.

        Args:
            frame: Frame; in other modes than ``light`` with exposure metadata.
            ev: Exposure compensation, EV; default: the camera's.
            seed: Seed of the grain.

        Raises:
            InputError: The frame has no exposure metadata.
        """
        from .negative import exposed

        return exposed(self, frame, ev, seed)


def _check(stock: Stock) -> None:
    where = f"stock {stock.name}"
    if stock.kind not in KINDS:
        raise InputError(f"{where}: kind: wanted negative or reversal, got {short(stock.kind)}")
    if stock.channels not in (("R", "G", "B"), ("Y",)):
        got = short(", ".join(stock.channels))
        raise InputError(f"{where}: layers: wanted R, G, B or Y, got {got}")
    number(stock.iso, f"{where}: iso", 0, 1e6, above=0, error=InputError)
    number(stock.balance, f"{where}: balance", 1000, 25000, error=InputError)
    number(stock.granularity, f"{where}: granularity", 0, 1000, error=InputError)
    number(stock.spread, f"{where}: spread", 0, 1000, error=InputError)
    nm = rising(f"{where}: wavelengths", stock.wavelengths)
    for layer in stock.layers:
        here = f"{where}: layer {layer.name}"
        seen = np.asarray(layer.sensitivity)
        if seen.shape != np.shape(stock.wavelengths):
            raise InputError(
                f"{here}: sensitivity: wanted {np.size(stock.wavelengths)} numbers, one for each "
                f"wavelength, got {seen.size}"
            )
        if not (np.isfinite(seen).all() and (seen >= 0).all() and seen.any()):
            raise InputError(
                f"{here}: sensitivity: numbers must be at least 0, and one of them above 0"
            )
        layer.curve.check(here)
        if (layer.curve.gamma < 0) != (stock.kind == "reversal"):
            wanted = "below 0" if stock.kind == "reversal" else "above 0"
            raise InputError(
                f"{here}: gamma: wanted a number {wanted} for {stock.kind} film, got "
                f"{layer.curve.gamma:g}"
            )
    if not tells_colors(np.array([layer.sensitivity for layer in stock.layers]), nm):
        raise InputError(
            f"{where}: sensitivity: layers must be sensitive between 380 and 780 nm, and their "
            f"curves linearly independent"
        )
    if stock.kind == "negative":
        if stock.paper is None:
            raise InputError(
                f"{where}: paper: missing, a negative needs the curve of the paper that it is "
                f"printed on"
            )
        stock.paper.check(f"{where}: paper")
        number(stock.paper.gamma, f"{where}: paper: gamma", above=0, error=InputError)
    if stock.halation is not None:
        _check_halation(stock.halation, len(stock.layers), f"{where}: halation")


def _check_halation(halation: Halation, layers: int, where: str) -> None:
    number(halation.base, f"{where}: base", 0, 10, above=0, error=InputError)
    number(halation.index, f"{where}: index", 1, 4, above=1, error=InputError)
    if len(halation.share) != layers:
        raise InputError(
            f"{where}: share: wanted {layers} numbers, one for each layer, got "
            f"{len(halation.share)}"
        )
    for share in halation.share:
        number(share, f"{where}: share", 0, 1, error=InputError)
