"""Ghosts of what mirrors and walls send to the lens: their cost, and noise of the other ghosts.

    python bench/flare_highlights.py [--json] [--paths 200000]

Three balls on a floor, under a sky of one colour, and a sun: matte ones with the sun in the frame,
whose ghosts must not get noisier; and of chrome with the sun behind the camera, where all that is
bright comes by way of them. CPU seconds of one thread, without and with highlights; the
error is relMSE of the flare, see ``bench/flare.py``, from two pictures and their mean.
"""

from __future__ import annotations

import argparse
import json
import time
from typing import Any

import numpy as np

import daguerre as dg
from daguerre.rendering.session import Session

SUN_RADIUS = 0.00465  # over its distance
KINDS = {"matte": (0.12, 0.2, -1.0), "chrome": (-0.5, 0.9, 0.7)}  # and the way to the sun


def ball(segments: int = 32) -> tuple[Any, Any]:
    """Positions, which are normals too, and triangles."""
    t, p = np.meshgrid(
        np.linspace(0, np.pi, segments + 1), np.linspace(0, 2 * np.pi, 2 * segments + 1)
    )
    points = np.stack([np.sin(t) * np.cos(p), np.cos(t), np.sin(t) * np.sin(p)], -1)
    a = np.arange(2 * segments)[:, None] * (segments + 1) + np.arange(segments)
    b = a + segments + 1
    faces = np.stack([a, a + 1, b, b, a + 1, b + 1], -1).reshape(-1, 3)
    return points.reshape(-1, 3), faces


def scene(kind: str) -> dg.Scene:
    """Three balls on a floor."""
    made = dg.Scene()
    points, faces = ball()
    mesh = made.add_mesh(points, faces, normals=points)
    chrome, matte = dg.Conductor((0.9, 0.9, 0.9), alpha=0.0), dg.Diffuse((0.6, 0.3, 0.2))
    for x, z in ((-0.55, -3.0), (0.2, -2.6), (0.9, -3.6)):
        pose = np.diag([0.4, 0.4, 0.4, 1.0])
        pose[:3, 3] = x, -0.1, z
        made.add_instance(mesh, dg.Material(chrome if kind == "chrome" else matte), pose)
    corners = np.array([(-6, -0.5, 3), (6, -0.5, 3), (6, -0.5, -9), (-6, -0.5, -9)], float)
    floor = made.add_mesh(corners, np.array([(0, 1, 2), (0, 2, 3)]))
    made.add_instance(floor, dg.Material(dg.Diffuse((0.25, 0.25, 0.22))), np.eye(4))
    made.set_environment(color=(3000, 4500, 7000))
    pose = np.eye(4)
    pose[:3, 3] = 50 * np.array(KINDS[kind]) / np.linalg.norm(KINDS[kind])
    made.add_light(dg.SphereLight((1.6e9, 1.5e9, 1.3e9), 50 * SUN_RADIUS), pose)
    return made


def measured(kind: str, paths: float, *, highlights: bool) -> dict[str, float]:
    """Times, what was found, and the error."""
    camera = dg.Camera(lens="double-gauss-50mm-f2", f_stop=4, focus_distance=3)
    pictures, setup, drawing = [], [], []
    for seed in (1, 2):
        started = time.process_time()
        session = Session(
            scene(kind),
            camera,
            resolution=(180, 120),
            flare=paths,
            flare_highlights=highlights,
            light_paths="off",
            seed=seed,
            threads=1,
        )
        ready = time.process_time()
        session.draw(0, 1)
        setup.append(ready - started)
        drawing.append(time.process_time() - ready)
        flare = session.frame().flare
        assert flare is not None
        pictures.append(flare.astype(np.float64))
    mean = (pictures[0] + pictures[1]) / 2
    error = (pictures[0] - pictures[1]) ** 2 / 2 / (mean**2 + 0.01 * mean.mean() ** 2)
    return {
        "setup_seconds": min(setup),
        "draw_seconds": min(drawing),
        "relmse": float(error.mean()),
        "flare": float(mean.sum()),
        "spots": session.flare_spots,
        "survey_rays": session.survey_rays,
    }


def main() -> None:
    """Prints lines, or JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--paths", type=float, default=200000.0)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    facts = {
        f"{kind} {'on' if on else 'off'}": measured(kind, arguments.paths, highlights=on)
        for kind in KINDS
        for on in (False, True)
    }
    if arguments.json:
        print(json.dumps(facts))
        return
    for name, values in facts.items():
        print(name, *(f"{key} {value:.4g}" for key, value in values.items()), sep="  ")


if __name__ == "__main__":
    main()
