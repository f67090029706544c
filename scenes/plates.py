#!/usr/bin/env python3
"""Makes the set of a plate, empty and with chessmen that are to be put into it.

    python scenes/plates.py [-o FOLDER]        (default: out/plates)

`empty.glb` is what the camera films. `shot.glb` has the same set below a node of that name, and the
chessmen below `chessmen`. Everything is made by arithmetic: no downloads, the same bytes on every
run.
"""

from __future__ import annotations

from kit.command import write_scenes

SCENES = ("empty", "shot")

if __name__ == "__main__":
    write_scenes("plates", SCENES, __doc__ or "")
