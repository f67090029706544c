"""A room lit through a door ajar, by Daguerre and, where installed, its peers, in one run.

    python bench/ajar.py --json [--w 240] [--h 135] [--spp 64] [--seeds 4] [--only daguerre mitsuba]
                         [--reference-spp 2048] [--mitsuba-python PYTHON] [--blender-python PYTHON]

``bench/ajar_door/room.py`` builds it: next to all light in the room has met two surfaces or more.
Errors are (A - B)^2 / 2 / (R^2 + 0.01) of pairs of seeds, R being one reference for all: Daguerre's
picture of --reference-spp samples. ``mean`` is over the frame, ``typical`` without its worst
hundredth, as a few sparks decide the mean. CPU seconds to 0.01 are CPU seconds x error / 0.01.
``of_reference`` is the picture's mean over the reference's, in the frame and in the room alone
(all that is darker than the gap of the door), where renderers should agree to 1 or 2 %.
Mitsuba has two rows, for its samplers ``independent`` and ``multijitter``;
``ratio_to_better_mitsuba`` is Daguerre's CPU seconds x error over the lower one of theirs.
Renderers take turns, seed by seed, each in a process of its own.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from peers import can_import, run

SIDES = Path(__file__).resolve().parent / "ajar_door"
#: Renderers, and the modules that they need.
MODULES = {
    "daguerre": "daguerre",
    "mitsuba": "mitsuba",
    "mitsuba_multijitter": "mitsuba",
    "cycles": "bpy",
}
BRIGHT = 3.0  # luminance of the reference, above which a pixel sees the corridor


def draw(
    name: str, seed: int, spp: int, folder: Path, options: argparse.Namespace
) -> tuple[np.ndarray, dict[str, Any]]:
    """One picture, (H, W, 3), and what its renderer said."""
    out = folder / f"{name}{seed}"
    program, _, sampler = name.partition("_")
    command = [options.pythons[name], str(SIDES / f"{program}_side.py"), "--out", str(out)]
    if program == "mitsuba":
        command += ["--sampler", sampler or "independent"]
    sizes = {"w": options.w, "h": options.h, "threads": options.threads}
    for key, value in (sizes | {"spp": spp, "seed": seed}).items():
        command += [f"--{key}", str(value)]
    said = run(command, dict(os.environ), str(folder))
    return np.load(out.with_suffix(".npy")).astype(np.float64), said


def reference(folder: Path, options: argparse.Namespace) -> np.ndarray:
    """The picture that errors are relative to, kept in --reference if that names a file."""
    path: Path | None = options.reference
    if path is None or not path.is_file():
        made, _ = draw("daguerre", 1000, options.reference_spp, folder, options)
        if path is not None:
            np.save(path, made)
        return made
    found: np.ndarray = np.load(path)
    if found.shape != (options.h, options.w, 3):
        sys.exit(f"ajar: {path}: wanted {options.w} x {options.h}, got another size")
    return found


def errors(pictures: list[np.ndarray], true: np.ndarray) -> dict[str, float]:
    """Errors of pairs of pictures, relative to the true one."""
    pairs = zip(pictures[::2], pictures[1::2], strict=True)
    each = np.mean([(a - b) ** 2 / 2 / (true**2 + 0.01) for a, b in pairs], axis=0).mean(axis=2)
    ranked = np.sort(each.ravel())
    typical = ranked[: len(ranked) * 99 // 100]
    return {"mean": float(ranked.mean()), "typical": float(typical.mean())}


def of_reference(picture: np.ndarray, true: np.ndarray) -> dict[str, list[float]]:
    """R, G, B over those of the reference."""
    within = (true @ (0.2126, 0.7152, 0.0722)) < BRIGHT
    parts = {"frame": np.ones_like(within), "room": within}
    return {
        name: [round(float(v), 4) for v in picture[part].mean(axis=0) / true[part].mean(axis=0)]
        for name, part in parts.items()
    }


def facts(
    pictures: list[np.ndarray], said: list[dict[str, Any]], true: np.ndarray
) -> dict[str, Any]:
    """One renderer's row."""
    found = errors(pictures, true)
    cpu = float(np.mean([one["cpu_s"] for one in said]))
    row = {"renderer": said[0]["renderer"], "cpu_s": round(cpu, 2), "error": found}
    row["cpu_s_to_0.01"] = {name: round(cpu * value / 0.01, 1) for name, value in found.items()}
    if "rays" in said[0]:
        row["rays"] = round(float(np.mean([one["rays"] for one in said])))
    return row | {"of_reference": of_reference(np.mean(pictures, axis=0), true)}


def ratios(out: dict[str, Any]) -> dict[str, Any]:
    """CPU seconds x error of Daguerre over the lower one of Mitsuba's samplers."""
    key = "cpu_s_to_0.01"
    theirs = [row[key] for name, row in out.items() if name.startswith("mitsuba")]
    if not theirs or "daguerre" not in out:
        return {}
    return {
        "ratio_to_better_mitsuba": {
            kind: round(own / min(one[kind] for one in theirs), 3)
            for kind, own in out["daguerre"][key].items()
        }
    }


def main() -> None:
    """Measures and prints one JSON object."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--json", action="store_true", help="accepted for symmetry; always JSON")
    parser.add_argument("--w", type=int, default=240)
    parser.add_argument("--h", type=int, default=135)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--seeds", type=int, default=4, help="an even number")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--only", nargs="+", choices=tuple(MODULES))
    parser.add_argument("--reference", type=Path, help="picture as .npy, made if it is not there")
    parser.add_argument("--reference-spp", type=int, default=2048)
    parser.add_argument("--mitsuba-python", default=sys.executable)
    parser.add_argument("--blender-python", default=sys.executable)
    options = parser.parse_args()
    if options.seeds < 2 or options.seeds % 2:
        parser.error(f"--seeds: wanted an even number, got {options.seeds}")
    named = {"mitsuba": options.mitsuba_python, "bpy": options.blender_python}
    options.pythons = {name: named.get(need, sys.executable) for name, need in MODULES.items()}
    names = [
        name for name in options.only or MODULES if can_import(options.pythons[name], MODULES[name])
    ]
    out: dict[str, Any] = {
        "benchmark": "ajar",
        "resolution": [options.w, options.h],
        "spp": options.spp,
        "threads": options.threads,
        "machine": f"{platform.machine()}, {os.cpu_count()} cores",
    }
    with tempfile.TemporaryDirectory() as folder:
        true = reference(Path(folder), options)
        drawn: dict[str, Any] = {name: ([], []) for name in names}
        for seed in range(1, options.seeds + 1):
            for name in names if seed % 2 else names[::-1]:
                picture, said = draw(name, seed, options.spp, Path(folder), options)
                drawn[name][0].append(picture)
                drawn[name][1].append(said)
    out |= {name: facts(*drawn[name], true) for name in names}
    out |= ratios(out)
    print(json.dumps(out, indent=1))


if __name__ == "__main__":
    main()
