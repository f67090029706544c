"""Calibrated cameras: OpenCV's own functions as oracle, and pictures drawn through the model."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre import charts
from daguerre.camera.projection import MODELS, Projection
from daguerre.errors import UsageError

cv2 = pytest.importorskip("cv2")

SIZE = (1280, 720)
FOCAL, PRINCIPAL = (900.0, 910.0), (630.5, 350.2)
MATRIX = np.array([[900.0, 0, 630.5], [0, 910, 350.2], [0, 0, 1]])
RATIONAL = (-0.28, 0.09, 1e-3, -2e-3, -0.01, 0.02, 0.01, 1e-3, 2e-3, -1e-3, 1e-3, 5e-4, 0.01, -0.02)
FISHEYE = (0.01, -0.003, 0.001, -2e-4)
STILL = (np.zeros(3), np.zeros(3))


def pixels(margin: float = 0) -> np.ndarray:
    x = np.linspace(-margin, SIZE[0] - 1 + margin, 80)
    y = np.linspace(-margin, SIZE[1] - 1 + margin, 60)
    return np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)


@pytest.mark.parametrize("count", [4, 5, 8, 12, 14])
def test_opencv_projects_and_undistorts_alike(count: int) -> None:
    k = np.array(RATIONAL[:count])
    model = Projection("opencv", SIZE, FOCAL, PRINCIPAL, tuple(k))
    seen = model.unproject(pixels())
    assert np.isfinite(seen).all()
    there = cv2.projectPoints(seen, *STILL, MATRIX, k)[0].reshape(-1, 2)
    np.testing.assert_allclose(there, pixels(), atol=1e-6)
    np.testing.assert_allclose(model.project(seen * 3.0), pixels(), atol=1e-6)
    # OpenCV's own inverse is iterative: as many steps as it takes.
    criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 500, 1e-14)
    if hasattr(cv2, "undistortPointsIter"):  # before OpenCV 5
        ideal = cv2.undistortPointsIter(pixels()[:, None], MATRIX, k, None, None, criteria)
    else:
        ideal = cv2.undistortPoints(pixels()[:, None], MATRIX, k, criteria=criteria)
    np.testing.assert_allclose(seen[:, :2] / seen[:, 2:], ideal.reshape(-1, 2), atol=1e-9)


def test_opencv_fisheye_alike() -> None:
    k = np.array(FISHEYE)
    model = Projection("kannala_brandt", SIZE, FOCAL, PRINCIPAL, FISHEYE)
    seen = model.unproject(pixels())
    ahead = seen[:, 2] > 0.1
    there = cv2.fisheye.projectPoints(seen[ahead][:, None], *STILL, MATRIX, k)[0].reshape(-1, 2)
    np.testing.assert_allclose(there, pixels()[ahead], atol=1e-6)
    ideal = cv2.fisheye.undistortPoints(
        pixels()[:, None], MATRIX, k, criteria=(3, 200, 1e-15)
    ).reshape(-1, 2)
    np.testing.assert_allclose(seen[ahead, :2] / seen[ahead, 2:], ideal[ahead], atol=1e-8)


def test_omni_alike() -> None:
    """Mei's model as OpenCV's contributors have it: xi, then radial and tangential terms."""
    xi, k = 1.1, np.array([-0.2, 0.05, 1e-3, -2e-3])
    model = Projection("omni", SIZE, FOCAL, PRINCIPAL, (xi, *k))
    rng = np.random.default_rng(2)
    points = rng.standard_normal((500, 3)) + np.array([0, 0, 1.5])
    unit = points / np.linalg.norm(points, axis=1, keepdims=True)
    flat = unit[:, :2] / (unit[:, 2:] + xi)
    wanted = cv2.projectPoints(np.c_[flat, np.ones(500)], *STILL, MATRIX, k)[0].reshape(-1, 2)
    got = model.project(points)
    known = np.isfinite(got).all(axis=1)
    assert known.mean() > 0.6
    np.testing.assert_allclose(got[known], wanted[known], atol=1e-6)


@pytest.mark.parametrize("model", MODELS)
def test_there_and_back_is_where_one_was(model: str) -> None:
    parameters: dict[str, tuple[float, ...]] = {
        "opencv": RATIONAL, "kannala_brandt": FISHEYE, "double_sphere": (-0.2, 0.58),
        "eucm": (0.6, 1.1), "omni": (0.9, -0.1), "fov": (0.9,),
        "opencv_inverse": (0.1, -0.02, 2e-3, -3e-3, 0.0, 0.05), "ftheta": (0.02, -0.05, 0.01),
    }  # fmt: skip
    made = Projection(model, SIZE, (400.0, 402.0), PRINCIPAL, parameters.get(model, ()))
    seen = made.unproject(pixels(40))
    known = np.isfinite(seen).all(axis=1)
    assert known.mean() > 0.15
    np.testing.assert_allclose(np.linalg.norm(seen[known], axis=1), 1, atol=1e-12)
    back = made.project(seen[known])
    np.testing.assert_allclose(back, pixels(40)[known], atol=1e-6)


def shot(camera: dg.Camera, **options: Any) -> dg.Frame:
    chart = charts.make("slanted-edge", width=2.4)
    given = {"resolution": (192, 108), "spp": 16, "filter": "box", "max_depth": 1} | options
    return dg.render(chart.scene(1.0), camera, **given)


def pose(distance: float = 1.5) -> np.ndarray:
    matrix = np.eye(4)
    matrix[2, 3] = distance
    return matrix


def test_a_rectilinear_projection_is_the_pinhole() -> None:
    camera = dg.Camera(transform=pose(), sensor_size=(36, 20.25))
    focal = 50 / 36 * SIZE[0]
    model = Projection("rectilinear", SIZE, (focal, focal))
    hole = shot(camera.with_(lens="pinhole", focal_length=50))
    same = shot(camera.with_(projection=model))
    np.testing.assert_allclose(same.rgb, hole.rgb, atol=2e-3)


@pytest.mark.parametrize("model", ["opencv", "kannala_brandt"])
def test_a_picture_shows_points_where_opencv_puts_them(model: str) -> None:
    """Small lamps, by rendering: half a pixel of wrong convention would show."""
    size, k = (640, 480), RATIONAL[:8] if model == "opencv" else FISHEYE
    matrix = np.array([[420.0, 0, 331.3], [0, 415, 236.8], [0, 0, 1]])
    made = Projection(model, size, (420.0, 415.0), (331.3, 236.8), k)
    for point in ([0.3, -0.2, 1.2], [-0.55, 0.33, 1.1], [0.02, 0.01, 0.9]):
        scene, place = dg.Scene(), np.eye(4)
        place[:3, 3] = np.multiply(point, (1, -1, -1))
        scene.add_light(dg.SphereLight((1e3, 1e3, 1e3), 0.004), place)
        at = np.array([point])
        if model == "opencv":
            u, v = cv2.projectPoints(at, *STILL, matrix, np.array(k))[0].ravel()
        else:
            u, v = cv2.fisheye.projectPoints(at[:, None], *STILL, matrix, np.array(k))[0].ravel()
        x, y = int(u + 0.5), int(v + 0.5)
        crop = (x - 6, y - 6, x + 7, y + 7)
        frame = dg.render(
            scene, dg.Camera(projection=made), resolution=size, crop=crop, spp=256, filter="box"
        )
        light = np.maximum(frame.xyz[..., 1], 0)
        rows, columns = np.indices(light.shape)  # pixel centres at integers
        found = [(light * at).sum() / light.sum() for at in (columns + crop[0], rows + crop[1])]
        np.testing.assert_allclose(found, [u, v], atol=0.03)


def test_an_iris_blurs_by_the_circle_of_confusion() -> None:
    """A small lamp in front of the plane in focus: its disc has the lecture's radius."""
    scene = dg.Scene()
    place = np.eye(4)
    place[2, 3] = -1.0
    scene.add_light(dg.SphereLight((1e4, 1e4, 1e4), 1e-4), place)
    model = Projection("equidistant", (400, 400), (556.0, 556.0))
    camera = dg.Camera(projection=model, f_stop=2.0, focus_distance=2.0, sensor_size=(36, 36))
    frame = dg.render(scene, camera, resolution=(400, 400), spp=64, crop=(140, 140, 260, 260))
    light = frame.xyz[..., 1]
    focal = 556 * 36 / 400
    radius = focal / 2 / 2 * (2 - 1) / 1 * (556 / 2.0) * 1e-3  # R (s - d) / d times f / s, px
    rows, columns = np.indices(light.shape) - 59.5
    measured = np.sqrt(2 * (light * (rows**2 + columns**2)).sum() / light.sum())
    assert measured == pytest.approx(radius, rel=0.03)


