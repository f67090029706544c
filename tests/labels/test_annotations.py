"""Boxes, masks and boxes in space: against OpenCV, closed forms and plain lists of vertices."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

import daguerre as dg
from daguerre.camera.projection import Projection
from daguerre.camera.rolling_shutter import RollingShutter
from daguerre.errors import DaguerreError, UsageError
from daguerre.labels.annotations import Annotation, Annotations
from daguerre.labels.boxes import rotation_of
from daguerre.labels.categories import Categories, base_name
from tests.rendering.test_truth import FPS, PINHOLE, PIXELS, SIZE, at, turned
from tests.support.scene import scenes

CUBE = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
FACES = [
    *[(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1)],
    *[(2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)],
]
BROWN = Projection("opencv", (96, 72), (70.0, 74.0), (50.0, 33.0), (-0.25, 0.06, 0.004, -0.003))
FISHEYE = Projection("kannala_brandt", (96, 72), (30.0, 30.0), None, (0.02, -0.004, 0, 0))


def cube(scene: dg.Scene, transform: Any, name: str = "cube", **options: Any) -> None:
    scene.add_instance(scene.add_mesh(CUBE, FACES), transform=transform, name=name, **options)


def scaled(x: float, y: float, z: float) -> np.ndarray:
    return np.diag([x, y, z, 1.0])


POSE = at(0.3, -0.2, -4) @ turned(1, 30) @ turned(0, 20) @ scaled(0.6, 0.4, 0.9)


def only(seen: Annotations) -> Annotation:
    assert len(seen.things) == 1
    return seen.things[0]


def in_opencv(seen: Annotations, points: np.ndarray) -> np.ndarray:
    """Pixels of points of the world by OpenCV, from COCO's corner: pixel centres are at halves."""
    known = seen.intrinsics
    inside = (points - seen.world_from_camera[:3, 3]) @ seen.world_from_camera[:3, :3]
    k, d = np.array(known["camera_matrix"]), np.array(known["parameters"], float)
    zero = np.zeros(3)
    if known["model"] == "kannala_brandt":
        return cv2.fisheye.projectPoints(inside[:, None], zero, zero, k, d)[0][:, 0] + 0.5
    return cv2.projectPoints(inside, zero, zero, k, d if d.size else None)[0][:, 0] + 0.5


def box_of(points: np.ndarray) -> np.ndarray:
    low, high = points.min(axis=0), points.max(axis=0)
    return np.concatenate([low, high - low])


@pytest.mark.parametrize(
    "camera",
    [
        dg.Camera(lens="pinhole", focal_length=50.0),
        dg.Camera(f_stop=2.0, focal_length=50.0, focus_distance=4.0, shift=(2.0, -1.5)),
        dg.Camera(projection=BROWN),
        dg.Camera(projection=FISHEYE),
    ],
    ids=["pinhole", "thin", "brown-conrady", "fisheye"],
)
@pytest.mark.parametrize("crop", [None, (20, 10, 90, 70)])
def test_boxes_are_those_of_opencv(camera: dg.Camera, crop: tuple[int, int, int, int]) -> None:
    scene = dg.Scene()
    cube(scene, POSE)
    pose = at(0.1, 0.2, 0.3) @ turned(1, -8) @ turned(2, 12)
    camera = camera.with_(transform=pose, shutter_time=0.0)
    seen = dg.annotate(scene, camera, resolution=(96, 72), crop=crop)
    found = only(seen)
    # Edges with many points: where the lens bends them, corners are not the ends.
    edges = [a + (b - a) * t for a in CUBE for b in CUBE for t in np.linspace(0, 1, 60)]
    world = np.array(edges) @ POSE[:3, :3].T + POSE[:3, 3]
    points = in_opencv(seen, world)
    wanted = box_of(np.clip(points, 0, seen.labels.shape[::-1]))
    np.testing.assert_allclose(found.full_box, wanted, atol=0.06)
    beside = 1 - np.prod(wanted[2:]) / np.prod(box_of(points)[2:])
    assert found.truncation == pytest.approx(beside, abs=3e-3)
    np.testing.assert_array_equal(seen.labels > 0, seen.mask(0))
    rows, columns = np.nonzero(seen.mask(0))
    assert found.box == (
        columns.min(), rows.min(), np.ptp(columns) + 1, np.ptp(rows) + 1
    )  # fmt: skip
    assert found.area == len(rows)
    assert found.visibility == 1
    # By pixels whose centres are inside: the true box, or within it by less than a thin corner.
    (x, y, width, height), (left, top, across, down) = found.box, found.full_box
    assert left - 0.5 <= x < left + 4
    assert top - 0.5 <= y < top + 4
    assert x + width <= left + across + 0.5
    assert y + height <= top + down + 0.5


