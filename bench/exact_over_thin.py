"""The exact lens beside the thin one: what real glass costs on the dof-field scene.

    python bench/exact_over_thin.py --json [--spp 16] [--filter blackman_harris] [--scene-dir DIR]

Both look through the double Gauss 50 mm at f/2: every surface, with dispersion and coatings,
against a thin lens of the same focal length. Two seeds each, in turn, on one thread. Error is
relMSE = mean((A - B)^2 / 2 / (((A + B) / 2)^2 + 0.01)); CPU seconds to relMSE 0.01 are
CPU seconds x relMSE / 0.01, as the error falls with 1 / samples.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import sys
from pathlib import Path
from typing import Any

import numpy as np
from peers import DEFAULT_SCENE, relative_mse

import daguerre as dg
from daguerre.rendering.session import Session

LENS = "double-gauss-50mm-f2"
F_STOP = 2.0


def main() -> None:
    """Parses the command line, renders, and prints one JSON object."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--json", action="store_true", help="accepted for symmetry; always JSON")
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--w", type=int, default=640)
    parser.add_argument("--h", type=int, default=360)
    parser.add_argument("--filter", default="blackman_harris")
    parser.add_argument("--scene-dir", type=Path, default=DEFAULT_SCENE)
    options = parser.parse_args()
    if not (options.scene_dir / "scene.py").is_file():
        sys.exit(f"exact_over_thin: no scene.py in {options.scene_dir}; name it with --scene-dir")
    sys.path.insert(0, str(options.scene_dir))
    from dof_field import build, camera, cpu_seconds

    scene, lens = build("thin"), dg.lenses.load(LENS)
    cameras = {
        model: camera("thin").with_(lens=lens, lens_model=model, f_stop=F_STOP)
        for model in ("exact", "thin")
    }
    seconds: dict[str, list[float]] = {model: [] for model in cameras}
    pictures: dict[str, list[np.ndarray]] = {model: [] for model in cameras}
    for seed in (1, 2):
        for model, view in cameras.items():
            session = Session(
                scene,
                view,
                resolution=(options.w, options.h),
                seed=seed,
                filter=options.filter,
                threads=1,
                max_depth=8,
            )
            started = cpu_seconds()
            session.draw(0, options.spp)
            seconds[model].append(cpu_seconds() - started)
            pictures[model].append(session.frame().rgb.astype(np.float64))
    out: dict[str, Any] = {
        "benchmark": "exact over thin",
        "lens": LENS,
        "f_stop": F_STOP,
        "spp": options.spp,
        "filter": options.filter,
        "machine": f"{platform.machine()}, {os.cpu_count()} cores",
    }
    for model in cameras:
        cpu, error = float(np.mean(seconds[model])), relative_mse(*pictures[model])
        out[f"{model}_cpu_s"] = round(cpu, 2)
        out[f"{model}_relmse"] = error
        out[f"{model}_cpu_s_to_relmse_0.01"] = round(cpu * error / 0.01, 2)
    out["cpu_ratio_equal_spp"] = round(out["exact_cpu_s"] / out["thin_cpu_s"], 3)
    key = "cpu_s_to_relmse_0.01"
    out["cpu_ratio_to_relmse"] = round(out[f"exact_{key}"] / out[f"thin_{key}"], 3)
    print(json.dumps(out, indent=1))


if __name__ == "__main__":
    main()
