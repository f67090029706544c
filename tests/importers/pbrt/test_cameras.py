"""Cameras: what pbrt's raster shows is what ours shows; brightness; the realistic camera."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.errors import InputError
from daguerre.exposure.lux_seconds import display_gain
from daguerre.lenses import Lens
from daguerre.rendering.pixels import check_filter

from .text import SQUARE, read

_LENS = "# a lens\n50 5 1.5 20\n-50 5 0 20\n0 40 0 10\n"


def _raster(options: str, point: tuple[float, float, float], film: tuple[int, int]) -> Any:
    """Place in pbrt's picture, 0 .. 1 to the right and downward, of a point of its camera space.

    Written out from the book (Pharr, Jakob and Humphreys 2023, section 5.2).
    """
    width, height = film
    aspect = width / height
    window = [-aspect, aspect, -1, 1] if aspect > 1 else [-1, 1, -1 / aspect, 1 / aspect]
    if "screenwindow" in options:
        window = [float(word) for word in options.split("[")[1].split("]")[0].split()]
    scale = 1 / math.tan(math.radians(40) / 2)
    x, y = (scale * value / point[2] for value in point[:2])
    return (x - window[0]) / (window[1] - window[0]), (window[3] - y) / (window[3] - window[2])


def _ours(camera: dg.Camera, world: np.ndarray) -> tuple[float, float]:
    x, y, z = np.linalg.inv(np.asarray(camera.transform))[:3] @ np.append(world, 1)
    assert z < 0
    film = [camera.focal_length * one / -z - camera.shift[i] for i, one in enumerate((x, y))]
    width, height = camera.sensor_size
    return film[0] / width + 0.5, 0.5 - film[1] / height


@pytest.mark.parametrize("film", [(64, 48), (48, 64), (50, 50)])
@pytest.mark.parametrize("mirrored", ["", "Scale -1 1 1 "])
@pytest.mark.parametrize("window", ["", '"float screenwindow" [-0.5 1 -0.75 0.75]'])
def test_points_are_where_pbrt_shows_them(
    tmp_path: Path, film: tuple[int, int], mirrored: str, window: str
) -> None:
    if window and film != (50, 50):
        window = ""
    options = (
        f'{mirrored}LookAt 1 2 -5  0 0.5 0  0.1 1 0 Camera "perspective" "float fov" 40 {window} '
        f'Film "rgb" "integer xresolution" {film[0]} "integer yresolution" {film[1]}'
    )
    scene = read(tmp_path, 'Translate 0.4 0.7 0.2 Shape "sphere" "float radius" 0.1', options)
    centre = scene.instances[0].transform[:3, 3]
    # Camera space of pbrt: x right, y up, z ahead, of LookAt by hand.
    eye, ahead = np.array((1, 2, -5.0)), np.array((-1, -1.5, 5.0))
    ahead /= np.linalg.norm(ahead)
    right = np.cross((0.1, 1, 0), ahead)
    right /= np.linalg.norm(right)
    seen = np.array([(0.4, 0.7, 0.2) - eye @ np.eye(3)]) @ np.stack(
        [right, np.cross(ahead, right), ahead], axis=1
    )
    seen = seen[0] * ((-1, 1, 1) if mirrored else (1, 1, 1))
    assert _ours(scene.camera(), centre) == pytest.approx(_raster(window, tuple(seen), film))


@pytest.mark.parametrize(("mirrored", "column"), [("", 12), ("Scale -1 1 1 ", 3)])
def test_the_picture_is_not_mirrored(tmp_path: Path, mirrored: str, column: int) -> None:
    """pbrt sees +x of its world on the right, unless the camera is mirrored."""
    options = (
        f'{mirrored}LookAt 0 0 -4  0 0 0  0 1 0 Camera "perspective" "float fov" 60 '
        'Film "rgb" "integer xresolution" 16 "integer yresolution" 16'
    )
    world = f'Translate 1.3 0 0 Scale 0.5 0.5 1 AreaLightSource "diffuse" {SQUARE}'
    frame = dg.render(read(tmp_path, world, options), resolution=(16, 16), spp=4)
    assert frame.rgb[8, column, 1] == pytest.approx(1, abs=0.01)
    assert frame.rgb[8, 15 - column].max() == 0


def _shown(frame: dg.Frame) -> float:
    """Shown value of 1 in a frame, by the file's own exposure mode."""
    assert frame.metadata["exposure"] == "light"
    return display_gain(frame.metadata)


