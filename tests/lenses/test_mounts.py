"""Mounts: plane apertures in air, which clip rays and bend none."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from daguerre import analysis, lenses
from daguerre.errors import InputError
from daguerre.lenses.library import FOLDER

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT.parent / "shared" / "data" / "reality" / "lens_measured.json"
TESSAR = "tessar-50mm-f2.8"
GAP = 1  # after this surface of the Tessar is air
#: RMS difference wide open, which the fit leaves out, EV; without mounts 0.26 to 0.54.
OPEN_EV = {
    "canon-ef-15mm-f2.8-fisheye": 0.16,
    "fujifilm-gf-110mm-f2": 0.07,
    "nikon-z-14-24mm-f2.8": 0.13,
    "sigma-50mm-f1.4": 0.2,
    "sony-sonnar-55mm-f1.8": 0.41,
    "voigtlander-apo-lanthar-50mm-f2": 0.23,
}


def with_mount(folder: Path, **row: Any) -> lenses.Lens:
    """The Tessar with a mount in the middle of its first air gap."""
    data = json.loads((FOLDER / f"{TESSAR}.json").read_text(encoding="utf-8"))
    whole = data["surfaces"][GAP]["thickness"]
    data["surfaces"][GAP]["thickness"] = whole / 2
    plane = {"kind": "spherical", "radius": None, "thickness": whole / 2, "fitted": True}
    data["surfaces"].insert(GAP + 1, {**plane, **row})
    data["configurations"] = []
    path = folder / "mounted.json"
    path.write_text(json.dumps(data))
    return lenses.read(path)


def heights(lens: lenses.Lens, clip: bool) -> NDArray[np.float64]:
    """Where rays along the axis, across the front, meet the film."""
    y = np.linspace(-9, 9, 19)
    origins = np.stack([0 * y, y, 0 * y - 20], axis=1)
    return lens.trace(origins, [0, 0, 1], clip=clip)[:, 1]


def test_a_mount_clips_and_bends_nothing(tmp_path: Path) -> None:
    bare, lens = lenses.load(TESSAR), with_mount(tmp_path, semi_diameter=4.0)
    free = heights(lens, clip=False)
    assert free == pytest.approx(heights(bare, clip=False), abs=1e-12)
    inside = np.isfinite(heights(lens, clip=True))
    assert inside.tolist() == [abs(y) <= 4 for y in range(-9, 10)]


def test_a_mount_may_cross_the_sag_of_its_neighbours(tmp_path: Path) -> None:
    """It is no element: nothing ends where the plane meets glass."""
    lens = with_mount(tmp_path, semi_diameter=9.0)
    assert lens.notes == lenses.load(TESSAR).notes
    assert repr(lens).splitlines()[-1].startswith("~ a mount")
    assert lens.surfaces[GAP + 1].fitted


@pytest.mark.parametrize(
    "row", [{"semi_diameter": None}, {"semi_diameter": 5, "radius": 40}, {"fitted": 1}]
)
def test_a_mount_is_a_plane_of_known_size(tmp_path: Path, row: dict[str, Any]) -> None:
    with pytest.raises(InputError, match=r"surfaces\[2\]\.fitted: w"):
        with_mount(tmp_path, **{"semi_diameter": 5, **row})


@pytest.mark.parametrize("name", OPEN_EV)
def test_mounts_of_the_library_leave_the_axis_its_light(name: str) -> None:
    lens = lenses.load(name)
    mounts = [i for i, s in enumerate(lens.surfaces) if s.fitted]
    wide = [s.replaced(semi_diameter=1e3) if s.fitted else s for s in lens.surfaces]
    assert mounts
    light = [
        analysis.relative_illumination(analysis.set_up(one), [0.0, 12.0]).irradiance
        for one in (lens, lens.rebuilt(wide))
    ]
    assert light[0][0] == pytest.approx(light[1][0], rel=1e-3)
    assert light[0][1] < 0.98 * light[1][1]


@pytest.mark.parametrize("name", OPEN_EV)
def test_wide_open_the_light_is_near_the_measured_one(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    if not DATA.is_file():
        pytest.skip("no measured lenses at ../shared/data/reality")
    monkeypatch.syspath_prepend(str(ROOT / "bench"))
    from measured import kind, vignetting
    from measured_products import calibrations

    (one,) = [c for c in calibrations(DATA.parent)[0] if c.lens == name]
    found = [vignetting(one, t)["ev"] for t in one.farthest() if kind(one, t) == "open"]
    assert found
    assert np.median(found) < OPEN_EV[name]
