#!/usr/bin/env python3
"""Makes the example scene: a table-top at night around a small brass orrery.

    python scenes/night_table.py [OUT.glb]        (default: out/night_table.glb)

Everything is made by arithmetic: no downloads, the same bytes on every run. Metres, y up, the table
top at y = 0, and the camera looks along -z. The luminances are stylised, not measured: a frame is
normalised so that 1 cd/m2 shows as 1, so the table is lit to some 0.1 - 0.5 cd/m2 and the lamps are
a few hundred times brighter, as the eye remembers such a night. The planets turn: see --time.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from night import orrery, room, things
from night.stage import Stage


def write(path: Path) -> None:
    """Writes the scene."""
    stage = Stage()
    room.add_camera(stage)
    room.add_table(stage)
    room.add_room(stage)
    room.add_garlands(stage)
    turns = orrery.add_orrery(stage)
    things.add_glasses(stage)
    things.add_candles(stage)
    things.add_small_things(stage)
    room.add_lantern(stage)
    room.add_moonlight(stage)
    stage.glb.add_turns("orrery", turns, 24.0)
    stage.glb.write(path)


def main() -> None:
    """Writes the scene to the path on the command line."""
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else Path("out/night_table.glb")
    write(path)
    print(f"{path}: {path.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
