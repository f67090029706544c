"""Models of distortion: there and back, against OpenCV, and what they answer outside."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from daguerre import lenses
from daguerre.analysis.bench import set_up
from daguerre.analysis.chief import chief_rays
from daguerre.distortion import (
    BrownConrady,
    Distortion,
    Division,
    Equidistant,
    Equisolid,
    OpenCV,
    OpenCVFisheye,
    Orthographic,
    Stereographic,
)
from daguerre.distortion.lens import LensDistortion
from daguerre.distortion.lens_map import LensMap
from daguerre.errors import DaguerreError, InputError

ALL = OpenCV(
    *(0.3, 0.1, 0.001, -0.002, 0.02, 0.5, 0.1, 0.01),
    *(0.001, 0.002, -0.001, 0.0005, 0.02, -0.03),
)
MODELS = [
    BrownConrady(-0.2, 0.05, 0.001, -0.002, 0.01),
    BrownConrady(0.2),
    ALL,
    OpenCVFisheye(-0.02, 0.01, -0.003, 0.0004),
    Division(-0.3, -0.02),
    Division(0.2),
    Equidistant(),
    Equisolid(),
    Stereographic(),
    Orthographic(),
]
POINTS = np.random.default_rng(3).uniform(-1, 1, (2000, 2)) * [0.7, 0.5]

SQUEEZED = "schneider-anamorphic-60mm"


def lens(name: str = "canon-ef-11-24mm-f4", **setting: float) -> LensDistortion:
    return LensDistortion(set_up(lenses.load(name), **setting), 20.0)


@pytest.mark.parametrize("name", ["laikin-projection-28mm-f2.8", "canon-ef-11-24mm-f4"])
def test_focal_length_is_the_scale_on_the_axis(name: str):
    # Two small heights are extrapolated to none; the first lens's chief rays end early.
    bench = set_up(lenses.load(name))
    heights = np.array([0.004, 0.008]) * bench.order.efl
    near, far = heights / chief_rays(bench, heights).angles
    focal = LensDistortion(bench, 1.05 * bench.field_mm).focal_length_mm
    assert focal == pytest.approx((4 * near - far) / 3, rel=3e-9)


@pytest.mark.parametrize("model", [*MODELS, lens()], ids=lambda m: type(m).__name__)
def test_there_and_back(model: Distortion):
    bent = model.distort(POINTS)
    assert np.isfinite(bent).all()
    assert np.abs(model.undistort(bent) - POINTS).max() < 1e-11
    assert model.distort([[0, 0]]) == pytest.approx(np.zeros((1, 2)), abs=1e-15)


@pytest.mark.parametrize("model", MODELS, ids=lambda m: type(m).__name__)
def test_near_the_axis_all_have_the_scale_of_an_ideal_lens(model: Distortion):
    if isinstance(model, OpenCV) and model.tau_x:
        pytest.skip("a sensor that is turned has another scale")
    near = np.array([[1e-5, 2e-5], [-2e-5, 1e-5]])
    assert model.distort(near) == pytest.approx(near, rel=1e-6)


@pytest.mark.parametrize("model", [m for m in MODELS if isinstance(m, OpenCV | OpenCVFisheye)])
def test_opencv_says_the_same(model):
    cv2 = pytest.importorskip("cv2", reason="opencv-python-headless is not installed")
    numbers = np.array(dataclasses.astuple(model))
    points = np.column_stack([POINTS, np.ones(len(POINTS))])[:, None]
    call = cv2.projectPoints if isinstance(model, OpenCV) else cv2.fisheye.projectPoints
    seen, _ = call(points, np.zeros(3), np.zeros(3), np.eye(3), numbers)
    assert np.abs(seen[:, 0] - model.distort(POINTS)).max() < 1e-14


def test_projections_are_what_they_say():
    angle = np.radians([10, 45, 80])
    ideal = np.column_stack([np.tan(angle), 0 * angle])
    for model, radius in [
        (Equidistant(), angle),
        (Equisolid(), 2 * np.sin(angle / 2)),
        (Stereographic(), 2 * np.tan(angle / 2)),
        (Orthographic(), np.sin(angle)),
    ]:
        assert model.distort(ideal)[:, 0] == pytest.approx(radius, rel=1e-14)


@pytest.mark.parametrize(
    ("model", "inside", "outside"),
    [
        (BrownConrady(-0.5), math.sqrt(2 / 3) - 1e-6, math.sqrt(2 / 3) + 1e-6),
        (BrownConrady(-0.5, p1=1e-4), math.sqrt(2 / 3) - 1e-3, math.sqrt(2 / 3) + 1e-3),
    ],
)
def test_a_formula_that_turns_back_ends_there(model, inside, outside):
    assert np.isfinite(model.distort([[inside, 0]])).all()
    assert np.isnan(model.distort([[outside, 0]])).all()
    edge = model.distort([[inside, 0]])
    assert model.undistort(edge) == pytest.approx(np.array([[inside, 0]]), abs=1e-6)
    assert np.isnan(model.undistort(edge * 1.01)).all()


def test_beside_the_camera_there_is_no_plane():
    assert np.isnan(Equidistant().undistort([[math.pi / 2 + 0.01, 0]])).all()
    assert np.isnan(Orthographic().undistort([[1.01, 0], [0, -1.2]])).all()
    assert np.isnan(Equisolid().undistort([[0, 2.1]])).all()
    assert np.isnan(OpenCVFisheye().undistort([[0, 4]])).all()
    assert np.isnan(Division(0.5).undistort([[1.5, 0]])).all()
    assert np.isnan(Division(0.5).distort([[0.8, 0]])).all()  # at most 1 / sqrt(2)


@pytest.mark.parametrize("focus", [math.inf, 0.8])
@pytest.mark.parametrize("nm", [450.0, 650.0])
def test_a_lens_is_its_chief_rays(focus, nm):
    bench = set_up(lenses.load("canon-ef-11-24mm-f4"), focus_m=focus)
    model = LensDistortion(bench, 20.2, nm)
    heights = np.array([0.5, 3.3, 11.0, 17.7, 20.0])
    rays = chief_rays(bench, heights, nm)
    seen = np.abs(rays.directions[:, 1] / rays.directions[:, 2])
    if math.isfinite(focus):  # where they meet the plane in focus
        along = bench.order.entrance_pupil.z - bench.focus_mm - rays.points[:, 2]
        slope = rays.directions[:, 1] / rays.directions[:, 2]
        seen = np.abs(rays.points[:, 1] + slope * along) / bench.focus_mm
    focal = model.focal_length_mm
    found = model.undistort(np.column_stack([0 * heights, heights / focal]))[:, 1]
    assert np.abs(found - seen).max() * focal < 3e-6  # mm
    assert model.distort(np.column_stack([seen, 0 * seen]))[:, 0] * focal == pytest.approx(heights)


def test_a_lens_ends_where_its_picture_ends():
    fisheye = lens("canon-ef-15mm-f2.8-fisheye")
    focal = fisheye.focal_length_mm
    assert np.isfinite(fisheye.undistort([[19 / focal, 0]])).all()
    assert np.isnan(fisheye.undistort([[20.5 / focal, 0]])).all()
    with pytest.raises(InputError, match="wanted an axially symmetric lens"):
        LensDistortion(set_up(lenses.load(SQUEEZED)), 10.0)


def skew_lens(kind: str):
    """A bench, and half of the film, mm."""
    if kind == "anamorphic":
        return set_up(lenses.load(SQUEEZED), focus_m=3.0), (12.45, 10.35)
    item = lenses.load("double-gauss-50mm-f2").decentered((9, 10), (0.4, -0.3), (1.0, 0.5))
    return set_up(item, focus_m=3.0), (18.0, 12.0)


@pytest.mark.parametrize("kind", ["anamorphic", "decentred"])
@pytest.mark.parametrize("nm", [450.0, 650.0])
def test_a_skew_lens_is_its_chief_rays(kind, nm):
    """Each film point, upside down, shows what its chief ray meets on the plane in focus."""
    bench, half = skew_lens(kind)
    model = LensMap(bench, half, nm)
    picture = np.random.default_rng(2).uniform(-1, 1, (50, 2)) * half  # mm to the right and down
    rays = chief_rays(bench, picture * (-1, 1), nm)
    away = bench.order.entrance_pupil.z - bench.focus_mm
    share = (away - rays.points[:, 2]) / rays.directions[:, 2]
    met = rays.points[:, :2] + share[:, None] * rays.directions[:, :2]
    ideal = met / bench.focus_mm * (1, -1)  # x to the right, y down
    bent = picture / model.focal_mm
    assert np.abs(model.undistort(bent) - ideal).max() * max(model.focal_mm) < 1e-6  # mm
    assert model.distort(ideal) == pytest.approx(bent, abs=1e-9)
    assert np.abs(ideal - bent).max() * min(model.focal_mm) > 0.1  # and there is something to see


def test_the_scales_of_a_squeezed_picture_are_the_lens_s_own():
    bench = set_up(lenses.load(SQUEEZED))
    across, down = LensMap(bench, (12.45, 10.35)).focal_mm
    orders = [bench.lens.first_order(section=section).efl for section in ("x", "y")]
    assert (across, down) == pytest.approx([abs(efl) for efl in orders], rel=0.03)
    near = np.array([[1e-3, 0], [0, 1e-3]])
    assert LensMap(bench, (12.45, 10.35)).undistort(near) == pytest.approx(near, rel=1e-4, abs=1e-9)


def test_both_maps_say_the_same_of_a_straight_lens():
    bench = set_up(lenses.load("canon-ef-11-24mm-f4"), zoom_mm=23, focus_m=2.0)
    radial, flat = LensDistortion(bench, 21.7, 545.0), LensMap(bench, (18.0, 12.0), 545.0)
    assert flat.focal_mm == pytest.approx((radial.focal_length_mm,) * 2, rel=1e-6)
    film = np.random.default_rng(3).uniform(-1, 1, (200, 2)) * (18, 12)
    found, wanted = (m.undistort(film / radial.focal_length_mm) for m in (flat, radial))
    assert np.abs(found - wanted).max() * radial.focal_length_mm < 1e-3 * 0.006  # mm of a pixel


def test_a_map_ends_where_its_film_or_its_light_ends():
    bench = set_up(lenses.load("canon-ef-15mm-f2.8-fisheye"))
    model = LensMap(bench, (22.0, 22.0))
    focal = model.focal_mm[0]
    assert np.isfinite(model.undistort([[15 / focal, 0], [0, -15 / focal]])).all()
    far = model.undistort([[21.9 / focal, 21.9 / focal], [23 / focal, 0], [np.nan, 0]])
    assert np.isnan(far).all()
    assert np.isnan(model.distort([[1e3, 0]])).all()


@pytest.mark.parametrize("points", [[1, 2], [[1, 2, 3]], [["a", "b"]], [[1], [1, 2]]])
def test_bad_points(points):
    with pytest.raises(DaguerreError, match=r"points: wanted shape \(N, 2\)"):
        Equidistant().distort(points)
