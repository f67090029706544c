# SPDX-License-Identifier: GPL-3.0-or-later
"""Facts of the chosen lens, and warnings where other choices do not fit it."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

import bpy

from daguerre import lenses
from daguerre.camera.ideal import IDEAL
from daguerre.errors import InputError
from daguerre.lenses import library
from daguerre.lenses.checking import SPILL
from daguerre.lenses.engraved import ROUNDED
from daguerre.lenses.errors import LensError
from daguerre.lenses.image_circle import stated_half_image

from .reports import told

#: Lenses that a user can choose and that have no prescription.
PLAIN = ("blender", *IDEAL)


@dataclass(frozen=True)
class Facts:
    """A lens with a prescription.

    Attributes:
        lens: The lens, at its zoom.
        year: Year of product or patent; None: unknown.
        range_mm: Shortest and longest focal length, mm; None: not a zoom.
        circle_mm: Diameter of its image circle, mm; None: unknown.
        zoom_fault: Reason why the lens stands at the zoom of its file instead; empty: it does not.
    """

    lens: lenses.Lens = field(repr=False)
    year: int | None
    range_mm: tuple[float, float] | None
    circle_mm: float | None
    zoom_fault: str = ""

    @property
    def f_number(self) -> float:
        """Widest f-stop at this zoom."""
        return self.lens.first_order().f_number

    def lines(self) -> Iterator[tuple[str, str]]:
        """Names and values of what a photographer asks first."""
        if self.year:
            yield "Year", str(self.year)
        yield "Widest stop", f"f/{self.f_number:.3g}"
        ends = self.range_mm or (self.lens.first_order().efl,)
        yield "Focal length", " to ".join(f"{end:.4g}" for end in ends) + " mm"
        yield "Image circle", f"{self.circle_mm:.3g} mm" if self.circle_mm else "not known"


def key_of(group: Any) -> tuple[str, int, float] | None:
    """Name or file of the chosen lens, time of the file, ns, and zoom, mm; None: an ideal lens."""
    if group.lens in PLAIN:
        return None
    name, changed = group.lens, 0
    if name == "file":
        path = Path(bpy.path.abspath(group.lens_file)) if group.lens_file else Path()
        name, changed = str(path), path.stat().st_mtime_ns if path.is_file() else 0
    return name, changed, round(group.zoom, 3)


def of(group: Any) -> Facts | str | None:
    """Facts of a camera's lens; a text: why it cannot be used; None: it is an ideal lens."""
    key = key_of(group)
    return None if key is None else _facts(*key)


@lru_cache(maxsize=32)
def _facts(name: str, changed: int, zoom: float) -> Facts | str:
    try:
        if name == ".":
            raise InputError("lens file: wanted one, got none")
        return _read(name, zoom)
    except Exception as error:  # whatever it is, the panel shows a sentence
        return told(error)


def _read(name: str, zoom: float) -> Facts:
    lens = lenses.load(name)
    entry = next((one for one in library.entries() if one.name == name), None)
    try:
        stands, fault = lens.at_zoom(zoom) if zoom else lens, ""
    except LensError as error:
        stands, fault = lens, f"Zoom: {error.message.rpartition('zoom: ')[2]}"
    return Facts(stands, entry.year if entry else None, lens.zoom_range_mm, _circle(lens), fault)


def _circle(lens: lenses.Lens) -> float | None:
    """Diameter of the image circle, mm, by the source's words; None: it says nothing."""
    half = stated_half_image(lens, lens.first_order())
    return None if half is None else 2 * half


def warnings(group: Any, reach_mm: float) -> dict[str, str]:
    """Choices that do not fit the lens, by the name of their property.

    Args:
        group: Properties of a camera.
        reach_mm: Largest distance of the film from the lens's axis, mm.
    """
    facts = of(group)
    if not isinstance(facts, Facts):
        return {}
    pairs = [("zoom", facts.zoom_fault)]
    if group.lens_model not in IDEAL:  # which have the lens's focal length alone
        pairs += [_stop(group, facts), ("sensor", _film(facts, reach_mm))]
    return {name: text for name, text in pairs if text}


def _stop(group: Any, facts: Facts) -> tuple[str, str]:
    name = "t_stop" if group.use_t_stop else "f_stop"
    widest = facts.lens.t_stop() if group.use_t_stop else facts.f_number
    if getattr(group, name) >= ROUNDED * widest:
        return name, ""
    return name, f"Wider than the lens opens: {name[0]}/{widest:.3g}"


def _film(facts: Facts, reach_mm: float) -> str:
    circle = facts.circle_mm or math.inf
    if 2 * reach_mm <= SPILL * circle:
        return ""
    return (
        f"Needs an image circle of {2 * reach_mm:.3g} mm, the lens has {circle:.3g}: dark corners"
    )
