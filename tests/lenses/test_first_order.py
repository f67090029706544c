"""First-order data of a triplet against those of a commercial program."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from daguerre import lenses

SK16, F2 = {"name": "SK16", "maker": "Hikari"}, {"name": "F2", "maker": "Schott"}
#: Radius and thickness, mm, and glass; the stop is the flint's rear surface.
TRIPLET = (
    (22.01359, 3.25896, SK16),
    (-435.76044, 6.00755, None),
    (-22.21328, 0.99997, F2),
    (20.29192, 4.75041, None),
    (79.6836, 2.95208, SK16),
    (-18.39533, 42.20778, None),
)
STOP = 3
#: OpticStudio 2026 R1 at 550 nm, in https://github.com/optiland/optiland/issues/710; mm.
#: Positions behind the lens are from the film, 42.20778 mm behind the last vertex.
EFL = 49.99978307143194
BACK_FOCAL_POINT = 0.2070775589588518
ENTRANCE_PUPIL = 11.51215867379674
REAR_PRINCIPAL_POINT = -49.79270551247308
EXIT_PUPIL = -50.961348024


def lens_in(folder: Path) -> lenses.Lens:
    surfaces: list[dict[str, Any]] = [
        {"kind": "spherical", "radius": r, "thickness": t, "glass": glass, "stop": i == STOP}
        for i, (r, t, glass) in enumerate(TRIPLET)
    ]
    path = folder / "triplet.json"
    path.write_text(json.dumps({"schema": "daguerre-lens/0.1", "surfaces": surfaces}))
    return lenses.load(path)


def test_first_order_agrees_with_a_commercial_program(tmp_path: Path) -> None:
    lens = lens_in(tmp_path)
    order = lens.first_order(550.0)
    film = float(lens.vertices[-1]) + TRIPLET[-1][1]
    found = (
        order.efl,
        order.back_focal_point - film,
        order.entrance_pupil.z,
        order.back_principal_point - film,
    )
    expected = (EFL, BACK_FOCAL_POINT, ENTRANCE_PUPIL, REAR_PRINCIPAL_POINT)
    assert found == pytest.approx(expected, rel=1e-11)
    assert order.exit_pupil.z - film == pytest.approx(EXIT_PUPIL, rel=0, abs=1e-6)
