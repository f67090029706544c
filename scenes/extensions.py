#!/usr/bin/env python3
"""Makes seven small scenes that together use every glTF extension that Daguerre reads.

    python scenes/extensions.py [-o FOLDER] [--only NAME]        (default: out/extensions)

Everything is made by arithmetic: no downloads, the same bytes on every run. Each scene has a file
in scenes/extensions/, whose first lines say what it uses, and holds its own camera and lights.
"""

from __future__ import annotations

from kit.command import write_scenes

SCENES = ("shelf", "glass", "octopus", "garden", "street", "packed", "street_on_the_map")

if __name__ == "__main__":
    write_scenes("extensions", SCENES, __doc__)
