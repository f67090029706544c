"""Cameras of USD: numbers against USD's own, units, and what a stage leaves out."""

from __future__ import annotations

import math
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.exposure.lux_seconds import display_gain

pytest.importorskip("pxr")

from pxr import Usd, UsdGeom

from daguerre.importers.usd.values import Clock

from .stage import FILE, PATH, camera_prim, noted, read

WIDE = """
    float focalLength = 35
    float horizontalAperture = 36
    float verticalAperture = 24
    float horizontalApertureOffset = {right}
    float verticalApertureOffset = {up}
"""


@pytest.mark.parametrize(("right", "up"), [(0, 0), (5, 0), (0, -3), (-4.5, 6.25)])
@pytest.mark.parametrize("metres", [0.01, 0.001, 1.0])
def test_rays_are_those_of_usds_own_frustum(right: float, up: float, metres: float) -> None:
    """Field of view and the direction of offsets, at every unit of a stage."""
    prim = camera_prim(WIDE.format(right=right, up=up))
    camera = read(prim, metres=metres)
    window = UsdGeom.Camera(prim).GetCamera(0).frustum.window  # at distance 1
    low, high = window.GetMin(), window.GetMax()
    columns, rows = 36, 24
    x = low[0] + (np.arange(columns) + 0.5) / columns * (high[0] - low[0])
    y = high[1] - (np.arange(rows) + 0.5) / rows * (high[1] - low[1])
    seen = dg.raymap(camera, (columns, rows)).direction
    np.testing.assert_allclose(seen[..., 0] / seen[..., 2], np.tile(x, (rows, 1)), atol=1e-6)
    np.testing.assert_allclose(-seen[..., 1] / seen[..., 2], np.tile(y, (columns, 1)).T, atol=1e-6)


def test_camera_lengths_are_tenths_of_a_unit_and_focus_is_in_units() -> None:
    lines = """
        float focalLength = 0.25
        float horizontalAperture = 0.36
        float focusDistance = 2.5
        float fStop = 2.8
    """
    camera = read(camera_prim(lines), metres=1.0)
    assert camera.focal_length == pytest.approx(25)
    assert camera.sensor_size[0] == pytest.approx(36)
    assert camera.focus_distance == pytest.approx(2.5)
    assert camera.f_stop == 2.8
    inches = read(camera_prim(lines), metres=0.0254)
    assert inches.focal_length == pytest.approx(0.25 * 2.54)
    assert inches.focus_distance == pytest.approx(2.5 * 0.0254)


def test_a_unit_that_is_probably_wrong_is_noted_and_millimetres_help() -> None:
    lines = "float focalLength = 24\nfloat horizontalAperture = 36"
    _, notes = noted(camera_prim(lines), metres=1.0)
    assert "a lens of 2.4 m; metersPerUnit is probably wrong: --camera-units mm" in notes[0]
    assert len(notes) == 1
    _, notes = noted(camera_prim("float horizontalAperture = 3.6"))
    assert notes == []
    _, notes = noted(camera_prim("float horizontalAperture = 0.36"))
    assert notes[0].startswith("this file says a sensor 0.36 mm wide")
    camera, notes = noted(camera_prim(lines), metres=1.0, camera_millimetres=1.0)
    assert notes == []
    assert camera is not None
    assert (camera.focal_length, camera.sensor_size[0]) == (24, 36)


def test_what_a_stage_leaves_out_keeps_daguerres_default() -> None:
    camera = read(camera_prim())
    usual = dg.Camera()
    for name in (
        *("f_stop", "focus_distance", "shutter_time", "shutter_offset", "exposure_time"),
        *("exposure_f_stop", "iso", "responsivity", "exposure_compensation", "lens"),
    ):
        assert getattr(camera, name) == getattr(usual, name), name
    assert camera.focal_length == 50
    assert camera.sensor_size == pytest.approx((20.955, 15.2908))  # the schema's


