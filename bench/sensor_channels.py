"""Cost of a sensor's channels on the film, and how far bands and XYZ are from them.

    python bench/sensor_channels.py errors|cost --json

``errors``: root mean square over channels and surfaces in D65 light, per cent of white, for each
sensor of the library: by the fitted matrix from XYZ, and by bands. Surfaces are mixtures of RGB, as
a render makes them, and bells: bumps and dips over wavelength, 15 to 80 nm wide, which none of the
fits was made with. ``cost``: processor seconds of one render (a white sky and nothing else: the
film's share is at its largest; and a room) with XYZ alone, with three channels, with 16 bands; the
least of several runs by turns.
"""

from __future__ import annotations

import argparse
import json
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre as dg
from daguerre import sensors
from daguerre.color import illuminants
from daguerre.color.spectra import FIRST_NM, LAST_NM, unit_d65
from daguerre.rendering.session import Session
from daguerre.sensors.bands import weights_of_bands

BANDS = (4, 8, 16, 32, 64)
NM = illuminants.NM
RUNS, SAMPLES = 7, 16


def surfaces(kind: str) -> NDArray[np.float64]:
    """Reflectances at ``NM``, shape (200, L)."""
    rng = np.random.default_rng(1)
    if kind == "rgb":
        return np.asarray(rng.uniform(0, 1, (200, 3)) @ illuminants.rgb_reflectances().T)
    at, width = rng.uniform(400, 700, (200, 1)), rng.uniform(15, 80, (200, 1))
    bell = np.exp(-0.5 * ((NM - at) / width) ** 2)
    return np.asarray(np.where(rng.random((200, 1)) < 0.5, bell, 1 - bell))


def errors() -> dict[str, Any]:
    """By kind of surface and sensor."""
    found: dict[str, Any] = {}
    film = unit_d65(NM)[400] / illuminants.d65()[400]  # the film's units of radiance
    for kind in ("rgb", "bells"):
        light = surfaces(kind) * illuminants.d65()
        for name in sensors.names():
            sensor = sensors.load(name)
            truth = light @ sensor.sensitivity(NM).T * illuminants.STEP
            made = {"xyz": light @ illuminants.observer() @ sensor.channels_from_xyz().T}
            for count in BANDS:
                width = (LAST_NM - FIRST_NM) / count
                band = np.minimum((NM - FIRST_NM) / width, count - 1).astype(int)
                means = np.stack([film * light[:, band == b].mean(axis=1) for b in range(count)], 1)
                made[str(count)] = means @ weights_of_bands(sensor, count)
            rms = {k: 100 * float(np.sqrt(((v - truth) ** 2).mean())) for k, v in made.items()}
            found.setdefault(kind, {})[name] = {k: round(v, 2) for k, v in rms.items()}
    return found


def cost() -> dict[str, Any]:
    """Processor seconds by scene and what the film keeps."""
    sky, room = dg.Scene(), dg.Scene()
    for scene, level in ((sky, 1.0), (room, 0.5)):
        scene.set_environment(color=(level, level, level))
    floor = np.array([(-9, -1, -9), (9, -1, -9), (9, -1, 9), (-9, -1, 9)], float)
    mesh = room.add_mesh(floor, np.array([(0, 2, 1), (0, 3, 2)]))
    room.add_instance(mesh, dg.Material(dg.Diffuse((0.5, 0.5, 0.5))))
    ways: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
        "xyz": ({}, {}),
        "channels": ({"sensor": "ideal"}, {}),
        "bands": ({}, {"bands": 16}),
    }
    out: dict[str, Any] = {}
    for name, scene in (("sky", sky), ("room", room)):
        best = dict.fromkeys(ways, np.inf)
        for _ in range(RUNS):
            for way, (eye, options) in ways.items():
                camera = dg.Camera(f_stop=2.8, focus_distance=5.0, **eye)
                one = Session(
                    scene, camera, resolution=(320, 214), threads=1, light_paths="off", **options
                )
                one.draw(0, 1)
                begun = time.process_time()
                one.draw(1, 1 + SAMPLES)
                best[way] = min(best[way], time.process_time() - begun)
        out[name] = {way: round(seconds, 3) for way, seconds in best.items()}
    return out


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=("errors", "cost"))
    parser.add_argument("--json", action="store_true", help="accepted; the output is always JSON")
    print(json.dumps(errors() if parser.parse_args().what == "errors" else cost(), indent=2))


if __name__ == "__main__":
    main()