@pytest.mark.parametrize(
    ("options", "ratio"),
    [
        ('Camera "perspective"', 1.0),
        ('Camera "perspective" Film "rgb" "float iso" 400', 4.0),
        ('Camera "perspective" Film "rgb" "float iso" 400 "string sensor" "nikon_d850"', 4.0),
        ('Camera "perspective" "float shutterclose" 0.25 Film "rgb" "float iso" 200', 0.5),
        ('Camera "perspective" "float lensradius" 0.05 "float focaldistance" 2', 1.0),
        ('Camera "perspective" "float lensradius" 9 "float focaldistance" 2', 1.0),
        ('Camera "spherical" "string mapping" "equirectangular"', 1.0),
    ],
)
def test_the_picture_is_as_bright_as_in_pbrt(tmp_path: Path, options: str, ratio: float) -> None:
    """Imaging ratio: time x ISO / 100."""
    options = f'{options} Film "rgb" "integer xresolution" 8 "integer yresolution" 8'
    if "iso" in options:
        options = options.rsplit("Film", 1)[0]
    scene = read(tmp_path, 'LightSource "infinite" "rgb L" [0.3 0.3 0.3]', options)
    size = (8, 4) if "spherical" in options else (8, 8)
    frame = dg.render(scene, resolution=size, spp=4)
    inner = frame.rgb[1:-1, 1:-1]  # a panorama loses light at its edges
    assert inner.mean() == pytest.approx(0.3, rel=0.05)  # the frame is in cd/m2
    assert _shown(frame) == pytest.approx(ratio, rel=1e-6)


def test_a_picture_of_pbrt_v3_has_no_exposure_but_its_scale(tmp_path: Path) -> None:
    options = 'Camera "perspective" "float shutterclose" 0.01 Film "image" "float scale" 3'
    scene = read(tmp_path, 'LightSource "infinite" "rgb L" [0.2 0.2 0.2] WorldEnd', options)
    frame = dg.render(scene, resolution=(8, 6), spp=4)
    assert _shown(frame) == pytest.approx(3, rel=1e-6)


@pytest.mark.parametrize("version", ["", " WorldEnd"])
def test_what_pbrt_multiplies_by_is_all_in_the_ev(tmp_path: Path, version: str) -> None:
    """In another mode the ISO does not count a second time, and a meter may choose it."""
    options = 'Camera "perspective" "float shutterclose" 0.25 Film "rgb"'
    options += ' "float scale" 3' if version else ' "float iso" 400'
    camera = read(tmp_path, SQUARE + version, options).camera()
    assert (camera.exposure, camera.iso, camera.responsivity) == ("light", 100, 1)
    assert (camera.exposure_time, camera.exposure_f_stop) == (None, None)
    assert camera.exposure_compensation == pytest.approx(math.log2(3) if version else 0, abs=1e-6)


def test_a_film_of_no_brightness(tmp_path: Path) -> None:
    options = 'Camera "perspective" Film "image" "float scale" 0'
    scene = read(tmp_path, f"{SQUARE} WorldEnd", options)
    assert scene.camera().exposure_compensation == 0
    assert "a scale of 0 of the film is left out (1 use)" in scene.warnings
    options = 'Camera "perspective" "float shutterclose" 1e-30'
    with pytest.raises(InputError, match=r"Camera: .*exposure_compensation: .*at least -64"):
        read(tmp_path, SQUARE, options)
    options = 'Camera "perspective" "float shutterclose" 0'
    with pytest.raises(InputError, match="the two times must differ"):
        read(tmp_path, SQUARE, options)


