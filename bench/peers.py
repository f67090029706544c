"""The dof-field scene through Daguerre and, where installed, its peers, in one run.

    python bench/peers.py --json [--mode thin|mb] [--w 640] [--h 360] [--spp 64] [--noise 0.1]
                          [--seeds 2] [--only daguerre] [--scene-dir DIR]
                          [--mitsuba-python PYTHON] [--blender-python PYTHON]

Pairs of seeds give the error without a reference:
relMSE = mean((A - B)^2 / 2 / (((A + B) / 2)^2 + 0.01)).
``relmse_typical`` leaves out the worst hundredth of the pixels, ``relmse_median`` is the middle
pixel. Errors are medians over the pairs, CPU seconds over the seeds.
CPU seconds to relMSE 0.01 are CPU seconds x relMSE / 0.01, as the error falls with 1 / samples.
--noise adds each renderer's own adaptive sampling, where it has one: Daguerre's --noise, and the
noise threshold of Cycles. Mitsuba 3 has none. relMSE 0.01 is a noise of 0.1.
--mode mb: 40 of the 200 objects travel and turn 45 degrees. Mitsuba 3 cannot blur shapes: left out.
Mitsuba has two rows, for its samplers ``independent`` and ``multijitter``. The ratios beside the
better of them are of all three errors.
Each renderer runs in a process of its own; Mitsuba and Cycles need an interpreter that can import
them (--mitsuba-python, --blender-python; default: this one).
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).resolve().parent
CYCLES_SAMPLES = 4096
VARIANT = "llvm_ad_rgb"
#: Rows of Mitsuba, and their samplers.
MITSUBA = {"mitsuba": "independent", "mitsuba_multijitter": "multijitter"}
DEFAULT_SCENE = HERE.parent.parent / "shared" / "peers"


def relative_mse(a: np.ndarray, b: np.ndarray) -> float:
    """Error of one of two independent renders, (H, W, 3) each, relative to their mean."""
    mean = (a + b) / 2
    return float(np.mean((a - b) ** 2 / 2 / (mean**2 + 0.01)))


def pixel_errors(a: np.ndarray, b: np.ndarray) -> dict[str, float]:
    """Errors as in `relative_mse`: of all pixels, without the worst hundredth, and median."""
    each = ((a - b) ** 2 / 2 / (((a + b) / 2) ** 2 + 0.01)).mean(axis=2)
    ranked = np.sort(each.ravel())
    return {
        "relmse": relative_mse(a, b),
        "relmse_typical": float(ranked[: len(ranked) * 99 // 100].mean()),
        "relmse_median": float(np.median(ranked)),
    }


def run(command: list[str], environment: dict[str, str], folder: str) -> dict[str, Any]:
    """Runs one renderer in a folder that it may litter; its ``RESULT {...}`` is the answer."""
    done = subprocess.run(
        command, capture_output=True, text=True, env=environment, cwd=folder, check=False
    )
    for line in reversed(done.stdout.splitlines()):
        if line.startswith("RESULT "):
            return dict(json.loads(line[7:]))
    raise RuntimeError(f"{command[1]} failed: {done.stderr.strip()[-400:]}")


def measure(
    name: str, command: list[str], options: argparse.Namespace, **extra: str
) -> dict[str, Any]:
    """Some seeds of one renderer: cost, errors, and cost to a fixed error.

    Args:
        name: Name of its files.
        command: Command that runs it.
        options: Options of this bench.
        **extra: Environment variables.
    """
    paths = [str(options.scene_dir.resolve()), *os.environ.get("PYTHONPATH", "").split(os.pathsep)]
    environment = dict(
        os.environ, PYTHONPATH=os.pathsep.join(str(Path(p).resolve()) for p in paths if p), **extra
    )
    results, pictures = [], []
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(1, options.seeds + 1):
            out = str(Path(folder) / f"{name}{seed}")
            arguments = ["--mode", options.mode, "--seed", str(seed), "--out", out]
            for option in ("w", "h", "spp", "threads"):
                arguments += [f"--{option}", str(getattr(options, option))]
            results.append(run([*command, *arguments], environment, folder))
            pictures.append(np.load(out + ".npy").astype(np.float64))
    cpu = float(np.median([r["cpu_s"] for r in results]))
    pairs = zip(pictures[::2], pictures[1::2], strict=True)
    each = [pixel_errors(a, b) for a, b in pairs]
    errors = {name: float(np.median([one[name] for one in each])) for name in each[0]}
    spp = float(np.mean([r.get("spp", options.spp) for r in results]))
    samples = pictures[0].shape[0] * pictures[0].shape[1] * spp
    return {
        "renderer": results[0]["renderer"],
        "spp": round(spp, 2),
        "cpu_s": round(cpu, 2),
        **errors,
        "cpu_s_to_relmse_0.01": round(cpu * errors["relmse"] / 0.01, 2),
        "samples_per_cpu_second": round(samples / cpu),
        "setup_seconds": results[0].get("build_s"),
        "peak_memory_mb": results[0].get("peak_rss_mb"),
        "mean": [round(float(v), 5) for v in np.mean(pictures, axis=(0, 1, 2))],
    }


def measure_cycles(options: argparse.Namespace) -> dict[str, Any]:
    """Cycles, with even sampling and with its own adaptive sampling."""
    command = [options.blender_python, str(options.scene_dir.resolve() / "r_blender.py")]
    out = {"cycles": measure("cycles", command, options)}
    if options.noise:
        with tempfile.TemporaryDirectory() as folder:
            # Run by the peer's script before it renders; the threshold is of one pixel's error.
            hook = Path(folder) / "adaptive.py"
            hook.write_text(
                f"cy.use_adaptive_sampling = True; cy.samples = {CYCLES_SAMPLES}\n"
                f"cy.adaptive_threshold = {options.noise}\n"
            )
            adaptive = measure("cycles_adaptive", command, options, CAMHOOK=str(hook))
        adaptive.pop("samples_per_cpu_second")  # it does not say how many it drew
        out["cycles_adaptive"] = adaptive
    return out


def measure_mitsuba(options: argparse.Namespace) -> dict[str, Any]:
    """Mitsuba with each of two samplers; its second picture counts, as the first compiles."""
    if options.mode == "mb" or not can_import(options.mitsuba_python, "mitsuba"):
        return {"mitsuba": None}
    program = str(options.scene_dir.resolve() / "r_mitsuba.py")
    return {
        name: measure(
            name,
            [options.mitsuba_python, program, "--variant", f"{VARIANT}:{sampler}", "--repeat", "2"],
            options,
        )
        for name, sampler in MITSUBA.items()
    }


def ratios(out: dict[str, Any]) -> dict[str, Any]:
    """CPU seconds x error over those of Mitsuba, and over the better of its samplers."""
    made: dict[str, Any] = {}
    theirs = [out[name] for name in MITSUBA if out.get(name)]
    for own in ("daguerre", "daguerre_adaptive"):
        if theirs and out.get(own):
            end = own.removeprefix("daguerre")
            found = {
                kind: [score(out[own], kind) / score(one, kind) for one in theirs]
                for kind in ("relmse", "relmse_typical", "relmse_median")
            }
            made[f"ratio_to_mitsuba{end}"] = round(found["relmse"][0], 3)
            made[f"ratio_to_better_mitsuba{end}"] = {
                kind: round(max(each), 3) for kind, each in found.items()
            }
    return made


def score(row: dict[str, Any], kind: str) -> float:
    """CPU seconds x error of a row."""
    return float(row["cpu_s"] * row[kind])


def can_import(python: str, module: str) -> bool:
    """Whether that interpreter has the module."""
    return subprocess.run([python, "-c", f"import {module}"], capture_output=True).returncode == 0


def main() -> None:
    """Parses the command line, runs what is installed and prints one JSON object."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--json", action="store_true", help="accepted for symmetry; always JSON")
    parser.add_argument("--mode", choices=("pinhole", "thin", "mb"), default="thin")
    parser.add_argument("--w", type=int, default=640, help="px")
    parser.add_argument("--h", type=int, default=360, help="px")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--seeds", type=int, default=2, help="an even number")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--noise", type=float, help="adaptive sampling too, to this error")
    parser.add_argument("--only", choices=("daguerre", "mitsuba", "cycles"))
    parser.add_argument("--scene-dir", type=Path, default=DEFAULT_SCENE)
    parser.add_argument("--mitsuba-python", default=sys.executable)
    parser.add_argument("--blender-python", default=sys.executable)
    options = parser.parse_args()
    if options.seeds < 2 or options.seeds % 2:
        parser.error(f"--seeds: wanted an even number, got {options.seeds}")
    if not (options.scene_dir / "scene.py").is_file():
        sys.exit(f"peers: no scene.py in {options.scene_dir}; name its folder with --scene-dir")
    out: dict[str, Any] = {
        "benchmark": "dof-field",
        "mode": options.mode,
        "resolution": [options.w, options.h],
        "spp": options.spp,
        "threads": options.threads,
        "machine": f"{platform.machine()}, {os.cpu_count()} cores",
    }
    if options.only in (None, "daguerre"):
        own = [sys.executable, str(HERE / "dof_field.py")]
        out["daguerre"] = measure("daguerre", own, options)
        for key in (
            "cpu_s_to_relmse_0.01",
            "samples_per_cpu_second",
            "setup_seconds",
            "peak_memory_mb",
        ):
            out[key] = out["daguerre"][key]
        if options.noise:
            noisy = [*own, "--noise", str(options.noise)]
            out["daguerre_adaptive"] = measure("daguerre_adaptive", noisy, options)
    if options.only in (None, "cycles") and can_import(options.blender_python, "bpy"):
        out |= measure_cycles(options)
    if options.only in (None, "mitsuba"):
        out |= measure_mitsuba(options)
    out |= ratios(out)
    print(json.dumps(out, indent=1))


if __name__ == "__main__":
    main()