@pytest.mark.parametrize("size", [(50, 37), (50, 38), (101, 76)])  # of 96 x 72: half a row off
def test_intrinsics_of_a_picture_whose_rows_are_rounded(size: tuple[int, int]) -> None:
    scene = dg.Scene()
    cube(scene, POSE)
    seen = dg.annotate(scene, dg.Camera(projection=BROWN, shutter_time=0.0), resolution=size)
    edges = [a + (b - a) * t for a in CUBE for b in CUBE for t in np.linspace(0, 1, 60)]
    points = in_opencv(seen, np.array(edges) @ POSE[:3, :3].T + POSE[:3, 3])
    np.testing.assert_allclose(only(seen).full_box, box_of(points), atol=0.06)


def test_intrinsics_are_those_of_the_moment() -> None:
    scene = dg.Scene()
    cube(scene, POSE)
    later = Projection("opencv", (96, 72), (80.0, 86.0), (44.0, 39.0), (-0.1, 0.02, 0.0, 0.002))
    camera = dg.Camera(projection=dg.keys([(0.0, BROWN), (1.0, later)]), shutter_time=0.0)
    edges = [a + (b - a) * t for a in CUBE for b in CUBE for t in np.linspace(0, 1, 60)]
    world = np.array(edges) @ POSE[:3, :3].T + POSE[:3, 3]
    for time in (0.0, 0.4, 1.0):
        seen = dg.annotate(scene.at(time), camera, resolution=(96, 72))
        wanted = box_of(np.clip(in_opencv(seen, world), 0, (96, 72)))
        np.testing.assert_allclose(only(seen).full_box, wanted, atol=0.06)


def test_boxes_in_space_are_those_of_the_node() -> None:
    scene = dg.Scene()
    cube(scene, POSE)
    pose = at(0.1, 0.2, 0.3) @ turned(1, -8)
    seen = dg.annotate(scene, PINHOLE.with_(transform=pose), resolution=SIZE)
    box, inside = only(seen).box3, only(seen).camera_box3
    np.testing.assert_allclose(box.center, POSE[:3, 3], atol=1e-6)
    np.testing.assert_allclose(box.size, (1.2, 0.8, 1.8), atol=1e-6)
    np.testing.assert_allclose(box.rotation, turned(1, 30)[:3, :3] @ turned(0, 20)[:3, :3])
    assert np.linalg.det(inside.rotation) == pytest.approx(1)
    back = inside.corners() @ seen.world_from_camera[:3, :3].T + seen.world_from_camera[:3, 3]
    np.testing.assert_allclose(back, box.corners(), atol=1e-6)
    corners = CUBE @ POSE[:3, :3].T + POSE[:3, 3]
    np.testing.assert_allclose(sorted(box.corners().tolist()), sorted(corners.tolist()), atol=1e-6)
    assert inside.center[2] > 0  # ahead is +z
    there = CUBE @ (pose := only(seen).camera_from_node)[:3, :3].T + pose[:3, 3]
    np.testing.assert_allclose(sorted(inside.corners().tolist()), sorted(there.tolist()), atol=1e-6)


def test_mirrors_and_flat_things_have_axes() -> None:
    for matrix in (scaled(-1, 2, 3), turned(2, 40) @ scaled(1, 0, 1), scaled(-2, -2, -2)):
        turn = rotation_of(matrix)
        np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(turn) == pytest.approx(1)


@pytest.mark.parametrize("rolling", [None, RollingShutter("top", line_time=5e-4)])
def test_through_glass_the_box_holds_the_pixels(rolling: RollingShutter | None) -> None:
    camera = dg.Camera(
        lens="fisheye-16mm-f2.8", focus_distance=1.0, shutter_time=0.0, rolling_shutter=rolling
    )
    scene = dg.Scene()
    points, faces, normals = scenes.sphere(48, 0.35)
    mesh = scene.add_mesh(points, faces, normals)
    places = [(0, 0, -1), (1.1, 0.4, -0.9), (-0.8, -0.6, -1.1)]
    for i, (x, y, z) in enumerate(places):
        way = dg.keys([(-1.0, at(x - 2, y, z)), (1.0, at(x + 2, y, z))])
        scene.add_instance(mesh, transform=way, name=f"ball {i}")
    seen = dg.annotate(scene, camera, resolution=(180, 120))
    assert len(seen.things) == 3
    for found in seen.things:
        (x, y, width, height), (left, top, across, down) = found.box, found.full_box
        off = np.array([x - left, y - top, width - across, height - down])
        assert found.truncation == 0
        assert np.abs(off).max() < 1.3  # px: centres of pixels at both ends