def test_an_f_stop_of_0_is_a_pinhole_and_a_focus_of_0_is_unset() -> None:
    camera = read(camera_prim("float fStop = 0\nfloat focusDistance = 0"))
    assert (camera.lens, camera.f_stop, camera.focus_distance) == ("pinhole", None, None)


@pytest.mark.parametrize(
    ("opens", "closes", "time", "offset"),
    [(0, 0, 0.0, 0.0), (-0.25, 0.25, 0.5 / 24, -0.25), (0, 0.5, 0.5 / 24, 0.0)],
)
def test_shutters_are_in_frames(opens: float, closes: float, time: float, offset: float) -> None:
    lines = f"double shutter:open = {opens}\ndouble shutter:close = {closes}"
    camera = read(camera_prim(lines))
    assert (camera.shutter_time, camera.shutter_offset) == pytest.approx((time, offset))
    assert camera.fps == 24
    # Time codes of another rate than the frames.
    camera = read(camera_prim(lines), fps=12.0)
    assert camera.shutter_time == pytest.approx(time)
    assert camera.shutter_offset == pytest.approx(offset / 2)


def test_a_shutter_that_never_opens_and_parallel_rays_make_no_camera() -> None:
    camera, notes = noted(camera_prim("double shutter:open = 0.5\ndouble shutter:close = 0.25"))
    assert camera is None
    assert notes == ["a camera with a shutter that closes before it opens is left out (1 use)"]
    camera, notes = noted(camera_prim('token projection = "orthographic"'))
    assert camera is None
    assert notes == ["an orthographic camera is left out: no lens makes parallel rays (1 use)"]


EXPOSED = """
    float fStop = 4
    float exposure = {ev}
    float exposure:iso = {iso}
    float exposure:time = {time}
    float exposure:fStop = {stop}
    float exposure:responsivity = {factor}
"""
EXPOSURES: list[dict[str, float]] = [
    {"ev": 0, "iso": 100, "time": 0.02, "stop": 4, "factor": 1},
    {"ev": 1, "iso": 100, "time": 0.02, "stop": 4, "factor": 1},
    {"ev": -0.5, "iso": 320, "time": 0.01, "stop": 5.6, "factor": 1.5},
    {"ev": 0.25, "iso": 50, "time": 0.03, "stop": 2.8, "factor": 0.8},
]


def shown(camera: dg.Camera) -> float:
    """Display-linear value of a radiance of 1 in the picture of a camera."""
    scene = dg.Scene()
    scene.set_environment(color=(20.0, 20.0, 20.0))
    frame = dg.render(scene, camera.with_(focus_distance=2.0), resolution=(8, 6), spp=4)
    assert frame.rgb.mean() == pytest.approx(20, rel=0.01)
    return display_gain(frame.metadata)


def usds(prim: Usd.Prim, code: Usd.TimeCode | None = None) -> float:
    """USD's own scale."""
    return float(UsdGeom.Camera(prim).ComputeLinearExposureScale(code or Usd.TimeCode.Default()))


@pytest.mark.parametrize("values", EXPOSURES)
@pytest.mark.parametrize("lens", ["", "fStop = 0", "fStop = 1.4", "focusDistance = 40"])
def test_a_picture_is_usds_scale_times_the_light(values: dict[str, float], lens: str) -> None:
    lines = EXPOSED.format(**values) + "double shutter:close = 0.1"
    if lens:
        name = lens.split()[0]
        lines = "\n".join(line for line in lines.splitlines() if f"float {name} " not in line)
        lines += f"\nfloat {lens}"
    prim = camera_prim(lines)
    camera = read(prim)
    assert camera.exposure == "manual"
    assert shown(camera) == pytest.approx(usds(prim), rel=3e-7)


