"""The exact lens as a whole, through the public API: light, place, sharpness and colour.

Expected values come from a second tracer (lens_by_hand.py), from single rays of ``Lens.trace``, or
from formulas; never from the camera that is under test.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre import lenses
from tests.support.lenses import lens_by_hand as by_hand
from tests.support.lenses.lens_names import CLASSICS
from tests.support.scene import scenes

Array = NDArray[np.float64]
SIZE = (60, 40)
PIXEL = 36 / SIZE[0]  # mm
FAST = "double-gauss-50mm-f2"


# White worlds -------------------------------------------------------------------------------------


def f_stop(lens: lenses.Lens, stops_down: int) -> float:
    """The f-number so many stops below full aperture."""
    return lens.first_order().f_number * math.sqrt(2) ** stops_down * (1 + 1e-6)


def white(name: str, stop: float, spp: int = 64) -> dg.Frame:
    """A world of luminance 1 through a lens at infinity."""
    camera = dg.Camera(lens=name, f_stop=stop, focus_distance=math.inf)
    return dg.render(scenes.furnace(), camera, resolution=SIZE, spp=spp, filter="box")


def film_z(frame: dg.Frame, lens: lenses.Lens) -> float:
    """Where the film stands, mm in the lens frame."""
    return float(frame.metadata["entrancePupilOffset"] + lens.first_order().entrance_pupil.z)


def film_radius() -> Array:
    """Distance of each pixel's centre from the axis, mm, (H, W)."""
    y, x = np.mgrid[: SIZE[1], : SIZE[0]] + 0.5
    return np.asarray(np.hypot(x - SIZE[0] / 2, y - SIZE[1] / 2) * PIXEL)


def ring_errors(picture: Array, radii: Array, profile: Array, width: float = 1.0) -> Array:
    """Relative error of each ring of the film against the profile; rings under 5 % are left out."""
    r = film_radius()
    expected = np.interp(r, radii, profile)
    errors = []
    for inner in np.arange(0, radii[-1] - width, width):
        ring = (r >= inner) & (r < inner + width)
        if expected[ring].size >= 8 and expected[ring].min() > 0.05:
            errors.append(picture[ring].mean() / expected[ring].mean() - 1)
    return np.array(errors)


def lopsidedness(picture: Array) -> float:
    """Largest relative difference of a quadrant's ring from the other three."""
    h, w = SIZE[1] // 2, SIZE[0] // 2
    four = np.stack(
        [
            picture[:h, :w],
            picture[:h, ::-1][:, :w],
            picture[::-1][:h, :w],
            picture[::-1, ::-1][:h, :w],
        ]
    )
    r = film_radius()[:h, :w]
    worst = 0.0
    for inner in range(0, 20, 4):
        means = four[:, (r >= inner) & (r < inner + 4)].mean(axis=1)
        if means.mean() > 0.05:
            worst = max(worst, float(np.abs(means / means.mean() - 1).max()))
    return worst


@pytest.mark.parametrize(
    ("name", "stops_down"),
    [(name, 0) for name in CLASSICS]
    + [pytest.param(name, 2, marks=[] if name == FAST else pytest.mark.slow) for name in CLASSICS],
)
def test_a_white_world_shows_the_vignetting_alone(name: str, stops_down: int) -> None:
    lens = lenses.load(name)
    stop = f_stop(lens, stops_down)
    frame = white(name, stop)
    assert frame.xyz is not None
    picture = frame.xyz[..., 1].astype(np.float64)
    # Denser where mounts cut the picture off.
    radii = np.concatenate([np.linspace(0, 16, 9), np.linspace(16.5, 21.6, 12)])
    profile = np.array([by_hand.irradiance(lens, film_z(frame, lens), r, stop) for r in radii])
    profile /= profile[0]

    errors = ring_errors(picture, radii, profile)
    assert len(errors) >= 15
    assert np.abs(errors).max() < 0.02
    assert lopsidedness(picture) < 0.02
    if lens.nominal.image_circle_mm and lens.nominal.image_circle_mm >= 43.2:
        assert min(picture[0, 0], picture[0, -1], picture[-1, 0], picture[-1, -1]) > 0.02
    # A ring 4 % too bright or a side 5 % too dark must not go unnoticed.
    r = film_radius()
    ring = np.where((r > 8) & (r < 9), 1.04, 1)
    assert np.abs(ring_errors(picture * ring, radii, profile)).max() > 0.02
    side = np.where(np.arange(SIZE[0]) < SIZE[0] / 2, 0.95, 1)
    assert lopsidedness(picture * side) > 0.02