def test_the_thin_lens_has_its_radius_and_focus_in_the_units_of_the_camera(tmp_path: Path) -> None:
    options = 'Scale 2 2 2 Camera "perspective" "float lensradius" 0.1 "float focaldistance" 6'
    camera = read(tmp_path, SQUARE, options).camera()
    assert camera.aperture_diameter == pytest.approx(0.1 * 1000)  # 0.2 units of the camera
    assert camera.focus_distance == pytest.approx(3)


def test_the_realistic_camera_has_lens_iris_focus_and_film(tmp_path: Path) -> None:
    (tmp_path / "lens.dat").write_text(_LENS)
    options = (
        'LookAt 0 0 -3 0 0 0 0 1 0 Camera "realistic" "string lensfile" "lens.dat" '
        '"float aperturediameter" 4 "float focusdistance" 3 '
        'Film "rgb" "integer xresolution" 30 "integer yresolution" 40 "float diagonal" 25'
    )
    scene = read(tmp_path, SQUARE, options)
    camera = scene.camera()
    lens = camera.lens
    assert isinstance(lens, Lens)
    order = lens.first_order()
    assert camera.f_stop == pytest.approx(order.efl / (order.entrance_pupil.diameter * 4 / 10))
    assert camera.sensor_size == pytest.approx((15, 20))
    focused = lens.focused(3, measured_from="sensor")
    film = camera.transform[:3, 3] + camera.transform[:3, 2] * (
        (focused.film_z_mm - focused.entrance_pupil_z) / 1000
    )
    assert film == pytest.approx((0, 0, 3), abs=1e-9)  # pbrt's camera stands at its film


def test_the_realistic_camera_shows_the_illuminance_of_its_film(tmp_path: Path) -> None:
    """pbrt's pixel is the integral of cos^4 / z^2 over the exit pupil: pi sin^2, times the ratio.

    The iris is the rear element, so the exit pupil is the iris itself.
    """
    (tmp_path / "lens.dat").write_text(_LENS)
    options = (
        'Camera "realistic" "string lensfile" "lens.dat" "float aperturediameter" 4 '
        '"float focusdistance" 10 Film "rgb" "float diagonal" 1 '
        '"integer xresolution" 8 "integer yresolution" 8 "float iso" 100'
    )
    scene = read(tmp_path, 'LightSource "infinite" "rgb L" [0.5 0.5 0.5]', options)
    camera = scene.camera()
    assert isinstance(camera.lens, Lens)
    frame = dg.render(scene, resolution=(8, 8), spp=64)
    shown = float(frame.rgb[3:5, 3:5, 1].mean()) * _shown(frame)
    focused = camera.lens.focused(10, measured_from="sensor")
    distance = focused.film_z_mm - camera.lens.vertices[-1]
    sine = math.sin(math.atan(2 / distance))
    assert shown == pytest.approx(0.5 * math.pi * sine**2, rel=0.02)  # its glass loses no light


def test_pbrt_v3_weighs_its_realistic_camera_simply(tmp_path: Path) -> None:
    (tmp_path / "lens.dat").write_text(_LENS)
    options = 'Camera "realistic" "string lensfile" "lens.dat" "float aperturediameter" 4'
    simple = read(tmp_path, f"{SQUARE} WorldEnd", options).camera()
    # The iris of 4 mm is the rear surface itself, of a radius of 5 mm: a square of 4 mm, widened.
    widened = 4 + 2 * (2 * math.hypot(15, 15) / 1024)
    share = math.pi / 4 * (4 / widened) ** 2
    assert 2**simple.exposure_compensation == pytest.approx(share, rel=1e-3)
    options = f'{options} "float shutterclose" 0.5'
    again = read(tmp_path, f"{SQUARE} WorldEnd", options).camera()
    assert again.exposure_compensation == simple.exposure_compensation  # its time does not count
    weighed = f'{options} "bool simpleweighting" "false"'
    camera = read(tmp_path, f"{SQUARE} WorldEnd", weighed).camera()
    focused = camera.lens.focused(10, measured_from="sensor")
    sine = math.sin(math.atan(2 / (focused.film_z_mm - camera.lens.vertices[-1])))
    wanted = 0.5 * math.pi * sine**2
    assert 2**camera.exposure_compensation == pytest.approx(wanted, rel=0.02)


