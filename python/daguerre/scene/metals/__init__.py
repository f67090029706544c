"""Metals by their measured indices of refraction, in the public domain; see ``tables.json``."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from daguerre.checks import short
from daguerre.errors import UsageError, suggest
from daguerre.scene.spectrum import Spectrum


@dataclass(frozen=True)
class Metal:
    """A metal of the table.

    Attributes:
        name: Chemical symbol or formula.
        eta: Real part of the index of refraction.
        k: Extinction coefficient.
        source: Authors and publication of the measurement.
    """

    name: str
    eta: Spectrum
    k: Spectrum
    source: str


def names() -> tuple[str, ...]:
    """Names of the metals, in alphabetic order."""
    return tuple(sorted(_tables()))


def entry(name: str) -> Metal:
    """A metal with its source.

    Raises:
        UsageError: No such metal.
    """
    table = _tables().get(str(name))
    if table is None:
        known = ", ".join(names())
        hint = suggest(name, names())
        raise UsageError(f"metal: wanted one of {known}, got {short(name)}{hint}")
    nm = table["wavelengths_nm"]
    return Metal(name, Spectrum(nm, table["eta"]), Spectrum(nm, table["k"]), table["source"])


def load(name: str) -> tuple[Spectrum, Spectrum]:
    """Real part of a metal's index of refraction, and its extinction coefficient.

    Raises:
        UsageError: No such metal.
    """
    metal = entry(name)
    return metal.eta, metal.k


@cache
def _tables() -> dict[str, dict[str, Any]]:
    path = Path(__file__).with_name("tables.json")
    return json.loads(path.read_text("utf-8"))["metals"]  # type: ignore[no-any-return]
