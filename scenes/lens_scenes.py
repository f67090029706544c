#!/usr/bin/env python3
"""Makes six scenes for lenses: arcade, lamps, long table, table at night, caustics, toy blocks.

    python scenes/lens_scenes.py [-o FOLDER] [--only NAME]     (default: out/lens_scenes)

Everything is made by arithmetic: no downloads, the same bytes on every run.
"""

from __future__ import annotations

from kit.command import write_scenes

SCENES = ("arcade", "lamps", "long_table", "photographer", "caustics", "blocks")

if __name__ == "__main__":
    write_scenes("lens_scenes", SCENES, __doc__ or "")