def test_what_is_hidden_has_its_whole_box_and_no_pixel() -> None:
    scene = dg.Scene()
    cube(scene, at(z=-6) @ scaled(0.3, 0.3, 0.3), "small")
    cube(scene, at(z=-4) @ scaled(0.6, 0.6, 0.1), "large")
    cube(scene, at(x=0.6, z=-6) @ scaled(0.5, 0.5, 0.1), "half")
    seen = dg.annotate(scene, PINHOLE, resolution=(240, 180))
    small, large, half = seen.things
    assert (small.box, small.area, small.visibility) == (None, 0, 0)
    assert small.full_box[2] == pytest.approx(0.6 / 5.7 * 50 / 36 * 240, rel=1e-5)
    assert large.visibility == 1
    assert half.box is not None
    assert half.box[2] < 0.3 * half.full_box[2]
    # Seen from 4 m - 0.1 m, the large one ends at 0.6 m; the half one is seen beyond.
    edge = 0.6 / 3.9 * 5.9
    share = (1.1 - edge) / (1.1 - 0.1)
    assert half.visibility == pytest.approx(share, abs=0.01)


def test_what_leaves_the_picture_says_how_much() -> None:
    scene = dg.Scene()
    edge = SIZE[0] / 2 / PIXELS * 4  # m, at the right edge of the picture
    cube(scene, at(x=edge, z=-5) @ scaled(0.4, 0.2, 1.0))
    found = only(dg.annotate(scene, PINHOLE, resolution=SIZE))
    # The face at 4 m reaches from edge - 0.4 to edge + 0.4; the far one lies within it.
    left = (edge - 0.4) / 6 * PIXELS + SIZE[0] / 2
    width = (edge + 0.4) / 4 * PIXELS + SIZE[0] / 2 - left
    assert found.full_box[0] == pytest.approx(left, abs=1e-4)
    assert found.full_box[0] + found.full_box[2] == SIZE[0]
    assert found.truncation == pytest.approx(1 - (SIZE[0] - left) / width, abs=1e-5)


def test_a_room_around_the_camera_fills_the_picture() -> None:
    scene = dg.Scene()
    cube(scene, scaled(5, 5, 5), "room")
    cube(scene, at(z=3), "behind")
    found = only(dg.annotate(scene, PINHOLE, resolution=SIZE))
    assert found.name == "room"
    assert found.full_box == (0, 0, *SIZE)
    assert found.truncation is None


def test_an_empty_scene_and_one_that_is_hidden_have_no_things() -> None:
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    assert dg.annotate(scene, PINHOLE, resolution=SIZE).things == []
    cube(scene, POSE, shown=dg.keys([(-1.0, True), (-0.5, False)]))
    seen = dg.annotate(scene, PINHOLE, resolution=SIZE)
    assert seen.things == []
    assert not seen.labels.any()
    assert [c.name for c in seen.categories] == ["cube"]


def test_a_lamp_hides_and_is_no_thing() -> None:
    scene = dg.Scene()
    cube(scene, at(z=-6), "far")
    scene.add_light(dg.SphereLight((1, 1, 1), 0.5), at(z=-3))
    found = only(seen := dg.annotate(scene, PINHOLE, resolution=(120, 90)))
    assert seen.labels[45, 60] == 0
    # A ball of radius r at the distance d covers the angle asin(r / d).
    disc = np.pi * (np.tan(np.arcsin(0.5 / 3)) * 50 / 36 * 120) ** 2
    square = (2 / 5 * 50 / 36 * 120) ** 2
    assert found.visibility == pytest.approx(1 - disc / square, abs=0.02)


