"""Scenes that the scripts of ``scenes/`` make."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[3] / "scenes"


def make(name: str, folder: Path, *flags: str) -> None:
    """Runs ``scenes/NAME.py``, which writes into the folder."""
    script = [sys.executable, SCRIPTS / f"{name}.py", "-o", folder, *flags]
    subprocess.run(script, check=True, capture_output=True)


def made_twice(name: str, folder: Path, most: int = 5_000_000) -> Path:
    """A folder of scenes; each had the same bytes, fewer than ``most``, when it was made again."""
    first, second = folder / "a", folder / "b"
    for each in (first, second):
        make(name, each)
    scenes = sorted(first.glob("*.glb"))
    assert scenes
    for scene in scenes:
        assert scene.read_bytes() == (second / scene.name).read_bytes()
        assert scene.stat().st_size < most
    return first
