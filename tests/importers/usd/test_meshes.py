"""Meshes: faces, primvars, subsets, subdivision."""

from __future__ import annotations

import pickle
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pxr import Gf, Sdf, Usd, UsdGeom, UsdShade, Vt

import daguerre as dg
from daguerre.files.notes import Notes
from daguerre.importers.usd.meshes import Choice, Meshes
from daguerre.importers.usd.values import Clock
from tests.support.formats import stages

CYCLES = [0, 1, 2, 3]


def _one(scene: dg.Scene, name: str = "card") -> Any:
    (i,) = scene.nodes[name]
    return scene.meshes[scene.instances[i].mesh]


def _load(tmp_path: Path, write: Any) -> dg.Scene:
    stage = stages.new_stage(tmp_path / "x.usda")
    write(stage)
    return dg.load(stages.save(stage))


def _normals(mesh: Any) -> np.ndarray:
    a, b, c = (mesh.positions[mesh.indices[:, k]] for k in range(3))
    return np.cross(b - a, c - a)


def _area(mesh: Any) -> float:
    return float(0.5 * np.linalg.norm(_normals(mesh), axis=1).sum())


def test_polygons_become_triangles_of_the_same_area(tmp_path: Path) -> None:
    angles = np.arange(7) * 2 * np.pi / 7
    points = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    scene = _load(tmp_path, lambda s: stages.mesh(s, "/card", points, [7], range(7)))
    assert len(_one(scene).indices) == 5
    assert _area(_one(scene)) == pytest.approx(3.5 * np.sin(2 * np.pi / 7), rel=1e-6)


def test_left_handed_meshes_face_the_same_way(tmp_path: Path) -> None:
    def write(stage: Usd.Stage) -> None:
        stages.mesh(stage, "/right")
        left = stages.mesh(stage, "/left", corners=[0, 3, 2, 1])
        left.CreateOrientationAttr("leftHanded")
        smooth = stages.cube(stage, "/smooth", "catmullClark")
        smooth.CreateFaceVertexIndicesAttr(
            [c for k in range(6) for c in reversed(stages.CUBE_FACES[4 * k : 4 * k + 4])]
        )
        smooth.CreateOrientationAttr("leftHanded")

    scene = _load(tmp_path, write)
    assert (_normals(_one(scene, "right"))[:, 2] > 0).all()
    assert (_normals(_one(scene, "left"))[:, 2] > 0).all()
    smooth = _one(scene, "smooth")
    assert (np.einsum("ni,ni->n", smooth.normals, smooth.positions) > 0).all()
    centres = smooth.positions[smooth.indices].mean(axis=1)
    assert (np.einsum("ni,ni->n", _normals(smooth), centres) > 0).all()


def test_holes_and_small_faces_are_left_out(tmp_path: Path) -> None:
    def write(stage: Usd.Stage) -> None:
        points = [*stages.SQUARE, (3, -1, 0), (3, 1, 0)]
        made = stages.mesh(stage, "/card", points, [4, 2, 4], [0, 1, 2, 3, 0, 1, 1, 4, 5, 2])
        made.CreateHoleIndicesAttr([0])

    scene = _load(tmp_path, write)
    assert _area(_one(scene)) == pytest.approx(4)
    assert _one(scene).positions[:, 0].min() == 1
    assert "a face of fewer than three corners is left out (1 use)" in scene.warnings