@pytest.mark.parametrize(("moment", "seconds"), [("open", -0.02), ("mid", 0), ("close", 0.02)])
def test_what_moves_is_where_it_is_at_the_moment(moment: str, seconds: float) -> None:
    scene = dg.Scene()
    way = [(t, at(5 * t, 0, -4) @ turned(2, 100 * t) @ scaled(0.3, 0.2, 0.1)) for t in (-1.0, 1.0)]
    cube(scene, dg.keys(way))
    camera = PINHOLE.with_(transform=dg.keys([(t, at(y=2 * t)) for t in (-1.0, 1.0)]))
    seen = dg.annotate(scene, camera, resolution=SIZE, gt_time=moment)
    assert seen.time == pytest.approx(seconds)
    found = only(seen)
    np.testing.assert_allclose(found.box3.center, (5 * seconds, 0, -4), atol=1e-6)
    np.testing.assert_allclose(found.camera_box3.center, (5 * seconds, 2 * seconds, 4), atol=1e-6)
    plain = dg.Scene(time=seconds)
    cube(plain, way_at(way, seconds))
    still = camera.frozen_at(seconds).with_(shutter_time=0.0)
    np.testing.assert_allclose(
        found.full_box, only(dg.annotate(plain, still, resolution=SIZE)).full_box, atol=1e-3
    )


def way_at(way: list[tuple[float, np.ndarray]], seconds: float) -> np.ndarray:
    return np.asarray(dg.keys(way).at(seconds))


def test_of_a_rolling_shutter_boxes_are_by_line_and_space_by_the_middle() -> None:
    line_time = 2e-3
    camera = PINHOLE.with_(rolling_shutter=RollingShutter("top", line_time=line_time))
    scene = dg.Scene()
    cube(scene, dg.keys([(t, at(3 * t, 0, -4.1) @ scaled(0.5, 0.4, 0.1)) for t in (-1.0, 1.0)]))
    found = only(seen := dg.annotate(scene, camera, resolution=SIZE))
    assert seen.time == pytest.approx(0)
    np.testing.assert_allclose(found.box3.center, (0, 0, -4.1), atol=1e-6)
    # The lower edge is seen later than the upper one by its lines, so the box is wider.
    lines = 0.8 / 4 * PIXELS
    wider = 3 * line_time * lines / 4 * PIXELS
    assert found.full_box[2] == pytest.approx(1.0 / 4 * PIXELS + wider, abs=1e-3)
    assert wider > 0.1


def test_a_mesh_that_deforms_has_the_box_of_its_moment() -> None:
    scene = dg.Scene()
    mesh = scene.add_mesh(dg.keys([(-1.0, CUBE * 0.1), (1.0, CUBE * (0.5, 0.3, 0.1))]), FACES)
    scene.add_instance(mesh, transform=at(z=-4), name="balloon")
    found = only(dg.annotate(scene.at(0.5), PINHOLE, resolution=SIZE))
    np.testing.assert_allclose(found.box3.size, (0.8, 0.5, 0.2), atol=1e-6)


@pytest.mark.parametrize(
    ("name", "base"),
    [
        ("Chair", "Chair"),
        ("Chair.001", "Chair"),
        ("Chair_2", "Chair"),
        ("Chair-03", "Chair"),
        ("Chair 4", "Chair"),
        ("Chair (5)", "Chair"),
        ("Chair_2.001", "Chair"),
        ("Boeing747", "Boeing747"),
        ("007", "007"),
        ("lens_50mm", "lens_50mm"),
        (".001", ".001"),
    ],
)
def test_copies_are_of_one_category(name: str, base: str) -> None:
    assert base_name(name) == base


def family() -> dg.Scene:
    scene = dg.Scene()
    for i, name in enumerate(["Chair", "Chair.001", "Table", "Lamp_1", "Floor"]):
        cube(scene, at(0.5 * i - 1, 0, -6) @ scaled(0.2, 0.2, 0.2), name)
    scene.add_instance(0, transform=at(-1, 0.6, -6) @ scaled(0.1, 0.1, 0.1), name="Chair")
    return scene


def test_a_node_is_one_thing_with_all_of_its_parts() -> None:
    seen = dg.annotate(family(), PINHOLE, resolution=(240, 180))
    assert [t.name for t in seen.things] == ["Chair", "Chair.001", "Table", "Lamp_1", "Floor"]
    assert {c.name: c.id for c in seen.categories} == {
        "Chair": 1,
        "Floor": 2,
        "Lamp": 3,
        "Table": 4,
    }
    assert seen.things[0].category is seen.things[1].category
    chair = seen.things[0]
    assert chair.instances == (0, 5)
    np.testing.assert_allclose(chair.box3.size, (0.4, 0.9, 0.4), atol=1e-6)
    assert chair.full_box[3] > 1.5 * seen.things[1].full_box[3]


