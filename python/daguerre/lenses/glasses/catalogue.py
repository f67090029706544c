"""Finds glasses by name, as makers, patents and old lens files write them."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.argument_checks import guarded
from daguerre.checks import short
from daguerre.errors import suggest
from daguerre.files.json_item import Item
from daguerre.lenses.errors import LensError
from daguerre.lenses.glass_formula import absorption_of, formula_of
from daguerre.lenses.medium import AIR, Medium

FOLDER = Path(__file__).parent
#: Catalogues, in the order in which names are looked up.
MAKERS = ("Schott", "Ohara", "Hoya", "Hikari", "CDGM", "Sumita", "Corning", "LZOS", "materials")
#: Prefixes of newer glass types; the first that exists is taken.
PREFIXES = ("N", "S", "J", "H", "E", "K", "L", "P", "M", "Q", "D")
_OTHER_NAMES = {"FLUORITE": "CaF2", "CALCIUMFLUORIDE": "CaF2", "FUSEDSILICA": "SiO2"} | {
    "SILICA": "SiO2",
    "QUARTZGLASS": "SiO2",
    "ACRYLIC": "PMMA",
    "PLEXIGLAS": "PMMA",
    "POLYCARBONATE": "PC",
    "POLYSTYRENE": "PS",
    "NIKON": "Hikari",
}
_WITH_MAKER = re.compile(r"^(.*?)\s*\(([A-Za-z]+)\)$")
_WORD = re.compile(r"[A-Za-z][A-Za-z0-9]*(?:-[A-Za-z0-9]+)*")
#: Spectral lines at which makers state indices, nm: F and C of hydrogen, d of helium.
LINE_F, LINE_D, LINE_C = 486.1327, 587.5618, 656.2725


@guarded
@dataclass(frozen=True, eq=False)
class GlassData:
    """One glass of a catalogue.

    Attributes:
        name: Name in its maker's spelling.
        maker: One of ``MAKERS``, or ``core`` for air, water and vacuum.
        core: Medium of the core: index and absorption.
        stated_nd: Index at 587.56 nm as the maker states it; None: not stated.
        stated_vd: Abbe number as the maker states it; None: not stated.
        note: Substitution for the requested name; empty: none.
    """

    name: str
    maker: str
    core: Medium
    stated_nd: float | None = None
    stated_vd: float | None = None
    note: str = ""

    @property
    def nd(self) -> float:
        """Index at 587.56 nm, from the dispersion formula."""
        return float(self.core.index(LINE_D))

    @property
    def vd(self) -> float:
        """Abbe number (nd - 1) / (nF - nC), from the dispersion formula."""
        spread = self.core.index(LINE_F) - self.core.index(LINE_C)
        return float((self.nd - 1) / spread) if spread else float("inf")

    def index(self, wavelength_nm: ArrayLike) -> NDArray[np.float64]:
        """Returns the index relative to air, in the shape of the wavelengths (nm)."""
        return np.asarray(np.vectorize(self.core.index, [float])(wavelength_nm), np.float64)

    def internal_transmittance(
        self, wavelength_nm: ArrayLike, thickness_mm: float = 10.0
    ) -> NDArray[np.float64]:
        """Returns the internal transmittance of a plate, 0 to 1, in the shape of the wavelengths.

        Args:
            wavelength_nm: Wavelengths, nm, any shape.
            thickness_mm: Thickness of the plate, mm.
        """
        per_mm = np.vectorize(self.core.absorption_per_mm, [float])(wavelength_nm)
        return np.asarray(np.exp(-thickness_mm * per_mm), np.float64)


@guarded
def names(maker: str | None = None) -> list[str]:
    """Returns the names of all glasses, or of one maker's, sorted."""
    found = {entry.name for entry in _entries(maker)}
    return sorted(found)


@guarded
def find(name: str, maker: str | None = None) -> GlassData:
    """Finds a glass by name; case, spaces and hyphens do not matter.

    The name may end in its maker in parentheses. The name of a discontinued glass finds its
    successor (BK7: N-BK7), with a ``note``.

    Args:
        name: Name such as ``N-BK7``, ``SF6 (Schott)``, ``CaF2``, ``water``.
        maker: One of ``MAKERS``; default: any, in that order.

    Raises:
        LensError: No glass has this name (lens-glass); the message suggests the nearest names.
    """
    maker = _maker(name, maker)
    found = _found(name, maker)
    if found is None:
        raise LensError(
            f"glass {name!r}: no glass has this name in {asked(maker)}"
            f"{suggest(name, names(maker))}",
            "lens-glass",
        )
    return found


def asked(maker: str | None = None) -> str:
    """Names the catalogues that are searched, for messages."""
    return f"the catalogue of {maker}" if maker else f"the catalogues {', '.join(MAKERS)}"


