"""The benches of lenses run, and their JSON has the keys that others read."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]


def result(script: str, *flags: str) -> dict[str, Any]:
    command = [sys.executable, str(ROOT / "bench" / script), "--json", *flags]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def test_lens_rays() -> None:
    found = result("lens_rays.py", "--seconds", "0.001", "--f-stop", "8")
    assert found["bench"] == "lens_rays"
    assert found["lens"] == "double-gauss-50mm-f2"
    assert found["valid_rays_per_second"] == found["stops"]["f/8"]["valid_rays_per_second"] > 0
    assert found["pass_fraction"] > 0.9
    assert found["setup_seconds"] > 0
    zoom = found["zoom"]
    assert zoom["surfaces"] > 30
    assert zoom["valid_rays_per_second"] > 0
    assert zoom["pass_fraction_two_stops_down"] > 0.9
    assert len(zoom["stops"]) == 2


def test_lens_setup() -> None:
    found = result("lens_setup.py", "--only", "axial", "--repeats", "1", "--no-sheet")
    axial = found["lenses"]["axial"]
    assert 0 < axial["cold_seconds"] < 100 * axial["cold_wanted"]
    assert "sheet" not in found