def test_a_fisheye_sees_behind_itself() -> None:
    scene = dg.Scene()
    for angle, colour in ((0.0, (1e4, 0, 0)), (100.0, (0, 1e4, 0))):
        place = np.eye(4)
        a = np.radians(angle)
        place[:3, 3] = [2 * np.sin(a), 0, -2 * np.cos(a)]
        scene.add_light(dg.SphereLight(colour, 0.05), place)
    model = Projection.of_field("equisolid", (200, 200), 220)
    frame = dg.render(scene, dg.Camera(projection=model), resolution=(200, 200), spp=16)
    middle, side = frame.rgb[100, 100], frame.rgb[100]
    assert middle[0] > 10 * abs(middle[1])
    green = int(np.argmax(side[:, 1]))
    wanted = 100 + np.sin(np.radians(50)) / np.sin(np.radians(55)) * 100
    assert green + 0.5 == pytest.approx(wanted, abs=1.5)


def test_a_panorama_is_as_bright_at_its_edges() -> None:
    scene = dg.Scene()
    scene.set_environment(np.ones((2, 4, 3)))
    projection = Projection.of_field("equirectangular", (64, 32), 360)
    camera = dg.Camera(projection=projection, f_stop=None)
    luminance = dg.render(scene, camera, resolution=(64, 32), spp=64).rgb[..., 1]
    edges = (luminance[:, 0], luminance[:, -1], luminance[0], luminance[-1])
    means = [edge.mean() for edge in edges]
    assert np.allclose(means, 1, atol=0.01)  # 0.88 without what lies beyond


