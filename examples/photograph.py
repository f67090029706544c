"""Takes a photograph: light, a meter, a sensor with its noise, a raw file and a developed picture.

    python examples/photograph.py [FOLDER]        (default: out)

Shows: a frame is light and knows its exposure; a sensor makes a raw of it, a pixel of the
frame to a photosite; the raw is a DNG for any darkroom, or a JPEG developed here.
"""

from __future__ import annotations

import sys
from pathlib import Path

import daguerre as dg


def main(folder: str = "out", width: int = 540, spp: int = 16) -> None:
    """Photographs a chart of 24 colours, lit as a room is in the evening."""
    chart = dg.charts.make("colour")  # or a scene of your own: dg.load("scene.glb")
    body = dg.sensors.load("sony-a7r-ii")  # dg.sensors.names() has them all
    camera = chart.camera().with_(lens="thin", f_stop=5.6, shutter_time=1 / 60, sensor=body)
    camera = camera.with_(exposure="manual")  # time, stop and ISO set the brightness
    size = width, 2 * width // 3
    frame = dg.render(chart.scene(luminance=60), camera, resolution=size, spp=spp)

    metered = dg.metering.meter(frame)
    print(metered)
    raw = frame.expose(body, iso=metered.iso, seed=1)  # another seed, another shot
    Path(folder).mkdir(parents=True, exist_ok=True)
    frame.save(f"{folder}/photograph.exr")
    raw.save(f"{folder}/photograph.dng")
    raw.save(f"{folder}/photograph.jpg", look="standard")


if __name__ == "__main__":
    main(*sys.argv[1:2])
