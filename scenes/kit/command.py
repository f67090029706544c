"""Command line of the scripts that write several scenes."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path


def write_scenes(package: str, scenes: Sequence[str], description: str) -> None:
    """Writes the scenes into the folder on the command line.

    Args:
        package: Folder beside the script that has a module for each scene, with ``make()``; also
            the name of the folder in ``out`` into which they go by default.
        scenes: The modules.
        description: For ``--help``.
    """
    parser = argparse.ArgumentParser(description=description.split("\n", 1)[0])
    parser.add_argument("-o", "--output", type=Path, default=Path("out") / package)
    parser.add_argument("--only", action="append", choices=scenes)
    given = parser.parse_args()
    for name in given.only or scenes:
        path = given.output / f"{name}.glb"
        import_module(f"{package}.{name}").make().write(path)
        print(f"{path}: {path.stat().st_size / 1e6:.1f} MB")
