"""Small bright lamps out of focus: light sent to the film beside camera rays, against these alone.

    python bench/night.py --json [--radius 2 10 40] [--spp 32] [--w 960] [--h 540] [--plain]
    python bench/night.py --json --check [--spp 65536] [--batches 16]

The scene is scenes/lens_scenes/photographer.py without its glasses: a table in focus at 1.2 m
and 100 sphere lamps, 3 to 8 m away, through the double Gauss 50 mm at f/2. --radius is the lamps',
in mm; they shine as much whatever their size. Both sides draw --spp samples per pixel with each
seed, in turn, on one thread; the pilot and the light paths are in the CPU seconds.

Error is relMSE = mean((A - B)^2 / 2 / (R^2 + 0.01)) of two seeds A and B, as in bench/peers.py, but
R is the mean of all pictures that had light paths: where a lamp is met once in a thousand samples,
A and B alone do not know how bright a pixel is. CPU seconds to relMSE 0.01 are CPU seconds x
relMSE / 0.01, as the error falls with 1 / samples.

--plain: scenes without such lamps, light_paths auto against off.
--check: instead, camera rays alone, with --spp samples of each pixel in batches of different seeds,
over crops that hold what is in focus, lamps out of focus, and cat's eyes in a corner; against both
strategies by Welch's test (tests/support/pictures/statistical.py). A whole frame of so many samples
would take days.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import resource
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

import daguerre as dg
from daguerre.rendering.light_plan import pilot
from daguerre.rendering.session import Session

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "scenes")]
DATA = ROOT.parent / "shared" / "data"
LENS = "double-gauss-50mm-f2"
F_STOP = 2.0
WANTED = {2.0: 30.0, 10.0: 4.0, 40.0: 1.0}  # ratio of CPU seconds by radius, mm
SIDES = ("camera", "both")
# (x0, y0, side), fractions of the frame: its subject, lamps out of focus, lamps in the corner
CROPS = {"in_focus": (0.50, 0.52), "bokeh": (0.53, 0.17), "cat_eye": (0.045, 0.03)}
CROP_PX = 32


def cpu_seconds() -> float:
    """User and system time of this process."""
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


def night_table(radius: float) -> tuple[dg.Scene, dg.Camera]:
    """The scene with its lamps as spheres of this radius (m), and its camera."""
    from lens_scenes import photographer
    from night.stage import Stage

    stage = Stage()
    photographer.add_set(stage)
    scene = loaded(stage.glb)
    for lamp in photographer.lamps():
        place = np.eye(4)
        place[:3, 3] = lamp.at
        color = tuple(Stage.shine(lamp.color, lamp.luminance(radius)))
        scene.add_light(dg.SphereLight(color, radius), place)
    return scene, scene.camera("Camera").with_(lens=dg.lenses.load(LENS), f_stop=F_STOP)


def draw(
    scene: dg.Scene, camera: dg.Camera, side: str, seed: int, options: argparse.Namespace
) -> tuple[np.ndarray, float, float, Session]:
    """Picture, and CPU seconds of drawing and of the pilot."""
    session = Session(
        scene,
        camera,
        resolution=(options.w, options.h),
        seed=seed,
        threads=1,
        max_depth=8,
        light_paths="off" if side == "camera" else options.light_paths,
    )
    started = cpu_seconds()
    if side == "both" and options.light_paths == "auto":
        pilot(session.prepared, session.light_plan.core)  # once more, to be timed
    flown = cpu_seconds()
    session.draw(0, options.spp)
    seconds = cpu_seconds() - flown
    return session.frame().rgb.astype(np.float64), seconds, flown - started, session


def compare(scene: dg.Scene, camera: dg.Camera, options: argparse.Namespace) -> dict[str, Any]:
    """Both sides in turn: cost, error, and cost to relMSE 0.01."""
    pictures: dict[str, list[np.ndarray]] = {side: [] for side in SIDES}
    seconds: dict[str, list[float]] = {side: [] for side in SIDES}
    out: dict[str, Any] = {}
    for seed in range(1, options.seeds + 1):
        for side in SIDES if seed % 2 else SIDES[::-1]:
            picture, cpu, pilot, session = draw(scene, camera, side, seed, options)
            pictures[side].append(picture)
            seconds[side].append(cpu)
            if side == "both":
                out |= {"light_paths": session.light_paths, "pilot_cpu_s": round(pilot, 3)}
    reference = np.mean(pictures["both"], axis=0)
    pilots = {"camera": 0.0, "both": out["pilot_cpu_s"]}
    for side in SIDES:
        errors = [
            float(np.mean((a - b) ** 2 / 2 / (reference**2 + 0.01)))
            for a, b in zip(pictures[side][::2], pictures[side][1::2], strict=True)
        ]
        cpu, error = float(np.median(seconds[side])), float(np.mean(errors))
        out[f"{side}_cpu_s"] = round(cpu, 2)
        out[f"{side}_relmse"] = error
        out[f"{side}_cpu_s_to_relmse_0.01"] = round(cpu * error / 0.01 + pilots[side], 2)
    key = "cpu_s_to_relmse_0.01"
    both = out["both_cpu_s"] + out["pilot_cpu_s"]
    out["cpu_ratio_equal_spp"] = round(both / out["camera_cpu_s"], 3)
    out["times_faster"] = round(out[f"camera_{key}"] / out[f"both_{key}"], 2)
    return out


def loaded(glb: Any) -> dg.Scene:
    """One of the scenes that the repository makes."""
    with tempfile.TemporaryDirectory() as folder:
        glb.write(Path(folder) / "scene.glb")
        return dg.load(Path(folder) / "scene.glb")


def interior() -> Any:
    """A room that a panel on its ceiling lights, with spheres of plaster, polish and brass."""
    from extensions.studio import Studio
    from kit import shapes

    studio = Studio()
    wall = studio.matter("wall", (0.7, 0.68, 0.62), 1)
    studio.put("room", shapes.box((4, 2.6, 6)), wall)
    studio.softbox((0.5, 2.4, -0.2), (0, 0, -0.9), (1.2, 0.8), 12)
    colors = ((0.6, 0.6, 0.6), (0.5, 0.1, 0.08), (0.9, 0.7, 0.35))
    for k, (color, roughness) in enumerate(zip(colors, (1.0, 0.15, 0.25), strict=True)):
        matter = studio.matter("ball", color, roughness, float(k == 2))
        studio.put("ball", shapes.ball(0.35, 32, 64), matter, (0.9 * (k - 1), 0.35, -1.2 + 0.5 * k))
    studio.camera((0.3, 1.2, 2.7), (0, 0.6, -1), 35, 2.8, (0, 0.35, -0.7))
    return studio.glb


def plain_scenes() -> dict[str, tuple[dg.Scene, dg.Camera]]:
    """Scenes that have no small lamps, or have them in focus or far from it; absent: no data."""
    from extensions import garden, shelf
    from lens_scenes import arcade, long_table

    made = {
        "arcade": loaded(arcade.make()),
        "long_table": loaded(long_table.make()),
        "interior": loaded(interior()),
        "product_shot": loaded(shelf.make()),
        "garden": loaded(garden.make()),
    }
    chess, sunset = DATA / "scenes/open_chess_set_512.glb", DATA / "hdri/pmndrs_sunset.hdr"
    if chess.is_file() and sunset.is_file():
        made["chess_in_daylight"] = dg.load(chess)
        made["chess_in_daylight"].set_environment(sunset)
    cameras = {name: scene.camera(None) for name, scene in made.items()}
    peers = ROOT.parent / "shared" / "peers"
    if (peers / "scene.py").is_file():
        sys.path.insert(0, str(peers))
        import dof_field

        made["dof_field"], cameras["dof_field"] = dof_field.build("thin"), dof_field.camera("thin")
    return {name: (scene, cameras[name]) for name, scene in made.items()}


def batches(
    scene: dg.Scene,
    camera: dg.Camera,
    crop: tuple[int, ...],
    paths: Any,
    spp: int,
    first: int,
    options: Any,
    technique: str = "both",
) -> np.ndarray:
    """Independent pictures of a crop, (n, H, W, 3)."""
    every = [
        dg.render(
            scene,
            camera,
            spp=spp,
            seed=first + k,
            resolution=(options.w, options.h),
            crop=crop,
            max_depth=8,
            light_paths=paths,
            technique=technique,
        ).rgb
        for k in range(options.batches)
    ]
    return np.array(every, np.float64)


def check(options: argparse.Namespace) -> dict[str, Any]:
    """Camera rays alone against both strategies, crop by crop."""
    from tests.support.pictures.statistical import differences, seldom_met

    scene, camera = night_table(options.radius[0] / 1e3)
    # Take as many light paths as the frame gets: a crop's own plan is its small share of them.
    plan = Session(
        scene,
        camera,
        resolution=(options.w, options.h),
        max_depth=8,
        light_paths=options.light_paths,
    ).light_paths
    lamps = [light for light, _ in scene.lights if isinstance(light, dg.SphereLight)]
    brightest = max(max(lamp.luminance) for lamp in lamps)
    out: dict[str, Any] = {"light_paths": plan}
    for name, (x, y) in CROPS.items():
        x0, y0 = int(x * options.w), int(y * options.h)
        crop = (x0, y0, x0 + CROP_PX, y0 + CROP_PX)
        alone = batches(scene, camera, crop, "off", options.spp // options.batches, 1, options)
        both = batches(scene, camera, crop, plan, options.both_spp, 1001, options)
        # Measure the light paths: all but what is left with next to none of them
        few = (1e-6 * (plan[0] > 0), 1e-6 * (plan[1] > 0))
        rest = batches(scene, camera, crop, few, options.both_spp, 2001, options, "light")
        found = both.mean(axis=0) - rest.mean(axis=0)
        expected = seldom_met(alone, found, brightest, options.spp)
        out[name] = {
            "crop": crop,
            "camera_mean": alone.mean(axis=(0, 1, 2)).round(5).tolist(),
            "both_mean": both.mean(axis=(0, 1, 2)).round(5).tolist(),
            "camera_error": round(float(alone.mean(axis=(1, 2)).std(axis=0).mean()), 6),
            "differences": differences(both, expected),
        }
    return out


def main() -> None:
    """Measures and prints one JSON object."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--json", action="store_true", help="accepted for symmetry; always JSON")
    parser.add_argument("--radius", type=float, nargs="+", default=[2.0], help="mm")
    parser.add_argument("--spp", type=int, help="default 32; with --check 65536")
    parser.add_argument("--seeds", type=int, default=2, help="an even number")
    parser.add_argument("--w", type=int, default=960)
    parser.add_argument("--h", type=int, default=540)
    parser.add_argument("--light-paths", default="auto", help="or M1,M2")
    parser.add_argument("--plain", action="store_true")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--batches", type=int, default=16)
    parser.add_argument("--both-spp", type=int, default=256, help="of each batch of --check")
    options = parser.parse_args()
    options.spp = options.spp or (65536 if options.check else 32)
    out: dict[str, Any] = {
        "benchmark": "night",
        "lens": LENS,
        "f_stop": F_STOP,
        "spp": options.spp,
        "machine": f"{platform.machine()}, {os.cpu_count()} cores",
    }
    if options.check:
        out |= check(options)
    elif options.plain:
        for name, (scene, camera) in plain_scenes().items():
            out[name] = compare(scene, camera, options)
    else:
        for radius in options.radius:
            found = compare(*night_table(radius / 1e3), options)
            out[f"{radius:g} mm"] = found | {"wanted": WANTED.get(radius)}
    print(json.dumps(out, indent=1))


if __name__ == "__main__":
    main()
