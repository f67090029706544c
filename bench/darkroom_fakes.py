#!/usr/bin/env python3
"""How far depth of field and motion blur of the darkroom are from rendered ones.

    python bench/darkroom_fakes.py SCENE.glb [--camera NAME] [--time S] [--spp N] [--size 480x320]

Renders a scene through a pinhole in an instant, with depth and motion, and as its camera does;
prints the errors of the pinhole's picture and of the fake: relMSE, less the noise of the truth, and
PSNR on a screen (gamma 2.2, cut at 1). With --time for motion blur, without for depth of field.
Scenes: scenes/lens_scenes.py, scenes/motion.py.
"""

from __future__ import annotations

import argparse

import numpy as np

import daguerre as dg


def errors(image: np.ndarray, truth: dg.Frame) -> str:
    """Errors of a picture against a frame."""
    square = (image - truth.rgb) ** 2 - truth.variance
    screen = [np.clip(i, 0, 1) ** (1 / 2.2) for i in (image, truth.rgb)]
    psnr = -10 * np.log10(((screen[0] - screen[1]) ** 2).mean())
    return f"relMSE {(square / (truth.rgb**2 + 0.01)).mean():.4f}  PSNR {psnr:.1f} dB"


def main() -> None:
    """Renders, fakes, compares."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scene")
    parser.add_argument("--camera")
    parser.add_argument("--time", type=float)
    parser.add_argument("--spp", type=int, default=128)
    parser.add_argument("--size", default="480x320")
    arguments = parser.parse_args()
    width, height = (int(n) for n in arguments.size.split("x"))
    options = {"resolution": (width, height), "spp": arguments.spp}
    scene = dg.load(arguments.scene)
    camera = scene.camera(arguments.camera)
    moving = arguments.time is not None
    if moving:
        scene.time = arguments.time
        camera = camera.with_(lens="pinhole", shutter_angle=180)
    else:
        camera = camera.with_(shutter_angle=0)
    instant = camera.with_(lens="pinhole", shutter_angle=0)
    sharp = dg.render(scene, instant, gt_time="mid", motion=moving, aovs=True, **options)
    truth = dg.render(scene, camera, **options)
    depth = sharp.aovs["depth.Z"]
    if moving:
        flow = np.concatenate([sharp.motion, sharp.motion_back], axis=2)
        fake = dg.post.motion_blur(sharp.rgb, flow, depth)
    else:
        fake = dg.post.depth_of_field(
            *(sharp.rgb, depth),
            focal_length=camera.focal_length,
            f_stop=camera.f_stop,
            focus=truth.metadata["focus"],
            sensor=camera.sensor_size,
            blades=camera.blades,
        )
    print(f"no effect  {errors(sharp.rgb, truth)}")
    print(f"fake       {errors(fake, truth)}")


if __name__ == "__main__":
    main()