@pytest.mark.parametrize(
    "line",
    [
        "exposure:iso = 800",
        "exposure:iso = 100",
        "exposure:time = 0.02",
        "exposure:time = 1",
        "exposure:fStop = 2",
        "exposure:responsivity = 0.25",
        "exposure:responsivity.timeSamples = {0: 0.25, 24: 1}",
    ],
)
def test_one_attribute_of_exposure_is_manual_with_the_fallbacks_of_usd(line: str) -> None:
    prim = camera_prim(f"float {line}\nfloat exposure = 1")
    camera = read(prim)
    assert camera.exposure == "manual"
    assert shown(camera) == pytest.approx(usds(prim, Usd.TimeCode(0)), rel=3e-7)


@pytest.mark.parametrize("ev", [0.0, 1.5])
def test_exposure_alone_is_an_ev_in_light(ev: float) -> None:
    prim = camera_prim(f"float exposure = {ev}")
    camera = read(prim)
    assert (camera.exposure, camera.exposure_compensation) == ("light", ev)
    assert shown(camera) == pytest.approx(2**ev, rel=1e-9)


NAMED: dict[str, tuple[str, dict[str, Any]]] = {
    "light": ("float exposure:iso = 400", {"exposure": "light", "iso": 400}),
    "manual": ("", {"exposure": "manual", "exposure_time": None, "exposure_f_stop": None}),
    "auto": (
        "float exposure:time = 0.02\nfloat fStop = 4",
        {"exposure": "auto", "exposure_time": 0.02, "exposure_f_stop": None, "responsivity": 1},
    ),
    "A": ("float exposure:iso = 400", {"exposure": "A", "iso": 400, "exposure_time": None}),
    "S": ("float exposure:time = 0.02", {"exposure": "S", "exposure_f_stop": None}),
    "P": ("float exposure = 1", {"exposure": "P", "exposure_compensation": 1}),
}


@pytest.mark.parametrize("mode", NAMED)
def test_an_attribute_of_ours_names_the_mode(mode: str) -> None:
    lines, wanted = NAMED[mode]
    named = f'token daguerre:exposure:mode = "{mode}"\nstring daguerre:exposure:meter = "spot:3,4"'
    camera = read(camera_prim(f"{lines}\n{named}"))
    assert {name: getattr(camera, name) for name in wanted} == wanted
    assert camera.meter == "spot:3,4"


CONFLICTS = {
    ("auto", "float exposure:iso = 400"): "exposure:iso: wanted none, as exposure auto chooses",
    ("auto", "float exposure:iso = 100"): "exposure:iso: wanted none, as exposure auto chooses",
    ("A", "float exposure:time = 0.5"): "exposure:time: wanted none, as exposure A chooses",
    ("A", "double shutter:close = 0.5"): "exposure A chooses the exposure time, but shutter_time",
    ("S", "float fStop = 2"): "exposure S chooses the f-stop, but f_stop is set",
    ("P", "float exposure:fStop = 2"): "exposure:fStop: wanted none, as exposure P chooses",
    ("auto", "double daguerre:exposure:iso = 400"): "chooses the ISO, but iso is set",
    ("M", ""): "daguerre:exposure:mode: wanted light, manual, auto, A, S, P; got 'M'",
    ("light", 'string daguerre:exposure:meter = "sky"'): "daguerre:exposure:meter: wanted centre",
    ("light", "int daguerre:exposure:meter = 3"): "daguerre:exposure:meter: wanted a name, got 3",
}


@pytest.mark.parametrize(("mode", "line"), CONFLICTS)
def test_a_mode_and_what_it_chooses_are_one_error(mode: str, line: str) -> None:
    prim = camera_prim(f'{line}\ntoken daguerre:exposure:mode = "{mode}"')
    with pytest.raises(dg.InputError, match=r"shot\.usda: /World/Cam") as error:
        read(prim)
    assert CONFLICTS[mode, line] in str(error.value)