@pytest.mark.parametrize("scheme", ["none", "bilinear"])
@pytest.mark.parametrize(
    "interpolation", ["constant", "uniform", "vertex", "varying", "faceVarying"]
)
@pytest.mark.parametrize("indexed", [False, True])
def test_every_interpolation_puts_colours_where_they_belong(
    tmp_path: Path, scheme: str, interpolation: str, indexed: bool
) -> None:
    counts = {"constant": 1, "uniform": 2, "vertex": 6, "varying": 6, "faceVarying": 8}
    count = counts[interpolation]
    rng = np.random.default_rng(3)
    colors = rng.uniform(0.1, 1, (count, 3)).astype(np.float32)
    order = rng.permutation(count)

    def write(stage: Usd.Stage) -> None:
        points = [*stages.SQUARE, (3, -1, 0), (3, 1, 0)]
        made = stages.mesh(stage, "/card", points, [4, 4], [0, 1, 2, 3, 1, 4, 5, 2], scheme)
        if indexed:
            stages.primvar(made, "displayColor", colors[order], interpolation, np.argsort(order))
        else:
            stages.primvar(made, "displayColor", colors, interpolation)

    scene = _load(tmp_path, write)
    mesh = _one(scene)
    at = {
        (-1, -1): (0, 0),
        (1, -1): (1, 1),
        (1, 1): (2, 2),
        (-1, 1): (3, 3),
        (3, -1): (4, 5),
        (3, 1): (5, 6),
    }
    if interpolation == "constant":
        assert scene.materials[0].kind.base_color == pytest.approx(tuple(colors[0]), abs=1e-6)
        return
    for triangle in mesh.indices:
        face = 0 if mesh.positions[triangle, 0].mean() < 1 else 1
        for vertex in triangle:
            x, y, _ = mesh.positions[vertex]
            if (x, y) not in at:
                continue
            point, corner = at[x, y]
            if face == 1:
                corner = {0: 4, 1: 4, 4: 5, 5: 6, 2: 7}[point]
            wanted = {"uniform": face, "faceVarying": corner}.get(interpolation, point)
            assert np.allclose(mesh.colors[vertex, :3], colors[wanted], atol=1e-5)


def test_a_primvar_of_a_wrong_length_is_noted(tmp_path: Path) -> None:
    def write(stage: Usd.Stage) -> None:
        stages.primvar(stages.mesh(stage, "/card"), "displayColor", np.ones((3, 3)), "vertex")

    scene = _load(tmp_path, write)
    assert any(
        "'displayColor' has the wrong number of values for its mesh" in w for w in scene.warnings
    )


def test_texture_coordinates_have_their_origin_at_the_top_left(tmp_path: Path) -> None:
    def write(stage: Usd.Stage) -> None:
        made = stages.mesh(stage, "/card")
        stages.primvar(made, "st", [(0, 0), (1, 0), (1, 1), (0, 1)], "vertex")

    mesh = _one(_load(tmp_path, write))
    low = np.flatnonzero((mesh.positions == (-1, -1, 0)).all(axis=1))
    assert np.allclose(mesh.uv[low], (0, 1))


def test_normals_of_the_file_shade_a_polygon_mesh_and_not_a_smooth_one(tmp_path: Path) -> None:
    def write(stage: Usd.Stage) -> None:
        for name, scheme in (("flat", "none"), ("smooth", "catmullClark")):
            made = stages.cube(stage, f"/{name}", scheme)
            made.CreateNormalsAttr(stages.vectors(np.tile((0, 0, 2.0), (24, 1))))
            made.SetNormalsInterpolation("faceVarying")

    scene = _load(tmp_path, write)
    assert np.allclose(_one(scene, "flat").normals, (0, 0, 1))
    smooth = _one(scene, "smooth")
    assert (np.einsum("ni,ni->n", smooth.normals, smooth.positions) > 0).all()


def test_a_subdivided_cube_lies_on_its_limit_surface(tmp_path: Path) -> None:
    mesh = _one(_load(tmp_path, lambda s: stages.cube(s, "/card", "catmullClark")))
    # Halstead, Kass, DeRose 1993: (9 v + 4 e + f) / 24 at a corner of valence 3.
    corner = np.abs(mesh.positions).min(axis=1).max()
    assert corner == pytest.approx(0.5, abs=1e-5)
    assert len(mesh.indices) >= 6 * 4**3


def test_creases_and_boundaries_follow_the_file(tmp_path: Path) -> None:
    def write(stage: Usd.Stage) -> None:
        sharp = stages.cube(stage, "/sharp", "catmullClark")
        edges = [(0, 1), (1, 3), (3, 2), (2, 0), (4, 5), (5, 7), (7, 6), (6, 4)]
        edges += [(0, 4), (1, 5), (2, 6), (3, 7)]
        sharp.CreateCreaseIndicesAttr([v for edge in edges for v in edge])
        sharp.CreateCreaseLengthsAttr([2] * 12)
        sharp.CreateCreaseSharpnessesAttr([10.0] * 12)
        only = stages.mesh(stage, "/edge", scheme="catmullClark")
        only.CreateInterpolateBoundaryAttr("edgeOnly")
        stages.mesh(stage, "/corner", scheme="catmullClark")

    scene = _load(tmp_path, write)
    assert _area(_one(scene, "sharp")) == pytest.approx(24, rel=1e-5)
    assert _area(_one(scene, "corner")) == pytest.approx(4, rel=1e-5)
    assert _area(_one(scene, "edge")) < 3.6