def read(path: Path, text: str) -> Categories:
    path.write_text(text)
    return Categories.read(path)


def test_a_file_says_what_nodes_are(tmp_path: Path) -> None:
    chosen = read(
        tmp_path / "c.json",
        '{"Chair*": "seat", "Lamp_?": {"name": "light", "id": 7, "supercategory": "electric"},'
        ' "Floor": null, "F*": "ground", "Tab*": {"name": "seat"}}',
    )
    seen = dg.annotate(family(), PINHOLE, resolution=(240, 180), categories=chosen)
    assert [(t.name, t.category.name) for t in seen.things] == [
        ("Chair", "seat"), ("Chair.001", "seat"), ("Table", "seat"), ("Lamp_1", "light")
    ]  # fmt: skip
    known = [(c.id, c.name, c.supercategory) for c in seen.categories]
    assert known == [(1, "seat", ""), (2, "ground", ""), (7, "light", "electric")]


def test_a_parent_is_one_thing_with_what_hangs_below_it(tmp_path: Path) -> None:
    scene = family()
    scene.nodes = {"Set": [0, 1, 2], **scene.nodes}
    chosen = read(tmp_path / "c.json", '{"Set": "dining set", "*": "other"}')
    seen = dg.annotate(scene, PINHOLE, resolution=(240, 180), categories=chosen)
    assert [t.name for t in seen.things] == ["Set", "Chair", "Lamp_1", "Floor"]
    assert seen.things[0].instances == (0, 1, 2)
    assert seen.things[1].instances == (5,)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{}", "empty, wanted patterns of names with their categories"),
        ("[1]", "wanted an object"),
        ('{"a": 3}', "a: wrong type: wanted an object"),
        ('{"a": {"id": 1}}', "a.name"),
        ('{"a": {"name": "x", "id": 0}}', "a.id: out of range: wanted 1"),
        ('{"a": {"name": "x", "idd": 1}}', "a.idd: unknown member"),
        ('{"a": {"name": "x", "id": 1}, "b": {"name": "y", "id": 1}}', "an id for each category"),
        ('{"a": {"name": "x", "id": 1}, "b": {"name": "x", "id": 2}}', "one id for 'x'"),
        ('{"a": "x", "a": "y"}', "twice"),
        ('{"Chiar": "x"}', "'Chiar': no node has a name that matches"),
    ],
)
def test_bad_files_of_categories(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(DaguerreError) as caught:
        dg.annotate(family(), PINHOLE, categories=read(tmp_path / "c.json", text), resolution=SIZE)
    assert message in str(caught.value)
    assert str(tmp_path / "c.json") in str(caught.value)


def test_names_of_thousands_of_letters_are_cut_in_errors(tmp_path: Path) -> None:
    name = "x" * 9999
    text = f'{{"a": {{"name": "{name}", "id": 1}}, "b": {{"name": "y{name}", "id": 1}}}}'
    with pytest.raises(DaguerreError, match="wanted an id for each category, got 1 for") as caught:
        read(tmp_path / "c.json", text)
    assert len(str(caught.value)) < 400


def test_what_is_no_file_of_categories_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="categories: wanted Categories or a file, got 3"):
        dg.annotate(family(), PINHOLE, categories=3)
    (tmp_path / "c.json").write_text('{"Table": "table"}')
    seen = dg.annotate(family(), PINHOLE, resolution=SIZE, categories=tmp_path / "c.json")
    assert only(seen).name == "Table"


def test_means_label_by_the_largest_share() -> None:
    scene = dg.Scene()
    scene.add_instance(scene.add_mesh(*scenes.quad(0.06)), transform=at(z=-4), name="chip")
    camera = dg.Camera(f_stop=1.4, focus_distance=1.0, fps=FPS, shutter_time=0.0)
    size = {"resolution": (480, 360), "crop": (200, 140, 280, 220)}
    chief = only(dg.annotate(scene, camera, **size))
    mean = only(dg.annotate(scene, camera, gt_lens="mean", **size))
    # Blur takes more than half of the light away from its corners.
    assert 0.5 * chief.area < mean.area < 0.98 * chief.area
    assert chief.full_box == mean.full_box
    assert chief.visibility == mean.visibility == 1
