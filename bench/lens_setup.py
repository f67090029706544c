"""Set-up of lenses, and the data sheet of one lens.

    python bench/lens_setup.py --json [--only KIND ...] [--no-sheet]

From the file's name to a lens that draws rays (parse, zoom, focus, fit), nothing kept from before;
3 m away, wide open, for the whole film. CPU seconds of one thread, the shortest of several, imports
not counted. The data sheet is launch to file of ``daguerre lens NAME --plot``, wall seconds,
imports counted.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import daguerre as dg
from daguerre import _core


@dataclass(frozen=True)
class Case:
    """A lens as it is set up; ``wanted_s`` is the time that a cold one may take."""

    lens: str
    wanted_s: float
    zoom_mm: float | None = None
    tilt_deg: tuple[float, float] = (0.0, 0.0)


CASES = {
    "axial": Case("double-gauss-50mm-f2", 0.1),
    "zoom": Case("nikon-af-s-70-200mm-f2.8", 0.3, 120.0),
    "fisheye": Case("olympus-zuiko-fisheye-8mm-f2.8", 0.5),
    "tilted": Case("canon-ts-e-90mm-f2.8-macro", 2.0, tilt_deg=(8.0, 0.0)),
    "anamorphic": Case("schneider-anamorphic-60mm", 2.0),
}
SHEET_WANTED_S = 5.0
SHEET = "double-gauss-50mm-f2"


def set_up(case: Case) -> _core.ExactLens:
    """The lens from its name."""
    focused = dg.lenses.load(case.lens).focused(3.0, zoom_mm=case.zoom_mm)
    film = [float(s) for s in (focused.lens.data.get("format") or "36x24").split("x")]

    settings = _core.ExactLensSettings(
        half_diagonal_mm=0.51 * math.hypot(*film),
        film_z_mm=focused.film_z_mm,
        tilt_deg=case.tilt_deg,
        film_half_mm=(0.51 * film[0], 0.51 * film[1]),
    )
    return _core.ExactLens(focused.lens.prescription, settings)


def shortest(action: Callable[[], Any], times: int) -> float:
    """CPU seconds of the quickest of several."""
    found = []
    for _ in range(times):
        started = time.thread_time()
        action()
        found.append(time.thread_time() - started)
    return min(found)


def measure(case: Case, repeats: int) -> dict[str, Any]:
    """One kind of lens."""
    return {
        "lens": case.lens,
        "cold_seconds": shortest(lambda: set_up(case), repeats),
        "cold_wanted": case.wanted_s,
    }


def sheet_seconds() -> float:
    """Launch to file of one data sheet."""
    with tempfile.TemporaryDirectory() as folder:
        started = time.perf_counter()
        command = [sys.executable, "-m", "daguerre.cli", "lens", SHEET]
        command += ["--plot", str(Path(folder) / "sheet.pdf")]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        return time.perf_counter() - started


def run(kinds: list[str], repeats: int, sheet: bool) -> dict[str, Any]:
    """The whole measurement as one JSON object."""
    found: dict[str, Any] = {"bench": "lens_setup"}
    found["lenses"] = {kind: measure(CASES[kind], repeats) for kind in kinds}
    if sheet:
        found["sheet"] = {"lens": SHEET, "seconds": sheet_seconds(), "wanted": SHEET_WANTED_S}
    found["version"] = dg.__version__
    return found


def main() -> int:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--json", action="store_true", help="one JSON object on stdout")
    parser.add_argument("--only", nargs="+", choices=list(CASES), default=list(CASES))
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--no-sheet", action="store_true")
    options = parser.parse_args()
    result = run(options.only, options.repeats, not options.no_sheet)
    if options.json:
        print(json.dumps(result))
        return 0
    for kind, case in result["lenses"].items():
        print(
            f"{kind:11} {case['lens']:32} {case['cold_seconds'] * 1e3:6.0f} ms "
            f"({case['cold_wanted'] * 1e3:.0f})"
        )
    if "sheet" in result:
        print(f"data sheet  {result['sheet']['seconds']:.1f} s ({result['sheet']['wanted']:g})")
    return 0


if __name__ == "__main__":
    sys.exit(main())
