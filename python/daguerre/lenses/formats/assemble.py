"""Builds a lens file from drafts of surfaces and configurations."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from daguerre.files.json_item import clean
from daguerre.lenses.errors import LensError

from .draft import FAR, Draft, SurfacePose, Table, lay_out, surface, with_thicknesses
from .pupil import Pupil, size_stops
from .text import Unread

SCHEMA = "daguerre-lens/0.1"


@dataclass
class Configuration:
    """A zoom or focus position of an imported file.

    Attributes:
        thicknesses: Thicknesses that differ, mm, by the surface's number in the file.
        stop_semi_diameter: Semi-diameter of the stop, mm, if its size changes.
    """

    name: str
    thicknesses: dict[int, float] = field(default_factory=dict)
    pupil: Pupil | None = None
    stop_semi_diameter: float | None = None
    facts: dict[str, Any] = field(default_factory=dict)


def lens_file(
    file: str,
    name: str,
    drafts: list[Draft],
    configurations: list[Configuration],
    unread: Unread,
    nominal: dict[str, Any] | None = None,
    **more: object,
) -> dict[str, Any]:
    """Builds a lens file of the schema with all configurations; the drafts have the first's gaps.

    Args:
        file: Name of the imported file, for messages.
        name: Name of the lens.
        drafts: The object, the surfaces, the image.
        configurations: Zoom or focus positions, at least one.
        unread: Collects notes on ignored content.
        nominal: Nominal values that the file states.
        more: Further members of the lens file.
    """
    tables = [lay_out(with_thicknesses(drafts, c.thicknesses), file) for c in configurations]
    for c, table in zip(configurations, tables, strict=True):
        _check_gaps(file, c, table)
    base = tables[0]
    placed = zip(base.drafts, base.gaps, base.places, strict=True)
    data: dict[str, Any] = {"schema": SCHEMA, "name": clean(name) or "lens", **more}
    data["nominal"] = nominal or {}
    if drafts[0].glass is not None:
        data["object_medium"] = drafts[0].glass
    data["surfaces"] = [surface(draft, gap, place) for draft, gap, place in placed]
    _fit_apertures(data["surfaces"], unread)
    data["configurations"] = []
    for c, table in zip(configurations, tables, strict=True):
        if not _same_places(base, table):
            unread.add("a configuration that decentres or tilts surfaces is ignored", clean(c.name))
        else:
            data["configurations"].append(_configuration(c, table, base, data["configurations"]))
    _film_note(base, unread)
    if drafts[-1].curvature != 0:
        unread.add("the image surface is curved; the film is taken as flat")
    size_stops(data, file, [c.pupil for c in configurations])
    return data


def _configuration(
    c: Configuration, table: Table, base: Table, others: list[dict[str, Any]]
) -> dict[str, Any]:
    name, taken = clean(c.name), {other["name"] for other in others}
    count = 2
    while name in taken:
        name, count = f"{clean(c.name)} ({count})", count + 1
    far = not math.isfinite(table.object_distance) or table.object_distance >= FAR
    out: dict[str, Any] = {
        "name": name,
        "gaps": {
            str(i): gap
            for i, (gap, first) in enumerate(zip(table.gaps, base.gaps, strict=True))
            if gap != first
        },
        "object_distance_mm": None if far else table.object_distance,
        **c.facts,
    }
    if c.stop_semi_diameter is not None:
        out["stop_semi_diameter"] = c.stop_semi_diameter
    return out


def _check_gaps(file: str, c: Configuration, table: Table) -> None:
    for draft, gap in zip(table.drafts[:-1], table.gaps[:-1], strict=True):
        if gap < 0:
            raise LensError(
                f"{file}: {clean(c.name)}: surface {draft.number}: thickness: wanted at least "
                f"0 mm to the next surface, got {gap:g}",
                "lens-overlap",
                draft.number,
            )


def _same_places(a: Table, b: Table) -> bool:
    if [d.number for d in a.drafts] != [d.number for d in b.drafts]:
        return False
    zero = SurfacePose([0.0] * 3, [0.0] * 3)
    return all(
        np.allclose(p or zero, q or zero, rtol=0, atol=1e-9)
        for p, q in zip(a.places, b.places, strict=True)
    )


def _fit_apertures(surfaces: list[dict[str, Any]], unread: Unread) -> None:
    """Cuts clear diameters that exceed the sphere's diameter."""
    for row in surfaces:
        radius, semi = row["radius"], row["semi_diameter"]
        sphere = row["kind"] == "spherical" and radius is not None
        if sphere and semi is not None and semi > abs(radius):
            row["semi_diameter"] = abs(radius)
            unread.add(
                "a clear diameter is reduced to the diameter of the sphere",
                f"surface {row['from']}",
            )


def _film_note(table: Table, unread: Unread) -> None:
    if table.film is not None:
        decenter, tilt = table.film
        unread.add(
            "the film is decentred by "
            + ", ".join(f"{v:.4g}" for v in decenter[:2])
            + " mm and tilted by "
            + ", ".join(f"{v:.4g}" for v in tilt)
            + " degrees; it is taken as square to the axis of the first surface"
        )
