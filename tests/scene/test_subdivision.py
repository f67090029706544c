"""Subdivision surfaces against closed forms, eigenvectors and subdivision by brute force."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest

from daguerre.errors import InputError
from daguerre.scene.subdivision import Refiner, Rules, edges_of_chains
from daguerre.scene.subdivision.catmull_clark import CatmullClark
from daguerre.scene.subdivision.cut import opened_mesh
from daguerre.scene.subdivision.faces import Faces as Control
from daguerre.scene.subdivision.loop import Loop
from daguerre.scene.subdivision.refiner import MAX_FACES
from daguerre.scene.subdivision.scheme import Scheme
from tests.support.scene import control_meshes as meshes
from tests.support.scene.control_meshes import Faces, Mesh
from tests.support.scene.plain_subdivision import Plain

Edges = dict[tuple[int, int], float]
RING = ((0, 1), (1, 3), (3, 2), (2, 0))


def refiner(count: int, faces: Faces, scheme: str = "catmull-clark", level: int = 1, **rules: Any):
    sizes = [len(face) for face in faces]
    return Refiner(count, sizes, [v for face in faces for v in face], scheme, level, Rules(**rules))


def shaken(points: np.ndarray, seed: int = 3) -> np.ndarray:
    return points + 0.15 * np.random.default_rng(seed).standard_normal(points.shape)


def rules_of(edges: Edges, corners: dict[int, float], boundary: str) -> dict[str, Any]:
    return {
        "creases": np.array(list(edges), int).reshape(-1, 2),
        "crease_sharpness": list(edges.values()),
        "corners": np.array(list(corners), int),
        "corner_sharpness": list(corners.values()),
        "boundary": boundary,
    }


SMOOTH, ONLY = "edge and corner", "edge only"
CC, LOOP = "catmull-clark", "loop"
MIXED = {(0, 1): 0.5, (1, 3): 1.7, (3, 2): 2.2, (2, 0): 3.1, (0, 4): 0.8}
#: Name, control mesh, scheme, sharp edges, sharp vertices, boundary.
CASES: list[tuple[str, Mesh, str, Edges, dict[int, float], str]] = [
    ("cube", meshes.cube(), CC, {}, {}, SMOOTH),
    ("crease", meshes.cube(), CC, dict.fromkeys(RING, 10.0), {}, SMOOTH),
    ("dart", meshes.cube(), CC, {(0, 1): 10}, {}, SMOOTH),
    ("two darts", meshes.cube(), CC, {(0, 1): 10, (1, 3): 12}, {}, SMOOTH),
    ("three creases", meshes.cube(), CC, {(0, 1): 10, (0, 2): 10, (0, 4): 10}, {}, SMOOTH),
    ("corner", meshes.cube(), CC, {}, {0: 10}, SMOOTH),
    ("semi-sharp 0.3", meshes.cube(), CC, dict.fromkeys(RING, 0.3), {}, SMOOTH),
    ("semi-sharp 1", meshes.cube(), CC, dict.fromkeys(RING, 1.0), {}, SMOOTH),
    ("semi-sharp 2.7", meshes.cube(), CC, dict.fromkeys(RING, 2.7), {}, SMOOTH),
    ("mixed", meshes.cube(), CC, MIXED, {7: 1.4, 0: 0.3}, SMOOTH),
    (
        "semi-sharp at a crease", meshes.cube(), CC,
        {**dict.fromkeys(RING, 10.0), (0, 4): 1.6, (1, 5): 0.4, (3, 7): 2.5}, {2: 1.3}, SMOOTH,
    ),
    (
        "semi-sharp at a dart", meshes.cube(), CC,
        {(0, 1): 10, (0, 2): 1.6, (1, 5): 2.4, (0, 4): 0.7}, {1: 0.5}, SMOOTH,
    ),
    ("open", meshes.grid(3, 3), CC, {}, {}, SMOOTH),
    ("edge only", meshes.grid(3, 3), CC, {}, {}, ONLY),
    ("L", (meshes.grid(3, 3)[0], meshes.grid(3, 3)[1][:-1]), CC, {}, {}, SMOOTH),
    (
        "semi-sharp at a boundary", meshes.grid(3, 3), CC,
        {(1, 5): 1.5, (2, 6): 0.6, (6, 10): 2.5}, {1: 0.7, 4: 1.2}, SMOOTH,
    ),
    ("pentagons", meshes.prism(5), CC, {}, {}, SMOOTH),
    ("open prism", (meshes.prism(5)[0], meshes.prism(5)[1][1:]), CC, {}, {}, SMOOTH),
    ("three faces", meshes.fins(), CC, {}, {}, SMOOTH),
    ("cone of 6", meshes.cone(6), CC, {}, {}, SMOOTH),
    ("crease of 6", meshes.cone(6), CC, {(0, 1): 10, (0, 4): 10}, {}, SMOOTH),
    ("icosahedron", meshes.icosahedron(), LOOP, {}, {}, SMOOTH),
    ("torus", meshes.torus(4, 3, triangles=True), LOOP, {}, {}, SMOOTH),
    ("Loop crease", meshes.cone(7), LOOP, {(0, 1): 10, (0, 4): 10}, {}, SMOOTH),
    ("Loop dart", meshes.cone(5), LOOP, {(0, 1): 10}, {}, SMOOTH),
    ("Loop semi-sharp", meshes.cone(6), LOOP, {(0, 1): 1.3, (0, 3): 2.3}, {}, SMOOTH),
    ("Loop fan", (meshes.cone(5)[0], meshes.cone(5)[1][:-1]), LOOP, {}, {}, SMOOTH),
    ("Loop edge only", (meshes.cone(4)[0], meshes.cone(4)[1][:-1]), LOOP, {}, {}, ONLY),
]  # fmt: skip


@pytest.mark.parametrize("case", CASES, ids=[case[0] for case in CASES])
def test_limits_and_normals_are_those_of_brute_force(case: Any) -> None:
    _, (points, faces), scheme, edges, corners, boundary = case
    points = shaken(points)
    plain = Plain(
        list(points),
        [tuple(face) for face in faces],
        {frozenset(edge): s for edge, s in edges.items()},
        dict(corners),
        scheme == LOOP,
    ).closed(boundary == SMOOTH)
    fine = plain.refined()
    made = refiner(len(points), faces, scheme, 1, **rules_of(edges, corners, boundary))
    positions, normals = made.surface(points)
    limits = np.array([fine.limit(v) for v in range(len(fine.points))])
    distances = np.linalg.norm(positions[:, None] - limits[None], axis=2)
    assert set(distances.argmin(axis=1)) == {v for face in fine.faces for v in face}
    assert distances.min(axis=1).max() < 1e-7
    checked = 0
    for i, v in enumerate(distances.argmin(axis=1)):
        sides = fine.sides(int(v))
        if has_plane(fine, int(v), [count for count, _ in sides]):
            errors = [np.abs(normal - normals[i]).max() for _, normal in sides]
            assert min(errors) < 2e-4, (i, v)
            # each side has a copy with its normal
            copies = normals[distances[:, v] < 1e-7]
            assert len(copies) == len(sides)
            nearest = [np.abs(copies - normal).max(axis=1).min() for _, normal in sides]
            assert max(nearest) < 2e-4, (i, v)
            checked += 1
    assert checked > len(positions) / 2


def has_plane(mesh: Plain, v: int, sides: list[int]) -> bool:
    """Whether each side of a vertex has one tangent plane under the plain rules.

    A corner of two faces has none; neither has a crease with so many faces on a side that a wave
    along it shrinks as slowly as the crease.
    """
    sharp = sum(s >= 10 for edge, s in mesh.edges.items() if v in edge)
    if mesh.corners.get(v, 0) >= 10 or sharp > 2:
        return max(sides) == 1
    return sharp < 2 or max(sides) <= (4 if mesh.loop else 3)


def test_a_cube_has_the_closed_form() -> None:
    """Halstead et al. 1993: (n^2 v + 4 sum e + sum f) / (n (n + 5))."""
    points, faces = meshes.cube()
    made = refiner(8, faces, level=3)
    positions, normals = made.surface(points)
    corner = (9 * points[0] + 4 * points[[1, 2, 4]].sum(0) + points[[3, 5, 6]].sum(0)) / 24
    np.testing.assert_allclose(positions[0], corner, atol=1e-14)
    np.testing.assert_allclose(normals[0], -np.ones(3) / 3**0.5, atol=1e-14)
    for axis in range(3):  # middles of faces look along the axes
        far = positions[:, axis].argmax()
        np.testing.assert_allclose(np.abs(normals[far]), np.eye(3)[axis], atol=1e-14)


def local_map(scheme: Scheme, faces: int, closed: bool) -> np.ndarray:
    """Map of a ring, by refining each of its points alone with the plain rules."""
    quads = scheme.quads
    spokes = faces if closed else faces + 1
    count = scheme.ring(0 if closed else 1, faces)
    rings = []
    for i in range(faces):
        one, other = 1 + i, 1 + (i + 1) % spokes
        rings.append((0, one, 1 + spokes + i, other) if quads else (0, one, other))
    columns = []
    for k in range(count):
        plain = Plain([np.array([float(i == k)]) for i in range(count)], rings, loop=not quads)
        fine = plain.closed(False).refined()
        number = {edge: count + i for i, edge in enumerate(plain.uses())}
        ends = [number[frozenset((0, 1 + i))] for i in range(spokes)]
        middles = [len(fine.points) - faces + i for i in range(faces)] if quads else []
        columns.append([float(fine.points[i][0]) for i in (0, *ends, *middles)])
    return np.array(columns).T


@pytest.mark.parametrize("scheme", [CatmullClark(), Loop()])
@pytest.mark.parametrize("faces", [1, 2, 3, 4, 5, 8])
@pytest.mark.parametrize("closed", [True, False])
def test_limit_weights_are_left_eigenvectors(scheme: Scheme, faces: int, closed: bool) -> None:
    """Stam 1998: the limit and its tangents are the first left eigenvectors of the ring's map."""
    if closed and faces < 3:
        return
    matrix = local_map(scheme, faces, closed)
    weights = scheme.limit(0 if closed else 1, faces, False)
    np.testing.assert_allclose(weights.sum(axis=0), [1, 0, 0], atol=1e-12)
    np.testing.assert_allclose(weights[:, 0] @ matrix, weights[:, 0], atol=1e-12)
    values = []
    for tangent in weights[:, 1:].T:
        pulled = tangent @ matrix
        value = pulled @ tangent / (tangent @ tangent)
        if not (faces == 1 and value < 0.4):  # a chain of eigenvectors, of value 1/4
            np.testing.assert_allclose(pulled, value * tangent, atol=1e-12)
        values.append(value)
    known = np.sort(np.abs(np.linalg.eigvals(matrix)))[::-1]
    if closed:
        np.testing.assert_allclose(values, known[1:3], atol=1e-9)
    else:
        assert values[0] == pytest.approx(0.5)
        assert values[1] == pytest.approx(1 / 4 if faces == 1 else known[1:3].min(), abs=1e-9) or (
            values[1] == pytest.approx(known[1])
        )