def test_a_camera_that_moves(tmp_path: Path) -> None:
    options = 'ActiveTransform EndTime Translate 0 0 -2 ActiveTransform All Camera "perspective"'
    scene = read(tmp_path, SQUARE, options)
    camera = scene.camera()
    assert camera.evaluated_at(0.0).transform[:3, 3] == pytest.approx((0, 0, 0))
    assert camera.evaluated_at(0.5).transform[:3, 3] == pytest.approx((0, 0, -1))
    assert scene.motion or camera.motion


def test_a_spherical_camera_shows_every_direction_where_pbrt_does(tmp_path: Path) -> None:
    """u runs from +x over +z: the picture's middle shows -x, its right half -z (book, 5.3)."""
    options = 'Camera "spherical" "string mapping" "equirectangular" '
    options += 'Film "rgb" "integer xresolution" 32 "integer yresolution" 16'
    for way, column in (((1, 0, 0), 0), ((0, 0, 1), 8), ((-1, 0, 0), 16), ((0, 0, -1), 24)):
        x, y, z = (2 * one for one in way)
        world = f'Translate {x} {y} {z} AreaLightSource "diffuse" Shape "sphere"'
        frame = dg.render(read(tmp_path, world, options), resolution=(32, 16), spp=4)
        lit = frame.rgb[7:9, :, 1].mean(axis=0)
        assert lit[max(column, 1)] > 0.9
        assert lit[(column + 16) % 32] == 0


def test_orthographic_cameras_are_refused_by_name(tmp_path: Path) -> None:
    with pytest.raises(dg.InputError, match=r"Camera: kind: wanted perspective.*'orthographic'"):
        read(tmp_path, SQUARE, 'Camera "orthographic"')


@pytest.mark.parametrize(
    ("filter_", "flag"),
    [
        ('"triangle"', "tent:2"),
        ('"triangle" "float xradius" 1.5 "float yradius" 1.5', "tent:1.5"),
        ('"box"', "box:0.5"),
        ('"gaussian"', "gaussian:1.5"),
        ('"gaussian" "float sigma" 1 "float xradius" 3 "float yradius" 3', "gaussian:3"),
        ('"mitchell"', "mitchell:2"),
        ('"triangle" "float xradius" 1', ""),
        ('"gaussian" "float sigma" 1', ""),
        ('"mitchell" "float B" 0', ""),
        ('"sinc"', ""),
    ],
)
def test_a_note_tells_the_flag_of_the_pixel_filter(tmp_path: Path, filter_: str, flag: str) -> None:
    scene = read(tmp_path, 'Shape "sphere"', f"PixelFilter {filter_}")
    told = "pbrt's pixel filter is left out: --filter chooses one"
    if flag:
        told = f"flags for the file's pixel filter: --filter {flag}"
        assert check_filter(flag) == flag
    assert f"{told} (1 use)" in scene.warnings


def test_a_gaussian_of_old_files_has_its_alpha(tmp_path: Path) -> None:
    options = 'PixelFilter "gaussian" "float alpha" 2 "float xradius" 1.5 "float yradius" 1.5'
    scene = read(tmp_path, 'Shape "sphere" WorldEnd', options)
    assert "flags for the file's pixel filter: --filter gaussian:1.5 (1 use)" in scene.warnings
    with pytest.raises(InputError, match="xradius: wanted"):
        read(tmp_path, 'Shape "sphere"', 'PixelFilter "triangle" "float xradius" -1')
