"""Differences between lenses of the library and measured products, from ``agreement.json``.

``script/docs/make-measured`` writes the file; docs/measured.md explains the numbers.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from .lens import Lens

FILE = Path(__file__).with_name("agreement.json")


@dataclass(frozen=True)
class Agreement:
    """Differences between a lens and its product, medians over focal lengths; None: not measured.

    Attributes:
        product: The lens's own product (``A``), or one of its optical family (``B``).
        distortion_px: Shape of distortion, RMS over the frame at 24 MP.
        red_px, blue_px: Lateral colour against green, RMS over the frame at 24 MP.
        open_ev: Light wide open, RMS over the frame, EV.
        stopped_ev: Light at the corner, stopped down 3.5 x or more, EV.
        magnification, stated: At the product's closest focus: the lens's, and its maker's figure.
        fitted: Quantities of a part that was fitted to the product: ``vignetting`` of a mount,
            ``magnification`` of the travel of focusing groups.
    """

    product: str
    distortion_px: float | None = None
    red_px: float | None = None
    blue_px: float | None = None
    open_ev: float | None = None
    stopped_ev: float | None = None
    magnification: float | None = None
    stated: float | None = None
    fitted: tuple[str, ...] = ()

    def __str__(self) -> str:
        product = "the measured product" if self.product == "A" else "a measured relative"
        light = _joined([_off(self.open_ev, "EV open"), _off(self.stopped_ev, "EV stopped down")])
        parts = [
            _off(self.distortion_px, "px", "distortion "),
            _off(self.red_px, "px", "red "),
            _off(self.blue_px, "px", "blue "),
            self._lit(light),
            self._magnified(),
        ]
        return f"Differences from {product}: {_joined(parts)}"

    def _lit(self, light: str) -> str:
        marked = " (mount fitted)" if "vignetting" in self.fitted else ""
        return f"light {light}{marked}" if light else ""

    def _magnified(self) -> str:
        if self.magnification is None or self.stated is None:
            return ""
        marked = ", travel fitted" if "magnification" in self.fitted else ""
        return f"magnification {self.magnification:.2f} (maker {self.stated:.2f}{marked})"


def _off(value: float | None, unit: str, name: str = "") -> str:
    return "" if value is None else f"{name}{value:.2f} {unit}"


def _joined(parts: list[str]) -> str:
    return ", ".join(part for part in parts if part)


def agreement(lens: Lens) -> Agreement | None:
    """Agreement of a lens of the library with a measured product; None: it has none."""
    found = _all().get(lens.source)
    return None if found is None else Agreement(**{**found, "fitted": tuple(found["fitted"])})


@cache
def _all() -> dict[str, Any]:
    return dict(json.loads(FILE.read_text(encoding="utf-8"))["lenses"])
