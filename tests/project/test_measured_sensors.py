"""The bench of measured bodies: the white of daylight, and noise by ISO."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from daguerre.sensors import load, names

ROOT = Path(__file__).resolve().parents[2]
BENCH, DATA = ROOT / "bench", ROOT.parent / "shared" / "data" / "reality"
#: Bodies with figures of others.
KNOWN = ("fujifilm-x-t4", "nikon-d5100", "sony-a7r-ii")


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.syspath_prepend(str(BENCH))
    import measured_sensors

    return measured_sensors


@pytest.fixture
def bodies(bench: Any) -> dict[str, Any]:
    """Measurements of the library's bodies."""
    if not (DATA / bench.CAMERAS).is_file():
        pytest.skip("no measured bodies at ../shared/data/reality")
    found = ((name, bench.measurements(load(name), bench.cameras(DATA))) for name in names())
    return {name: measured for name, measured in found if measured}


def test_white_of_daylight(bench: Any, bodies: dict[str, Any]) -> None:
    assert set(KNOWN) <= set(bodies)
    for name, measured in bodies.items():
        off = bench.daylight(load(name), measured["xyz_to_camera_d65"])
        assert max(map(abs, off.values())) < 0.2, name


@pytest.mark.parametrize("name", KNOWN)
def test_noise_keeps_its_ratio_over_iso(bench: Any, bodies: dict[str, Any], name: str) -> None:
    pytest.importorskip("rawpy", reason="rawpy is not installed")
    assert bench.row(load(name), bodies[name])["flat"] < 0.1


@pytest.mark.slow
def test_noise_of_every_body(bench: Any, bodies: dict[str, Any]) -> None:
    pytest.importorskip("rawpy", reason="rawpy is not installed")
    for name in set(bodies) - set(KNOWN):
        assert bench.row(load(name), bodies[name])["flat"] < 0.1, name


def test_noise_of_a_known_picture(bench: Any) -> None:
    """Each value of the band is a quarter of four: a quarter of their variance."""
    light = np.broadcast_to(np.linspace(0, 1, 1000), (2000, 1000))
    sigma = np.sqrt(1e-4 * light + 1e-6)
    noisy = light + sigma * np.random.default_rng(1).standard_normal(light.shape)
    slope, intercept = bench.line_of(*bench.variances(noisy))
    assert slope == pytest.approx(0.25e-4, rel=0.02)
    assert intercept == pytest.approx(0.25e-6, rel=0.3)


def test_without_data() -> None:
    command = [sys.executable, str(BENCH / "measured_sensors.py"), "--data", str(BENCH)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 3
    assert "--data: wanted a folder with cameras.json" in done.stderr


def test_body_without_measurements(
    bench: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / bench.CAMERAS).write_text(json.dumps({"cameras": []}))
    words = ["measured_sensors.py", "--data", str(tmp_path), "--sensor", "nikon-d5100"]
    monkeypatch.setattr(sys, "argv", words)
    with pytest.raises(SystemExit, match="3"):
        bench.main()