@pytest.mark.parametrize("name", [FAST, "wide-angle-35mm-f2", "sonnar-50mm-f2"])
def test_the_cast_of_a_white_world_is_that_of_the_coatings(name: str) -> None:
    lens = lenses.load(name)
    stop = f_stop(lens, 4)
    frame = white(name, stop)
    assert frame.xyz is not None
    nm = np.arange(400, 721, 20.0)
    light = [by_hand.irradiance(lens, film_z(frame, lens), 0, stop, n) for n in nm]
    weights = color_matching(nm) * daylight(nm)
    expected = (weights * light).sum(axis=1) / weights.sum(axis=1)
    found = frame.xyz[16:24, 26:34].mean(axis=(0, 1)) / white_point()
    np.testing.assert_allclose(found / found[1], expected / expected[1], atol=0.012)
    assert np.abs(found / found[1] - 1).max() < 0.12
    # The exposure by which the frame was divided, absolutely.
    assert frame.metadata["h0"] == pytest.approx(expected[1], rel=0.005)


def white_point() -> Array:
    """XYZ of RGB (1, 1, 1) in Rec.709 (D65)."""
    return np.array([0.95046, 1.0, 1.08906])


def color_matching(nm: Array) -> Array:
    """CIE 1931 x, y, z, shape (3, N): the fit of Wyman, Sloan and Shirley 2013, JCGT 2(2)."""

    def lobe(height: float, center: float, left: float, right: float) -> Array:
        return np.asarray(
            height * np.exp(-0.5 * ((nm - center) / np.where(nm < center, left, right)) ** 2)
        )

    return np.stack(
        [
            lobe(1.056, 599.8, 37.9, 31.0)
            + lobe(0.362, 442.0, 16.0, 26.7)
            - lobe(0.065, 501.1, 20.4, 26.2),
            lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1),
            lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8),
        ]
    )


def daylight(nm: Array) -> Array:
    """CIE illuminant D65, relative power: the standard's table at every 20 nm."""
    table = [49.98, 82.75, 93.43, 104.86, 117.81, 115.92, 109.35, 104.79, 104.41, 100.0, 95.79,
             90.01, 87.70, 83.70, 80.21, 78.28, 71.61, 61.60, 75.09]  # fmt: skip
    return np.interp(nm, np.arange(380, 741, 20), table)


@pytest.mark.parametrize("name", [FAST, "telephoto-600mm-f5.6"])
def test_exposure_stays_one_and_h0_halves_with_each_stop(name: str) -> None:
    lens = lenses.load(name)
    h0 = []
    for stops_down in range(4):
        camera = dg.Camera(lens=name, f_stop=f_stop(lens, stops_down), focus_distance=math.inf)
        frame = dg.render(
            scenes.furnace(),
            camera,
            resolution=(600, 400),
            crop=(295, 195, 305, 205),  # 0.6 mm: mounts shade a wide open lens right off the axis
            spp=64,
            filter="box",
        )
        assert frame.xyz is not None
        assert frame.xyz[..., 1].mean() == pytest.approx(1, abs=0.01)
        h0.append(frame.metadata["h0"])
    ratios = np.array(h0[1:]) / h0[:-1]
    np.testing.assert_allclose(ratios, 0.5, rtol=0.03)  # sin^2 is not exactly 1 / N^2


