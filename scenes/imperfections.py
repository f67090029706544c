#!/usr/bin/env python3
"""Makes eight scenes for the imperfections of lenses: stars for coma, a wall for distortion, ...

    python scenes/imperfections.py [-o FOLDER] [--only NAME]     (default: out/imperfections)

Everything is made by arithmetic: no downloads, the same bytes on every run. What is seen shines by
itself, so that `--max-depth 1` is enough, and differences between pictures are those of the lens.
"""

from __future__ import annotations

from kit.command import write_scenes

SCENES = ("wheel", "chart", "fair", "strings", "wall", "dusk", "starry", "rule")

if __name__ == "__main__":
    write_scenes("imperfections", SCENES, __doc__ or "")