def test_rays_beyond_the_field_are_refused_and_counted() -> None:
    model = Projection("orthographic", (100, 100), (40.0, 40.0))
    session = dg.Session(dg.Scene(), dg.Camera(projection=model), resolution=(100, 100))
    session.draw(0, 16)
    inside = np.pi * 40**2 / 100**2
    assert session.counters.camera_rays == 16 * 100 * 100
    assert session.counters.stopped_rays / session.counters.camera_rays == pytest.approx(
        1 - inside, abs=2e-3
    )


def test_truth_is_that_of_the_model() -> None:
    model = Projection("kannala_brandt", (192, 108), (60.0, 60.0), None, FISHEYE)
    camera = dg.Camera(transform=pose(), projection=model, shutter_time=0)
    chart = charts.make("slanted-edge", width=20.0)
    frame = dg.render(chart.scene(1.0), camera, resolution=(192, 108), spp=1, gt_time="mid")
    x, y = np.meshgrid(np.arange(192.0), np.arange(108.0))
    seen = model.unproject(np.stack([x, y], -1).reshape(-1, 2)).reshape(108, 192, 3)
    met = frame.aovs["depth.Z"] > 0
    assert met.mean() > 0.5
    np.testing.assert_allclose(frame.aovs["depth.Z"][met], 1.5, atol=1e-3)
    wanted = seen[..., :2] / seen[..., 2:] * 1.5
    np.testing.assert_allclose(frame.aovs["P.X"][met], wanted[..., 0][met], atol=2e-3)
    np.testing.assert_allclose(-frame.aovs["P.Y"][met], wanted[..., 1][met], atol=2e-3)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"model": "opencvv"}, "did you mean 'opencv'"),
        ({"size": (0, 5)}, "size"),
        ({"size": "big"}, "size"),
        ({"focal": (-1, 5)}, "focal"),
        ({"principal": (1,)}, "principal"),
        ({"parameters": (1,) * 15}, "parameters"),
        ({"parameters": "abc"}, "parameters"),
        ({"parameters": (float("nan"),)}, "finite"),
        ({"model": "double_sphere"}, "parameters"),
        ({"model": "double_sphere", "parameters": (0.1, 3)}, "alpha"),
    ],
)
def test_bad_calibrations_name_the_field(values: dict[str, Any], message: str) -> None:
    good: dict[str, Any] = {"model": "opencv", "size": SIZE, "focal": FOCAL}
    with pytest.raises(UsageError, match=message):
        Projection(**(good | values))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"lens": "thin"}, "lens"),
        ({"focal_length": 50}, "focal_length=None removes it"),
        ({"tilt": (3, 0)}, "tilt"),
        ({"natural_vignetting": True}, "natural_vignetting"),
        ({"projection": "opencv"}, "Projection"),
    ],
)
def test_what_a_calibration_cannot_have_is_refused(changes: dict[str, Any], message: str) -> None:
    camera = dg.Camera(transform=pose(), projection=Projection("opencv", SIZE, FOCAL))
    with pytest.raises(UsageError, match=message):
        shot(camera.with_(**changes), spp=1)


def test_a_picture_of_another_shape_is_refused() -> None:
    camera = dg.Camera(transform=pose(), projection=Projection("opencv", SIZE, FOCAL))
    with pytest.raises(UsageError, match="192 x 108"):
        shot(camera, resolution=(192, 120), spp=1)


def test_the_field_of_view_is_the_models() -> None:
    fisheye = Projection.of_field("equisolid", (400, 300), 190)
    across, down, diagonal = fisheye.field_of_view()
    assert across == pytest.approx(190, abs=1e-9)
    assert down < across < diagonal
    tangent = Projection("rectilinear", (200, 100), (100.0, 100.0))
    assert tangent.field_of_view()[:2] == pytest.approx((90, 2 * np.degrees(np.arctan(0.5))))
