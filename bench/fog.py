"""Fog around the night table: CPU time to equal error, against the same without fog.

    python bench/fog.py --json [--extinction 0.05 0.2] [--spp 16] [--seeds 4] [--w 192] [--h 128]

The scene is that of the demo, scenes/night_table.py, through the double Gauss 50 mm at f/2. Fog
fills the world: --extinction per metre, nine tenths of it scattered, by one lobe of mean cosine
0.7.
Both sides draw --spp samples per pixel with each seed, in turn, on one thread.

Error is relMSE = mean((A - B)^2 / 2 / (R^2 + 0.01)) of pairs of seeds A and B, where R is the mean
of all pictures of that side. CPU seconds to relMSE 0.01 are CPU seconds x relMSE / 0.01, as the
error falls with 1 / samples. --clip cuts the worst share of the pixels' errors off on both sides:
rare bright paths through the glasses make the plain mean wander from seed to seed.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import resource
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

import daguerre as dg
from daguerre.rendering.session import Session

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "scenes"))
LENS = "double-gauss-50mm-f2"
F_STOP = 2.0
ALBEDO = 0.9
MEAN_COSINE = 0.7
WANTED = 2.0


def cpu_seconds() -> float:
    """User and system time of this process."""
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def night_table(extinction: float) -> tuple[dg.Scene, dg.Camera]:
    """The demo's scene in fog, and its camera; 0: no fog."""
    import night_table as script

    with tempfile.TemporaryDirectory() as folder:
        script.write(Path(folder) / "scene.glb")
        scene = dg.load(Path(folder) / "scene.glb")
    if extinction > 0:
        scattering = (ALBEDO * extinction,) * 3
        absorption = ((1 - ALBEDO) * extinction,) * 3
        scene.set_fog(dg.Medium(absorption, scattering, lobes=((MEAN_COSINE, 1.0),)))
    return scene, scene.camera("Camera").with_(lens=dg.lenses.load(LENS), f_stop=F_STOP)


def draw(scene: dg.Scene, camera: dg.Camera, seed: int, options: Any) -> tuple[np.ndarray, float]:
    """Picture, and CPU seconds of drawing."""
    session = Session(
        scene, camera, resolution=(options.w, options.h), seed=seed, threads=1, max_depth=8
    )
    started = cpu_seconds()
    session.draw(0, options.spp)
    return session.frame().rgb.astype(np.float64), cpu_seconds() - started


def errors(pictures: list[np.ndarray], clip: float) -> float:
    """Mean relMSE of pairs of pictures, without the worst share of their pixels."""
    reference = np.mean(pictures, axis=0)
    squares = np.mean(
        [
            (a - b) ** 2 / 2 / (reference**2 + 0.01)
            for a, b in zip(pictures[::2], pictures[1::2], strict=True)
        ],
        axis=(0, 3),
    ).ravel()
    return float(np.sort(squares)[: squares.size - int(clip * squares.size)].mean())


def compare(extinctions: list[float], options: Any) -> dict[str, Any]:
    """Cost, error, and cost to relMSE 0.01 of each fog, all in turn."""
    sides = {extinction: night_table(extinction) for extinction in (0.0, *extinctions)}
    pictures: dict[float, list[np.ndarray]] = {side: [] for side in sides}
    seconds: dict[float, list[float]] = {side: [] for side in sides}
    for seed in range(1, options.seeds + 1):
        for side in list(sides)[:: 1 if seed % 2 else -1]:
            picture, cpu = draw(*sides[side], seed, options)
            pictures[side].append(picture)
            seconds[side].append(cpu)
    out: dict[str, Any] = {}
    costs: dict[str, dict[float, float]] = {"plain": {}, "clipped": {}}
    for side in sides:
        cpu = float(np.median(seconds[side]))
        found = {
            "plain": errors(pictures[side], 0),
            "clipped": errors(pictures[side], options.clip),
        }
        for name, error in found.items():
            costs[name][side] = cpu * error / 0.01
        out[f"{side:g}"] = {
            "cpu_s": round(cpu, 2),
            "relmse": found["plain"],
            "relmse_clipped": found["clipped"],
            "mean": pictures[side][0].mean(axis=(0, 1)).round(4).tolist(),
            "cpu_ratio_equal_spp": round(cpu / float(np.median(seconds[0.0])), 3),
            "times_without": round(costs["plain"][side] / costs["plain"][0.0], 3),
            "times_without_clipped": round(costs["clipped"][side] / costs["clipped"][0.0], 3),
        }
    return out


def main() -> None:
    """Measures and prints one JSON object."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--json", action="store_true", help="accepted for symmetry; always JSON")
    parser.add_argument("--extinction", type=float, nargs="+", default=[0.05, 0.2], help="1/m")
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--seeds", type=int, default=4, help="an even number")
    parser.add_argument("--clip", type=float, default=0.01, help="share of pixels")
    parser.add_argument("--w", type=int, default=192)
    parser.add_argument("--h", type=int, default=128)
    options = parser.parse_args()
    out: dict[str, Any] = {
        "benchmark": "fog",
        "lens": LENS,
        "f_stop": F_STOP,
        "spp": options.spp,
        "machine": f"{platform.machine()}, {os.cpu_count()} cores",
        "wanted": WANTED,
    }
    print(json.dumps(out | compare(options.extinction, options), indent=1))


if __name__ == "__main__":
    main()
