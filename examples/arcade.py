#!/usr/bin/env python3
"""Makes the scene through which lenses are compared: a marble head in an arcade at night.

    python examples/arcade.py [OUT.glb]        (default: out/arcade.glb)

Everything is made by arithmetic: no downloads, the same bytes on every run. Metres, y up; the eyes
of the head, the test chart and the white frame lie in the plane z = 0, which is half a metre high
in the picture, and the camera looks along -z. Whatever the focal length, step back until the frame
stands near the edge of the picture: what differs then is the lens. Luminances are stylised: 1 cd/m2
shows as 1.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from arcade import hall, head, lanterns, table
from night.stage import Stage


def main() -> None:
    """Writes the scene to the path on the command line."""
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else Path("out/arcade.glb")
    stage = Stage("daguerre examples/arcade.py")
    hall.add_hall(stage)
    lanterns.add_lanterns(stage)
    head.add_head(stage)
    table.add_table(stage)
    table.add_camera(stage)
    stage.glb.write(path)
    print(f"{path}: {path.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
