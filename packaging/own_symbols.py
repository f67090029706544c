"""Gives Embree's symbols in a wheel a prefix of their own, so that no other Embree answers them.

Usage: own_symbols.py TREE, where TREE is an unpacked wheel that auditwheel has repaired. A program
such as Blender that loads its own Embree (another version) first would otherwise answer the calls
of our core: the linker looks for a name in the program's libraries before it looks in ours.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

PREFIX = "daguerre_"
LIBRARY, CORE = "*.libs/libembree*", "*/_core*.so"


def defined(library: Path) -> list[str]:
    """Names of the functions that a library offers."""
    text = subprocess.run(
        ["nm", "-D", "--defined-only", "--format=posix", str(library)],
        capture_output=True, text=True, check=True,
    ).stdout  # fmt: skip
    return sorted({line.split()[0].split("@")[0] for line in text.splitlines()})


def rename(library: Path, core: Path) -> None:
    """Renames what a library offers, there and in the core that calls it."""
    names = defined(library)
    with tempfile.NamedTemporaryFile("w", suffix=".map") as pairs:
        pairs.write("".join(f"{name} {PREFIX}{name}\n" for name in names))
        pairs.flush()
        for file in (library, core):
            subprocess.run(
                ["patchelf", "--rename-dynamic-symbols", pairs.name, str(file)], check=True
            )


def main(tree: Path) -> None:
    """Renames the symbols of Embree in an unpacked wheel."""
    (library,), (core,) = tree.glob(LIBRARY), tree.glob(CORE)
    rename(library, core)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
