"""Sweeps aperture and focus: three lamps at 0.5, 1 and 3 m as discs of light.

    python examples/bokeh_and_focus.py [FOLDER]        (default: out)

Shows: lamps from Python, f-stop and focus of a real lens, and a sheet of several frames. Rows
are f-stops, columns are focus distances. Discs at f/4 are half as wide as at f/2.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import daguerre as dg

F_STOPS, DISTANCES = (2.0, 4.0, 8.0), (0.5, 1.0, 3.0)  # m from the camera, which looks along -z


def lamps() -> dg.Scene:
    """Three small lamps side by side in the picture, each at its distance."""
    scene = dg.Scene()
    for across, distance in zip((-0.12, 0.0, 0.12), DISTANCES, strict=True):
        place = np.eye(4)
        place[:3, 3] = across * distance, 0, -distance
        scene.add_light(dg.SphereLight(luminance=(900, 600, 250), radius=0.002 * distance), place)
    return scene


def main(folder: str = "out", width: int = 150, spp: int = 16) -> None:
    """Renders nine frames and saves them as one sheet."""
    scene, camera = lamps(), dg.Camera(lens="double-gauss-50mm-f2", sensor_size=(18, 12))
    size = width, 2 * width // 3
    rows = []
    for f_stop in F_STOPS:
        views = [camera.with_(f_stop=f_stop, focus_distance=distance) for distance in DISTANCES]
        frames = [dg.render(scene, view, resolution=size, spp=spp) for view in views]
        rows.append(np.concatenate([frame.rgb for frame in frames], axis=1))
    sheet = dg.Frame(np.concatenate(rows))
    Path(folder).mkdir(parents=True, exist_ok=True)
    sheet.save(f"{folder}/bokeh_and_focus.exr")
    sheet.save(f"{folder}/bokeh_and_focus.png", tone="soft")


if __name__ == "__main__":
    main(*sys.argv[1:2])