def maker_of(name: str, maker: str) -> str:
    """Name of a catalogue, in any case.

    Raises:
        LensError: There is no such catalogue (lens-glass).
    """
    found = _maker(name, maker)
    assert found is not None
    return found


@guarded
def lookup(name: str, maker: str | None = None) -> GlassData | None:
    """Finds a glass like :func:`find`, but returns None if there is none; makes no suggestions."""
    return _found(name, _maker(name, maker))


def _found(name: str, maker: str | None) -> GlassData | None:
    key = _key(name)
    exact = _by_key(maker).get(key)
    if exact is not None:
        return _load(exact)
    tail = _WITH_MAKER.match(name.strip())
    if tail and maker is None and tail[2].upper() in {m.upper() for m in (*MAKERS, "Nikon")}:
        whose = "Hikari" if tail[2].upper() == "NIKON" else tail[2]
        return _found(tail[1], _maker(tail[1], whose))
    other = _by_key(maker).get(_key(_OTHER_NAMES.get(key, "")))
    if other is None:
        found = (_by_key(maker).get(prefix + key) for prefix in PREFIXES)
        other = next((entry for entry in found if entry is not None), None)
    return None if other is None else _load(other, f"{name}: took {other.name} ({other.maker})")


@guarded
def similar(
    label: str, nd: float, tolerance: float = 5e-4, makers: Sequence[str] = ()
) -> GlassData | None:
    """Finds the catalogue's glass that a lens file's label names, if its nd agrees; else None.

    Labels hold more than names (``N-SK16 / SK16 class (Schott, 620/603)``), so each word is tried
    in turn, in the catalogues of ``makers`` first.
    """
    return next((g for g in _of_label(label, makers) if abs(g.nd - nd) <= tolerance), None)


@guarded
def named(label: str, makers: Sequence[str] = ()) -> GlassData | None:
    """Finds the first catalogue glass that a lens file's label names, if any, whatever its nd."""
    return next(_of_label(label, makers), None)


def _of_label(label: str, makers: Sequence[str]) -> Iterator[GlassData]:
    """Glasses of a label's words, the exact names of a maker before its newer types."""
    for word in _WORD.findall(label):
        key = _key(word)
        if len(key) < 2:
            continue
        keys = (key, *(prefix + key for prefix in PREFIXES), _key(_OTHER_NAMES.get(key, "")))
        for maker in dict.fromkeys((*makers, *MAKERS)):
            for candidate in keys:
                entry = _by_key(maker).get(candidate)
                if entry is not None:
                    yield _load(entry)


@dataclass(frozen=True)
class _Entry:
    name: str
    maker: str
    file: str


def _key(name: str) -> str:
    return re.sub(r"[^A-Z0-9]", "", name.upper())


def _maker(name: str, maker: str | None) -> str | None:
    if maker is None:
        return None
    for known in MAKERS:
        if known.upper() == maker.upper():
            return known
    raise LensError(
        f"glass {name!r}: there is no catalogue of {short(maker)}"
        f"{suggest(maker, MAKERS, few=True)}",
        "lens-glass",
    )


@cache
def _catalogue(maker: str) -> dict[str, Any]:
    """Glasses of a maker, including glasses added by hand."""
    data, added = _json(f"{maker.lower()}.json"), _json("added.json")["glasses"]
    return {**data["glasses"], **added.get(maker, {})}


def _json(name: str) -> dict[str, Any]:
    data: dict[str, Any] = json.loads((FOLDER / name).read_text("utf-8"))
    return data


def _entries(maker: str | None) -> Iterator[_Entry]:
    if maker is None:
        yield from (_Entry(name, "core", "") for name in ("air", "water", "vacuum"))
    for one in MAKERS if maker is None else (_maker("names", maker),):
        assert one is not None
        for name in _catalogue(one):
            yield _Entry(name, one, f"{one.lower()}.json")


@cache
def _by_key(maker: str | None) -> dict[str, _Entry]:
    table: dict[str, _Entry] = {}
    for entry in _entries(maker):
        table.setdefault(_key(entry.name), entry)
    return table


@cache
def _load(entry: _Entry, note: str = "") -> GlassData:
    if entry.maker == "core":
        made = AIR if entry.name == "air" else Medium(entry.name)
        return GlassData(entry.name, "core", made, note=note)
    item = Item(_catalogue(entry.maker)[entry.name], entry.name, Item({}, entry.file))
    formula = formula_of(item)
    assert formula is not None, entry
    glass = formula[0]
    absorption = absorption_of(item)
    if absorption is not None:
        glass = glass.with_absorption(*absorption)
    stated = item.value.get("catalogue", {})
    return GlassData(entry.name, entry.maker, glass, stated.get("nd"), stated.get("vd"), note)