def test_equal_numbers_do_not_split_light_from_blur_where_the_mode_is_named() -> None:
    """So a camera that we wrote comes back; the numbers of others stay as they are."""
    named = '\ntoken daguerre:exposure:mode = "manual"'
    lines = "float fStop = 2.8\nfloat exposure:fStop = 2.8\ndouble shutter:close = 0.48"
    lines += "\nfloat exposure:time = 0.02"
    camera = read(camera_prim(lines))
    assert (camera.exposure_time, camera.exposure_f_stop) == (0.02, 2.8)
    camera = read(camera_prim(lines + named))
    assert (camera.exposure_time, camera.exposure_f_stop) == (None, None)
    moving = "fStop.timeSamples = {0: 2.8, 24: 5.6}"
    camera = read(camera_prim(f"float {moving}\nfloat exposure:{moving}{named}"))
    assert camera.exposure_f_stop is None
    assert "exposure_f_stop" not in camera.motion
    other = moving.replace("5.6", "8")
    camera = read(camera_prim(f"float {moving}\nfloat exposure:{other}{named}"))
    assert "exposure_f_stop" in camera.motion
    camera = read(camera_prim("float exposure:time = 1"))
    assert camera.exposure_time == 1  # as the fallback, but authored


MOVING = """
    float focalLength.timeSamples = {0: 24, 48: 70}
    float horizontalAperture.timeSamples = {0: 36, 24: 30}
    float horizontalApertureOffset.timeSamples = {0: 0, 24: 5}
    float fStop.timeSamples = {0: 2.8, 24: 5.6}
    float focusDistance.timeSamples = {0: 100, 12: 300}
"""


@pytest.mark.parametrize("code", [-3.0, 0.0, 7.0, 12.0, 30.0, 60.0])
def test_what_changes_over_time_is_what_usd_has_at_that_time(code: float) -> None:
    prim = camera_prim(MOVING)
    camera = read(prim).evaluated_at(code / 24)
    usd = UsdGeom.Camera(prim).GetCamera(Usd.TimeCode(code))
    assert camera.focal_length == pytest.approx(usd.focalLength, rel=1e-6)
    assert camera.sensor_size[0] == pytest.approx(usd.horizontalAperture, rel=1e-6)
    assert camera.shift[0] == pytest.approx(usd.horizontalApertureOffset, rel=1e-6, abs=1e-9)
    assert camera.f_stop == pytest.approx(usd.fStop, rel=1e-6)
    assert camera.focus_distance == pytest.approx(usd.focusDistance / 100, rel=1e-6)
    assert set(camera.motion) == {
        "focal_length", "sensor_size", "shift", "f_stop", "focus_distance"
    }  # fmt: skip


def test_a_stop_of_0_and_a_focus_of_0_among_keys() -> None:
    lines = (
        "float fStop.timeSamples = {0: 0, 24: 4}\nfloat focusDistance.timeSamples = {0: 0, 24: 300}"
    )
    camera, notes = noted(camera_prim(lines))
    assert camera is not None
    assert camera.evaluated_at(0).f_stop > 1e8
    assert camera.evaluated_at(1).f_stop == 4
    assert camera.focus_distance == pytest.approx(3)
    assert len(notes) == 1


def test_values_that_cannot_move_are_noted() -> None:
    white = "double daguerre:sensor:whiteBalance.timeSamples = {0: 3200, 24: 5600}"
    camera, notes = noted(camera_prim(white))
    assert camera is not None
    assert camera.white_balance == 3200
    assert notes == [
        "daguerre:sensor:whiteBalance of a camera changes over time; its value at one time is "
        "kept (1 use)"
    ]


CHANGING = """
    float exposure:iso.timeSamples = {0: 100, 24: 400}
    float exposure:time.timeSamples = {0: 0.02, 12: 0.01}
    float exposure:fStop.timeSamples = {0: 2, 24: 4}
    float exposure:responsivity.timeSamples = {0: 1, 24: 2}
    float exposure.timeSamples = {0: 0, 24: 3}
    double shutter:open.timeSamples = {0: -0.25, 24: 0}
    double shutter:close.timeSamples = {0: 0.25, 12: 0.75, 24: 0.5}
"""