def test_subsets_have_their_own_materials_and_the_rest_the_mesh_s(tmp_path: Path) -> None:
    def write(stage: Usd.Stage) -> None:
        made = stages.cube(stage, "/card")
        api = UsdShade.MaterialBindingAPI.Apply(made.GetPrim())
        for name, color, faces in (("a", (1, 0, 0), [0, 1]), ("b", (0, 1, 0), [1, 2, 5])):
            subset = api.CreateMaterialBindSubset(name, Vt.IntArray(faces))
            UsdShade.MaterialBindingAPI.Apply(subset.GetPrim()).Bind(_material(stage, name, color))
        api.Bind(_material(stage, "rest", (0, 0, 1)))

    scene = _load(tmp_path, write)
    areas = {}
    for i in scene.nodes["card"]:
        instance = scene.instances[i]
        color = scene.materials[instance.material].kind.base_color
        areas[tuple(round(c) for c in color)] = _area(scene.meshes[instance.mesh])
    assert areas == {(1, 0, 0): 8.0, (0, 1, 0): 8.0, (0, 0, 1): 8.0}


def _material(stage: Usd.Stage, name: str, color: Any) -> UsdShade.Material:
    made = UsdShade.Material.Define(stage, f"/Looks/{name}")
    shader = UsdShade.Shader.Define(stage, f"/Looks/{name}/s")
    shader.CreateIdAttr("UsdPreviewSurface")
    shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).Set(Gf.Vec3f(*color))
    made.CreateSurfaceOutput().ConnectToSource(shader.ConnectableAPI(), "surface")
    return made


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda m: m.CreateFaceVertexCountsAttr([5]),
            "wanted 5, the sum of faceVertexCounts, got 4",
        ),
        (lambda m: m.CreateFaceVertexCountsAttr([-4]), "faceVertexCounts: wanted at least 0"),
        (lambda m: m.CreateFaceVertexIndicesAttr([0, 1, 2, 9]), r"wanted 0 \.\. 3, got 9"),
        (lambda m: m.CreateFaceVertexIndicesAttr([0, 1, 2, -1]), r"wanted 0 \.\. 3, got -1"),
        (
            lambda m: m.CreatePointsAttr([(0, 0, 0), (1, 0, 0), (0, float("inf"), 0), (0, 0, 0)]),
            "points must be finite",
        ),
        (lambda m: m.CreatePointsAttr([(0, 0, 0)]), r"wanted 0 \.\. 0, got 3"),
    ],
)
@pytest.mark.parametrize("scheme", ["none", "catmullClark"])
def test_topologies_that_lie_are_refused(
    tmp_path: Path, change: Any, message: str, scheme: str
) -> None:
    with pytest.raises(dg.InputError, match=message) as caught:
        _load(tmp_path, lambda s: change(stages.mesh(s, "/card", scheme=scheme)))
    assert "/card" in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize("scheme", ["none", "catmullClark"])
@pytest.mark.parametrize(
    ("kind", "value"),
    [
        ("", None),
        ("point3f[]", Vt.Vec3fArray()),
        ("int[]", Vt.IntArray(12)),
        ("float[]", Vt.FloatArray(12)),
        ("int", 3),
        ("float3", Gf.Vec3f(1, 2, 3)),
    ],
)
def test_a_mesh_without_points_is_left_out(
    tmp_path: Path, scheme: str, kind: str, value: Any
) -> None:
    def write(stage: Usd.Stage) -> None:
        stages.mesh(stage, "/other")
        stages.mesh(stage, "/card", scheme=scheme).GetPrim().RemoveProperty("points")
        if kind:  # the schema's own type would be enforced above the layer
            card = stage.GetRootLayer().GetPrimAtPath("/card")
            made = Sdf.AttributeSpec(card, "points", Sdf.ValueTypeNames.Find(kind))
            made.default = value

    scene = _load(tmp_path, write)
    assert len(scene.instances) == 1
    assert "a mesh without points is left out (1 use)" in scene.warnings


def test_an_empty_mesh_is_no_note(tmp_path: Path) -> None:
    scene = _load(tmp_path, lambda s: stages.mesh(s, "/card", np.zeros((0, 3)), (), ()))
    assert not scene.instances
    assert scene.warnings == []


