#!/usr/bin/env python3
"""Makes small scenes that move, for the pictures of the gallery and of docs/motion.md.

    python examples/motion.py [-o FOLDER] [--only NAME]        (default: out/motion)

Everything is made by arithmetic: no downloads, the same bytes on every run. Each scene has a file
in examples/motion/, whose first lines say what moves in it and when.
"""

from __future__ import annotations

import argparse
import sys
from importlib import import_module
from pathlib import Path

HERE = Path(__file__).resolve().parent
SCENES = ("billiards", "racer", "plane", "cradle", "lamp", "street")


def main() -> None:
    """Writes the scenes into the folder on the command line."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("-o", "--output", type=Path, default=Path("out/motion"))
    parser.add_argument("--only", action="append", choices=SCENES)
    given = parser.parse_args()
    sys.path.insert(0, str(HERE))
    for name in given.only or SCENES:
        path = given.output / f"{name}.glb"
        import_module(f"motion.{name}").make().write(path)
        print(f"{path}: {path.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
