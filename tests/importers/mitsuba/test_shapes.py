"""Shapes have Mitsuba's points, normals and texture coordinates; groups and instances."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg

from .peer import peer
from .scene_files import loaded, written

TURN = (
    '<transform name="to_world"><scale value="{scale}"/><rotate y="1" angle="35"/>'
    '<rotate x="1" angle="-20"/><translate x="0.5" y="2" z="-1"/></transform>'
)
CARVED = {
    "sphere": '<point name="center" value="1 2 3"/><float name="radius" value="0.5"/>',
    "cylinder": '<point name="p0" value="0 1 0"/><point name="p1" value="1 1 3"/>'
    '<float name="radius" value="0.25"/>',
}


def _shape(plugin: str, inner: str = "", scale: str = "1.5") -> str:
    return f'<shape type="{plugin}" id="it">{inner}{TURN.format(scale=scale)}</shape>'


def _vertices(scene: dg.Scene) -> tuple[Any, Any, Any]:
    """Points, normals and texture coordinates in the world."""
    (index,) = scene.nodes["it"]
    instance = scene.instances[index]
    mesh, world = scene.meshes[instance.mesh], instance.transform
    points = mesh.positions @ world[:3, :3].T + world[:3, 3]
    assert mesh.normals is not None
    normals = mesh.normals @ np.linalg.inv(world[:3, :3])
    return points, normals / np.linalg.norm(normals, axis=1, keepdims=True), mesh.uv


def _agrees(path: Path, scene: dg.Scene, *, mirrored: bool = False) -> None:
    """Compares with rays of Mitsuba against the middles of triangles, along their normals.

    Mitsuba 3.9.1 turns mirrored meshes without normals inside out; later versions do not.
    """
    mitsuba = peer()
    there = mitsuba.load_file(str(path), parallel=False)
    points, normals, uv = _vertices(scene)
    triangles = scene.meshes[scene.instances[scene.nodes["it"][0]].mesh].indices
    inside = np.array([0.5, 0.3, 0.2])
    for three in triangles[:: max(len(triangles) // 60, 1)]:
        point, normal = inside @ points[three], inside @ normals[three]
        normal /= np.linalg.norm(normal)
        ray = mitsuba.Ray3f((point + 1e-1 * normal).tolist(), (-normal).tolist())
        found = there.ray_intersect(ray)
        assert found.is_valid()
        assert np.linalg.norm(np.array(found.p) - point) < 2e-3
        cosine = np.array(found.sh_frame.n) @ normal
        assert (abs(cosine) if mirrored else cosine) > 1 - 1e-3
        assert np.allclose(np.array(found.uv), inside @ uv[three], atol=6e-3)


@pytest.mark.parametrize("plugin", ["sphere", "rectangle", "disk", "cylinder", "cube"])
@pytest.mark.parametrize("variant", ["plain", "carved", "flipped"])
def test_solids_are_those_of_mitsuba(plugin: str, variant: str, tmp_path: Path) -> None:
    inner = CARVED.get(plugin, "") if variant == "carved" else ""
    if variant == "flipped":
        inner = '<boolean name="flip_normals" value="true"/>'
    path = written(tmp_path, _shape(plugin, inner))
    _agrees(path, dg.load(path))


@pytest.mark.parametrize("inner", ["", '<boolean name="flip_normals" value="true"/>'])
def test_a_mirrored_sphere_points_inward_as_in_mitsuba(inner: str, tmp_path: Path) -> None:
    path = written(tmp_path, _shape("sphere", inner, scale="-1.5, 1.5, 1.5"))
    _agrees(path, dg.load(path))


_OBJ = """
v -1 -1 0
v 1 -1 0
v 1 1 0.5
v -1 1 0
vt 0 0
vt 1 0
vt 1 0.5
vt 0 1
f 1/1 2/2 3/3
f 1/1 3/3 4/4
"""


@pytest.mark.parametrize(
    "flags", [{}, {"flip_tex_coords": "false"}, {"face_normals": "true"}, {"flip_normals": "true"}]
)
@pytest.mark.parametrize("scale", ["2", "-1, 1, 1"])
def test_meshes_of_files_are_those_of_mitsuba(
    flags: dict[str, str], scale: str, tmp_path: Path
) -> None:
    (tmp_path / "a.obj").write_text(_OBJ)
    inner = '<string name="filename" value="a.obj"/>' + "".join(
        f'<boolean name="{name}" value="{value}"/>' for name, value in flags.items()
    )
    path = written(tmp_path, _shape("obj", inner, scale))
    scene = dg.load(path)
    if "face_normals" in flags:
        assert scene.meshes[0].normals is None
        return
    _agrees(path, scene, mirrored=scale.startswith("-"))


def test_files_are_read_once(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text(_OBJ)
    one = '<shape type="obj"><string name="filename" value="a.obj"/></shape>'
    assert len(loaded(tmp_path, one * 5).meshes) == 1


def test_groups_are_placed_by_their_instances_alone(tmp_path: Path) -> None:
    group = (
        '<shape type="shapegroup" id="g"><shape type="sphere">'
        '<transform name="to_world"><translate x="1"/></transform></shape>'
        '<shape type="cube"/></shape>'
    )
    instance = (
        '<shape type="instance" id="{}"><ref id="g"/><transform name="to_world">'
        '<scale value="2"/><translate y="{}"/></transform></shape>'
    )
    scene = loaded(tmp_path, group, instance.format("a", 5), instance.format("b", 7))
    assert len(scene.meshes) == 2
    assert [len(scene.nodes[name]) for name in "ab"] == [2, 2]
    ball = scene.instances[scene.nodes["b"][0]].transform
    assert np.allclose(ball @ (0, 0, 0, 1), (2, 7, 0, 1))
    assert not loaded(tmp_path, group).instances
    for part, wrong in {
        '<shape type="instance"/>': "a reference to a shape group",
        '<shape type="instance"><shape type="cube"/></shape>': "a shape group, got a shape 'cube'",
    }.items():
        with pytest.raises(dg.InputError, match=wrong):
            loaded(tmp_path, part)


def test_nodes_have_names_of_their_own(tmp_path: Path) -> None:
    scene = loaded(tmp_path, '<shape type="cube"/>' * 3, '<shape type="disk" id="cube.2"/>')
    assert set(scene.nodes) == {"cube", "cube.2", "cube.3", "cube.2.2"}


def test_a_unit_scales_lengths_and_intensities(tmp_path: Path) -> None:
    parts = (
        _shape("cube"),
        '<emitter type="point"><point name="position" x="100"/>'
        '<rgb name="intensity" value="10000"/></emitter>',
    )
    scene = loaded(tmp_path, *parts, unit_m=0.01)
    points, _, _ = _vertices(scene)
    assert np.allclose(points, _vertices(loaded(tmp_path, *parts))[0] / 100, atol=1e-6)
    light, pose = scene.lights[0]
    assert isinstance(light, dg.PointLight)
    assert np.allclose(light.intensity, 1)
    assert np.allclose(pose[:3, 3], (1, 0, 0))
    with pytest.raises(dg.UsageError, match="unit_m: wanted"):
        loaded(tmp_path, *parts, unit_m=0)


def test_curves(tmp_path: Path) -> None:
    (tmp_path / "hair.txt").write_text("0 0 0 1\n1 0 0 1\n2 0 0 2\n3 0 0 1\n\n\n0 1 0 1\n0 2 0 1\n")
    body = '<shape type="{}" id="it"><string name="filename" value="hair.txt"/>{}</shape>'
    turn = '<transform name="to_world"><scale value="2"/></transform>'
    scene = loaded(tmp_path, body.format("linearcurve", turn), unit_m=0.1)
    curves = scene.meshes[0]
    assert np.allclose(curves.positions[:4, 0], (0, 0.2, 0.4, 0.6))
    assert np.allclose(curves.radii[:4], (0.1, 0.1, 0.2, 0.1))  # type: ignore[attr-defined]
    with pytest.raises(dg.InputError, match="curves of at least 4 points, got 2"):
        loaded(tmp_path, body.format("bsplinecurve", ""))
    (tmp_path / "hair.txt").write_text("0 0 0 1\n1 0 x 1\n")
    with pytest.raises(
        dg.InputError, match=r"hair\.txt: line 2: wanted four numbers: x y z radius"
    ):
        loaded(tmp_path, body.format("linearcurve", ""))


def test_a_cylinder_needs_a_length_and_an_unknown_shape_is_noted(tmp_path: Path) -> None:
    with pytest.raises(dg.InputError, match="the two points must differ"):
        loaded(tmp_path, '<shape type="cylinder"><point name="p1" value="0 0 0"/></shape>')
    notes = loaded(tmp_path, '<shape type="sdfgrid"/>').warnings
    assert "a shape 'sdfgrid' is left out (1 use)" in notes


def test_colours_of_meshes_are_reflectances(tmp_path: Path) -> None:
    (tmp_path / "a.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nproperty float color_0\nproperty float color_1\n"
        "property float color_2\nelement face 2\nproperty list uchar int vertex_indices\n"
        "property float r\nproperty float g\nproperty float b\nend_header\n"
        "0 0 0 1 0 0\n1 0 0 0 1 0\n1 1 0 0 0 1\n0 1 0 1 1 1\n"
        "3 0 1 2 0.1 0.2 0.3\n3 0 2 3 0.4 0.5 0.6\n"
    )
    body = (
        '<shape type="ply"><string name="filename" value="a.ply"/><bsdf type="diffuse">'
        '<texture type="mesh_attribute" name="reflectance"><string name="name" value="{}"/>'
        "</texture></bsdf></shape>"
    )
    scene = loaded(tmp_path, body.format("vertex_color"))
    assert scene.materials[0].kind == dg.Diffuse((1, 1, 1))
    colors = scene.meshes[0].colors
    assert colors is not None
    assert np.allclose(colors[:, :3], [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)])
    by_face = loaded(tmp_path, body.format("face_color")).meshes[0]
    assert by_face.colors is not None
    for three, color in zip(by_face.indices, ((0.1, 0.2, 0.3), (0.4, 0.5, 0.6)), strict=True):
        assert np.allclose(by_face.colors[three, :3], color)
    other = loaded(tmp_path, body.format("face_weight"))
    assert "the attribute 'face_weight' of a mesh is left out (1 use)" in other.warnings


@pytest.mark.parametrize("quad", ["f 1//1 2//1 3//1 4//1", "f 1//1 2//1 3//1\nf 1//1 3//1 4//1"])
@pytest.mark.parametrize("flat", [False, True])
def test_normals_of_a_file_say_what_the_front_is(quad: str, flat: bool, tmp_path: Path) -> None:
    """A lamp whose corners run against its normals shines along these, as in Mitsuba."""
    lines = "v -1 -1 0\nv -1 1 0\nv 1 1 0\nv 1 -1 0\nvn 0 0 1\n"
    (tmp_path / "a.obj").write_text(lines + quad + "\n")
    inner = '<string name="filename" value="a.obj"/>' + (
        '<boolean name="face_normals" value="true"/>' if flat else ""
    )
    lamp = '<emitter type="area"><rgb name="radiance" value="1 1 1"/></emitter>'
    scene = loaded(tmp_path, f'<shape type="obj">{inner}{lamp}</shape>')
    scene.add_camera("a", dg.Camera(transform=dg.look_at((0, 0, 5), (0, 0, 0)), lens="pinhole"))
    frame = dg.render(scene, "a", resolution=(16, 16), spp=256)
    assert frame.rgb[6:10, 6:10].mean() == pytest.approx(0.0 if flat else 1.0, rel=0.02)
