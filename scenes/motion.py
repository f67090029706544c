#!/usr/bin/env python3
"""Makes small scenes that move, for the pictures of the gallery and of docs/motion.md.

    python scenes/motion.py [-o FOLDER] [--only NAME]        (default: out/motion)

Everything is made by arithmetic: no downloads, the same bytes on every run. Each scene has a file
in scenes/motion/, whose first lines say what moves in it and when.
"""

from __future__ import annotations

from kit.command import write_scenes

SCENES = ("billiards", "racer", "plane", "cradle", "lamp", "street")

if __name__ == "__main__":
    write_scenes("motion", SCENES, __doc__)
