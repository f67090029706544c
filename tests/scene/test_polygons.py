"""Polygons as triangles, values per corner, and both in ``Scene.add_mesh``."""

from __future__ import annotations

import pickle
import time
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.scene import ears, polygons
from daguerre.scene.polygons import triangulate, weld
from daguerre.scene.subdivision import Refiner, Rules, Subdivision
from tests.support.scene import control_meshes as meshes


def areas(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Vectors of triangle areas, shape (T, 3)."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.cross(b - a, c - a) / 2


def star(count: int, rng: np.random.Generator) -> np.ndarray:
    """A simple polygon around the origin, with corners at any distance, in any plane."""
    turn = 2 * np.pi * (np.arange(count) + 0.8 * rng.random(count)) / count
    far = 0.1 + rng.random(count)
    flat = np.stack([far * np.cos(turn), far * np.sin(turn), np.zeros(count)], axis=1)
    return np.roll(flat @ np.linalg.qr(rng.standard_normal((3, 3)))[0], rng.integers(count), axis=0)


@pytest.mark.parametrize("count", [4, 5, 7, 12, 40])
def test_triangles_cover_a_polygon_once(count: int) -> None:
    rng = np.random.default_rng(count)
    stars = [star(count, rng) for _ in range(50)]
    points = np.concatenate(stars)
    triangles, faces = triangulate([count] * 50, np.arange(count * 50), points)
    assert faces.tolist() == np.repeat(np.arange(50), count - 2).tolist()
    for face, polygon in enumerate(stars):
        whole = np.cross(polygon, np.roll(polygon, -1, axis=0)).sum(axis=0) / 2
        normal = whole / np.linalg.norm(whole)
        parts = areas(points, triangles[faces == face]) @ normal
        assert parts.min() > -1e-12  # none is turned over, so none overlaps
        assert parts.sum() == pytest.approx(np.linalg.norm(whole))
        own = triangles[faces == face]
        assert set(own.ravel().tolist()) == set(range(face * count, (face + 1) * count))


@pytest.mark.parametrize("height", [3, 9])
def test_concave_quadrangles_are_divided_inside(height: float) -> None:
    points = np.array([[0, 0, 0], [2, 1, 0], [4, 0, 0], [2, height, 0]], float)
    for turn in range(4):
        triangles, _ = triangulate([4], np.roll(np.arange(4), turn), points)
        corners = np.roll(np.arange(4), turn)[triangles]
        assert all({1, 3} <= set(triangle) for triangle in corners.tolist())
        assert areas(points, corners)[:, 2].min() > 0


def test_quadrangles_get_the_shorter_diagonal() -> None:
    points = np.array([[0, 0, 0], [3, 0, 0], [4, 1, 0], [1, 1, 0]], float)
    triangles, _ = triangulate([4], [0, 1, 2, 3], points)
    assert all({1, 3} <= set(triangle) for triangle in triangles.tolist())


def test_sizes_may_be_mixed() -> None:
    rng = np.random.default_rng(8)
    sizes = rng.integers(3, 9, 200)
    points = np.concatenate([star(n, rng) for n in sizes])
    triangles, faces = triangulate(sizes, np.arange(sizes.sum()), points)
    starts = np.cumsum(sizes) - sizes
    assert (triangles // 1 >= starts[faces][:, None]).all()
    assert (triangles < (starts + sizes)[faces][:, None]).all()
    plain, again = triangulate(sizes, np.arange(sizes.sum()))
    assert (again == faces).all()
    assert (plain[:, 0] == starts[faces]).all()  # fans
    for got in (triangulate([], []), triangulate([], [], np.zeros((0, 3)))):
        assert got[0].shape == (0, 3)
        assert got[1].shape == (0,)


def test_polygons_that_cross_themselves_end() -> None:
    rng = np.random.default_rng(4)
    points = np.concatenate([rng.random((100 * 9, 3)), np.zeros((9, 3)), np.ones((9, 3))])
    triangles, _ = triangulate([9] * 102, np.arange(len(points)), points)
    assert len(triangles) == 102 * 7


def test_endless_work_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """A comb of 40,000 corners takes minutes with ears; a fan of as many takes none."""
    monkeypatch.setattr(ears, "MAX_WORK", ears.MAX_WORK >> 5)
    count = 40_000
    comb = np.zeros((count, 3))
    comb[:, 0] = np.arange(count)
    comb[:, 1] = np.where(np.arange(count) % 2, 0.1, 5)
    comb[-1], comb[0] = [count, -10, 0], [0, -10, 0]
    before = time.process_time()
    with pytest.raises(dg.InputError, match="polygons: concave polygons have too many corners"):
        triangulate([count], np.arange(count), comb)
    assert time.process_time() - before < 20
    turn = 2 * np.pi * np.arange(count) / count
    circle = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    assert len(triangulate([count], np.arange(count), circle)[0]) == count - 2


def test_weld_makes_equal_corners_one() -> None:
    rng = np.random.default_rng(6)
    vertices = rng.integers(0, 50, 4000)
    uv = rng.integers(0, 3, (4000, 2)).astype(np.float32) / 3
    ids = rng.integers(0, 2, 4000)
    rows, index = weld(vertices, uv, ids)
    every = np.column_stack([vertices, uv, ids])
    np.testing.assert_array_equal(every[rows][index], every)
    assert len(rows) == len(np.unique(every, axis=0))
    assert (np.diff(rows) > 0).all()
    first = [int(np.flatnonzero(index == i)[0]) for i in range(len(rows))]
    assert rows.tolist() == first
    assert weld([], np.zeros((0, 2)))[1].shape == (0,)
    bits = np.array([[np.nan], [np.nan], [0.0], [-0.0]])
    assert weld([0, 0, 0, 0], bits)[1].tolist() == [0, 0, 1, 2]


def test_weld_is_that_of_a_dictionary(monkeypatch: pytest.MonkeyPatch) -> None:
    """Few corners differ from others of their vertex, each in one bit."""
    monkeypatch.setattr(polygons, "_CHUNK", 64)
    rng = np.random.default_rng(7)
    vertices = rng.integers(0, 50, 1000)
    uv = rng.random((50, 2)).astype(np.float32)[vertices]
    normals = rng.random((50, 3)).astype(np.float32)[vertices]
    for values in (uv, normals):
        values.view(np.uint32)[rng.integers(0, 1000, 9), rng.integers(0, values.shape[1], 9)] ^= 1
    known: dict[bytes, int] = {}
    leaders = []
    for corner in range(1000):
        key = b"".join(part[corner].tobytes() for part in (vertices, uv, normals))
        leaders.append(known.setdefault(key, corner))
    rows, index = weld(vertices, uv, normals)
    assert 50 < len(rows) <= 68
    assert rows.tolist() == sorted(set(leaders))
    assert rows[index].tolist() == leaders


CUBE, FACES = meshes.cube()
CORNERS = [v for face in FACES for v in face]
UV = np.tile([[0, 0], [1, 0], [1, 1], [0, 1]], (6, 1))


def added(**keywords: Any) -> dg.Scene:
    scene = dg.Scene()
    scene.add_mesh(**{"positions": CUBE, "indices": CORNERS, **keywords})
    return scene


def test_polygons_make_a_mesh() -> None:
    mesh = added(sizes=[4] * 6).meshes[0]
    assert mesh.positions.shape == (8, 3)
    assert np.abs(areas(mesh.positions, mesh.indices)).sum() == pytest.approx(24)
    split = added(sizes=[4] * 6, uv=UV, colors=np.arange(24.0).reshape(8, 3)).meshes[0]
    assert split.uv is not None
    assert split.colors is not None
    assert split.indices.shape == (12, 3)
    for corner in range(3):  # each corner keeps its vertex, its uv and its colour
        v = split.indices[:, corner]
        source = [int(np.abs(CUBE - p).sum(axis=1).argmin()) for p in split.positions[v]]
        np.testing.assert_array_equal(split.colors[v, 0], 3 * np.array(source))
    assert np.abs(areas(np.pad(split.uv, ((0, 0), (0, 1))), split.indices)).sum() == 6


def test_a_surface_makes_a_mesh() -> None:
    rules = Rules(creases=[(0, 1), (1, 3)])
    mesh = added(sizes=[4] * 6, subdivision=Subdivision(level=3, rules=rules), uv=UV).meshes[0]
    made = Refiner(8, [4] * 6, CORNERS, level=3, rules=rules)
    points, normals = made.surface(CUBE)
    assert mesh.normals is not None
    assert mesh.uv is not None
    assert len(mesh.indices) == 2 * 24 * 16
    rows = np.abs(mesh.positions[:, None] - points.astype(np.float32)).sum(axis=2) < 1e-6
    for i, row in enumerate(rows):  # normals of copies belong to their side
        assert np.abs(normals[row] - mesh.normals[i]).max(axis=1).min() < 1e-6
    kept = np.unique(mesh.uv[np.linalg.norm(mesh.positions, axis=1).argmax()])
    assert set(kept.tolist()) <= {0.0, 1.0}
    outward = np.einsum(
        "ij,ij->i", areas(mesh.positions, mesh.indices), mesh.positions[mesh.indices[:, 0]]
    )
    assert (outward > 0).all()
    same = added(indices=FACES, subdivision="catmull-clark").meshes[0]
    assert same.positions.shape == (98, 3)  # 8, 12 + 6, 24 + 48
    colored = added(indices=FACES, subdivision="bilinear", colors=CUBE / 2 + 0.5).meshes[0]
    assert colored.colors is not None
    np.testing.assert_allclose(colored.colors[:, :3], colored.positions / 2 + 0.5, atol=1e-6)


@pytest.mark.parametrize("subdivision", [None, "catmull-clark", "bilinear"])
@pytest.mark.parametrize("uv", [None, UV])
def test_polygons_move(subdivision: str | None, uv: Any) -> None:
    big = CUBE * [2, 1, 3] + [1, 0, 0]
    over = dg.keys([(0, CUBE), (2, big)])
    scene = added(positions=over, sizes=[4] * 6, subdivision=subdivision, uv=uv)
    for when, points in ((0, CUBE), (2, big), (1, (CUBE + big) / 2)):
        still = added(positions=points, sizes=[4] * 6, subdivision=subdivision, uv=uv).meshes[0]
        for moved in (scene.at(when), pickle.loads(pickle.dumps(scene)).at(when)):
            np.testing.assert_allclose(moved.meshes[0].positions, still.positions, atol=1e-6)
            if still.normals is not None:
                np.testing.assert_allclose(moved.meshes[0].normals, still.normals, atol=1e-6)
    steps = added(steps=([0, 2], [CUBE, big]), sizes=[4] * 6, subdivision=subdivision, uv=uv)
    np.testing.assert_array_equal(steps.at(2).meshes[0].positions, scene.at(2).meshes[0].positions)


def test_normals_per_corner_move_with_their_corner() -> None:
    flat = np.repeat([[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1]], 4, 0)
    over = dg.keys([(0, np.tile([[0, 0, 1.0]], (24, 1))), (1, flat)])
    scene = added(positions=dg.keys([(0, CUBE), (1, CUBE)]), sizes=[4] * 6, normals=over)
    mesh = scene.at(1).meshes[0]
    faces = areas(mesh.positions, mesh.indices)
    np.testing.assert_allclose(mesh.normals[mesh.indices[:, 0]], faces / 2, atol=1e-6)


def test_a_surface_renders() -> None:
    scene = added(positions=dg.keys([(0, CUBE), (1, 1.5 * CUBE)]), indices=FACES,
                  subdivision="catmull-clark")  # fmt: skip
    scene.add_instance(0, dg.Diffuse((0.5, 0.5, 0.5)))
    pose = np.eye(4)
    pose[2, 3] = 6
    scene.add_camera("Camera", dg.Camera(transform=pose, shutter_time=0.5))
    scene.set_environment(color=(1, 1, 1))
    frame = dg.render(scene, resolution=(24, 16), spp=4)
    assert 0.2 < float(frame.rgb[8, 12].mean()) / float(frame.rgb[0, 0].mean()) < 0.7


BAD: list[tuple[str, dict[str, Any], str]] = [
    ("sum", {"sizes": [4] * 5}, r"indices: wanted 20 corners \(the sum of sizes\), got 24"),
    ("two", {"sizes": [2] * 12}, r"sizes\[0\]: wanted at least 3 corners, got 2"),
    ("index", {"sizes": [3], "indices": [0, 1, 8]}, "indices: wanted 0 .. 7, got 0 .. 8"),
    ("sizes", {"sizes": [4.0] * 6}, "sizes: wanted integers"),
    ("name", {"subdivision": "smooth", "indices": FACES}, "scheme: wanted one of"),
    ("kind", {"subdivision": 3, "indices": FACES}, "subdivision: wanted"),
    ("loop", {"subdivision": "loop", "indices": FACES}, "wanted triangles for loop"),
    ("uv", {"sizes": [4] * 6, "uv": UV[:9]}, "uv: wanted 8 elements"),
    ("uv, other", {"sizes": [4] * 6, "uv": UV, "uv1": UV[:9]}, r"uv1: wanted 8 elements \(one per"),
    ("uv rows", {"sizes": [4] * 6, "uv": [[0], [1, 2]]}, "uv: wanted .* unequal length"),
    ("color rows", {"sizes": [4] * 6, "colors": [[0], [1, 2]]}, "colors: .* unequal length"),
    ("NaN", {"subdivision": "bilinear", "sizes": [4] * 6, "uv": UV * np.nan}, r"uv\[0\]: wanted f"),
    ("rules", {"subdivision": Subdivision(rules=3), "indices": FACES}, "rules: wanted Rules"),
    ("level", {"subdivision": Subdivision(level=0), "indices": FACES}, "level: wanted 1 .. 10"),
    ("normals", {"subdivision": "loop", "indices": FACES, "normals": CUBE}, "normals: not allowed"),
    ("ragged", {"subdivision": "bilinear", "indices": CORNERS[:22]}, r"indices: wanted shape \(F"),
    ("motion", {"sizes": [4] * 6, "motion": dg.keys([(0, 1)])}, "motion: wanted positions over"),
    ("colors", {"sizes": [4] * 6, "colors": CUBE[1:]}, "colors: wanted 8 elements"),
]  # fmt: skip


@pytest.mark.parametrize(("change", "message"), [b[1:] for b in BAD], ids=[b[0] for b in BAD])
def test_what_is_wrong_is_named_and_nothing_is_added(change: dict[str, Any], message: str) -> None:
    scene = dg.Scene()
    with pytest.raises(dg.DaguerreError, match=message):
        scene.add_mesh(**{"positions": CUBE, "indices": CORNERS, **change})
    assert scene == dg.Scene()


def test_a_number_of_vertices_that_changes_is_named() -> None:
    over = dg.keys([(0, CUBE), (1, CUBE)])
    for subdivision in (None, "catmull-clark"):
        scene = added(positions=Shrinking(over), sizes=[4] * 6, uv=UV, subdivision=subdivision)
        with pytest.raises(dg.InputError, match=r"wanted (8 elements|shape .8, 3.), got .*7, 3"):
            scene.at(1)


class Shrinking:
    """Points of which one is lost later."""

    def __init__(self, value: Any) -> None:
        self._value = value

    def at(self, time_s: float) -> np.ndarray:
        return np.asarray(self._value.at(time_s))[: 8 if time_s == 0 else 7]

    def breaks(self, begin: float, end: float) -> list[float]:
        return list(self._value.breaks(begin, end))
