"""Corners of the library's lenses: no mount blocks their chief rays, and they do not darken."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from daguerre import analysis, lenses
from daguerre.analysis.bench import Bench

ROOT = Path(__file__).parents[2]
# Transcribed diameters blocked the corners of the first seven; the ninth has mounts.
TEN = (
    "asahi-super-takumar-50mm-f1.4",
    "canon-ef-24-70mm-f2.8",
    "laowa-12mm-f2.8",
    "olympus-xa-35mm-f2.8",
    "sigma-17-40mm-f1.8",
    "sonnar-50mm-f2",
    "zeiss-distagon-28mm-f2",
    "laikin-fisheye-5mm-f1.8",
    "sony-sonnar-55mm-f1.8",
    "tessar-50mm-f2.8",
)
WIDENED = {"laowa-12mm-f2.8": {0: 24.5, 2: 18, 3: 15, 4: 10.5}, "wide-angle-28mm-f3.5": {2: 16}}
DARKER = 0.85  # least light of a stop over that of a wider one; pupils have aberrations
SHARES = np.array([0, 0.85, 0.93, 1.0])


def benches(name: str) -> list[Bench]:
    """A lens wide open, at both ends of its zoom."""
    lens = lenses.load(name)
    return [analysis.set_up(lens, zoom_mm=zoom) for zoom in lens.zoom_range_mm or (None,)]


def faults(name: str) -> list[str]:
    """Heights at which a mount blocks the chief ray, or the light falls as the iris closes."""
    found = []
    for bench in benches(name):
        heights = bench.field_mm * SHARES
        chief = analysis.chief_rays(bench, heights)
        passed = bench.rays(chief.points - chief.directions, chief.directions).passed
        found += [f"{y:.2f} mm: no chief ray" for y in heights[~passed]]
        light = np.array(
            [
                analysis.relative_illumination(
                    bench.stopped(k * bench.f_stop), heights, grid=40
                ).relative
                for k in (1, 3.5, 8)
            ]
        )
        darker = (light < DARKER * np.maximum.accumulate(light)).any(axis=0)
        found += [f"{y:.2f} mm: darkens" for y in heights[darker]]
    return found


@pytest.mark.parametrize("name", TEN)
def test_no_corner_darkens_as_the_iris_closes(name: str) -> None:
    assert faults(name) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", lenses.names())
def test_no_corner_of_the_library_darkens_as_the_iris_closes(name: str) -> None:
    assert faults(name) == []


@pytest.mark.parametrize("name", WIDENED)
def test_widened_diameters_keep_those_of_the_source(name: str) -> None:
    lens = lenses.load(name)
    found = {i: s.widened_from for i, s in enumerate(lens.surfaces) if s.widened_from}
    assert found == WIDENED[name]
    assert "+ wider than in the source" in repr(lens)
    assert [
        line.split("+")[0].split()[-1] for line in repr(lens).splitlines()[3:-1] if "+" in line
    ] == [f"{lens.surfaces[i].semi_diameter:.3f}" for i in found]


def widen(*names: str) -> str:
    """Files that the script would change."""
    command = [sys.executable, str(ROOT / "script" / "widen-diameters"), "--check", *names]
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()


def test_the_script_finds_its_own_diameters() -> None:
    assert widen("laowa-12mm-f2.8", "wide-angle-28mm-f3.5", "tessar-50mm-f2.8") == ""


@pytest.mark.slow
def test_the_script_finds_all_of_its_diameters() -> None:
    assert widen() == ""
