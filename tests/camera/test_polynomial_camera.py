"""Polynomial lenses against the exact ones that they stand for: rays, pictures, refusals."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre.errors import UsageError
from daguerre.setup.camera import set_up
from daguerre.setup.fit import FitQuality
from daguerre.setup.resolved import ResolvedCamera
from tests.support.lenses.line_glass import on_the_line
from tests.support.scene import scenes

Array = NDArray[np.float64]
GAUSS = "double-gauss-50mm-f2"
ZOOM = "nikon-af-s-70-200mm-f2.8"
RESOLUTION = (600, 400)


@dataclass(frozen=True)
class Case:
    """A camera, and how far its fit may be off."""

    name: str
    camera: dict[str, Any] = field(default_factory=dict)

    def both(self) -> tuple[ResolvedCamera, ResolvedCamera]:
        """Polynomial and exact."""
        camera = dg.Camera(**({"focus_distance": 3.0} | self.camera), lens_model="polynomial")
        made = [
            set_up(dg.Scene(), c, RESOLUTION, None)
            for c in (camera, camera.with_(lens_model="exact"))
        ]
        return made[0], made[1]


CASES = [
    Case("double Gauss wide open", {"lens": GAUSS, "f_stop": 2.0}),
    Case("zoom, blades", {"lens": ZOOM, "zoom": 150.0, "blades": 7}),
    Case("fisheye beyond 90 degrees", {"lens": "nikon-fisheye-6mm-f5.6", "degree": 9}),
    Case("tilted", {"lens": GAUSS, "f_stop": 4.0, "tilt": (0.0, 4.0), "degree": 5}),
    Case("dropped", {"lens": GAUSS, "decenter": (((6, 10), (0.2, 0.0)),), "degree": 5}),
]


def quality(setup: ResolvedCamera) -> FitQuality:
    glass = setup.lens.glass
    assert glass is not None
    assert glass.fit is not None
    return glass.fit


def draw(setup: ResolvedCamera, film: Array, u: Array, nm: Array) -> tuple[Array, Array, Array]:
    core: Any = setup.core
    o, d, w = core.rays(*(np.ascontiguousarray(v, np.float32) for v in (film, u, nm)))
    return np.asarray(o, float), np.asarray(d, float), np.asarray(w, float)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_rays_are_those_of_the_exact_lens_within_the_stated_error(case: Case) -> None:
    fitted, exact = case.both()
    assert fitted.lens.model == "polynomial", fitted.notes
    random = np.random.default_rng(2)
    film = (random.random((6000, 2)) - 0.5) * fitted.frame_size_mm
    u, nm = random.random((6000, 2)), 390 + 380 * random.random(6000)
    (o1, d1, w1), (o2, d2, w2) = draw(fitted, film, u, nm), draw(exact, film, u, nm)
    lit = (w1 > 0) & (w2 > 0)
    assert lit.sum() > 0.3 * len(film)
    assert ((w1 > 0) != (w2 > 0)).sum() < 5e-3 * lit.sum()
    # where the rays cross the sphere of focus: as far apart as the film error is there
    if quality(fitted).rms_um < 5:
        f = fitted.lens.effective_focal_length_mm
        away = [o[lit] + 3 * d[lit] for o, d in ((o1, d1), (o2, d2))]
        apart = np.linalg.norm(away[0] - away[1], axis=1) / 3 * f * 1e3  # um on the film
        assert math.sqrt((apart**2).mean()) < 3 * quality(fitted).rms_um + 0.1
    bright = np.abs(w1 - w2)[lit] / w2[lit].mean()
    assert math.sqrt((bright**2).mean()) < 0.01


def test_the_default_degree_and_its_error_are_said() -> None:
    camera = dg.Camera(lens=GAUSS, lens_model="polynomial", focus_distance=3.0)
    setup = set_up(dg.Scene(), camera, RESOLUTION, None)
    assert quality(setup).degree == 7
    assert quality(setup).rms_px == pytest.approx(quality(setup).rms_um / 60)
    assert any("degree 7 is off by" in note for note in setup.notes)


def test_a_fit_that_is_not_good_enough_is_named_and_replaced() -> None:
    camera = dg.Camera(lens=GAUSS, lens_model="polynomial", degree=1, focus_distance=3.0)
    setup = set_up(dg.Scene(), camera, RESOLUTION, None)
    exact = set_up(dg.Scene(), camera.with_(lens_model="exact"), RESOLUTION, None)
    assert setup.lens.model == "exact"
    (note,) = [n for n in setup.notes if "degree 1" in n]
    assert "mm from the middle" in note
    assert "degrees off the axis" in note
    assert "the exact lens draws instead" in note
    u = np.random.default_rng(1).random((500, 2))
    nm = np.full(500, 550.0)
    for a, b in zip(draw(setup, 20 * u - 10, u, nm), draw(exact, 20 * u - 10, u, nm), strict=True):
        np.testing.assert_array_equal(a, b)
    lenient = set_up(dg.Scene(), camera.with_(fit_tolerance=1e3), RESOLUTION, None)
    assert lenient.lens.model == "polynomial"


def test_the_region_is_named_by_what_its_edge_still_sees() -> None:
    """The outermost zone reaches beyond the last film point that light finds."""
    camera = dg.Camera(
        lens="petzval-100mm-f2.2", lens_model="polynomial", degree=3, focus_distance=2.0
    ).with_(sensor_size=(24, 16), f_stop=2.8, fit_tolerance=1e-3)
    (note,) = [n for n in set_up(dg.Scene(), camera, (240, 160), None).notes if "degree 3" in n]
    low, high = (int(x) for x in re.search(r"\((\d+) to (\d+) degrees", note).groups())
    assert 0 < low <= high


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"degree": 4}, "degree: wanted an odd number from 1 to 13, got 4"),
        ({"degree": 15}, "degree: wanted an odd number from 1 to 13, got 15"),
        ({"degree": -1}, "degree: wanted an odd number from 1 to 13, got -1"),
        ({"lens_model": "exact", "degree": 7}, "degree: wanted lens_model polynomial, got"),
        ({"lens_model": "thin", "fit_tolerance": 1.0}, "wanted lens_model polynomial, got"),
        ({"fit_tolerance": 0.0}, "fit_tolerance"),
        ({"ripple": (2.0, 100.0)}, "ripple: wanted lens_model exact"),
        ({"lens": "thin"}, "lens_model: polynomial needs a lens with a prescription"),
    ],
)
def test_what_a_polynomial_lens_cannot_do(given: dict[str, Any], said: str) -> None:
    camera = dg.Camera(**({"lens": GAUSS, "lens_model": "polynomial"} | given))
    with pytest.raises(UsageError, match=said):
        set_up(dg.Scene(), camera, (36, 24), None)


def test_another_model_drops_what_only_polynomials_have() -> None:
    camera = dg.Camera(lens=GAUSS, lens_model="polynomial", degree=9, fit_tolerance=2.0)
    exact = camera.with_(lens_model="exact")
    assert (exact.degree, exact.fit_tolerance) == (None, None)
    assert camera.with_(f_stop=4.0).degree == 9


def test_a_white_world_through_both() -> None:
    pictures = []
    for model in ("exact", "polynomial"):
        lens = on_the_line(GAUSS)
        camera = dg.Camera(lens=lens, lens_model=model, f_stop=2.0, focus_distance=3.0)
        frame = dg.render(scenes.furnace(), camera, resolution=(36, 24), spp=32, filter="box")
        pictures.append(np.asarray(frame.xyz))
        assert frame.metadata["camera"]["lens_model"] == model
    # the same samples: only rays at the rims of iris and mounts change sides
    apart = np.abs(pictures[1] - pictures[0]) / pictures[0]
    assert (apart > 1e-3).mean() < 0.1
    np.testing.assert_allclose(pictures[1].mean((0, 1)), pictures[0].mean((0, 1)), rtol=1e-3)


def test_states_of_a_lens_that_changes_are_what_its_middle_is() -> None:
    camera = dg.Camera(
        lens=GAUSS,
        lens_model="polynomial",
        degree=1,
        f_stop=2.8,
        focus_distance=dg.keys([(0.0, 2.0), (1.0, 3.0)]),
        shutter_time=1.0,
        shutter_offset=0.0,
    )
    setup = set_up(dg.Scene(), camera, RESOLUTION, None)
    exact = set_up(dg.Scene(), camera.with_(lens_model="exact"), RESOLUTION, None)
    assert setup.lens.model == "exact"
    u, nm = np.random.default_rng(3).random((200, 2)), np.full(200, 550.0)
    for a, b in zip(draw(setup, 9 * u, u, nm), draw(exact, 9 * u, u, nm), strict=True):
        np.testing.assert_array_equal(a, b)
