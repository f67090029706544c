#!/usr/bin/env python3
"""Makes a scene for the exposure triangle: pinwheels at a fence, for a sky of known luminance.

    python scenes/exposure.py [-o FOLDER]        (default: out/exposure)

Everything is made by arithmetic: no downloads, the same bytes on every run.
"""

from __future__ import annotations

from kit.command import write_scenes

SCENES = ("pinwheels",)

if __name__ == "__main__":
    write_scenes("exposure", SCENES, __doc__ or "")
