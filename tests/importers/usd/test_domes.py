"""Dome lights: directions, sums, motion, and the light that a panorama keeps when it is turned."""

from __future__ import annotations

import math
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pxr import Gf, Sdf, Usd, UsdGeom, UsdLux, UsdUtils

import daguerre as dg
from daguerre.importers.usd.domes import Strength
from daguerre.importers.usd.lights import Emission
from daguerre.motion.values import keys
from daguerre.pictures.panorama import resampled
from tests.support.formats import stages

_ROWS = 64
#: Directions of a dome, all apart, and the colour of its picture there.
_SPOTS = {
    (0, 0, 1): (1, 0, 0),
    (1, 0, 0): (0, 1, 0),
    (-1, 0, 0): (0, 0, 1),
    (0, 1, 0): (1, 1, 0),
    (0, -1, 0): (0, 1, 1),
    (0, 0.6, -0.8): (1, 0, 1),
}


def _panorama(rows: int = _ROWS) -> np.ndarray:
    """Spots on grey, written out from the text of OpenEXR: +z in the middle, +x left of it."""
    latitude = (0.5 - (np.arange(rows) + 0.5) / rows) * math.pi
    longitude = (0.5 - (np.arange(2 * rows) + 0.5) / (2 * rows)) * 2 * math.pi  # pi at the left
    high, around = np.meshgrid(latitude, longitude, indexing="ij")
    flat = np.cos(high)
    seen = np.stack([flat * np.sin(around), np.sin(high), flat * np.cos(around)], axis=2)
    made = np.full((rows, 2 * rows, 3), 0.25)
    for direction, color in _SPOTS.items():
        made[seen @ np.array(direction) > math.cos(0.3)] = color
    return made.astype(np.float32)


def _dome(
    stage: Usd.Stage, name: str = "/dome", kind: Any = UsdLux.DomeLight, **inputs: Any
) -> Any:
    made = kind.Define(stage, name)
    for key, value in inputs.items():
        attribute = made.GetPrim().GetAttribute(f"inputs:{key}")
        for code, one in value.items() if isinstance(value, dict) else ((None, value),):
            attribute.Set(one) if code is None else attribute.Set(one, code)
    return made


def _pictured(stage: Usd.Stage, pixels: Any = None, **more: Any) -> Any:
    folder = Path(stage.GetRootLayer().realPath).parent
    stages.picture(folder / "sky.exr", _panorama() if pixels is None else pixels)
    made = _dome(stage, **more)
    made.GetPrim().GetAttribute("inputs:texture:file").Set(Sdf.AssetPath("./sky.exr"))
    return made


def _toward(scene: Any, direction: Any, **options: Any) -> Any:
    return stages.seen(scene, stages.looking(np.array(direction, float)), **options)


def _check(scene: Any, scene_from_dome: Any) -> None:
    """Each spot is where the rotation takes it."""
    for direction, color in _SPOTS.items():
        found = _toward(scene, scene_from_dome @ np.array(direction))
        assert np.allclose(found, color, atol=0.02), (direction, found)


def _turned(degrees: Any) -> np.ndarray:
    """Rotation about x, then y, then z, from USD itself."""
    stage = Usd.Stage.CreateInMemory()
    xform = UsdGeom.Xform.Define(stage, "/x")
    stages.place(xform, turn=degrees)
    return np.array(xform.GetLocalTransformation()).T[:3, :3]


_Z_UP = np.array([(1, 0, 0), (0, 0, 1), (0, -1, 0)])  # scene from a stage with z up
_POLE = np.array([(1, 0, 0), (0, 0, -1), (0, 1, 0)])  # +y to +z, +z to -y


