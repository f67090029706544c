"""Ground truth: chief rays and their inverse, exact values at a stated time, motion in pixels."""

from __future__ import annotations

import daguerre._core as _core
import numpy as np
import pytest

from daguerre import lenses


@pytest.mark.parametrize("name", ["fisheye-16mm-f2.8", "telephoto-200mm-f1.8", "sonnar-50mm-f2"])
def test_the_film_point_of_a_chief_ray_is_where_it_came_from(name: str) -> None:
    lens = lenses.load(name)
    f_stop = lens.first_order().f_number
    exact = _core.ExactLens(lens.prescription, f_stop, _core.Iris(), 3.0, False, 22.0)
    chief = _core.Camera.exact(_core.Motion.still(np.eye(4)), exact).chief_rays()
    radius, angle = np.random.default_rng(1).uniform(0, [[21.6], [6.28]], (2, 500))
    film = radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], 1)
    origins, directions = chief.rays(film)
    for distance in (0.5, 3.0, 1e6):
        back = chief.film_points(origins + distance * directions)
        assert np.abs(back - film).max() < 1e-3 * 0.006  # mm: 1e-3 px of 6 um
    assert np.abs(chief.film_points(directions, True) - film).max() < 1e-3 * 0.006
