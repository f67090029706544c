"""A scene anywhere on Earth: the picture of the same scene at 0."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.labels.annotations import annotate
from daguerre.maps.ray_map import raymap
from daguerre.rendering.session import Session
from daguerre.setup import built_scene
from tests.support.scene.scenes import at, quad, sphere

SIZE = (48, 32)
#: Whole cells; the last is an orbit.
CELLS = [(1024.0, 0.0, 0.0), (512000.0, 1024.0, -5399552.0), (7000064.0, 0.0, 0.0)]
#: Map coordinates as files have them.
ODD = (500000.25, 40.0, -5400000.75)
DOWN = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])


def moved(shift: tuple[float, float, float], transform: np.ndarray) -> np.ndarray:
    made = np.array(transform, float)
    made[:3, 3] += shift
    return made


def over_time(first: np.ndarray, last: np.ndarray, **given: Any) -> Any:
    return dg.keys(((0.0, first), (0.02, last)), **given)


def street(shift: tuple[float, float, float]) -> dg.Scene:
    """Every kind of thing that has a place, all of it moved by a shift."""

    def here(x: float, y: float, z: float) -> np.ndarray:
        return moved(shift, at(x, y, z))

    scene = dg.Scene()
    floor, faces = quad(8)
    tilt = np.array([[1, 0, 0, 0], [0, 0, 1, -1], [0, -1, 0, -4], [0, 0, 0, 1.0]])
    grey = dg.Material(dg.Diffuse((0.6, 0.5, 0.4)))
    scene.add_instance(scene.add_mesh(floor, faces), grey, moved(shift, tilt), name="floor")
    ball = scene.add_mesh(*sphere(12))
    shiny = scene.add_material(dg.Material(dg.Conductor((0.9, 0.7, 0.4), 0.2)))
    scene.add_instance(ball, shiny, here(-1.25, 0, -5), name="ball")
    path = over_time(here(0.5, 0, -5), here(1.5, 0.25, -5))
    scene.add_instance(ball, grey, path, name="flying")
    turned = over_time(here(2, 1, -6), here(2, 1, -6) @ DOWN, pivot=(0, 0.5, 0))
    scene.add_instance(ball, grey, turned, name="turning")
    around = dg.spin((0, 1, 0), 20.0, transform=here(-2.5, 1, -6), center=(0.5, 0, 0))
    scene.add_instance(ball, shiny, around, name="spinning")
    smoke = dg.DensityGrid(
        np.full((2, 2, 2), 0.5, np.float32), 2 * np.eye(4) - np.diag((0, 0, 0, 1))
    )
    cloud = dg.Medium((0.1, 0.2, 0.3), (0.5, 0.5, 0.5), density=smoke)
    bound = dg.Material(dg.Boundary(), interior=cloud)
    scene.add_instance(ball, bound, here(0, 0.5, -3.5), name="cloud")
    scene.set_fog(
        dg.Medium(
            (0.05,) * 3,
            (0.05,) * 3,
            density=dg.DensityGrid(
                np.linspace(0, 1, 27, dtype=np.float32).reshape(3, 3, 3),
                moved(shift, np.diag((8.0, 4.0, 8.0, 1.0))) @ at(-0.5, -0.25, -1),
            ),
        )
    )
    lamp, faces = quad(0.75)
    shines = dg.Material(dg.Diffuse((0, 0, 0)), emission=(12, 11, 9))
    over = here(0.5, 3, -4) @ DOWN
    scene.add_instance(scene.add_mesh(lamp, faces), shines, over, name="lamp")
    scene.add_light(dg.SphereLight((40, 60, 90), 0.0625, name="bulb"), here(-1.5, 1.5, -4))
    scene.add_light(dg.PointLight((3, 3, 3), name="point"), here(1, 2, -2))
    scene.add_light(dg.SpotLight((9, 3, 3), 10.0, 30.0, name="spot"), here(-1, 2, -4) @ DOWN)
    scene.set_environment(color=(0.05, 0.06, 0.08))
    return scene


def camera(shift: tuple[float, float, float], **changes: Any) -> dg.Camera:
    path = over_time(moved(shift, at(0, 0, 1)), moved(shift, at(0.25, 0.25, 1)))
    given: dict[str, Any] = {"f_stop": 2.0, "focal_length": 24.0, "shutter_time": 0.02, "fps": 25}
    return dg.Camera(transform=path, **(given | changes))


def picture(shift: tuple[float, float, float], **settings: Any) -> dg.Frame:
    given: dict[str, Any] = {"spp": 4, "aovs": True, "gt_time": "mid", "motion": True}
    return dg.render(street(shift), camera(shift), resolution=SIZE, **(given | settings))


def off_blocks(a: dg.Frame, b: dg.Frame) -> float:
    """Largest difference of blocks of 4 px, as a share of the brightest pixel."""
    off = np.abs((a.rgb - b.rgb).reshape(8, 4, 12, 4, 3).mean(axis=(1, 3)))
    return float(off.max() / b.rgb.max())


@pytest.fixture(scope="module")
def at_zero() -> dg.Frame:
    return picture((0, 0, 0))


@pytest.mark.parametrize("shift", CELLS)
def test_whole_cells_leave_every_bit(shift: tuple[float, float, float], at_zero: dg.Frame) -> None:
    frame = picture(shift)
    assert np.array_equal(frame.rgb, at_zero.rgb)
    met = at_zero.aovs["depth.Z"] != 0
    for name, plane in frame.aovs.items():
        wanted = at_zero.aovs[name].astype(float)
        if name.startswith("P."):
            wanted = np.where(met, wanted + shift["XYZ".index(name[-1])], 0)
        assert np.array_equal(plane, wanted, equal_nan=True), name
    assert frame.metadata["world_origin"] == list(shift)
    assert "world_origin" not in at_zero.metadata
    assert {"P.X", "motion.U"} <= frame.aovs.keys()


def test_map_coordinates_have_the_picture_of_the_scene_at_zero(at_zero: dg.Frame) -> None:
    # In a cell the scene is up to 512 m from its origin, where floats are 6e-5 m apart.
    frame = picture(ODD)
    assert off_blocks(picture(ODD, spp=32), picture((0, 0, 0), spp=32)) < 0.01
    met = (at_zero.aovs["depth.Z"] != 0) & (frame.aovs["object_id"] == at_zero.aovs["object_id"])
    assert met.sum() > 0.99 * (at_zero.aovs["depth.Z"] != 0).sum()
    for name in ("depth.Z", "distance.Z"):
        assert np.abs(frame.aovs[name] - at_zero.aovs[name])[met].max() < 1e-3, name
    places = frame.layer("P") - at_zero.layer("P") - ODD
    assert np.abs(places)[met].max() < 1e-3
    for name in ("motion.U", "motion.V"):
        off = np.abs(frame.aovs[name] - at_zero.aovs[name])[met]
        assert np.nanmax(off) < 0.01, name


def test_means_over_samples_have_places_in_the_world() -> None:
    near, far = (picture(shift, gt_time=None, motion=False) for shift in ((0, 0, 0), CELLS[1]))
    met = near.aovs["depth.Z"] != 0
    assert np.array_equal(far.layer("P")[met], near.layer("P")[met].astype(float) + CELLS[1])
    assert not far.layer("P")[~met].any()


def test_light_paths_and_catchers_are_moved_too() -> None:
    def frame(shift: tuple[float, float, float], paths: float | str) -> dg.Frame:
        scene = street(shift)
        scene.set_fog(None)
        for i, material in enumerate(scene.materials):
            if isinstance(material.kind, dg.Boundary):
                scene.materials[i] = dg.Material(dg.Diffuse((0.3, 0.3, 0.3)))
        if paths == "off":
            scene.add_node("stage", np.array(shift))
            scene.group_instances("stage", [0])
            scene.set_catcher("stage")
        return dg.render(scene, camera(shift), resolution=SIZE, spp=4, light_paths=paths)

    near, far = frame((0, 0, 0), 1.0), frame(CELLS[1], 1.0)
    assert np.array_equal(near.rgb, far.rgb)
    near, far = frame((0, 0, 0), "off"), frame(CELLS[1], "off")
    assert np.array_equal(near.rgb, far.rgb)
    assert near.catcher is not None
    assert np.array_equal(near.catcher, far.catcher)


def test_boxes_and_rays(at_zero: dg.Frame) -> None:
    shift = CELLS[1]
    near = annotate(street((0, 0, 0)), camera((0, 0, 0)), resolution=SIZE)
    far = annotate(street(shift), camera(shift), resolution=SIZE)
    assert [thing.name for thing in near.things] == [thing.name for thing in far.things]
    assert np.array_equal(near.labels, far.labels)
    for a, b in zip(near.things, far.things, strict=True):
        assert (a.box, a.full_box, a.visibility) == (b.box, b.full_box, b.visibility)
        assert np.allclose(b.box3.center - np.array(shift), a.box3.center, atol=1e-6)
    rays = [raymap(camera(s), SIZE, scene=street(s), frame="world") for s in ((0, 0, 0), shift)]
    assert np.allclose(rays[1].origin - np.array(shift), rays[0].origin, atol=1e-8)
    assert np.array_equal(rays[1].direction, rays[0].direction)


def test_files_have_the_places_relative_to_an_origin(tmp_path: Path) -> None:
    frame = picture(ODD)
    frame.save(tmp_path / "far.exr")
    again = dg.load_frame(tmp_path / "far.exr")
    assert again.metadata["world_origin"] == frame.metadata["world_origin"]
    assert np.abs(again.layer("P") - frame.layer("P")).max() < 1e-4
    assert again.layer("P").dtype == np.float64
    assert np.array_equal(again.aovs["depth.Z"], frame.aovs["depth.Z"])


def test_passes_of_crops_and_ranges_share_the_origin(tmp_path: Path) -> None:
    # The origin is of the whole frame, so parts of a picture add up.
    scene, view = street(ODD), camera(ODD)
    whole = Session(scene, view, resolution=SIZE, spp=4)
    part = Session(scene, view, resolution=SIZE, spp=4, crop=(40, 24, 48, 32))
    assert whole.prepared.built.origin == part.prepared.built.origin
    whole.draw(0, 4)
    part.draw(0, 2)
    part.draw(2, 4)
    assert np.array_equal(part.frame().rgb, whole.frame().rgb[24:, 40:])


def test_a_rig_shares_the_first_origin(monkeypatch: Any) -> None:
    built: list[Any] = []
    build = built_scene.build

    def counted(*given: Any, **named: Any) -> Any:
        built.append(given[3])
        return build(*given, **named)

    monkeypatch.setattr(built_scene, "build", counted)
    first = camera(CELLS[1])
    cameras = {"first": first, "second": first.with_(transform=moved(CELLS[1], at(0, 0, 600)))}
    frames = dg.render_rig(street(CELLS[1]), cameras, resolution=SIZE, spp=1)
    assert built == [CELLS[1]]
    assert {name: f.metadata["world_origin"] for name, f in frames.items()} == {
        name: list(CELLS[1]) for name in cameras
    }


def test_another_origin_is_another_picture() -> None:
    scene, view = street(CELLS[0]), camera(CELLS[0])
    own = Session(scene, view, resolution=SIZE, spp=1)
    shared = Session(scene, view, resolution=SIZE, spp=1, origin=(0.0, 0.0, 0.0))
    assert own.key["settings"] != shared.key["settings"]


def test_an_origin_out_of_reach_is_refused() -> None:
    with pytest.raises(dg.UsageError, match=r"origin: wanted a point within 1e\+18 m of 0, got"):
        Session(dg.Scene(), camera(CELLS[0]), resolution=SIZE, spp=1, origin=(1e30, 0.0, 0.0))


def test_an_object_whose_vertices_are_far_from_its_own_origin() -> None:
    # A mover, so that its rays are traced in its own space.
    near, far = dg.Scene(), dg.Scene()
    points, triangles, normals = sphere(12)
    away = np.array((400000.0, 0, -5000000.0))
    for scene, shift in ((near, np.zeros(3)), (far, away)):
        floor, faces = quad(8, -3.0)
        scene.add_instance(scene.add_mesh(floor, faces), dg.Diffuse((0.5, 0.5, 0.5)))
        mesh = scene.add_mesh(points + shift, triangles, normals)
        back = [at(*(np.array((x, 0, -2.0)) - shift)) for x in (0, 0.25)]
        scene.add_instance(mesh, dg.Diffuse((0.8, 0.2, 0.2)), over_time(*back))
        scene.add_light(dg.PointLight((9, 9, 9)), at(2, 2, 1))
    view = dg.Camera(transform=at(0, 0, 2), shutter_time=0.02, focus_distance=3.0)
    frames = [dg.render(s, view, resolution=SIZE, spp=32) for s in (near, far)]
    assert off_blocks(*frames) < 0.005


def test_vertices_that_a_file_has_rounded_are_told() -> None:
    scene = dg.Scene()
    points, triangles, normals = sphere(12)
    far = np.asarray(points + np.array((5e6, 0, 0)), np.float32)
    scene.add_instance(scene.add_mesh(far, triangles, normals, name="tower"), dg.Diffuse())
    view = dg.Camera(transform=at(5e6, 0, 5), focus_distance=5.0)
    warnings = Session(scene, view, resolution=SIZE, spp=1).warnings
    assert len(warnings) == 1
    assert "tower" in warnings[0]
    assert "0.5 m apart" in warnings[0]


def test_a_camera_beyond_what_doubles_can_tell_apart_is_told() -> None:
    view = dg.Camera(transform=at(4e12, 0, 0), focus_distance=5.0)
    warnings = Session(dg.Scene(), view, resolution=SIZE, spp=1).warnings
    assert warnings == ["the camera is 4e+12 m from 0, where 64-bit numbers are 0.00049 m apart"]