@pytest.mark.parametrize(("name", "stop"), [(FAST, 2.0), (FAST, 8.0), ("tessar-50mm-f2.8", 4.0)])
def test_axial_irradiance_is_pi_sin_squared(name: str, stop: float) -> None:
    """E = pi T L sin^2(theta'), theta' of the steepest ray that the iris passes."""
    lens = lenses.load(name)
    camera = dg.Camera(lens=name, f_stop=stop, focus_distance=math.inf)
    facts = dg.Session(scenes.furnace(), camera, resolution=(4, 4)).metadata
    film = facts["entrancePupilOffset"] + lens.first_order().entrance_pupil.z
    iris = by_hand.iris_radius(lens, stop)
    low, high = 0.0, 0.6  # sin(theta')
    for _ in range(40):
        sine = (low + high) / 2
        toward = np.array([[0, sine, -math.sqrt(1 - sine**2)]])
        passed = by_hand.passes(lens, np.array([[0, 0, film]]), toward, iris, 555)[0] > 0
        low, high = (sine, high) if passed else (low, sine)
    found = facts["h0"] / facts["camera"]["transmittance"]
    assert found == pytest.approx(math.pi * low**2, rel=0.005)
    assert found == pytest.approx(math.pi / (4 * stop**2), rel=0.07)


# Points -------------------------------------------------------------------------------------------

# About as many as `auto` chooses for a point in 3600 x 2400 pixels, whose trial takes most of the
# time. With four sample indices the noise of what is measured is about 1 % of what is allowed.
FEW_PATHS = (8000, 0)


def point_at(direction: tuple[float, float], degrees: float, distance: float) -> Array:
    """A point (m, camera frame) at an angle from the axis and a distance from the pupil."""
    a = math.radians(degrees)
    return distance * np.array(
        [direction[0] * math.sin(a), direction[1] * math.sin(a), -math.cos(a)]
    )


def chief_ray(lens: lenses.Lens, point: Array, nm: float) -> tuple[Array, Array]:
    """Origin and direction (mm, lens frame) of the ray through the middle of the stop."""
    pupil = lens.first_order().entrance_pupil
    origin = np.array([*point[:2] * 1e3, pupil.z + point[2] * 1e3])
    radial = np.array([*point[:2], 0]) / max(math.hypot(*point[:2]), 1e-12)
    (stop,) = [i for i, s in enumerate(lens.surfaces) if s.stop]

    def direction(height: float) -> Array:
        return np.asarray(radial * height + [0, 0, pupil.z] - origin)

    def miss(height: float) -> float:
        path = lens.prescription.path(origin[None], direction(height)[None], nm, False)
        return float(path[stop] @ radial) if len(path) > stop else math.nan

    heights = np.linspace(-1, 1, 81) * (lens.surfaces[0].semi_diameter or 20)
    misses = np.array([miss(h) for h in heights])
    (crossings,) = np.nonzero(misses[:-1] * misses[1:] <= 0)
    low, high = heights[crossings[0]], heights[crossings[0] + 1]
    rising = misses[crossings[0] + 1] > 0
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (low, middle) if (miss(middle) > 0) == rising else (middle, high)
    return origin, direction((low + high) / 2)


def landing(lens: lenses.Lens, point: Array, film: float, nm: float = 555) -> Array:
    """Where a point's chief ray meets the film: mm, upright picture."""
    origin, direction = chief_ray(lens, point, nm)
    return -lens.trace(origin, direction, nm, image_z=film)[0, :2]


def photograph(
    camera: dg.Camera,
    point: Array,
    radius: float,
    middle: Array,
    half: int,
    width: int,
    spp: int,
    light_paths: str | tuple[float, float] = "auto",
) -> tuple[Array, Array, Array]:
    """A ball of light around a film point (mm): XYZ of the crop, x and y of its pixels in mm."""
    scene, at = dg.Scene(), np.eye(4)
    at[:3, 3] = point
    scene.add_light(dg.SphereLight((1, 1, 1), radius), at)
    height = width * 2 // 3
    column = round((middle[0] / 36 + 0.5) * width)
    row = round((0.5 - middle[1] / 24) * height)
    crop = (
        max(column - half, 0),
        max(row - half, 0),
        min(column + half, width),
        min(row + half, height),
    )
    frame = dg.render(
        scene,
        camera,
        resolution=(width, height),
        crop=crop,
        spp=spp,
        filter="box",
        light_paths=light_paths,
    )
    assert frame.xyz is not None
    y, x = np.mgrid[crop[1] : crop[3], crop[0] : crop[2]] + 0.5
    return frame.xyz.astype(np.float64), (x / width - 0.5) * 36, (0.5 - y / height) * 24


