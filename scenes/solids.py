#!/usr/bin/env python3
"""Makes scenes of solids in solids: a pool with bubbles, seen in three ways, and a paperweight.

    python scenes/solids.py [-o FOLDER] [--only NAME]        (default: out/solids)

The pool is seen by a bare camera, through a flat port, and through a dome. Everything is made by
arithmetic: no downloads, the same bytes on every run.
"""

from __future__ import annotations

from kit.command import write_scenes

SCENES = ("bare", "flat", "dome", "paperweight")

if __name__ == "__main__":
    write_scenes("solids", SCENES, __doc__)