def test_creases_that_do_not_fit_are_refused(tmp_path: Path) -> None:
    def write(stage: Usd.Stage) -> None:
        made = stages.cube(stage, "/card", "catmullClark")
        made.CreateCreaseIndicesAttr([0, 99])
        made.CreateCreaseLengthsAttr([2])
        made.CreateCreaseSharpnessesAttr([1.0])

    with pytest.raises(dg.InputError, match="/card"):
        _load(tmp_path, write)


@pytest.mark.parametrize("scheme", ["none", "catmullClark"])
def test_points_over_time_move_and_travel(tmp_path: Path, scheme: str) -> None:
    def write(stage: Usd.Stage) -> None:
        made = stages.cube(stage, "/card", scheme)
        rest = np.array(stages.CUBE, np.float32)
        made.GetPointsAttr().Clear()
        made.GetPointsAttr().Set(stages.vectors(rest), 0)
        made.GetPointsAttr().Set(stages.vectors(rest * (1, 3, 1)), 24)

    scene = _load(tmp_path, write)
    assert pickle.loads(pickle.dumps(scene)) == scene
    heights = [np.ptp(_one(scene.at(t)).positions[:, 1]) for t in (0.0, 0.5, 1.0, 7.0)]
    assert np.allclose(np.array(heights) / heights[0], [1, 2, 3, 3], rtol=1e-5)
    if scheme != "none":  # normals follow
        moved = _one(scene.at(1.0))
        turned = _normals(moved)
        turned /= np.linalg.norm(turned, axis=1, keepdims=True)
        facing = np.einsum("ni,nki->nk", turned, moved.normals[moved.indices])
        assert facing.min() > 0.9


def test_one_mesh_serves_all_instances(tmp_path: Path) -> None:
    def write(stage: Usd.Stage) -> None:
        stages.cube(stage, "/Protos/P/card")
        for i in range(5):
            prim = stage.DefinePrim(f"/copy{i}", "Xform")
            prim.GetReferences().AddInternalReference("/Protos/P")
            prim.SetInstanceable(True)
            stages.place(prim, at=(3 * i, 0, 0))
        UsdGeom.Imageable(stage.GetPrimAtPath("/Protos")).MakeInvisible()

    stage = stages.new_stage(tmp_path / "x.usda")
    UsdGeom.Scope.Define(stage, "/Protos")
    write(stage)
    scene = dg.load(stages.save(stage))
    assert (len(scene.meshes), len(scene.instances)) == (1, 5)
    assert np.allclose(scene.node_positions["copy4"], (12, 0, 0))
    assert scene.nodes["copy4"] == scene.nodes["copy4/card"]


@pytest.mark.parametrize("interpolation", ["faceVarying", "vertex"])
def test_a_shape_that_is_needed_again_is_the_same(tmp_path: Path, interpolation: str) -> None:
    """Two choices of one mesh, with another mesh in between: it is read and noted once."""
    stage = stages.new_stage(tmp_path / "x.usda")
    sizes, corners = [4] * 6 + [2], [*stages.CUBE_FACES, 0, 1]
    made = stages.mesh(stage, "/a", stages.CUBE, sizes, corners, "catmullClark")
    uv = np.random.default_rng(1).random((26 if interpolation == "faceVarying" else 8, 2))
    stages.primvar(made, "st", uv, interpolation)
    other = stages.cube(stage, "/b", "catmullClark")
    scene, notes, reads = dg.Scene(), Notes(), []
    meshes = Meshes(scene, Clock("f", 24.0, 0.0), 12, notes)

    def index(prim: Any, *uv_sets: str) -> Any:
        def read() -> Any:
            reads.append(prim.GetPath())
            points = np.array(UsdGeom.Mesh(prim).GetPointsAttr().Get(), np.float32)
            return points, points

        choice = Choice("", uv_sets, False)
        return scene.meshes[meshes.index(str(prim.GetPath()), prim, read, choice)]

    with closing(meshes):
        first, _, again = index(made.GetPrim(), "st"), index(other.GetPrim()), index(made.GetPrim())
    assert [str(path) for path in reads] == ["/a", "/b"]
    assert notes.sentences() == ["a face of fewer than three corners is left out (1 use)"]
    assert first.uv is not None
    assert again.uv is None
    for name in ("positions", "normals"):
        corners_of = [getattr(one, name)[one.indices] for one in (first, again)]
        assert np.array_equal(*corners_of)
