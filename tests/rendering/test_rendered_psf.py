"""A point of light through the whole renderer, against the point spread of the bench.

The bench sends rays from the point to the film; the camera looks for it from the film. The picture
of a small ball of light is the spread, widened by the ball's own picture and by a pixel.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

import daguerre as dg
from daguerre import analysis, lenses
from daguerre.analysis.psf import WHITE_NM, WHITE_WEIGHTS

PIXELS = 25


@dataclass(frozen=True)
class Point:
    """A lens at a setting, and a point: image height in mm, distances in m."""

    lens: str
    f_stop: float
    focus: float
    height: float
    distance: float
    zoom: float | None = None
    squeeze: float = 1.0


POINTS = {
    "aspheric": Point("sony-planar-50mm-f1.4", 1.6, 3.0, -15, 2.0),
    "zoom": Point("canon-ef-24-70mm-f2.8", 2.8, 2.0, 16, 1.2, zoom=40),
    "anamorphic": Point("schneider-anamorphic-60mm", 2.0, 4.0, 6, 2.0, squeeze=2.0),
    "close": Point("canon-ef-100mm-f2.8-macro", 2.8, 0.5, 8, 0.45),
}


@pytest.mark.parametrize("case", POINTS)
def test_a_rendered_point_is_the_spread_of_the_bench(case: str) -> None:
    p = POINTS[case]
    bench = analysis.set_up(
        lenses.load(p.lens), f_stop=p.f_stop, focus_m=p.focus, zoom_mm=p.zoom, by="paraxial"
    )
    light = analysis.pencil(bench, p.height, distance_mm=1e3 * p.distance)
    assert light is not None
    assert light.source is not None
    spot = analysis.spot(light, WHITE_NM, WHITE_WEIGHTS, grid=128, jitter=True)
    reach = float(np.abs(spot.points - spot.centroid).max())
    magnification = abs(bench.magnification) * p.focus / p.distance
    radius = 0.12 * reach / magnification  # of the ball, mm
    pixel = 2 * (1.25 * reach + 2 * radius * magnification) / PIXELS
    source = (light.source - [0, 0, bench.order.entrance_pupil.z]) * 1e-3
    x, y, share = _picture(p, source, 1e-3 * radius, pixel)

    off = spot.points - spot.centroid
    middle = [share @ x, share @ y]
    # Film along x is sagittal, turned where the height is below the axis.
    sagittal, tangential = spot.centroid
    turned = 1 if p.height >= 0 else -1
    wanted = [turned * sagittal, p.height + turned * tangential]
    np.testing.assert_allclose(middle, wanted, atol=0.12 * pixel)
    for axis, at in enumerate((x, y)):
        ball = radius * magnification / (p.squeeze if axis == 0 else 1)
        variance = spot.weights @ off[:, axis] ** 2 + ball**2 / 4 + pixel**2 / 12
        spread = np.sqrt(share @ (at - middle[axis]) ** 2)
        assert spread == pytest.approx(np.sqrt(variance), rel=0.03, abs=0.05 * pixel)
    distance = np.hypot(x - middle[0], y - middle[1])
    for part in (0.5, 0.75):
        ours, theirs = share[distance < part * reach].sum(), _within(spot, part * reach)
        assert ours == pytest.approx(theirs, abs=0.05)


def _within(spot: analysis.Spot, radius: float) -> float:
    return float(spot.encircled_energy(np.array([radius]))[0])


def _picture(
    p: Point, source: np.ndarray, radius: float, pixel: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Film points (mm, as the bench counts them) and shares of the light of a few pixels."""
    width, height = 2 * int(4 / pixel) + 1, 2 * int(19 / pixel) + 1
    camera = dg.Camera(
        lens=p.lens,
        f_stop=p.f_stop,
        zoom=p.zoom,
        focus_distance=p.focus,
        sensor_size=(width * pixel, height * pixel),
    )
    place = np.eye(4)
    place[:3, 3] = source
    scene = dg.Scene()
    scene.add_light(dg.SphereLight((1e6, 1e6, 1e6), radius), place)
    # The image is upside down on the film, and pictures are upright.
    column, row = width // 2 - PIXELS // 2, int(height / 2 + p.height / pixel) - PIXELS // 2
    crop = (column, row, column + PIXELS, row + PIXELS)
    frame = dg.render(
        scene,
        camera,
        spp=128,
        resolution=(width, height),
        crop=crop,
        filter="box",
        max_depth=1,
        light_paths=(1000, 0),  # as `auto` chooses; the noise of places and spreads is 0.003 px
    )
    light = np.asarray(frame.rgb, np.float64) @ [0.2126, 0.7152, 0.0722]
    columns, rows = np.meshgrid(np.arange(PIXELS), np.arange(PIXELS))
    x = -(column + columns + 0.5 - width / 2) * pixel
    y = (row + rows + 0.5 - height / 2) * pixel
    border = light[[0, -1]].sum() + light[:, [0, -1]].sum()
    assert border < 1e-3 * light.sum()
    return x.ravel(), y.ravel(), light.ravel() / light.sum()
