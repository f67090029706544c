"""How well rays are aimed through every lens of a folder: the share that passes, and the set-up.

    python bench/aim_survey.py FOLDER_OR_FILE [...] [--json] [--configurations] [--boxes]

Each lens is set up wide open, two and four stops down, for the whole frame that it was made for,
focused at 50 focal lengths. Film points are uniform over a 3:2 frame; those in the dark (below 2 %
of the brightest ring) do not count. ``fb`` counts the parts of the film where exit-pupil boxes are
drawn; set-up is CPU seconds.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

from daguerre import _core
from daguerre.errors import CoreError, DaguerreError
from daguerre.lenses.projections import projected

SAMPLES = 1 << 15
RINGS = 64


def glass(data: dict[str, Any] | None) -> _core.Glass:
    """A medium as the files write it."""
    if not data:
        return _core.Glass.constant(1.0)
    if "table" in data:
        nm, n = zip(*data["table"], strict=True)
        return _core.Glass.table(list(nm), list(n))
    if not data.get("vd"):
        return _core.Glass.constant(data["nd"])
    return _core.Glass.abbe(data["nd"], data["vd"])


def prescription(data: dict[str, Any], configuration: int) -> _core.Prescription:
    """The lens with the gaps and the stop of one of its configurations."""
    setting = data["configurations"][configuration]
    gaps = setting.get("gaps") or {}
    rows = data["surfaces"]
    stops = [i for i, s in enumerate(rows) if s["kind"] == "stop" or s.get("stop")]
    surfaces = []
    for i, s in enumerate(rows):
        stop = i == (stops[0] if stops else 0)
        semi = s.get("semi_diameter")
        if stop and setting.get("stop_semi_diameter"):
            semi = setting["stop_semi_diameter"]
        last = i + 1 == len(rows)
        gap = gaps.get(str(i), s["thickness"])
        surfaces.append(
            _core.Surface(
                1 / s["radius"] if s["radius"] else 0.0,
                0.0 if last else float(gap or 0),
                semi or math.inf,
                glass(s.get("glass")),
                stop,
                s["kind"],
                conic=s.get("conic") or 0.0,
                asphere={int(k[1:]): v for k, v in (s.get("asphere") or {}).items() if v},
            )
        )
    return _core.Prescription(data["name"], surfaces, glass(data.get("object_medium")), "mgf2", 0.0)


def half_diagonal(data: dict[str, Any], efl: float) -> float:
    """Half the diagonal of the frame that a lens was made for, mm."""
    nominal = data["nominal"]
    circle = nominal.get("image_circle_mm")
    half = circle / 2 if circle else 0.2 * efl
    angle = math.radians((nominal.get("full_field_deg") or 0) / 2)
    if not angle:
        return half
    law = nominal.get("projection") or "rectilinear"
    if law != "rectilinear":
        return min(half, float(projected(law, efl, angle)))
    return half if circle else efl * (math.tan(angle) if angle < 1.2 else angle)


def measure(
    lens: _core.Prescription, f_stop: float, half: float, boxes: bool = False
) -> dict[str, Any]:
    """One f-stop: pass fraction, rays per second, fallback and set-up."""
    efl = lens.first_order(587.5618).efl
    started = time.thread_time()
    draw = _core.PupilDraw.slope_boxes if boxes else _core.PupilDraw.aimed
    settings = _core.ExactLensSettings(
        f_stop=f_stop, focus_distance_m=0.05 * abs(efl), half_diagonal_mm=half, draw=draw
    )
    exact = _core.ExactLens(lens, settings)
    setup = time.thread_time() - started
    random = np.random.default_rng(1)
    size = 2 * half * np.array([3, 2]) / math.sqrt(13)
    film = ((random.random((SAMPLES, 2)) - 0.5) * size).astype(np.float32)
    u_lens = random.random((SAMPLES, 2)).astype(np.float32)
    nm = (380 + 400 * random.random(SAMPLES)).astype(np.float32)
    *_, weight, _ = exact.generate(film, u_lens, nm)
    ring = (np.hypot(film[:, 0], film[:, 1]) / half * RINGS).astype(int).clip(0, RINGS - 1)
    count = np.maximum(np.bincount(ring, minlength=RINGS), 1)
    light = np.bincount(ring, weight, minlength=RINGS) / count
    lit = light[ring] > 0.02 * light.max()
    return {
        "f_stop": exact.f_stop,
        "pass": float((weight > 0)[lit].mean()),
        "lit": float(lit.mean()),
        "degree": exact.aim_degree,
        "fallback": exact.aim_fallback_segments,
        "setup_seconds": setup,
    }


def survey(path: Path, every: bool, boxes: bool) -> list[dict[str, Any]]:
    """All f-stops of one file, or why it cannot be used."""
    data = json.loads(path.read_text())
    rows = []
    for c in range(len(data["configurations"]) if every else 1):
        row: dict[str, Any] = {"lens": path.stem, "configuration": c}
        try:
            lens = prescription(data, c)
            order = lens.first_order(587.5618)
            half = half_diagonal(data, abs(order.efl))
            row |= {"surfaces": len(data["surfaces"]), "half_diagonal_mm": half}
            row["stops"] = [
                measure(lens, order.f_number * 2 ** (k / 2), half, boxes) for k in (0, 2, 4)
            ]
        except (CoreError, DaguerreError) as error:
            row["error"] = str(error)
        rows.append(row)
    return rows


def print_row(row: dict[str, Any]) -> None:
    """One lens on one line."""
    name = row["lens"] + (f"#{row['configuration']}" if row["configuration"] else "")
    if "error" in row:
        print(f"{name:36} {row['error']}")
        return
    stops = "  ".join(
        f"f/{s['f_stop']:<5.3g} {s['pass']:.3f} k{s['degree']} "
        f"fb{s['fallback']:<3} {s['setup_seconds'] * 1e3:4.0f}ms"
        for s in row["stops"]
    )
    print(f"{name:36} {row['surfaces']:2} {row['half_diagonal_mm']:5.1f}  {stops}", flush=True)


def main() -> int:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("paths", nargs="+", type=Path)
    parser.add_argument("--json", action="store_true", help="one JSON object on stdout")
    parser.add_argument("--configurations", action="store_true", help="all, not the first only")
    parser.add_argument("--boxes", action="store_true", help="exit-pupil boxes, to compare")
    options = parser.parse_args()
    files: list[Path] = []
    for path in options.paths:
        files += sorted(path.glob("*.json")) if path.is_dir() else [path]
    rows = []
    for file in files:
        for row in survey(file, options.configurations, options.boxes):
            rows.append(row)
            if not options.json:
                print_row(row)
    if options.json:
        print(json.dumps({"bench": "aim_survey", "lenses": rows}))
    return 0


if __name__ == "__main__":
    sys.exit(main())
