"""Cost of a camera that is known by a calibration over a pinhole.

    python bench/projections.py --json [--rounds 20] [--spp 2] [--f-stop N]

Every model sees the chess set in daylight with the same field across, in the same picture; the
pinhole, or with ``--f-stop`` the thin lens, is drawn before each of them. One thread, processor
time: medians over the rounds, by turns, of the time of a model over that of the pinhole before it,
and the standard error of that median. Wanted: at most 1.05.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

import numpy as np

import daguerre as dg
from daguerre.rendering.session import Session

DATA = Path(__file__).resolve().parents[2] / "shared" / "data"
CHESS, SUNSET = DATA / "scenes/open_chess_set_512.glb", DATA / "hdri/pmndrs_sunset.hdr"
SIZE, FIELD = (480, 270), 40.0  # px; degrees across
#: name -> model and parameters
MODELS: dict[str, tuple[str, tuple[float, ...]]] = {
    "rectilinear": ("rectilinear", ()),
    "equidistant": ("equidistant", ()),
    "equisolid": ("equisolid", ()),
    "stereographic": ("stereographic", ()),
    "orthographic": ("orthographic", ()),
    "opencv 5": ("opencv", (-0.28, 0.09, 1e-3, -2e-3, -0.01)),
    "opencv 8": ("opencv", (0.1, -0.05, 1e-3, -2e-3, 0.01, 0.12, -0.03, 0.004)),
    "opencv 14": (
        "opencv",
        (*(0.1, -0.05, 1e-3, -2e-3, 0.01, 0.12, -0.03, 4e-3), 2e-3, 0, -1e-3, 0, 0.01, -0.02),
    ),
    "opencv_inverse": ("opencv_inverse", (0.1, -0.02, 1e-3, -2e-3, 0.01)),
    "kannala_brandt": ("kannala_brandt", (0.01, -0.003, 0.001, -2e-4)),
    "double_sphere": ("double_sphere", (-0.2, 0.58)),
    "eucm": ("eucm", (0.6, 1.1)),
    "omni": ("omni", (0.9, -0.1, 0.02, 1e-3, -1e-3)),
    "fov": ("fov", (0.9,)),
}


def cameras(camera: dg.Camera, f_stop: float | None) -> dict[str, dg.Camera]:
    """Cameras of one place and one field; the first is the one that others are compared with."""
    focal = 18 / np.tan(np.radians(FIELD / 2))
    hole = "pinhole" if f_stop is None else "thin"
    plain = camera.with_(lens=hole, focal_length=focal, f_stop=f_stop, motion={})
    made = {hole: plain}
    for name, (model, parameters) in MODELS.items():
        projection = dg.Projection.of_field(model, SIZE, FIELD, parameters)
        made[name] = plain.with_(lens=None, focal_length=None, projection=projection)
    return made


def ratios(f_stop: float | None, rounds: int, spp: int) -> dict[str, Any]:
    """Medians of the time over the first camera's, and their standard errors."""
    scene = dg.load(CHESS)
    scene.set_environment(SUNSET)
    sessions: dict[str, Session] = {}
    built = None
    for name, camera in cameras(scene.camera(), f_stop).items():
        sessions[name] = Session(scene, camera, resolution=SIZE, threads=1, built=built)
        built = sessions[name].built
    (first, plain), *others = sessions.items()
    over: dict[str, list[float]] = {name: [] for name, _ in others}
    for turn in range(rounds + 1):
        for name, session in others:
            before = drawn(plain, spp)
            over[name].append(drawn(session, spp) / before)
        if turn == 0:  # memory was touched for the first time
            over = {name: [] for name in over}
    found = {name: np.array(values) for name, values in over.items()}
    return {
        "over": first,
        "ratio": {name: round(float(np.median(v)), 3) for name, v in found.items()},
        "error": {
            name: round(float(1.25 * v.std() / np.sqrt(len(v))), 3) for name, v in found.items()
        },
    }


def drawn(session: Session, spp: int) -> float:
    """Processor seconds of the next samples."""
    begin = session.ranges[-1][1] if session.ranges else 0
    started = time.process_time()
    session.draw(begin, begin + spp)
    return time.process_time() - started


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--json", action="store_true", help="accepted for symmetry; always JSON")
    parser.add_argument("--rounds", type=int, default=20)
    parser.add_argument("--spp", type=int, default=2)
    parser.add_argument("--f-stop", type=float, default=None)
    options = parser.parse_args()
    if not (CHESS.is_file() and SUNSET.is_file()):
        print(json.dumps({"skipped": f"no {CHESS} and {SUNSET}"}))
        return
    print(json.dumps(ratios(options.f_stop, options.rounds, options.spp), indent=2))


if __name__ == "__main__":
    main()