@pytest.mark.parametrize("code", [0.0, 6.0, 12.0, 18.0, 30.0])
def test_exposure_and_shutter_over_time_are_what_usd_has_at_that_time(code: float) -> None:
    prim = camera_prim(CHANGING)
    camera, notes = noted(prim)
    assert camera is not None
    assert notes == []
    now, usd = camera.evaluated_at(code / 24), UsdGeom.Camera(prim)
    ours = now.exposure_time * now.iso / 100 * 2**now.exposure_compensation * now.responsivity
    ours *= 0.45 * math.pi / now.exposure_f_stop**2  # ISO 12232, f/1
    assert ours == pytest.approx(usds(prim, Usd.TimeCode(code)), rel=1e-6)
    opens, closes = usd.GetShutterOpenAttr().Get(code), usd.GetShutterCloseAttr().Get(code)
    assert now.shutter_offset == pytest.approx(opens, abs=1e-9)
    assert now.shutter_time == pytest.approx((closes - opens) / 24, rel=1e-9)


def test_a_shutter_that_closes_before_it_opens_at_one_moment_makes_no_picture() -> None:
    camera, notes = noted(camera_prim("double shutter:open.timeSamples = {0: 0, 24: 0.5}"))
    assert camera is None
    assert len(notes) == 1


def test_what_is_not_drawn_is_noted_once() -> None:
    lines = """
        float4[] clippingPlanes = [(0, 0, 1, 2)]
        float2 clippingRange = (50, 20)
        uniform token stereoRole = "left"
    """
    _, notes = noted(camera_prim(lines))
    assert [note.split(" of a camera")[0][:22] for note in notes] == [
        "a clipping range whose", "clipping planes", "stereoRole left",
    ]  # fmt: skip


@pytest.mark.parametrize(("authored", "metres", "wanted"), [
    ("", 0.01, 0.0),  # the schema's fallback is nobody's wish
    ("float2 clippingRange = (0.1, 100)", 0.01, 0.001),
    ("float2 clippingRange = (50, 1e6)", 0.01, 0.5),
    ("float2 clippingRange = (0.25, 1e6)", 1.0, 0.25),
    ("float2 clippingRange = (0, 100)", 1.0, 0.0),
    ("float2 clippingRange = (-1, 100)", 1.0, 0.0),
    ("float2 clippingRange = (3, 100)\ndouble daguerre:nearClip = 0", 1.0, 0.0),
    ("float2 clippingRange = (3, 100)\ndouble daguerre:nearClip = 0.125", 0.01, 0.125),
])  # fmt: skip
def test_a_near_clipping_plane_is_honoured(authored: str, metres: float, wanted: float) -> None:
    camera, notes = noted(camera_prim(authored), metres=metres, camera_millimetres=1.0)
    assert camera is not None
    assert camera.near_clip == pytest.approx(wanted, rel=1e-12)
    assert notes == []


@pytest.mark.parametrize("pair", ["(5, 5)", "(5, 1)", "(0, 0)"])
def test_a_clipping_range_that_holds_nothing_is_noted(pair: str) -> None:
    camera, notes = noted(camera_prim(f"float2 clippingRange = {pair}"))
    assert camera is not None
    assert camera.near_clip == 0
    assert notes == [
        "a clipping range whose far plane is not beyond its near one is left out (1 use)"
    ]


