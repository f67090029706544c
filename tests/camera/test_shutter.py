"""The shutter in a photographer's terms: times, curves, types, what is refused, what is told."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.camera import shutter
from daguerre.camera.shutter_curve import read_curve
from daguerre.cli.flags.shutter import ShutterFlags
from tests.support.scene import scenes

SIZE = (30, 20)


def camera(**parameters: Any) -> dg.Camera:
    return dg.Camera(**parameters)


def flags(**given: str) -> dict[str, Any]:
    names = ShutterFlags.__dataclass_fields__
    return ShutterFlags(**{name: given.get(name) for name in names}).changes()


@pytest.mark.parametrize(
    ("parameters", "expected"),
    [
        ({}, (-1 / 96, 1 / 96)),  # 180 degrees at 24 fps, around the frame
        ({"shutter_time": 0.5}, (-0.25, 0.25)),
        ({"shutter_angle": 90, "fps": 25}, (-0.005, 0.005)),
        ({"shutter_time": 0.01, "shutter_offset": 0}, (0, 0.01)),
        ({"shutter_time": 0.01, "shutter_offset": -0.25, "fps": 25}, (-0.01, 0)),
        ({"shutter_time": 0}, (0, 0)),
        (  # the last of 20 rows opens 19 line times after the first
            {"shutter_time": 0.01, "rolling_shutter": dg.RollingShutter("top", line_time=0.001)},
            (-0.0145, 0.0145),
        ),
        (
            {"shutter_time": 0, "rolling_shutter": dg.RollingShutter("left", readout_time=0.3)},
            (-0.145, 0.145),
        ),
        (
            {"shutter_time": 0.01, "shutter_type": "focal_plane", "shutter_offset": 0},
            (0, 0.01 + 19 / 20 / 300),
        ),
        (
            {"shutter_type": "rotary", "shutter_offset": 0},
            (0, 1 / 48 + 29 / 30 * 60 / 360 / 24),
        ),
    ],
)
def test_the_interval_holds_all_lines(
    parameters: dict[str, Any], expected: tuple[float, float]
) -> None:
    for time in (0.0, 7.5):
        got = shutter.interval(camera(**parameters), time, SIZE)
        assert got == pytest.approx((time + expected[0], time + expected[1]))


def test_each_type_exposes_the_lines_in_its_own_order() -> None:
    def opens(x: int, y: int, **parameters: Any) -> float:
        made = shutter.core_shutter(camera(shutter_time=0.01, **parameters), SIZE)
        return float(made.moment(x, y, 0.0)[0] * made.duration_s)

    assert opens(3, 19) == 0
    assert opens(3, 19, shutter_type="focal_plane") == 0  # curtains fall on an image upside down
    assert opens(3, 0, shutter_type="focal_plane") == pytest.approx(19 / 20 / 300)
    assert opens(3, 19, shutter_type="electronic") == pytest.approx(19 / 20 / 60)
    assert opens(29, 3, shutter_type="rotary") == pytest.approx(29 / 30 / 6 / 24)
    faster = dg.RollingShutter("right", readout_time=0.003)
    assert opens(0, 3, shutter_type="rotary", rolling_shutter=faster) == pytest.approx(0.0029)
    leaf = shutter.core_shutter(camera(shutter_time=0.01, shutter_type="leaf"), SIZE)
    assert leaf.moment(0, 0, 0.125) == pytest.approx((0.125, 0.5))


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"shutter_time": -0.1}, "shutter_time: wanted a number of at least 0"),
        ({"shutter_time": float("nan")}, "shutter_time: wanted"),
        ({"shutter_time": "fast"}, "shutter_time: wanted"),
        ({"shutter_angle": -1}, "shutter_angle: wanted"),
        ({"shutter_time": 0.1, "shutter_angle": 90}, "either shutter_time or shutter_angle"),
        ({"fps": 0}, "fps: wanted"),
        ({"shutter_offset": float("inf")}, "shutter_offset: wanted"),
        ({"shutter_type": "leave"}, "shutter_type: wanted .*did you mean 'leaf'"),
        ({"shutter_type": "rotary", "shutter_time": 1}, "rotary: wanted at most"),
        ({"shutter_curve": "bix"}, "shutter_curve: wanted box.*did you mean 'box'"),
        ({"shutter_curve": "trapezoid"}, "takes its efficiency"),
        ({"shutter_curve": ("trapezoid", 0.4)}, "efficiency: wanted"),
        ({"shutter_curve": 5}, "shutter_curve: wanted"),
        ({"shutter_curve": [(0, 1)]}, "2 to 4096 points"),
        (
            {"shutter_curve": [(0, 1), (0.6, 1), (0.5, 1)]},
            "times within 0 .. 1 that do not decrease",
        ),
        ({"shutter_curve": [(0, 0), (1, 0)]}, "shutter: curve: never open"),
        ({"shutter_curve": [(0, 1), (1, float("nan"))]}, "an opening of at least 0"),
        ({"rolling_shutter": ("top", 1)}, "wanted a RollingShutter"),
        ({"rolling_shutter": dg.RollingShutter("up", 0.1)}, "scan_order: wanted top"),
        ({"rolling_shutter": dg.RollingShutter()}, "either line_time or readout_time, got none"),
        ({"rolling_shutter": dg.RollingShutter("top", 1, 1)}, "got both"),
        ({"rolling_shutter": dg.RollingShutter("top", -1)}, "line_time: wanted"),
        (
            {"lens": "tessar-50mm-f2.8", "aperture_image": np.ones((4, 4)), "shutter_type": "leaf"},
            "shutter_type leaf: wanted blades for the iris of an exact lens",
        ),
        (
            {"sensor_size": dg.keys([(-1, (36.0, 24.0)), (1, (18.0, 12.0))])},
            "sensor_size: cannot change while the shutter is open",
        ),
        (
            {"rolling_shutter": dg.RollingShutter("top", 1), "shutter_type": "leaf"},
            "a leaf shutter exposes all lines at once",
        ),
    ],
)
def test_what_is_no_shutter_is_refused(parameters: dict[str, Any], message: str) -> None:
    scene = scenes.furnace()
    with pytest.raises(dg.UsageError, match=message):
        dg.render(scene, camera(**parameters), resolution=(4, 3), spp=1)


def test_one_way_to_say_how_long_replaces_the_other() -> None:
    by_time = camera().with_(shutter_time=0.1)
    by_angle = by_time.with_(shutter_angle=90)
    assert (by_angle.shutter_time, by_angle.shutter_angle) == (None, 90)
    assert by_angle.with_(shutter_time=0.2).shutter_angle is None


def test_efficiency_darkens_the_picture_and_the_shutter_time_does_not() -> None:
    scene = scenes.furnace()
    look = {"resolution": (6, 4), "spp": 16}
    for changes, expected in (
        ({"shutter_time": 3.0}, 1.0),
        ({"shutter_time": 0.0}, 1.0),
        ({"shutter_curve": ("trapezoid", 0.75)}, 0.75),
        ({"shutter_curve": [(0, 0), (1, 8)]}, 0.5),
        ({"rolling_shutter": dg.RollingShutter("left", readout_time=0.1)}, 1.0),
        # radius 0..1..0 with half of the time wide open: area 1/2 + 2 * 1/4 * 1/3
        ({"shutter_type": "leaf"}, 2 / 3),
    ):
        for lens in ("pinhole", "thin"):
            picture = dg.render(scene, camera(lens=lens, **changes), **look)
            assert picture.rgb.mean() == pytest.approx(expected, abs=0.01), (lens, changes)


def test_metadata_and_hashes_tell_the_shutter() -> None:
    scene = scenes.furnace()
    made = dg.Session(scene, camera(shutter_angle=90.0, fps=25.0), resolution=(4, 3))
    assert made.metadata["expTime"] == pytest.approx(0.01)
    assert (made.metadata["shutterAngle"], made.metadata["captureRate"]) == (90.0, 25.0)
    assert made.metadata["time"] == 0
    long = dg.Session(scene, camera(shutter_time=4.0), resolution=(4, 3))
    assert "shutterAngle" not in long.metadata
    keys = [
        dg.Session(scene, camera(**p), resolution=(4, 3)).key["camera"]
        for p in (
            {},
            {"shutter_time": 0.1},
            {"shutter_type": "leaf"},
            {"shutter_offset": 0.5},
            {"shutter_curve": ("trapezoid", 0.9)},
            {"rolling_shutter": dg.RollingShutter("top", 1e-5)},
            {"rolling_shutter": dg.RollingShutter("bottom", 1e-5)},
        )
    ]
    assert len(set(keys)) == len(keys)


def test_flags_say_what_photographers_say(tmp_path: Path) -> None:
    assert flags() == {}
    assert flags(shutter="1/48") == {"shutter_time": 1 / 48}
    assert flags(shutter="20ms", fps="24000/1001") == {"shutter_time": 0.02, "fps": 24000 / 1001}
    assert flags(shutter_angle="172.8") == {"shutter_angle": 172.8}
    assert flags(shutter_offset="-0.25", shutter_type="focal-plane") == {
        "shutter_offset": -0.25,
        "shutter_type": "focal_plane",
    }
    assert flags(rolling="top,16.6ms") == {
        "rolling_shutter": dg.RollingShutter("top", readout_time=0.0166)
    }
    assert flags(rolling="left,15us/line")["rolling_shutter"].line_time == pytest.approx(15e-6)
    assert flags(shutter_curve="trapezoid:0.8") == {"shutter_curve": ("trapezoid", 0.8)}
    table = tmp_path / "shutter.csv"
    table.write_text("t_ms,open\n# measured\n2,0\n3; 40\n\n6 0\n")
    assert flags(shutter_curve=str(table)) == {"shutter_curve": [(0, 0), (0.25, 40), (1, 0)]}


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"shutter": "1/0"}, "--shutter: wanted a time"),
        ({"shutter": "1/48", "shutter_angle": "180"}, "--shutter and --shutter-angle"),
        ({"fps": "24s"}, "--fps: wanted a number"),
        ({"rolling": "top"}, "--rolling: wanted a side and a time"),
        ({"rolling": "top,fast"}, "--rolling: wanted a time"),
        ({"shutter_curve": "trapezoid:x"}, "trapezoid:E"),
        (
            {"shutter_curve": "none.csv"},
            r"none\.csv: no such file \(wanted box, trapezoid:E or",
        ),
    ],
)
def test_wrong_flags_are_named(given: dict[str, str], message: str) -> None:
    with pytest.raises(dg.DaguerreError, match=message):
        flags(**given)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "at least two points"),
        (b"0,1", "at least two points"),
        (b"1,1\n1,1", "at least two points at different times"),
        (b"0,1\n2,1\n1,1", "line 3: times must not decrease, got 1 after 2"),
        (b"t,v\nu,w", "line 2: wanted time and opening"),
        (b"0,1\n1,nan", "line 2"),
        (b"0,1,2\n3,4,5", "line 2"),
        (b"\xff\xfe\x00", "wanted UTF-8, got byte 0xff at byte 0"),
        (b"0,1\n" * 5000, "at most 4096 points"),
        (b"0,1\n" * 300000, "wanted at most 1048576 bytes, got 1200000"),
    ],
)
def test_tables_that_are_no_shutter_are_refused(
    tmp_path: Path, content: bytes, message: str
) -> None:
    path = tmp_path / "s.csv"
    path.write_bytes(content)
    with pytest.raises(dg.InputError, match=message):
        read_curve(path)


def test_a_moving_camera_blurs_an_edge_by_the_shutters_curve() -> None:
    wall = np.array([(-9, -9, -1), (0, -9, -1), (0, 9, -1), (-9, 9, -1)], float)
    triangles = np.array([(0, 1, 2), (0, 2, 3)])
    scene = dg.Scene()
    light = dg.Material(dg.Diffuse((0, 0, 0)), emission=(1, 1, 1))
    scene.add_instance(scene.add_mesh(wall, triangles), light)
    path = dg.keys([(9.0, scenes.at(-0.16, 0, 0)), (11.0, scenes.at(0.16, 0, 0))])
    scene.time = 10.0
    view = camera(
        transform=path,
        lens="pinhole",
        focal_length=50,
        shutter_time=2.0,
        shutter_curve=("trapezoid", 0.75),
    )
    options = {"resolution": (24, 2), "filter": "box", "seed": 3}
    picture = dg.render(scene, view, spp=512, **options).rgb.mean(axis=(0, 2))
    x = (np.arange(24 * 50) + 0.5) / 50 * 1.5 - 18  # mm
    until = np.clip(0.5 - x / 16, 0, 1)  # 0.32 m at 1 m are 16 mm on the film
    curve = np.minimum(1, np.minimum(np.linspace(0, 1, 2001), np.linspace(1, 0, 2001)) / 0.25)
    opened = np.concatenate([[0], np.cumsum((curve[1:] + curve[:-1]) / 4000)])
    expected = np.interp(until, np.linspace(0, 1, 2001), opened).reshape(24, 50).mean(axis=1)
    assert np.abs(picture - expected).max() < 0.03
    still = dg.render(scene, view.with_(shutter_time=0.0), spp=64, **options).rgb.mean(axis=(0, 2))
    assert np.abs(still - 0.75 * (np.arange(24) < 12)).max() < 0.02
