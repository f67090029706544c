"""Files of users are opened in one place, which refuses pipes and notes what is read."""

from __future__ import annotations

import re
from pathlib import Path

PACKAGE = Path(__file__).parents[2] / "python" / "daguerre"
#: Other files, each of the package itself, of the system, or just written by the same function.
OTHERS = {
    "cluster/store.py",  # the worker's own cache
    "compiled.py",  # /proc/cpuinfo
    "files/reading.py",  # the place
    "frame/shown.py",  # a temporary picture
    "pictures/picture_files.py",  # a pipe of this process
    "pictures/png.py",  # the temporary file that it writes
    "scene/packed/chunk.py",  # the .glb that was written just now
    "viewfinder/browser.py",  # the program of the browser
    "viewfinder/lens_list.py",  # drawings of the package
    "viewfinder/server.py",  # the page, and photographs that it has written
}
OPENS = re.compile(
    r"""\.read_bytes\(\)|open\([^()]*["']rb["']|\.open\(\)|fromfile\((?!stream)|np\.load\("""
)


def test_readers_open_files_in_one_place() -> None:
    found = {
        path.relative_to(PACKAGE).as_posix()
        for path in PACKAGE.rglob("*.py")
        if OPENS.search(path.read_text("utf-8"))
    }
    assert found - OTHERS == set()
    assert OTHERS - found == set(), "not needed any more"
