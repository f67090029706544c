"""Moves a bar through three shutters: an instant, 1/60 s, and lines that are read out in turn.

    python examples/motion_blur.py [FOLDER]        (default: out)

Shows: motion as keys over time, the shutter of a camera, and why a rolling shutter makes what
is upright lean: lower lines are exposed later, when the bar is farther on.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import daguerre as dg

SPEED = 6.0  # m/s to the right, 2 m before the camera
SHUTTERS = {
    "instant": {"shutter_time": 0.0},
    "blurred": {"shutter_time": 1 / 60},
    "rolling": {
        "shutter_time": 1 / 2000,
        "rolling_shutter": dg.RollingShutter("top", readout_time=1 / 30),
    },
}


def bar() -> dg.Scene:
    """A shining bar of 0.2 x 1 m that crosses the middle of the picture at 0 s."""
    scene, begin, end = dg.Scene(time=0.0), np.eye(4), np.eye(4)
    begin[0, 3], end[0, 3] = -0.1 * SPEED, 0.1 * SPEED
    corners = [(-0.1, -0.5, 0), (0.1, -0.5, 0), (0.1, 0.5, 0), (-0.1, 0.5, 0)]
    mesh = scene.add_mesh(corners, [(0, 1, 2), (0, 2, 3)])
    white = dg.Material(emission=(1, 1, 1))
    scene.add_instance(mesh, white, dg.keys([(-0.1, begin), (0.1, end)]), name="bar")
    return scene


def main(folder: str = "out", width: int = 300, spp: int = 32) -> None:
    """Renders the bar through each shutter."""
    scene, pose = bar(), np.eye(4)
    pose[2, 3] = 2.0
    Path(folder).mkdir(parents=True, exist_ok=True)
    for name, shutter in SHUTTERS.items():
        camera = dg.Camera(pose, lens="pinhole", focal_length=36, **shutter)
        frame = dg.render(scene, camera, resolution=(width, 2 * width // 3), spp=spp)
        frame.save(f"{folder}/motion_{name}.exr")
        frame.save(f"{folder}/motion_{name}.png")


if __name__ == "__main__":
    main(*sys.argv[1:2])
