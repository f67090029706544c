"""A command loads what it needs, so that it starts quickly."""

from __future__ import annotations

import subprocess
import sys

import pytest

LOADED = (
    "import sys; from daguerre.cli import main; main(sys.argv[1:]); "
    "print(*{name.split('.')[1] for name in sys.modules if name.startswith('daguerre.')})"
)


@pytest.mark.parametrize(
    ("command", "rooms"),
    [
        (["--version"], {"rendering", "setup", "lenses", "sensors", "development"}),
        (["lenses"], {"rendering", "setup", "development", "analysis"}),
        (["render", "nowhere.glb", "-o", "x.exr"], {"analysis", "plots", "development", "post"}),
    ],
)
def test_a_command_loads_no_room_that_it_does_not_enter(
    command: list[str], rooms: set[str]
) -> None:
    done = subprocess.run(
        [sys.executable, "-c", LOADED, *command], capture_output=True, text=True, check=True
    )
    assert not rooms & set(done.stdout.splitlines()[-1].split())