OURS = """
    string daguerre:lens:name = "double-gauss-50mm-f2"
    token daguerre:lens:model = "thick"
    double daguerre:lens:tStop = 2.4
    double2 daguerre:tilt = (3, -1)
    int daguerre:aperture:blades = 7
    double daguerre:aperture:rotation = 12.5
    double daguerre:aperture:curvature.timeSamples = {0: 0.1, 24: 0.3}
    double daguerre:sensor:whiteBalance = 5600
    token daguerre:shutter:type = "rotary"
    double2[] daguerre:shutter:curve = [(0, 0), (0.2, 1), (0.8, 1), (1, 0)]
    token daguerre:rollingShutter:scanOrder = "left"
    double daguerre:rollingShutter:lineOffset = 1.5e-5
    double2 daguerre:rollingShutter:lineExposure = (1, 100)
    double daguerre:focus:distance = inf
    token daguerre:sensor:fit = "vertical"
    float fStop = 2.8
    float focusDistance = 200
"""


def test_attributes_of_our_own_take_precedence() -> None:
    camera = read(camera_prim(OURS))
    wanted: dict[str, Any] = {
        "lens": "double-gauss-50mm-f2", "lens_model": "thick", "t_stop": 2.4, "f_stop": None,
        "tilt": (3, -1), "blades": 7, "blade_rotation": 12.5, "white_balance": 5600,
        "shutter_type": "rotary", "shutter_curve": [(0, 0), (0.2, 1), (0.8, 1), (1, 0)],
        "rolling_shutter": dg.RollingShutter("left", line_time=1.5e-5), "shutter_time": 0.01,
        "focus_distance": np.inf, "sensor_fit": "vertical", "focal_length": None,
    }  # fmt: skip
    assert {name: getattr(camera, name) for name in wanted} == wanted
    assert camera.evaluated_at(0.5).blade_curvature == pytest.approx(0.2)


def test_files_are_found_by_the_stage_alone(tmp_path: Path) -> None:
    asked = []

    def resolve(place: str, asset: str) -> Path:
        asked.append((place, asset))
        return tmp_path / asset

    prim = camera_prim("asset daguerre:lens:file = @lenses/my.json@")
    camera = read(prim, resolve=resolve)
    assert camera.lens == str(tmp_path / "lenses/my.json")
    assert asked == [(f"{FILE}: {PATH}.daguerre:lens:file", "lenses/my.json")]
    with pytest.raises(dg.InputError, match="refused"):
        read(prim)


def test_a_library_name_may_stand_in_an_asset() -> None:
    prim = camera_prim("asset daguerre:lens:file = @double-gauss-50mm-f2@")
    assert read(prim).lens == "double-gauss-50mm-f2"


