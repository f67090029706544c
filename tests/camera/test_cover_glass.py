"""A plane glass right before the film moves the focus, and nothing else."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.analysis import set_up
from daguerre.analysis.glare import VeilingGlare
from daguerre.lenses import library
from tests.camera.test_lens_models import LENS, Array, rays

INDEX, THICKNESS = 1.5168, 2.0


def covered(folder: Path, gap: float) -> dg.lenses.Lens:
    """The lens with a glass of 2 mm that ends ``gap`` mm before the film."""
    data = json.loads((library.FOLDER / f"{LENS}.json").read_text(encoding="utf-8"))
    surfaces = data["surfaces"]
    surfaces[-1]["thickness"] -= gap + THICKNESS / INDEX
    plane = {"kind": "spherical", "radius": None, "semi_diameter": 25}
    surfaces.append(plane | {"thickness": THICKNESS, "glass": {"nd": INDEX, "vd": 64.17}})
    surfaces.append(plane | {"thickness": gap, "glass": None})
    path = folder / "covered.json"
    path.write_text(json.dumps(data), encoding="utf-8")
    return dg.lenses.load(path)


def means(camera: dg.Camera, film: list[tuple[float, float]]) -> Array:
    """Unit vectors (N, 3) toward which each film point looks."""
    found = rays(camera, film)[1].sum(axis=1)
    return np.asarray(found / np.linalg.norm(found, axis=1, keepdims=True))


@pytest.mark.parametrize("angles", [(0.5, 0.0), (5.0, 0.0), (0.0, -8.0)])
def test_a_tilted_lens_sees_the_same_through_it(
    tmp_path: Path,
    angles: tuple[float, float],
) -> None:
    film = [(0.0, 0.0), (3.0, -2.0), (-2.0, 3.0)]
    plain = dg.Camera(lens=LENS, f_stop=11.0, focus_distance=2.0, tilt=angles)
    glass = plain.with_(lens=covered(tmp_path, 3.0))
    near = plain.with_(lens=covered(tmp_path, 0.5))
    for camera in (glass, near):
        np.testing.assert_allclose(means(camera, film), means(plain, film), atol=1e-3)


def test_veiling_glare_is_found_however_near_the_glass_is(tmp_path: Path) -> None:
    found = [
        VeilingGlare(set_up(covered(tmp_path, gap), f_stop=4.0), walks=100_000)
        for gap in (8.0, 0.5, 0.25)
    ]
    far, near, nearest = found
    for one in (near, nearest):
        assert one.scatter_error < 0.15 * one.scatter
        assert one.scatter == pytest.approx(far.scatter, rel=0.3)
        assert abs(one.ghosts - far.ghosts) < 4 * (one.ghosts_error + far.ghosts_error)