@pytest.mark.parametrize("turn", [(0, 0, 0), (0, 130, 0), (30, 0, 0), (20, 50, 80)])
@pytest.mark.parametrize("up", ["Y", "Z"])
@pytest.mark.parametrize("axis", [None, "scene", "Y", "Z"])
def test_directions_of_a_panorama(tmp_path: Path, axis: str | None, up: str, turn: Any) -> None:
    stage = stages.new_stage(tmp_path / "x.usda", up=up, metres=1e-9)
    kind = UsdLux.DomeLight if axis is None else UsdLux.DomeLight_1
    dome = _pictured(stage, kind=kind)
    if axis:
        dome.CreatePoleAxisAttr(axis)
    stages.place(dome, at=(1, 2, 3), turn=turn, scale=(2, 2, 2))
    expected = _turned(turn)
    if axis == "Z" or (axis == "scene" and up == "Z"):
        expected = expected @ _POLE
    if up == "Z":
        expected = _Z_UP @ expected
    _check(stages.read(stage), expected)


def test_a_mirrored_dome_is_mirrored(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    stages.place(_pictured(stage), scale=(-1, 1, 1))
    _check(stages.read(stage), np.diag([-1, 1, 1]))


def test_a_turn_about_the_pole_keeps_the_picture(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    dome = _pictured(stage, intensity=3.0)
    stages.place(dome, turn=(0, 70, 0))
    environment = stages.read(stage).environment
    assert np.array_equal(environment.image, _panorama())
    assert environment.scale == 3


def test_a_constant_dome(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    _dome(stage, intensity=2.0, exposure=1.0, color=Gf.Vec3f(1, 0.5, 0.25), normalize=True)
    scene = stages.read(stage)
    assert np.allclose(_toward(scene, (1, 2, 3)), (4, 2, 1), rtol=0.01)
    assert np.allclose(stages.illuminance(scene), math.pi * np.array((4, 2, 1)), rtol=0.01)


def test_the_colour_of_a_dome_tints_its_picture(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    _pictured(stage, np.full((8, 16, 3), 2.0), intensity=3.0, color=Gf.Vec3f(1, 0.5, 0))
    assert np.allclose(_toward(stages.read(stage), (0, 0, 1)), (6, 3, 0), atol=0.03)


def test_two_domes_add(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    stages.place(_pictured(stage, intensity=2.0), turn=(0, 40, 0))
    _dome(stage, "/other", intensity=0.5)
    scene, turn = stages.read(stage), _turned((0, 40, 0))
    for direction, color in _SPOTS.items():
        found = _toward(scene, turn @ np.array(direction))
        assert np.allclose(found, 2 * np.array(color) + 0.5, atol=0.03)


def test_two_constant_domes_add(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    _dome(stage, "/a", intensity=2.0)
    _dome(stage, "/b", color=Gf.Vec3f(1, 0, 0))
    assert stages.read(stage).environment.color == (3, 2, 2)


@pytest.mark.parametrize("turn", [(0, 50, 0), (50, 0, 0)])
def test_animated_intensity_blurs(tmp_path: Path, turn: Any) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    dome = _pictured(stage, intensity={0: 0.0, 24: 2.0}, exposure={0: 0.0, 24: 1.0})
    stages.place(dome, turn=turn)
    scene = stages.read(stage)
    t = (np.arange(1000) + 0.5) / 1000
    toward = _turned(turn) @ (0, 0, 1)
    camera = stages.looking(toward).with_(shutter_time=1.0)
    found = stages.seen(scene.at(0.5), camera, spp=1024)
    assert np.allclose(found, ((2 * t * 2**t).mean(), 0, 0), rtol=0.02, atol=1e-3)


def test_animated_visibility_of_a_constant_dome(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    dome = _dome(stage)
    for code, shown in ((0, "invisible"), (12, "inherited")):
        dome.GetVisibilityAttr().Set(shown, code)
    scene = stages.read(stage)
    assert [scene.at(t).environment.color[0] for t in (0.0, 0.4, 0.6)] == [0, 0, 1]


def test_a_strength_is_pure_and_travels() -> None:
    strength = Strength(Emission(keys([(0, 1.0), (1, 3.0)])))
    assert pickle.loads(pickle.dumps(strength)) == strength
    assert (strength.at(0.5), strength.breaks(-1, 2)) == (2, [0, 1])


# --- Light that is kept ----------------------------------------------------------------------


def _flux(panorama: Any) -> float:
    """Integral of the interpolated picture over all directions: rows by fine steps."""
    rows, fine = len(panorama), 16
    place = (np.arange(rows * fine) + 0.5) / fine - 0.5
    means = np.interp(place, np.arange(rows), panorama[:, :, 0].mean(axis=1, dtype=float))
    polar = (np.arange(rows * fine) + 0.5) / (rows * fine) * math.pi
    return float((means * np.sin(polar)).mean() * math.pi * 2 * math.pi)


def _sun(rows: int, polar: float, azimuth: float) -> np.ndarray:
    """A disc of 0.53 degrees; each pixel is its mean."""
    fine = 8
    theta = (np.arange(rows * fine) + 0.5) / (rows * fine) * math.pi
    phi = (np.arange(2 * rows * fine) + 0.5) / (rows * fine) * math.pi - azimuth
    near = np.sin(theta)[:, None] * math.sin(polar) * np.cos(phi)
    near += np.cos(theta)[:, None] * math.cos(polar)
    disc = (near > math.cos(math.radians(0.265))).reshape(rows, fine, 2 * rows, fine)
    return np.repeat(disc.mean(axis=(1, 3))[..., None], 3, axis=2).astype(np.float32)


@pytest.mark.parametrize("polar", [0.0, 3.0, 20.0, 55.0, 90.0, 170.0])
@pytest.mark.parametrize("rows", [128, 256])
def test_a_sun_keeps_its_light_wherever_it_is_turned(rows: int, polar: float) -> None:
    rng = np.random.default_rng(int(polar) + rows)
    for _ in range(4):
        turn = _turned(rng.uniform(-180, 180, 3))
        sun = _sun(rows, math.radians(polar), rng.uniform(0, 6))
        assert _flux(resampled(sun, turn, rows)) == pytest.approx(_flux(sun), rel=0.02)


def test_a_larger_picture_keeps_its_light_in_fewer_rows() -> None:
    sun = _sun(256, math.radians(70), 1)
    assert _flux(resampled(sun, _turned((30, 20, 10)), 64)) == pytest.approx(_flux(sun), rel=0.02)


@pytest.mark.parametrize("rows", [64, 100])
def test_a_spot_is_where_the_turn_takes_it(rows: int) -> None:
    """A tenth of a pixel is seen."""

    def middle(panorama: Any, sides: Any) -> Any:
        height = len(panorama)
        theta = (np.arange(height) + 0.5) / height * math.pi
        phi = ((np.arange(2 * height) + 0.5) / (2 * height) - 0.5) * 2 * math.pi
        theta, phi = theta[:, None], phi[None]
        flat = np.sin(theta)
        towards = [flat * np.sin(phi), np.cos(theta) + 0 * phi, flat * np.cos(phi)]
        mean = [(panorama[:, :, 0] * flat * axis).sum() for axis in towards] * np.array(sides)
        return mean / np.linalg.norm(mean)

    turn, sun = _turned((30, 20, 10)), _sun(64, 1.4, 2.0)
    expected = turn @ middle(sun, (-1, 1, 1))  # +z in the middle, +x left of it
    found = middle(resampled(sun, turn, rows), (1, 1, -1))  # -z in the middle, +x right of it
    assert math.acos(min(1.0, expected @ found)) < 0.1 * math.pi / rows


def test_an_even_panorama_stays_even() -> None:
    even = np.full((32, 64, 3), 2.5, np.float32)
    assert np.allclose(resampled(even, _turned((30, 20, 10)), 40), 2.5, rtol=1e-5)


# --- Notes and errors ------------------------------------------------------------------------


def _notes(stage: Usd.Stage, text: str) -> list[str]:
    return [note for note in stages.read(stage).warnings if text in note]


@pytest.mark.parametrize("layout", ["mirroredBall", "angular", "cubeMapVerticalCross"])
def test_other_layouts_are_a_note(tmp_path: Path, layout: str) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    _pictured(stage).CreateTextureFormatAttr(layout)
    assert len(_notes(stage, "not a latlong panorama")) == 1
    assert stages.read(stage).environment.color == (1, 1, 1)


def test_a_missing_picture_is_a_note(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    _dome(stage).CreateTextureFileAttr(Sdf.AssetPath("./none.exr"))
    assert len(_notes(stage, "a picture of a light is missing")) == 1


def test_a_picture_outside_of_the_folder_is_refused(tmp_path: Path) -> None:
    stages.picture(tmp_path / "sky.exr", _panorama(4))
    (tmp_path / "in").mkdir()
    stage = stages.new_stage(tmp_path / "in" / "x.usda")
    _dome(stage).CreateTextureFileAttr(Sdf.AssetPath("../sky.exr"))
    with pytest.raises(
        dg.InputError, match=r"/dome\.inputs:texture:file: leaves the stage's folder"
    ):
        stages.read(stage)


def test_a_damaged_picture_is_refused(tmp_path: Path) -> None:
    (tmp_path / "sky.exr").write_bytes(b"v/1\x01 and no more")
    stage = stages.new_stage(tmp_path / "x.usda")
    _dome(stage).CreateTextureFileAttr(Sdf.AssetPath("./sky.exr"))
    with pytest.raises(dg.InputError, match=r"sky\.exr"):
        stages.read(stage)


def test_a_picture_in_a_format_that_cannot_be_read_is_a_note(tmp_path: Path) -> None:
    (tmp_path / "sky.ptx").write_bytes(b"Ptex and more")
    stage = stages.new_stage(tmp_path / "x.usda")
    _dome(stage).CreateTextureFileAttr(Sdf.AssetPath("./sky.ptx"))
    assert len(_notes(stage, "a picture of a light in an unknown format")) == 1
    assert stages.read(stage).environment.color == (1, 1, 1)


def test_a_picture_inside_of_a_package(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    _pictured(stage)
    package = tmp_path / "x.usdz"
    assert UsdUtils.CreateNewUsdzPackage(str(stages.save(stage)), str(package))
    (tmp_path / "sky.exr").unlink()
    assert np.array_equal(dg.load(package).environment.image, _panorama())


@pytest.mark.parametrize(
    ("spoil", "note"),
    [
        (lambda dome: dome.CreatePortalsRel().AddTarget("/x"), "portals of a dome light"),
        (lambda dome: dome.AddRotateYOp().Set(9.0, 3), ""),
        (lambda dome: [op.Set(t, t) for op in [dome.AddRotateYOp()] for t in (1, 9)], "that turns"),
        (lambda dome: stages.place(dome, scale=(1, 1, 0)), "scaled to zero"),
    ],
)
def test_what_is_left_out_of_a_dome_is_one_note(tmp_path: Path, spoil: Any, note: str) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    spoil(_dome(stage))
    found = [text for text in _notes(stage, "") if "framing" not in text]
    assert len(found) == bool(note)
    assert all(note in text for text in found)


def test_changes_that_a_dome_cannot_show_are_notes(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    _pictured(stage, color={0: Gf.Vec3f(1), 9: Gf.Vec3f(0)})
    assert len(_notes(stage, "changing colour")) == 1
    _dome(stage, "/other", intensity={0: 0.0, 9: 1.0})
    assert _notes(stage, "one of several")[0].endswith("(2 uses)")


def test_domes_of_an_instancer_shine_once(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    instancer = UsdGeom.PointInstancer.Define(stage, "/many")
    _dome(stage, "/many/dome")
    instancer.CreatePrototypesRel().AddTarget("/many/dome")
    instancer.CreateProtoIndicesAttr([0, 0])
    instancer.CreatePositionsAttr([Gf.Vec3f(0), Gf.Vec3f(1)])
    assert stages.read(stage).environment.color == (1, 1, 1)
    assert len(_notes(stage, "of a point instancer is read once")) == 1


@pytest.mark.parametrize(
    "inputs",
    [
        {"intensity": 3e38},
        {"color": Gf.Vec3f(3e38)},
        {"color": Gf.Vec3f(3e38), "intensity": {0: 1.0, 9: 2.0}},
    ],
)
def test_extreme_domes_are_bounded(tmp_path: Path, inputs: Any) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    stages.place(_pictured(stage, np.full((8, 16, 3), 1e30), **inputs), turn=(30, 0, 0))
    scene = stages.read(stage)
    assert np.isfinite(scene.environment.image).all()
    assert len(_notes(stage, "brighter than")) == 1
