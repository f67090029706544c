"""Vignetting by a lens of the library against white worlds rendered through it."""

from __future__ import annotations

import numpy as np
import pytest

import daguerre as dg
from daguerre import lenses
from daguerre.analysis.bench import set_up
from daguerre.analysis.illumination import relative_illumination, spectral_illumination
from daguerre.color.spaces import LUMINANCE_709
from daguerre.convolution.rows import Rows
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM
from daguerre.post import lens_light
from daguerre.post.optics import Plane
from daguerre.post.picture import Canvas

SQUEEZED, LENS = "schneider-anamorphic-60mm", "double-gauss-50mm-f2"
SIZE, BLOCK = (60, 40), 10


@pytest.fixture(autouse=True)
def few_points(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, count in {"ACROSS": 9, "DOWN": 7, "RAYS": 40, "HEIGHTS": 13}.items():
        monkeypatch.setattr(lens_light, name, count)


def white_world(camera: dg.Camera, spp: int) -> np.ndarray:
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    return np.asarray(dg.render(scene, camera, resolution=SIZE, spp=spp).rgb)


def blocks(image: np.ndarray) -> np.ndarray:
    """Means of squares of pixels, which have less noise; (rows, columns, channels)."""
    width, height = SIZE
    parts = image.reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK, -1)
    return parts.mean(axis=(1, 3))


def agree(rendered: np.ndarray, light: np.ndarray) -> None:
    """But for the tint of the glass on the axis, which stays in a rendered picture."""
    ratio = blocks(rendered) / blocks(light)
    middle = ratio[1:-1, 2:-2].mean(axis=(0, 1))
    assert ratio / middle == pytest.approx(np.ones_like(ratio), abs=0.015)
    tint = ratio / ratio[:, :, 1:2]
    assert tint == pytest.approx(np.broadcast_to(middle / middle[1], tint.shape), abs=0.007)


def test_an_anamorphic_lens_darkens_as_its_white_world_does():
    sensor = (24.9, 16.6)
    setting = {"lens": SQUEEZED, "f_stop": 2.0}
    light = dg.post.vignette(
        np.ones((40, 60, 3), np.float32), model="lens", focus=3.0, sensor=sensor, **setting
    )
    camera = dg.Camera(focus_distance=3.0, sensor_size=sensor, **setting)
    agree(white_world(camera, 192), light)
    across, down = light[20, 0, 1], light[0, 30, 1]
    assert light[0, 0, 1] < min(across, down) < 0.97
    tint = light[0, 0, 0] / light[0, 0, 1]
    assert tint < 0.99  # its coatings let less red through from the side


def test_elements_off_the_axis_darken_one_side():
    moved = ((0, 3), (1.5, -2.5), (0.0, 0.0))
    lens = lenses.load(LENS).decentered(*moved)
    bench = set_up(lens, f_stop=2.8, focus_m=3.0, by="paraxial")
    canvas, film = Canvas(*SIZE), Plane((30.0, 20.0), 36 / 60)
    light = lens_light.lens_light(canvas, film, bench, color=True)(Rows(0, 40))
    camera = dg.Camera(lens=lens, f_stop=2.8, focus_distance=3.0)
    agree(white_world(camera, 192), light)
    assert abs(light[20, 0, 1] / light[20, -1, 1] - 1) > 0.03
    assert abs(light[0, 30, 1] / light[-1, 30, 1] - 1) > 0.03


def test_the_design_wavelength_is_the_data_sheet_s():
    bench = set_up(lenses.load(LENS), f_stop=2.0)
    heights = np.array([0.0, 12.0, 18.0])
    sheet = relative_illumination(bench, heights).irradiance
    points = np.column_stack([0 * heights, heights])
    found = spectral_illumination(bench, points, [DESIGN_WAVELENGTH_NM, 430.0])
    assert found[:, 0] == pytest.approx(sheet, rel=1e-4)
    assert abs(found[:, 1] / sheet - 1).max() > 0.01
    turned = spectral_illumination(bench, points[1:, ::-1], [DESIGN_WAVELENGTH_NM])
    assert turned[:, 0] == pytest.approx(sheet[1:], rel=2e-3)


def test_white_on_the_axis_stays_white_and_all_comes_back():
    image = np.random.default_rng(1).random((41, 61, 4), np.float32)
    setting = {"model": "lens", "lens": LENS, "f_stop": 2.0, "sensor": (36, 24)}
    dark = dg.post.vignette(image, **setting)
    assert dark[20, 30] == pytest.approx(image[20, 30], rel=1e-6)
    assert (dark[0, 0, :3] < 0.5 * image[0, 0, :3]).all()
    assert np.array_equal(dark[:, :, 3], image[:, :, 3])  # alpha
    assert dg.post.unvignette(dark, **setting) == pytest.approx(image, rel=1e-5)


def test_one_share_for_all_channels_is_the_luminance():
    image = np.ones((41, 61, 3), np.float32)
    setting = {"model": "lens", "lens": LENS, "f_stop": 2.0, "sensor": (36, 24)}
    plain = dg.post.vignette(image, colour=False, **setting)
    luminance = dg.post.vignette(image, **setting) @ LUMINANCE_709
    assert np.ptp(plain, axis=2).max() == 0
    assert plain[:, :, 0] == pytest.approx(luminance, rel=2e-3)
    assert np.array_equal(dg.post.vignette(image[:, :, :1], **setting)[:, :, 0], plain[:, :, 0])


def test_between_points_of_the_frame_parabolas_are_exact():
    x, y = np.linspace(-2, 2, 61)[None, :, None], np.linspace(-1, 1, 41)[:, None, None]

    def bowl(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.float32(3 - 0.3 * x**2 + 0.2 * x * y - 0.5 * y**2 + 0.1 * x)

    nodes = bowl(np.linspace(-2, 2, 7)[None, :, None], np.linspace(-1, 1, 5)[:, None, None])
    surface = lens_light.CubicGrid(nodes, 61, 41)
    assert surface(Rows(0, 41)) == pytest.approx(bowl(x, y), abs=1e-5)
    assert np.array_equal(surface(Rows(7, 9)), surface(Rows(0, 41))[7:9])
