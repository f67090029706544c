#!/usr/bin/env python3
"""Makes five scenes for lenses: an arcade, lamps, a long table, a table at night, caustics.

    python scenes/lens_scenes.py [-o FOLDER] [--only NAME]     (default: out/lens_scenes)

Everything is made by arithmetic: no downloads, the same bytes on every run.
"""

from __future__ import annotations

from kit.command import write_scenes

SCENES = ("arcade", "lamps", "long_table", "photographer", "caustics")

if __name__ == "__main__":
    write_scenes("lens_scenes", SCENES, __doc__ or "")