def test_levels_agree_where_they_meet() -> None:
    """Vertices of a coarse level have the same limit at every finer one."""
    points, faces = meshes.prism(5)
    points = shaken(points)
    rules = rules_of({(0, 1): 2.4, (1, 2): 10.0, (5, 6): 0.7}, {3: 1.8}, SMOOTH)
    coarse, fine = (refiner(10, faces, level=level, **rules) for level in (1, 4))
    (p, n), (q, m) = coarse.surface(points), fine.surface(points)
    np.testing.assert_allclose(q[: len(p)], p, atol=1e-12)
    np.testing.assert_allclose(m[: len(n)], n, atol=1e-9)


def test_normals_are_those_of_the_mesh_in_the_limit() -> None:
    """Finite differences: faces of a fine level have the normals of their vertices."""
    points, faces = meshes.torus(8, 5)
    made = refiner(len(points), faces, level=5)
    positions, normals = made.surface(shaken(points))
    quads = positions[made.vertices.reshape(-1, 4)]
    across = np.cross(quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    means = normals[made.vertices.reshape(-1, 4)].mean(axis=1)
    assert np.linalg.norm(across - means, axis=1).mean() < 2e-3


def test_bilinear_is_exact() -> None:
    points = np.array([[0, 0, 0], [1, 0, 0.3], [1.2, 1, -0.2], [0, 1, 0.5], [2, 0.5, 1]])
    made = refiner(5, [[0, 1, 2, 3], [1, 4, 2]], "bilinear", 3)
    positions, normals = made.surface(points)
    patch = positions[made.vertices[: 4 * 64]]
    s, t = solved(points[:4], patch)
    a, b, c, d = points[:4]
    along = (1 - t) * (b - a) + t * (c - d)
    across = (1 - s) * (d - a) + s * (c - b)
    np.testing.assert_allclose(a + s * along + t * (d - a), patch, atol=1e-9)
    exact = np.cross(along, across)
    exact /= np.linalg.norm(exact, axis=1, keepdims=True)
    np.testing.assert_allclose(normals[made.vertices[: 4 * 64]], exact, atol=1e-9)
    values = np.arange(7.0)[:, None]
    corners = made.face_varying(values)[: 4 * 64]
    expected = (1 - s) * (1 - t) * 0 + s * (1 - t) * 1 + s * t * 2 + (1 - s) * t * 3
    np.testing.assert_allclose(corners, expected, atol=1e-9)


def solved(points: np.ndarray, patch: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Parameters of points of a bilinear patch, multiples of 1/8."""
    s, t = np.meshgrid(np.arange(9) / 8, np.arange(9) / 8)
    s, t = s.reshape(-1, 1), t.reshape(-1, 1)
    a, b, c, d = points
    known = (1 - s) * (1 - t) * a + s * (1 - t) * b + s * t * c + (1 - s) * t * d
    nearest = np.linalg.norm(patch[:, None] - known[None], axis=2).argmin(axis=1)
    return s[nearest], t[nearest]


@pytest.mark.parametrize(
    ("mesh", "scheme", "euler"),
    [
        (meshes.cube(), CC, 2), (meshes.torus(5, 4), CC, 0), (meshes.prism(7), CC, 2),
        (meshes.grid(2, 3), CC, 1), (meshes.icosahedron(), LOOP, 2),
        (meshes.torus(4, 3, triangles=True), LOOP, 0),
    ],
)  # fmt: skip
@pytest.mark.parametrize("level", [1, 2, 3])
def test_topology_is_kept(mesh: Mesh, scheme: str, euler: int, level: int) -> None:
    points, faces = mesh
    made = refiner(len(points), faces, scheme, level)
    size = 3 if scheme == LOOP else 4
    polygons = made.vertices.reshape(-1, size)
    after = np.roll(polygons, -1, axis=1)
    halves = set(zip(polygons.ravel().tolist(), after.ravel().tolist(), strict=True))
    assert len(halves) == polygons.size  # each half-edge once: one orientation
    edges = {frozenset(half) for half in halves}
    assert made.count - len(edges) + len(polygons) == euler
    assert set(made.vertices.tolist()) == set(range(made.count))
    assert (made.sizes == size).all()
    each = [4 if scheme == LOOP else len(face) for face in faces]
    factor = 4 ** (level - 1)
    assert (
        made.parents.tolist() == np.repeat(np.arange(len(faces)), np.array(each) * factor).tolist()
    )


def test_refined_faces_lie_where_their_control_faces_do() -> None:
    points, faces = meshes.grid(4, 4)
    made = refiner(len(points), faces, level=3)
    linear = made.varying(points)[made.vertices].reshape(-1, 4, 3)
    for face in range(len(faces)):
        low, high = points[faces[face]].min(0), points[faces[face]].max(0)
        own = linear[made.parents == face].reshape(-1, 3)
        np.testing.assert_allclose([own.min(0), own.max(0)], [low, high], atol=1e-12)


def test_everything_is_linear_in_the_values() -> None:
    points, faces = meshes.prism(5)
    made = refiner(10, faces, level=2, **rules_of({(0, 1): 1.5}, {4: 10}, SMOOTH))
    rng = np.random.default_rng(5)
    corners = sum(len(face) for face in faces)
    one, other = rng.standard_normal((2, 10, 5))
    seams = np.arange(corners)  # a value of its own for each corner
    for act in (made.vertex, made.varying):
        np.testing.assert_allclose(act(2 * one - other), 2 * act(one) - act(other), atol=1e-12)
        np.testing.assert_allclose(act(np.ones((10, 1))), 1, atol=1e-12)
    one, other = rng.standard_normal((2, corners, 2))
    whole, part, less = (made.face_varying(v, seams) for v in (2 * one - other, one, other))
    np.testing.assert_allclose(whole, 2 * part - less, atol=1e-12)
    np.testing.assert_allclose(made.vertex(points), made.surface(points)[0], atol=1e-12)


@pytest.mark.parametrize(("mesh", "scheme"), [(meshes.cube(), CC), (meshes.icosahedron(), LOOP)])
def test_values_without_a_seam_follow_the_vertices(mesh: Mesh, scheme: str) -> None:
    points, faces = mesh
    edges = {(0, 1): 10.0, (1, 5): 10.0, (1, 7): 1.4, (4, 5): 0.6}
    made = refiner(len(points), faces, scheme, 3, **rules_of(edges, {6: 2.2}, SMOOTH))
    vertices = [v for face in faces for v in face]
    expected = made.vertex(points)[made.vertices]
    np.testing.assert_allclose(made.face_varying(points, vertices), expected, atol=1e-12)
    np.testing.assert_allclose(made.face_varying(points[vertices]), expected, atol=1e-12)


@pytest.mark.parametrize(
    ("rule", "kept"),
    [
        ("none", set()),
        ("corners only", {"corner", "outer"}),
        ("corners plus1", {"corner", "outer"}),
        ("corners plus2", {"corner", "outer", "concave", "dart"}),
        ("boundaries", {"corner", "outer", "concave", "dart", "rim"}),
        ("all", {"corner", "outer", "concave", "dart", "rim", "inside"}),
    ],
)
def test_seams_follow_their_rule(rule: str, kept: set[str]) -> None:
    """Sees which values stay as they are, on 4 x 4 faces: an island of one face, and a slit."""
    points, faces = meshes.grid(4, 4)
    corners = np.array([v for face in faces for v in face])
    values = shaken(points)[corners]
    values[60:] += 50  # the last face is an island
    face_of, vertex = np.repeat(np.arange(16), 4), corners
    values[(face_of == 4) & (vertex == 5)] += 0.3  # a slit from the rim to vertex 6
    made = refiner(25, faces, level=2, face_varying=rule, boundary="edge only")
    refined = made.face_varying(values)

    def stays(face: int, vertex: int) -> bool:
        wanted = values[(face_of == face) & (corners == vertex)][0]
        return bool(np.abs(refined - wanted).max(axis=1).min() < 1e-9)

    places = {
        "corner": (15, 18), "outer": (0, 0), "concave": (10, 18), "dart": (5, 6), "rim": (8, 10),
        "inside": (9, 12),
    }  # fmt: skip
    assert {name for name, place in places.items() if stays(*place)} == kept
    linear = refiner(25, faces, level=2, face_varying="all").face_varying(values)
    assert np.allclose(refined, linear) == (rule == "all")


@pytest.mark.parametrize(("rule", "kept"), [("corners plus1", True), ("corners only", False)])
def test_junctions_of_three_values_are_kept_by_plus1(rule: str, kept: bool) -> None:
    points, faces = meshes.cone(6)
    points = shaken(points)
    # Three islands of two faces each meet at the tip.
    values = np.array([points[v] + 9 * (f // 2) for f, face in enumerate(faces) for v in face])
    for scheme in (CC, LOOP):
        refined = refiner(7, faces, scheme, 2, face_varying=rule).face_varying(values)
        for island in range(3):
            found = np.abs(refined - points[0] - 9 * island).max(axis=1).min() < 1e-9
            assert found == kept


def test_the_end_of_a_seam_is_that_of_a_crease() -> None:
    points, faces = meshes.grid(4, 4)
    points = shaken(points)
    corners = np.array([v for face in faces for v in face])
    values = points[corners]
    values[(np.arange(64) // 4 == 4) & (corners == 5)] += 1e-9  # from the rim to vertex 6
    refined = refiner(25, faces, level=2).face_varying(values)
    made = refiner(25, faces, level=2, creases=[(5, 6)])
    expected = made.vertex(points)[made.vertices]
    near = np.abs(made.varying(points)[made.vertices] - points[6]).max(axis=1) < 0.6
    np.testing.assert_allclose(refined[near], expected[near], atol=1e-7)
    smooth = refiner(25, faces, level=2)
    assert np.abs(refined - smooth.vertex(points)[smooth.vertices])[near].max() > 1e-3


def test_a_value_for_each_face_is_an_island() -> None:
    """With a seam at each edge the smooth rule of one face alone holds."""
    _, faces = meshes.grid(2, 1)
    values = np.array([0.0, 1, 2, 3, 10, 11, 12, 13])[:, None]
    made = refiner(6, faces, level=2, face_varying="none", boundary="edge only")
    both = made.face_varying(values)
    alone = refiner(4, [[0, 1, 2, 3]], level=2, boundary="edge only")
    for face in range(2):
        expected = alone.vertex(values[4 * face : 4 * face + 4])[alone.vertices]
        np.testing.assert_allclose(both[64 * face : 64 * face + 64], expected, atol=1e-12)


def test_holes_shape_the_surface_and_are_left_out() -> None:
    points, faces = meshes.cube()
    whole, open_ = refiner(8, faces, level=2), refiner(8, faces, level=2, holes=[1])
    assert set(open_.parents.tolist()) == {0, 2, 3, 4, 5}
    kept = np.repeat(whole.parents != 1, 4)
    for made in (open_, pickle.loads(pickle.dumps(open_))):
        got = made.surface(points)
        want = whole.surface(points)
        assert len(got[0]) == made.count < whole.count
        for mine, all_ in zip(got, want, strict=True):
            np.testing.assert_array_equal(mine[made.vertices], all_[whole.vertices[kept]])
        values = np.random.default_rng(1).random((24, 2))
        assert made.face_varying(values).shape == (made.vertices.size, 2)


def test_without_boundaries_the_outer_faces_are_left_out() -> None:
    _, faces = meshes.grid(4, 4)
    made = refiner(25, faces, level=1, boundary="none")
    assert set(made.parents.tolist()) == {5, 6, 9, 10}
    rim = [v for v in range(25) if v % 5 in (0, 4) or v // 5 in (0, 4)]
    pairs = [(a, b) for a in rim for b in rim if b - a in (1, 5)]
    kept = refiner(25, faces, level=1, boundary="none", creases=pairs)
    assert set(kept.parents.tolist()) == set(range(16))


def test_sides_of_a_crease_have_copies_of_equal_position() -> None:
    points, faces = meshes.cube()
    smooth = refiner(8, faces, level=2)
    made = refiner(8, faces, level=2, creases=RING)
    assert made.count == smooth.count + 16
    positions, normals = made.surface(points)
    places, counts = np.unique(np.round(positions, 9), axis=0, return_counts=True)
    assert (counts == 2).sum() == 16
    for place in places[counts == 2]:
        one, other = normals[np.abs(positions - place).max(axis=1) < 1e-6]
        assert one @ other < 0.9


def test_sharpness_falls_by_one_a_level() -> None:
    """A semi-sharp crease lies between the smooth and the sharp one, and rises with sharpness."""
    points, faces = meshes.cube()
    top = [
        refiner(8, faces, level=1, creases=RING, crease_sharpness=s).surface(points)[0][0, 0]
        for s in (0, 0.25, 0.5, 1, 1.5, 2, 4, 9.9, 10)
    ]
    assert np.all(np.diff(top) < 0)
    assert top[-2] == pytest.approx(top[-1], abs=1e-3)


def test_odd_topologies_end_well() -> None:
    """Faces that meet in a point, face away from each other, or visit a vertex twice."""
    rng = np.random.default_rng(2)
    odd: list[Faces] = [
        [[0, 1, 2], [0, 3, 4]],
        [[0, 1, 2, 3], [0, 1, 4, 5]],
        [[0, 1, 1, 2], [2, 3, 4, 2]],
        [[0, 1, 2], [0, 1, 2], [2, 1, 0]],
        [[0, 1, 0, 1]],
        [[0, 0, 0]],
        [[0, 1, 2], [0, 2, 1]],
        [],
    ]
    odd += [rng.integers(0, 7, (rng.integers(1, 9), 4)).tolist() for _ in range(60)]
    for faces in odd:
        for scheme in (CC, "bilinear"):
            made = refiner(7, faces, scheme, 2, creases=[(0, 1), (1, 2)], crease_sharpness=1.5)
            points, normals = made.surface(rng.standard_normal((7, 3)))
            assert np.isfinite(points).all()
            np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1)
            corners = sum(len(face) for face in faces)
            np.testing.assert_allclose(made.face_varying(np.ones((corners, 2))), 1)


def walked(faces: Control, twins: np.ndarray) -> list[list[int]]:
    """Corners around each vertex, counter-clockwise, by steps from face to face."""
    after = {int(faces.after[twin]): corner for corner, twin in enumerate(twins) if twin >= 0}
    rings: list[list[int]] = []
    for corner in (*np.flatnonzero(twins < 0).tolist(), *range(len(twins))):
        if not any(corner in ring for ring in rings):
            rings.append([corner])
            while after.get(rings[-1][-1], corner) != corner:
                rings[-1].append(after[rings[-1][-1]])
    return sorted(rings, key=lambda ring: (faces.vertices[ring[0]], ring[0]))


@pytest.mark.parametrize("seed", range(12))
def test_fans_are_those_of_a_walk(seed: int) -> None:
    """Open and closed fans of up to 30 faces, and those of random faces, cut at random edges."""
    rng = np.random.default_rng(seed)
    tries = [meshes.cone(30)[1], meshes.torus(6, 5)[1], rng.integers(0, 6, (30, 4)).tolist()]
    for polygons in tries:
        flat = np.array([v for face in polygons for v in face])
        made = Control(31, np.array([len(face) for face in polygons]), flat)
        creases = rng.integers(0, 31, (4 * seed, 2))
        opened = opened_mesh(made, Rules(creases=creases).checked(31, len(polygons), "cut"))
        found, wanted = opened.fans, walked(made, opened.twins)
        assert found.rings.tolist() == [corner for ring in wanted for corner in ring]
        assert found.sizes.tolist() == [len(ring) for ring in wanted]
        assert found.opened.tolist() == [opened.twins[ring[0]] < 0 for ring in wanted]
        number = {corner: i for i, ring in enumerate(wanted) for corner in ring}
        assert found.of_corner.tolist() == [number[corner] for corner in range(len(flat))]


def test_a_vertex_of_many_faces_is_quick() -> None:
    points, faces = meshes.cone(30000)
    for scheme in (CC, LOOP):
        positions, normals = refiner(len(points), faces, scheme, 1).surface(points)
        assert np.isfinite(positions).all()
        np.testing.assert_allclose(normals[0], [0, 0, 1], atol=1e-6)


def test_edges_of_chains() -> None:
    edges, sharpness = edges_of_chains([4, 5, 6, 1, 2], [3, 2], [2, 3])
    assert edges.tolist() == [[4, 5], [5, 6], [1, 2]]
    assert sharpness.tolist() == [2, 2, 3]
    assert edges_of_chains([4, 5, 6], [3], [2, 7])[1].tolist() == [2, 7]
    for bad in (([1, 2], [3], [1]), ([1], [1], [1]), ([1, 2, 3], [3], [1, 2, 3])):
        with pytest.raises(InputError, match="creases: "):
            edges_of_chains(*bad)


def test_a_refiner_is_a_value() -> None:
    points, faces = meshes.cube()
    made = refiner(8, faces, level=2)
    before = pickle.dumps(made)
    made.surface(points)
    made.face_varying(np.zeros((24, 2)))
    assert len(pickle.dumps(made)) == len(before)
    assert made == pickle.loads(before) == copy.deepcopy(made)
    assert made != refiner(8, faces, level=1)


QUAD = [0, 1, 2, 3]
BAD: list[tuple[str, dict[str, Any], str]] = [
    ("size", {"sizes": [2], "vertices": [0, 1]}, r"sizes\[0\]: wanted at least 3 corners, got 2"),
    ("sum", {"sizes": [5]}, "vertices: wanted 5 corners"),
    ("index", {"vertices": [0, 1, 2, 4]}, "vertices: wanted 0 .. 3, got 0 .. 4"),
    ("negative", {"vertices": [0, 1, 2, -1]}, "vertices: wanted 0 .. 3, got -1"),
    ("fraction", {"vertices": [0, 1, 2, 3.0]}, "vertices: wanted integers"),
    ("huge size", {"sizes": [1 << 40]}, "sizes: wanted 0"),
    ("scheme", {"scheme": "loops"}, "scheme: wanted one of .*did you mean 'loop'"),
    ("loop", {"scheme": "loop"}, r"sizes\[0\]: wanted triangles for loop, got 4 corners"),
    ("level", {"level": 0}, "level: wanted 1 .. 10, got 0"),
    ("level 11", {"level": 11}, "level: wanted 1 .. 10, got 11"),
    ("level x", {"level": 1.5}, "level: wanted a whole number"),
    ("crease", {"rules": Rules(creases=[(0, 9)])}, "creases: wanted 0 .. 3"),
    ("odd", {"rules": Rules(creases=[0, 1, 2])}, r"creases: wanted shape \(E, 2\)"),
    (
        "sharpness", {"rules": Rules(creases=[(0, 1)], crease_sharpness=[1, 2])},
        "crease_sharpness: wanted 1 numbers",
    ),
    ("NaN", {"rules": Rules(corners=[0], corner_sharpness=np.nan)}, "corner_sharpness: .* got nan"),
    ("below 0", {"rules": Rules(corners=[0], corner_sharpness=-1)}, "corner_sharpness: .* got -1"),
    ("boundary", {"rules": Rules(boundary="edge")}, "boundary: wanted one of"),
    ("seams", {"rules": Rules(face_varying="some")}, "face_varying: wanted one of"),
    ("hole", {"rules": Rules(holes=[1])}, "holes: wanted 0 .. 0, got 1"),
]  # fmt: skip


@pytest.mark.parametrize(("change", "message"), [b[1:] for b in BAD], ids=[b[0] for b in BAD])
def test_what_is_wrong_is_named(change: dict[str, Any], message: str) -> None:
    given: dict[str, Any] = {"count": 4, "sizes": [4], "vertices": QUAD, **change}
    with pytest.raises(InputError, match=f"^subdivision: {message}"):
        Refiner(**given)


def test_wrong_values_are_named() -> None:
    made = Refiner(4, [4], QUAD)
    for act, values, message in (
        (made.surface, np.zeros((5, 3)), r"points: wanted shape \(4, 3\), got \(5, 3\)"),
        (made.surface, np.full((4, 3), np.nan), r"points\[0\]: wanted finite numbers"),
        (made.vertex, np.zeros(4), r"values: wanted shape \(4, K\)"),
        (made.varying, "abc", "values: wanted"),
        (made.face_varying, np.zeros((3, 2)), r"values: wanted shape \(4, K\)"),
    ):
        with pytest.raises(InputError, match=message):
            act(values)
    with pytest.raises(InputError, match=r"indices: wanted 0 \.\. 1, got 0"):
        made.face_varying(np.zeros((2, 2)), QUAD)
    with pytest.raises(InputError, match="indices: wanted 4"):
        made.face_varying(np.zeros((2, 2)), [0, 1])


def test_too_many_faces_are_refused_before_anything_is_made() -> None:
    count = MAX_FACES // 4**10 + 1
    vertices = np.zeros(4 * count, np.int64)
    with pytest.raises(InputError, match=f"level 10: wanted at most {MAX_FACES} refined faces"):
        Refiner(1, np.full(count, 4), vertices, level=10)
    Refiner(1, [4], [0, 0, 0, 0], level=10)
