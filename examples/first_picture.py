"""Photographs a scene through a real lens: linear light for work, a PNG for the eye.

    python examples/first_picture.py SCENE.glb [FOLDER]        (default: out)

Shows: a scene brings its camera, `with_` gives it a lens of the library, and a frame keeps
linear light. For a scene to begin with: `python scenes/night_table.py out/night_table.glb`.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import daguerre as dg


def main(scene: str, folder: str = "out", width: int = 360, spp: int = 32) -> None:
    """Renders `scene` with its own camera through a double Gauss at f/2."""
    loaded = dg.load(scene)
    for warning in loaded.warnings:  # what the file has and Daguerre does not know
        print(warning)
    lens = dg.lenses.load("double-gauss-50mm-f2")  # dg.lenses.names() has them all; or a file
    camera = loaded.camera().with_(lens=lens, focal_length=None, f_stop=2.0)
    frame = dg.render(loaded, camera, resolution=(width, 2 * width // 3), spp=spp)

    Path(folder).mkdir(parents=True, exist_ok=True)
    frame.save(f"{folder}/first_picture.exr")  # all that is known, 1 = a white world
    frame.save(f"{folder}/first_picture.png", tone="soft")  # highlights rolled off
    print(f"{frame}: mean {frame.rgb.mean():.3f}, focused at {camera.focus_distance:.2f} m")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("folder", nargs="?", default="out")
    main(**vars(parser.parse_args()))