BAD = {
    "focalLength": ("float focalLength = 0", "at least 0.001"),
    "focalLength ": ("float focalLength = nan", "finite"),
    "focalLength  ": ("float focalLength.timeSamples = {0: 10, 1: -1}", "at least"),
    "horizontalAperture": ("float horizontalAperture = -36", "at least"),
    "verticalAperture": ("float verticalAperture = inf", "finite"),
    "verticalApertureOffset": ("float verticalApertureOffset = 1e30", "at most"),
    "fStop": ("float fStop = -2", "at least"),
    "focusDistance": ("float focusDistance = -1", "at least"),
    "shutter:open": ("double shutter:open = nan", "finite"),
    "shutter:close": ("double shutter:close = 1e30", "at most"),
    "exposure:iso": ("float exposure:iso = 0", "above 0"),
    "exposure:time": ("float exposure:time = -1", "above 0"),
    "exposure:fStop": ("float exposure:fStop = inf", "finite"),
    "exposure": ("float exposure = 1000", "at most"),
    "clippingRange": ("float2 clippingRange = (nan, 1)", "finite"),
    "clippingRange ": ("float2 clippingRange = (1e30, 2e30)", "at most"),
    "daguerre:lens:name": ('string daguerre:lens:name = "nonsense"', "of the library"),
    "daguerre:lens:model": ('token daguerre:lens:model = "quantum"', "exact"),
    "daguerre:aperture:blades": ("int daguerre:aperture:blades = -7", "3 .. 64"),
    "daguerre:aperture:curvature": ("double daguerre:aperture:curvature = 3", "at most 1"),
    "daguerre:tilt": ("double3 daguerre:tilt = (1, 2, 3)", "angles"),
    "daguerre:shutter:type": ('token daguerre:shutter:type = "guillotine"', "rotary"),
    "daguerre:shutter:curve ": ("double2[] daguerre:shutter:curve = [(1, 1), (0, 1)]", "increase"),
    "daguerre:shutter:efficiency": ("double daguerre:shutter:efficiency = 0.1", "0.5"),
    "daguerre:lens:decenter": ("double[] daguerre:lens:decenter = [1, 2, 3]", "groups of 6"),
    "daguerre:lens:ripple": ("double[] daguerre:lens:ripple = [1]", "2 or 3 numbers"),
    "daguerre:aperture:imageSize": (
        "float[] daguerre:aperture:image = [1, 1]\nint2 daguerre:aperture:imageSize = (3, 1)",
        "width and height",
    ),
    "daguerre:projection:model": ('token daguerre:projection:model = "round"', "rectilinear"),
    "daguerre:sensor:pixelPitch": ("double daguerre:sensor:pixelPitch = 0", "above 0"),
    "daguerre:rollingShutter:scanOrder": (
        'token daguerre:rollingShutter:scanOrder = "spiral"', "topToBottom"),
    "daguerre:rollingShutter:lineOffset": (
        'token daguerre:rollingShutter:scanOrder = "top"', "one line to the next"),
    "omni:rtx:rollingShutter:lineOffset": (
        'token omni:rtx:rollingShutter:scanOrder = "topToBottom"\n'
        "double2 omni:rtx:rollingShutter:lineOffset = (1, 0)", "denominator"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_bad_values_are_one_error_that_names_the_attribute(name: str) -> None:
    lines, words = BAD[name]
    with pytest.raises(dg.InputError) as caught:
        noted(camera_prim(lines))
    said = str(caught.value)
    assert said.startswith(f"{FILE}: {PATH}.{name.strip()}: wanted "), said
    assert words in said, said
    assert "got " in said, said
    assert "\n" not in said


def test_a_wrong_type_is_an_error_too() -> None:
    for lines in (
        *('string daguerre:aperture:blades = "many"', "double daguerre:lens:model = 3"),
        *('string daguerre:sensor:whiteBalance = "warm"', "int daguerre:lens:name = 3"),
    ):
        with pytest.raises(dg.InputError, match=r"shot.usda: /World/Cam.daguerre.*wanted"):
            noted(camera_prim(lines))


def test_values_that_exclude_each_other_are_one_error() -> None:
    both = "double daguerre:lens:tStop = 2\ndouble daguerre:lens:apertureDiameter = 20"
    with pytest.raises(dg.InputError, match=r"^shot.usda: /World/Cam: wanted either t_stop or"):
        noted(camera_prim(both))
    shut = "double2[] daguerre:shutter:curve = [(0, 1), (0, 1)]"
    with pytest.raises(dg.InputError, match=r"^shot.usda: /World/Cam: shutter: curve: never open"):
        noted(camera_prim(shut))


def test_cameras_of_one_prim_are_equal_and_travel() -> None:
    prim = camera_prim(OURS + MOVING.split("float fStop")[0])
    first, again = read(prim), read(prim)
    assert first == again
    assert pickle.loads(pickle.dumps(first)) == first


def test_a_scene_time_chooses_the_value_of_what_cannot_move() -> None:
    prim = camera_prim("double daguerre:sensor:whiteBalance.timeSamples = {0: 3200, 24: 5600}")
    assert read(prim, clock=Clock(FILE, 24.0, 1.0)).white_balance == 5600
    assert read(prim, clock=Clock(FILE, 24.0, 0.5)).white_balance == 4400