def centroid(picture: Array, x: Array, y: Array) -> Array:
    """Centroid of one channel, mm."""
    return np.array([(picture * x).sum(), (picture * y).sum()]) / picture.sum()


def blur(
    lens: lenses.Lens, focus: float, stop: float, distance: float, spp: int
) -> tuple[float, float]:
    """Second moment (mm^2, mean of both axes) of a point's picture on the axis.

    Returns:
        Of the photograph, less the parts of the ball's own size and of the pixels, and of a bundle
        of single rays that fill the entrance pupil.
    """
    order, width = lens.first_order(), 3600
    camera = dg.Camera(lens=lens, f_stop=stop, focus_distance=focus)
    ball = 0.02 / order.efl * distance
    point, middle = np.array([0, 0, -distance]), np.zeros(2)
    xyz, x, y = photograph(camera, point, ball, middle, 40, width, spp, FEW_PATHS)
    picture = xyz[..., 1]
    cx, cy = centroid(picture, x, y)
    moment = float((picture * ((x - cx) ** 2 + (y - cy) ** 2)).sum() / picture.sum() / 2)
    film = lens.prescription.film_position(focus, False)
    image = magnification(lens, film, distance) * ball * 1e3
    moment -= image**2 / 4 + (36 / width) ** 2 / 12

    grid = np.stack(np.meshgrid(*[np.arange(-39.0, 40, 2) / 40] * 2), -1).reshape(-1, 2)
    grid = grid[np.hypot(*grid.T) < 1] * order.efl / stop / 2
    aim = np.column_stack([grid, np.full(len(grid), distance * 1e3)])
    origin = [0, 0, order.entrance_pupil.z - distance * 1e3]
    nm = np.arange(425, 676, 25.0)
    weights = color_matching(nm)[1] * daylight(nm)
    moments = [(lens.trace(origin, aim, n, image_z=film)[:, :2] ** 2).mean() for n in nm]
    return moment, float(weights @ moments / weights.sum())


def magnification(lens: lenses.Lens, film: float, distance: float) -> float:
    """Size on the film over size of a thing so many m from the entrance pupil, first order."""
    order = lens.first_order()
    before = distance * 1e3 + order.front_principal_point - order.entrance_pupil.z
    return float((film - order.back_principal_point) / before)


@pytest.mark.parametrize(
    ("name", "degrees", "distorted"),
    [
        (FAST, 0.0, False),
        (FAST, 18.0, True),
        ("wide-angle-28mm-f3.5", 30.0, True),
        ("fisheye-16mm-f2.8", 60.0, True),
        ("telephoto-200mm-f1.8", 4.5, False),  # focused by its group: 0.1 %
    ],
)
def test_points_land_where_their_chief_rays_do(name: str, degrees: float, distorted: bool) -> None:
    lens = lenses.load(name)
    width, distance = 960, 5.0
    point = point_at((0.8, 0.6), degrees, distance)
    camera = dg.Camera(lens=name, f_stop=8, focus_distance=-float(point[2]))
    focused = lens.focused(-float(point[2]))
    lens, film = focused.lens, focused.film_z_mm  # groups may have moved
    expected = landing(lens, point, film)
    pixel = 36 / width
    radius = 3 * pixel / lens.first_order().efl * distance
    xyz, x, y = photograph(camera, point, radius, expected, 16, width, 128)
    found = centroid(xyz[..., 1], x, y)
    assert np.linalg.norm(found - expected) < 0.5 * pixel
    # The same lens without distortion would show it elsewhere; so would a pinhole at the pupil.
    ideal = point[:2] * 1e3 * magnification(lens, film, -float(point[2]))
    assert (np.linalg.norm(found - ideal) > 0.5 * pixel) == distorted


