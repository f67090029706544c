"""Cameras see what Mitsuba's see: fields of view, offsets, thin lenses, clipping, shutters."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import daguerre as dg
from daguerre.importers.mitsuba.reader import read_all
from daguerre.rendering.pixels import check_filter

from .peer import ours, same_blocks, theirs
from .scene_files import camera, loaded, written


def _sensor(
    inner: str, plugin: str = "perspective", size: tuple[int, int] = (60, 40), turn: str = ""
) -> str:
    width, height = size
    return (
        f'<sensor type="{plugin}" id="eye">{inner}{turn}<film type="hdrfilm">'
        f'<integer name="width" value="{width}"/><integer name="height" value="{height}"/>'
        f"</film></sensor>"
    )


def _half_width(camera: dg.Camera) -> float:
    """Tangent of half the horizontal field of view."""
    assert camera.focal_length is not None
    assert camera.sensor_size is not None
    return float(camera.sensor_size[0]) / 2 / float(camera.focal_length)


@pytest.mark.parametrize(
    ("inner", "size", "half"),
    [
        ('<float name="fov" value="60"/>', (60, 40), math.tan(math.radians(30))),
        ('<float name="fov" value="60"/><string name="fov_axis" value="y"/>', (60, 40), 0.866025),
        (
            '<float name="fov" value="60"/><string name="fov_axis" value="smaller"/>',
            (60, 40),
            0.866025,
        ),
        (
            '<float name="fov" value="60"/><string name="fov_axis" value="larger"/>',
            (60, 40),
            0.577350,
        ),
        (
            '<float name="fov" value="60"/><string name="fov_axis" value="smaller"/>',
            (40, 60),
            0.577350,
        ),
        (
            '<float name="fov" value="60"/><string name="fov_axis" value="diagonal"/>',
            (30, 40),
            0.6 * 0.577350,
        ),
        ('<string name="focal_length" value="50mm"/>', (60, 40), 18 / 50),
        ('<string name="focal_length" value="35"/>', (40, 60), 12 / 35),
        ("", (60, 40), 18 / 50),
    ],
)
def test_fields_of_view(inner: str, size: tuple[int, int], half: float, tmp_path: Path) -> None:
    scene = loaded(tmp_path, _sensor(inner, size=size))
    assert _half_width(scene.camera("eye")) == pytest.approx(half, rel=1e-5)
    width, height = scene.camera().sensor_size or (0, 0)
    assert width / height == pytest.approx(size[0] / size[1])


def test_the_focal_length_is_that_of_a_full_frame(tmp_path: Path) -> None:
    scene = loaded(tmp_path, _sensor('<string name="focal_length" value="85mm"/>'))
    assert scene.camera().focal_length == pytest.approx(85)
    assert scene.camera().sensor_size == pytest.approx((36, 24))


def test_a_thin_lens_has_its_aperture_and_focus(tmp_path: Path) -> None:
    inner = '<float name="aperture_radius" value="2"/><float name="focus_distance" value="300"/>'
    camera = loaded(tmp_path, _sensor(inner, "thinlens"), unit_m=0.01).camera()
    assert camera.lens == "thin"
    assert camera.aperture_diameter == pytest.approx(40)
    assert camera.focus_distance == pytest.approx(3)
    assert camera.f_stop is None
    far = inner.replace("focus_distance", "far_clip")
    scene = loaded(tmp_path, _sensor(far, "thinlens"), '<shape type="sphere"/>', unit_m=0.01)
    assert scene.camera().focus_distance == pytest.approx(3)


def test_clipping_and_shutter(tmp_path: Path) -> None:
    inner = (
        '<float name="near_clip" value="20"/><float name="far_clip" value="900"/>'
        '<float name="shutter_open" value="0.5"/><float name="shutter_close" value="0.75"/>'
    )
    scene = loaded(tmp_path, _sensor(inner), '<shape type="sphere"/>', unit_m=0.01)
    camera = scene.camera()
    assert camera.near_clip == pytest.approx(0.2)
    assert camera.shutter_time == pytest.approx(0.25)
    assert camera.shutter_offset == pytest.approx(12)
    assert camera.fps == 24
    assert not any("far_clip" in note for note in scene.warnings)
    far = '<shape type="sphere"><point name="center" value="0 0 950"/></shape>'
    assert any(
        "far_clip of a sensor is ignored" in note
        for note in loaded(tmp_path, _sensor(inner), far).warnings
    )


@pytest.mark.parametrize(
    ("inner", "plugin", "wrong"),
    [
        ('<float name="fov" value="180"/>', "perspective", "fov: wanted an angle between"),
        (
            '<float name="fov" value="9"/><string name="focal_length" value="5"/>',
            "perspective",
            "either fov or focal_length",
        ),
        ('<string name="focal_length" value="x"/>', "perspective", "a length such as 50mm"),
        ('<float name="fov" value="9"/><string name="fov_axis" value="z"/>', "perspective", "one"),
        ("", "thinlens", "the property 'aperture_radius' is missing"),
        ('<float name="aperture_radius" value="0"/>', "thinlens", "a number above 0"),
        ('<float name="near_clip" value="0"/>', "perspective", "a number above 0"),
        (
            '<float name="shutter_open" value="1"/>',
            "perspective",
            "the shutter must close after it opens at 1",
        ),
        (
            '<transform name="to_world"><matrix value="1 1 0 0 1 0 0 0 1"/></transform>',
            "perspective",
            "but it shears",
        ),
        (
            '<transform name="to_world"><scale x="0"/></transform>',
            "perspective",
            "but it flattens",
        ),
    ],
)
def test_wrong_cameras(inner: str, plugin: str, wrong: str, tmp_path: Path) -> None:
    with pytest.raises(dg.InputError, match=rf"line 2, column \d+: .*{wrong}"):
        loaded(tmp_path, _sensor(inner, plugin))


def test_sensors_without_a_lens_are_left_out_by_name(tmp_path: Path) -> None:
    scene = loaded(tmp_path, _sensor("", "radiancemeter"), '<shape type="cube"/>')
    assert "a sensor 'radiancemeter' is left out: no lens has its projection (1 use)" in (
        scene.warnings
    )
    assert scene.default_camera == "framing"


def test_settings_are_told(tmp_path: Path) -> None:
    film = (
        '<sensor type="perspective" id="eye"><film type="hdrfilm">'
        '<integer name="width" value="60"/><integer name="height" value="40"/>'
        '<integer name="crop_offset_x" value="10"/><integer name="crop_width" value="20"/>'
        '<rfilter type="gaussian"><float name="stddev" value="0.4"/></rfilter></film>'
        '<sampler type="multijitter"><integer name="sample_count" value="9"/></sampler></sensor>'
    )
    path = written(
        tmp_path,
        '<integrator type="path"><integer name="max_depth" value="5"/></integrator>',
        film,
        film.replace('"eye"', '"other"'),
    )
    scene, settings, _ = read_all(path)
    found = settings["eye"]
    assert (found.resolution, found.crop, found.spp) == ((60, 40), (10, 0, 30, 40), 9)
    assert (found.filter, found.max_depth) == ("gaussian:1.2", 4)
    assert scene.warnings == [
        "flags for the file's film and sampler: --crop left=10,top=0,right=30,bottom=40 --spp 9 "
        "--filter gaussian:1.2 --max-depth 4"
    ]
    assert list(scene.cameras) == ["eye", "other"]


@pytest.mark.parametrize(
    ("rfilter", "wanted"),
    [
        ('<rfilter type="tent"/>', "tent:1"),
        ('<rfilter type="lanczos"/>', "mitchell"),
        ('<rfilter type="tent"><float name="radius" value="1.5"/></rfilter>', "tent:1.5"),
        ('<rfilter type="box"/>', "box:0.5"),
        # Ours ends at 3 standard deviations.
        ('<rfilter type="gaussian"/>', "gaussian:1.5"),
        ("", "gaussian"),
    ],
)
def test_filters_are_those_of_the_file(tmp_path: Path, rfilter: str, wanted: str) -> None:
    film = f'<sensor type="perspective" id="eye"><film type="hdrfilm">{rfilter}</film></sensor>'
    scene, settings, ledger = read_all(written(tmp_path, film))
    assert settings["eye"].filter == wanted
    nearest = "a filter 'lanczos' is read as 'mitchell' (1 use)"
    assert (nearest in scene.warnings) == ("lanczos" in rfilter)
    assert check_filter(wanted) == wanted
    assert ledger.counts()[2] == 0


#: Shining balls and a floor that tell left from right and up from down.
MARKS = "".join(
    f'<shape type="sphere"><point name="center" value="{center}"/>'
    f'<float name="radius" value="0.5"/><emitter type="area">'
    f'<rgb name="radiance" value="{color}"/></emitter></shape>'
    for center, color in (("1 0 0", "3 1 1"), ("0 1 0", "1 3 1"), ("0 0 1", "1 1 3"))
)


@pytest.mark.parametrize(
    "inner",
    [
        "",
        '<float name="principal_point_offset_x" value="0.2"/>'
        '<float name="principal_point_offset_y" value="0.1"/>',
        '<float name="near_clip" value="4.7"/>',
    ],
)
def test_cameras_see_what_those_of_mitsuba_see(inner: str, tmp_path: Path) -> None:
    seen = camera("4 3 3", "0.2 0.3 0", "0 1 0", fov=35, size=(80, 64))
    path = written(
        tmp_path,
        '<integrator type="path"><integer name="max_depth" value="1"/></integrator>',
        seen.replace("<transform", inner + "<transform", 1),
        MARKS,
    )
    same_blocks(ours(path, 64), theirs(path, 64), 0.05)


MIRROR = '<transform name="to_world"><scale x="-1"/>'


def test_a_mirrored_camera_sees_the_mirror_image_as_in_mitsuba(tmp_path: Path) -> None:
    seen = camera("4 3 3", "0.2 0.3 0", "0 1 0", fov=35, size=(80, 64))
    path = written(
        tmp_path,
        '<integrator type="path"><integer name="max_depth" value="2"/></integrator>',
        seen.replace('<transform name="to_world">', MIRROR, 1),
        MARKS,
        '<shape type="rectangle"><transform name="to_world"><scale value="2"/>'
        '<translate z="-1"/></transform></shape>',
        '<emitter type="directional"><vector name="direction" x="2" y="-1" z="-1"/></emitter>',
    )
    assert read_all(path)[0].warnings == [
        "flags for the file's film and sampler: --spp 16 --filter box:0.5 --max-depth 1"
    ]
    same_blocks(ours(path, 64), theirs(path, 64), 0.05)


def test_a_mirrored_camera_sees_normal_maps_and_slides_mirrored(tmp_path: Path) -> None:
    y, x = np.mgrid[0:16, 0:16] / 16
    slopes = np.stack([0.4 * np.sin(9 * x), 0.3 * np.sin(7 * y + x), 0.8 + 0 * x], axis=2)
    Image.fromarray((127.5 + 127.5 * slopes).astype(np.uint8)).save(tmp_path / "map.png")
    texture = (
        '<texture type="bitmap" name="{}"><string name="filename" value="map.png"/>{}</texture>'
    )
    raw = texture.format("normalmap", '<boolean name="raw" value="true"/>')
    parts = (
        '<shape type="rectangle"><bsdf type="normalmap">' + raw + '<bsdf type="diffuse"/></bsdf>'
        "</shape>",
        '<emitter type="projector"><float name="fov" value="60"/>'
        + texture.format("irradiance", "")
        + '<transform name="to_world"><lookat origin="1 0.5 2" target="0.1 0 0" up="0 1 0"/>'
        "</transform></emitter>",
    )
    seen = camera("0 0 4", size=(64, 64))
    plain = ours(written(tmp_path, seen, *parts), 64)
    seen = seen.replace('<transform name="to_world">', MIRROR, 1)
    same_blocks(ours(written(tmp_path, seen, *parts), 64), plain[:, ::-1], 0.04)


def test_a_thin_lens_blurs_as_mitsubas(tmp_path: Path) -> None:
    seen = camera("0 0 6", "0 0 0", "0 1 0", fov=40, size=(64, 64))
    lens = '<float name="aperture_radius" value="0.4"/><float name="focus_distance" value="9"/>'
    seen = seen.replace('"perspective"', '"thinlens"').replace("<transform", lens + "<transform", 1)
    path = written(
        tmp_path,
        '<integrator type="path"><integer name="max_depth" value="1"/></integrator>',
        seen,
        MARKS,
    )
    a, b = ours(path, 512), theirs(path, 512)
    same_blocks(a, b, 0.1, size=8)
    sharp = path.read_text().replace(
        'name="aperture_radius" value="0.4"', 'name="aperture_radius" value="1e-4"'
    )
    path.write_text(sharp)
    with pytest.raises(AssertionError, match="times the allowance"):
        same_blocks(ours(path, 64), b, 0.1, size=8)
    assert np.isfinite(a).all()
