"""The agreement of each lens with its product, which the package has."""

from __future__ import annotations

import json
from collections.abc import Iterable
from functools import cache
from typing import Any

import numpy as np

from daguerre import lenses

Row = dict[str, Any]


def text(rows: Row) -> str:
    """The file's text, with a line for each lens."""
    found = {name: json.dumps(one) for name, one in sorted(agreements(rows).items())}
    lines = ",\n".join(f'    "{name}": {one}' for name, one in found.items())
    return f'{{\n  "made_by": "script/docs/make-measured",\n  "lenses": {{\n{lines}\n  }}\n}}\n'


def agreements(rows: Row) -> dict[str, Row]:
    """Medians of each lens over the settings of its own product, else over those of a relative."""
    return {
        name: agreement(name, rows) for name in dict.fromkeys(r["lens"] for r in rows["distortion"])
    }


def agreement(lens: str, rows: Row) -> Row:
    """Members of ``daguerre.lenses.agreement.Agreement``."""
    match = min(r["match"] for r in rows["distortion"] if r["lens"] == lens)
    own = {
        name: [r for r in rows[name] if r["lens"] == lens and "error" not in r]
        for name in ("distortion", "colour", "vignetting", "magnification")
    }
    of = {name: [r for r in found if r.get("match", match) == match] for name, found in own.items()}
    light = {k: [r for r in of["vignetting"] if r["kind"] == k] for k in ("open", "stopped")}
    found: Row = {
        "distortion_px": median(r["px"] for r in of["distortion"]),
        "red_px": median(r["red_px"] for r in of["colour"]),
        "blue_px": median(r["blue_px"] for r in of["colour"]),
        "open_ev": median(r["ev"] for r in light["open"]),
        "stopped_ev": median(abs(r["corner_ev"]) for r in light["stopped"]),
        "magnification": median(r["predicted"] for r in of["magnification"]),
        "stated": median(r["magnification"] for r in of["magnification"]),
    }
    known = {name: value for name, value in found.items() if value is not None}
    return {"product": match, **known, "fitted": fitted(lens)}


def median(values: Iterable[float]) -> float | None:
    """Median, to four digits; None without values."""
    known = list(values)
    return float(f"{np.median(known):.4g}") if known else None


@cache
def fitted(name: str) -> list[str]:
    """Quantities to which the lens's file says that a part was fitted."""
    found = set()
    for member, value in lenses.load(name).data.items():
        parts = value if isinstance(value, list) else [value]
        if any(isinstance(part, dict) and part.get("fitted") for part in parts):
            found.add("magnification" if member == "configurations" else "vignetting")
    return sorted(found)