@pytest.mark.parametrize("name", [FAST, "wide-angle-35mm-f2", "portrait-85mm-f2"])
@pytest.mark.parametrize("focus", [1.0, 4.0])
def test_the_sharpest_point_is_at_the_focus_distance(name: str, focus: float) -> None:
    """Blur through focus: its second moment is a parabola in 1 / distance."""
    lens, stop = lenses.load(name), 5.6
    per_mm = stop / lens.first_order().efl ** 2 * 1e3  # 1/m that blur by 1 mm
    inverse = 1 / focus + np.linspace(-1, 1, 5) * min(0.15 * per_mm, 0.7 / focus)
    moments = np.array([blur(lens, focus, stop, 1 / u, 4) for u in inverse])
    found, expected = (-b / (2 * a) for a, b, _ in np.polyfit(inverse, moments, 2).T)
    assert found == pytest.approx(expected, abs=0.004 * per_mm)
    # The film is set by first-order optics at the d line; spherical aberration and the eye's green
    # shift the best point by less than the blur that a photographer calls sharp.
    assert found == pytest.approx(1 / focus, abs=0.03 * per_mm)


@pytest.mark.parametrize(("focus", "distance"), [(2.0, 4.0), (2.0, 1.2), (5.0, 1.5)])
@pytest.mark.parametrize("stop", [4.0, 11.0])
def test_circle_of_confusion_near_the_axis(focus: float, distance: float, stop: float) -> None:
    lens = lenses.load(FAST)
    moment, of_rays = blur(lens, focus, stop, distance, 4)
    assert moment == pytest.approx(of_rays, rel=0.03)
    # A disc of diameter c has the second moment c^2 / 16 along each axis. Distances of blur run
    # from the pupil, the magnification from the principal points.
    film = lens.prescription.film_position(focus, False)
    pupil = lens.first_order().efl / stop
    formula = pupil * abs(distance - focus) / distance * magnification(lens, film, focus)
    if stop > 8:  # little spherical aberration is left
        assert math.sqrt(16 * moment) == pytest.approx(formula, rel=0.04)


@pytest.mark.parametrize(
    ("name", "degrees"), [("telephoto-200mm-f1.8", 5.0), ("fisheye-16mm-f2.8", 65.0)]
)
def test_lateral_colour_is_that_of_single_rays(name: str, degrees: float) -> None:
    """Centroids of X, Y and Z against chief rays of every wavelength under the same weights."""
    lens = lenses.load(name)
    distance = 100 * lens.first_order().efl * 1e-3
    point = point_at((0.8, 0.6), degrees, distance)
    focus = -float(point[2])
    focused = lens.focused(focus)
    lens, film = focused.lens, focused.film_z_mm  # groups may have moved
    nm = np.arange(390, 711, 20.0)
    along = np.array([landing(lens, point, film, n) @ (0.8, 0.6) for n in nm])
    clear = [by_hand.irradiance(lens, film, 0, 11, n) for n in nm]
    weights = color_matching(nm) * daylight(nm) * clear
    expected = weights @ along / weights.sum(axis=1)
    camera = dg.Camera(lens=name, f_stop=11, focus_distance=focus)
    middle = np.array([0.8, 0.6]) * expected[1]
    xyz, x, y = photograph(camera, point, 0.03 * 0.1, middle, 16, 3600, 32, FEW_PATHS)
    found = np.array([centroid(xyz[..., k], x, y) @ (0.8, 0.6) for k in range(3)])
    blue, red = expected[2] - expected[1], expected[0] - expected[1]
    assert max(abs(blue), abs(red)) > 3e-3  # mm: there is something to see
    assert found[2] - found[1] == pytest.approx(blue, abs=1e-3)
    assert found[0] - found[1] == pytest.approx(red, abs=1e-3)
