"""Renders through a calibration of OpenCV, straightens the picture, and checks it.

    python examples/calibrated_camera.py [FOLDER]        (default: out)

Shows: a camera from K and distortion coefficients (a file or a dict), its STMaps, and a board
whose corners are known. The straightened picture must be what a pinhole with the same K sees.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import daguerre as dg

FOUND = {  # as cv2.calibrateCamera returns it, or the name of a file that cv2.FileStorage wrote
    "K": [[905.0, 0, 641], [0, 904, 358], [0, 0, 1]],
    "dist_coeffs": [-0.25, 0.08, 0.0004, -0.0007, 0],
    "image_size": (1280, 720),
}


def main(folder: str = "out", width: int = 640, spp: int = 16) -> None:
    """Renders a board bent and straight."""
    board = dg.charts.make("checkerboard", columns=10, rows=7, square=0.03)
    camera = dg.Camera.from_opencv(FOUND, camera=board.camera(focal_length=36))
    pinhole = dg.Camera.from_opencv(FOUND | {"dist_coeffs": [0] * 5}, camera=camera)
    size, scene = (width, width * 9 // 16), board.scene(luminance=1)
    bent = dg.render(scene, camera.with_(f_stop=None), resolution=size, spp=spp)
    straight = dg.render(scene, pinhole.with_(f_stop=None), resolution=size, spp=spp)

    maps = dg.stmaps(camera, size)
    back = dg.Frame(dg.post.apply_stmap(bent.rgb, maps.undistort), metadata=straight.metadata)
    inside = np.s_[size[1] // 8 : -size[1] // 8, size[0] // 8 : -size[0] // 8]
    for name, frame in (("bent", bent), ("straightened", back)):
        apart = np.abs(frame.rgb - straight.rgb)[inside].mean()
        print(f"{name}: {100 * apart:.1f} % of white from the pinhole's picture")

    Path(folder).mkdir(parents=True, exist_ok=True)
    for name, frame in (("bent", bent), ("straightened", back)):
        frame.save(f"{folder}/calibrated_{name}.png")


if __name__ == "__main__":
    main(*sys.argv[1:2])
