"""The first picture's noise: error of ``scenes/night_table.py`` on its table-top, for its CPU time.

    python bench/first_picture.py --json [--spp 128] [--reference night.npy] [--light-paths auto]

The scene of ``script/demo``, through the double Gauss 50 mm at f/2, one thread. The table is the
lower third of the frame. Errors are (A - B)^2 / 2 / (R^2 + 0.01) of pairs of seeds, R being the
reference: that of --reference, which is made of --reference-spp samples where the file is not there
yet, or else the mean of all pictures. ``median`` is that of the table's pixels, ``typical`` their
mean without the worst twentieth, ``frame`` the mean of the whole picture.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

import daguerre as dg
from daguerre.rendering.session import Session

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "scenes"))

LENS, F_STOP = "double-gauss-50mm-f2", 2.0
REFERENCE_SEED = 1000


def loaded() -> tuple[dg.Scene, dg.Camera]:
    """The scene, and its camera with the lens of ``script/demo``."""
    import night_table

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "night_table.glb"
        sys.argv[1:] = [str(path)]
        night_table.main()
        scene = dg.load(path)
    return scene, scene.camera(None).with_(lens=dg.lenses.load(LENS), f_stop=F_STOP)


def draw(
    scene: dg.Scene, camera: dg.Camera, seed: int, options: argparse.Namespace, spp: int
) -> tuple[np.ndarray, float, Session]:
    """Picture, CPU seconds of its samples, and the session."""
    session = Session(
        scene,
        camera,
        resolution=(options.w, options.h),
        seed=seed,
        threads=1 if spp == options.spp else 0,
        light_paths=options.light_paths,
    )
    before = time.process_time()
    session.draw(0, spp)
    seconds = time.process_time() - before
    return session.frame().rgb.astype(np.float64), seconds, session


def reference(scene: dg.Scene, camera: dg.Camera, options: argparse.Namespace) -> np.ndarray | None:
    """The picture that errors are relative to, if one is asked for."""
    path: Path | None = options.reference
    if path is None:
        return None
    if not path.is_file():
        np.save(path, draw(scene, camera, REFERENCE_SEED, options, options.reference_spp)[0])
    found: np.ndarray = np.load(path)
    if found.shape != (options.h, options.w, 3):
        sys.exit(f"first_picture: {path}: wanted {options.w} x {options.h}, got another size")
    return found


def facts(pictures: list[np.ndarray], true: np.ndarray) -> dict[str, float]:
    """Errors of pairs of pictures."""
    pairs = zip(pictures[::2], pictures[1::2], strict=True)
    each = np.mean([(a - b) ** 2 / 2 / (true**2 + 0.01) for a, b in pairs], axis=0).mean(axis=2)
    table = np.sort(each[each.shape[0] * 2 // 3 :].ravel())
    return {
        "table": float(table.mean()),
        "typical": float(table[: len(table) * 19 // 20].mean()),
        "median": float(np.median(table)),
        "frame": float(each.mean()),
    }


def main() -> None:
    """Measures and prints one JSON object."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--json", action="store_true", help="accepted for symmetry; always JSON")
    parser.add_argument("--w", type=int, default=240)
    parser.add_argument("--h", type=int, default=135)
    parser.add_argument("--spp", type=int, default=128)
    parser.add_argument("--seeds", type=int, default=2, help="an even number")
    parser.add_argument("--light-paths", default="auto", help="or off, or M1,M2")
    parser.add_argument("--reference", type=Path, help="picture as .npy, made if it is not there")
    parser.add_argument("--reference-spp", type=int, default=2048)
    options = parser.parse_args()
    if options.seeds < 2 or options.seeds % 2:
        parser.error(f"--seeds: wanted an even number, got {options.seeds}")
    scene, camera = loaded()
    true = reference(scene, camera, options)
    pictures, seconds = [], []
    for seed in range(1, options.seeds + 1):
        picture, cpu, session = draw(scene, camera, seed, options, options.spp)
        pictures.append(picture)
        seconds.append(cpu)
    found: dict[str, Any] = {
        "spp": options.spp,
        "cpu_s": round(float(np.median(seconds)), 2),
        "rays_per_sample": session.counters.rays / session.counters.camera_rays,
        "light_paths": session.light_paths,
        "mean": [round(float(v), 5) for v in np.mean(pictures, axis=(0, 1, 2))],
        **facts(pictures, np.mean(pictures, axis=0) if true is None else true),
    }
    print(json.dumps(found))


if __name__ == "__main__":
    main()
