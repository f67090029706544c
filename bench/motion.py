"""Cost of motion: CPU seconds and memory of scenes that move over the same scenes at rest.

    python bench/motion.py --json [--only CASE] [--repeats 3] [--spp 16] [--scene-dir DIR]
                           [--baseline PYTHON]

Cases: ``mb``, the dof-field scene of ``bench/peers.py`` with 40 of its 200 objects travelling and
turning 45 degrees, over the still scene; ``pan``, its camera turning by 2 degrees, over its camera
at rest; ``spins``, 10,000 instances that spin 20 times a second, over the same at rest; ``still``,
the still scene through this build over another one, whose interpreter is named by --baseline.

Both sides run in processes of their own, in turn (A B B A ...), with equal samples. A ratio is the
median over the pairs; --json tells each of them. Memory is a process's peak above what it
held after its imports.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).resolve().parent
DEFAULT_SCENE = HERE.parent.parent / "shared" / "peers"
DOF_FIELD = str(HERE / "dof_field.py")
SHUTTER = 1 / 48  # s
GRID = 100  # instances along each side
CASES = ("mb", "pan", "spins", "still")


def child(command: list[str], options: argparse.Namespace) -> dict[str, Any]:
    """Runs one side; its ``RESULT {...}`` is the answer."""
    paths = [str(options.scene_dir.resolve()), *os.environ.get("PYTHONPATH", "").split(os.pathsep)]
    where = os.pathsep.join(str(Path(p).resolve()) for p in paths if p)
    sizes = [f"--{name}={getattr(options, name)}" for name in ("w", "h", "spp", "threads")]
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            [*command, *sizes, "--out", str(Path(folder) / "out")],
            capture_output=True,
            text=True,
            env=dict(os.environ, PYTHONPATH=where),
            cwd=folder,
            check=False,
        )
    for line in reversed(done.stdout.splitlines()):
        if line.startswith("RESULT "):
            return dict(json.loads(line[7:]))
    raise SystemExit(f"motion: {' '.join(command)} failed: {done.stderr.strip()[-400:]}")


def compare(a: list[str], b: list[str], options: argparse.Namespace) -> dict[str, Any]:
    """B over A: CPU of drawing, CPU with set-up, and memory."""
    pairs = []
    for k in range(options.repeats):
        first, second = (a, b) if k % 2 == 0 else (b, a)
        results = [child(first, options), child(second, options)]
        pairs.append(results if k % 2 == 0 else results[::-1])

    def ratio(key: str) -> tuple[float, list[float]]:
        ratios = [after[key] / before[key] for before, after in pairs]
        return round(statistics.median(ratios), 3), [round(r, 3) for r in ratios]

    cpu, each = ratio("cpu_s")
    out = {"cpu_ratio": cpu, "cpu_ratios": each}
    if all("scene_rss_mb" in side for pair in pairs for side in pair):
        out["memory_ratio"] = ratio("scene_rss_mb")[0]
    for name, side in (("before", 0), ("after", 1)):
        out[name] = {
            key: statistics.median(pair[side][key] for pair in pairs)
            for key in ("cpu_s", "build_s", "peak_rss_mb", "scene_rss_mb", "mean")
            if key in pairs[0][side]
        }
    return out


def spins(options: argparse.Namespace) -> None:
    """The side of ``spins``: 10,000 rings of 1,536 triangles on a plane, seen from above."""
    import dof_field  # type: ignore[import-not-found]
    import scene as peers_scene  # type: ignore[import-not-found]

    import daguerre as dg

    def rss() -> float:
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024

    imported, rng = rss(), np.random.default_rng(3)
    scene = dg.Scene(time=SHUTTER / 2)
    ground = scene.add_mesh(dof_field.QUAD * GRID, [(0, 1, 2), (0, 2, 3)])
    scene.add_instance(ground, dg.Diffuse((0.4, 0.4, 0.4)))
    mesh = scene.add_mesh(*peers_scene.torusknot(64, 12))
    paints = [scene.add_material(dg.Diffuse(tuple(rng.uniform(0.1, 0.8, 3)))) for _ in range(8)]
    for k in range(GRID * GRID):
        x, y = np.divmod(k, GRID) - np.array((GRID - 1) / 2)
        turned = peers_scene.rot(rng.normal(size=3), rng.uniform(0, 6))
        place = peers_scene.trans((x, y, 0.5)) @ turned @ np.diag((0.4, 0.4, 0.4, 1.0))
        motion = dg.spin(rng.normal(size=3), 20.0, transform=place)
        if options.side == "rest":
            motion = motion.at(scene.time)
        scene.add_instance(mesh, paints[k % 8], motion)
    scene.set_environment(color=(0.6, 0.7, 0.9))
    transform = peers_scene.lookat(*map(np.array, ((0, -60.0, 25), (0, -12.0, 0), (0, 0, 1))))
    camera = dg.Camera(transform=transform, lens="pinhole", f_stop=None, shutter_time=SHUTTER)
    report(dg, scene, camera, options, imported)


def report(dg: Any, scene: Any, camera: Any, options: argparse.Namespace, imported: float) -> None:
    """Draws and prints what it took."""
    from daguerre.rendering.session import Session

    def cpu_seconds() -> float:
        usage = resource.getrusage(resource.RUSAGE_SELF)
        return usage.ru_utime + usage.ru_stime

    size, started = (options.w, options.h), time.perf_counter()
    session = Session(
        scene, camera, resolution=size, seed=1, filter="box", threads=options.threads, max_depth=8
    )
    built, cpu = time.perf_counter() - started, cpu_seconds()
    session.draw(0, options.spp)
    cpu = cpu_seconds() - cpu
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    result = {
        "cpu_s": round(cpu, 3),
        "build_s": round(built, 3),
        "peak_rss_mb": round(peak),
        "scene_rss_mb": round(peak - imported, 1),
        "mean": float(session.frame().rgb.mean()),
    }
    print("RESULT " + json.dumps(result), flush=True)


def measure(case: str, options: argparse.Namespace) -> dict[str, Any] | None:
    """One case."""
    thin = [sys.executable, DOF_FIELD, "--mode", "thin"]
    if case in ("mb", "pan"):
        return compare(thin, [sys.executable, DOF_FIELD, "--mode", case], options)
    if case == "spins":
        own = [sys.executable, str(HERE / "motion.py"), "--side"]
        return compare([*own, "rest"], [*own, "spin"], options)
    if options.baseline is None:
        return None
    return compare([options.baseline, DOF_FIELD, "--mode", "thin"], thin, options)


def main() -> None:
    """Measures the cases and prints one JSON object."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--json", action="store_true", help="accepted for symmetry; always JSON")
    parser.add_argument("--only", action="append", choices=CASES)
    parser.add_argument("--repeats", type=int, default=3, help="pairs of runs")
    parser.add_argument("--w", type=int, default=480, help="px")
    parser.add_argument("--h", type=int, default=270, help="px")
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--scene-dir", type=Path, default=DEFAULT_SCENE)
    parser.add_argument("--baseline", help="interpreter of an older build")
    parser.add_argument("--side", choices=("rest", "spin"), help=argparse.SUPPRESS)
    parser.add_argument("--out", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.side:
        return spins(options)
    if not (options.scene_dir / "scene.py").is_file():
        sys.exit(f"motion: no scene.py in {options.scene_dir}; name its folder with --scene-dir")
    out: dict[str, Any] = {
        "benchmark": "motion",
        "resolution": [options.w, options.h],
        "spp": options.spp,
    }
    for case in options.only or CASES:
        out[case] = measure(case, options)
    print(json.dumps(out, indent=1))
    return None


if __name__ == "__main__":
    main()
