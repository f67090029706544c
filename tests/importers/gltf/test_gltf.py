"""glTF: meshes, accessors, nodes, scenes; exact numbers from files made here."""

from __future__ import annotations

import json
import math
import struct
import time

import numpy as np
import pytest

from daguerre.checks import as_readonly
from daguerre.errors import InputError, UsageError
from daguerre.importers.gltf import reader as gltf
from tests.support.formats.make_gltf import CORNERS, Builder, glb_bytes, triangle

FAR = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 2, 0], [1, 2, 0]]


def test_triangle_in_every_container(tmp_path):
    (tmp_path / "a b.bin").touch()
    for path in (
        triangle().glb(tmp_path / "a.glb"),
        triangle().gltf(tmp_path / "data.gltf"),
        triangle().gltf(tmp_path / "file.gltf", "a b.bin"),
    ):
        scene = gltf.read(path, time=0.25)
        assert scene.path == path
        assert scene.time == 0.25
        assert scene.meshes[0].positions.tolist() == CORNERS
        assert scene.meshes[0].positions.dtype == np.float32
        assert scene.meshes[0].indices.tolist() == [[0, 1, 2]]
        assert scene.meshes[0].normals is None
        assert scene.nodes == {"tri": [0]}
        assert scene.node_positions["tri"].tolist() == [0, 0, 0]
        assert scene.warnings == []


def test_arrays_are_ready_for_the_core_to_read_in_place(tmp_path):
    scene = gltf.read(triangle().glb(tmp_path / "a.glb"))
    for values in (scene.meshes[0].positions, scene.meshes[0].indices):
        assert as_readonly(values) is values


def test_percent_encoded_name_and_query_free_data_uri(tmp_path):
    b = triangle()
    path = b.gltf(tmp_path / "a.gltf", "my mesh.bin")
    path.write_text(path.read_text().replace("my mesh.bin", "my%20mesh.bin"))
    assert len(gltf.read(path).meshes) == 1
    document = b.document()
    raw = "".join(f"%{byte:02x}" for byte in b.binary)
    document["buffers"][0]["uri"] = "data:application/octet-stream," + raw
    path.write_text(json.dumps(document))
    assert gltf.read(path).meshes[0].positions.tolist() == CORNERS


def test_backslash_is_a_separator_and_stays_inside(tmp_path):
    (tmp_path / "sub").mkdir()
    path = triangle().gltf(tmp_path / "a.gltf", "sub/mesh.bin")
    path.write_text(path.read_text().replace("sub/mesh.bin", "sub\\\\mesh.bin"))
    assert len(gltf.read(path).meshes) == 1


@pytest.mark.parametrize(
    ("mode", "indices", "wanted"),
    [
        (4, None, [[0, 1, 2], [3, 4, 5]]),
        (4, [2, 1, 0], [[2, 1, 0]]),
        (5, None, [[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]]),
        (5, [0, 1, 2, 2, 3, 3, 4, 5], [[0, 1, 2], [3, 5, 4]]),
        (6, None, [[1, 2, 0], [2, 3, 0], [3, 4, 0], [4, 5, 0]]),
        (6, [5, 1, 2, 3], [[1, 2, 5], [2, 3, 5]]),
    ],
)
def test_modes(tmp_path, mode, indices, wanted):
    b = Builder()
    extra = {} if indices is None else {"indices": b.accessor(indices, "u1")}
    b.node(mesh=b.mesh({"POSITION": b.accessor(FAR)}, mode=mode, **extra))
    mesh = gltf.read(b.glb(tmp_path / "a.glb")).meshes[0]
    assert mesh.indices.tolist() == wanted


def test_strip_winds_all_triangles_alike(tmp_path):
    b = Builder()
    b.node(mesh=b.mesh({"POSITION": b.accessor(FAR)}, mode=5))
    mesh = gltf.read(b.glb(tmp_path / "a.glb")).meshes[0]
    p = mesh.positions[mesh.indices]
    assert (np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])[:, 2] > 0).all()


def test_other_modes_are_counted(tmp_path):
    b = triangle()
    position = b.accessor(CORNERS)
    for mode in (0, 1, 1, 3):
        b.node(mesh=b.mesh({"POSITION": position}, mode=mode))
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    assert len(scene.meshes) == 1
    assert scene.warnings == [
        "a mesh primitive of points is left out (1 use)",
        "a mesh primitive of lines is left out (2 uses)",
        "a mesh primitive of a line strip is left out (1 use)",
    ]


@pytest.mark.parametrize("dtype", ["u1", "u2", "u4"])
def test_index_types(tmp_path, dtype):
    b = Builder()
    b.node(mesh=b.mesh({"POSITION": b.accessor(CORNERS)}, indices=b.accessor([0, 2, 1], dtype)))
    assert gltf.read(b.glb(tmp_path / "a.glb")).meshes[0].indices.tolist() == [[0, 2, 1]]


@pytest.mark.parametrize(
    ("dtype", "values", "wanted"),
    [
        ("f4", [[0.5, 0.25, 2, 1]], [0.5, 0.25, 2, 1]),
        ("u1", [[255, 51, 0, 255]], [1, 0.2, 0, 1]),
        ("u2", [[65535, 13107, 0, 65535]], [1, 0.2, 0, 1]),
        ("f4", [[0.5, 0.25, 2]], [0.5, 0.25, 2, 1]),
        ("u1", [[255, 51, 0]], [1, 0.2, 0, 1]),
        ("u2", [[65535, 13107, 0]], [1, 0.2, 0, 1]),
    ],
)
def test_vertex_colors(tmp_path, dtype, values, wanted):
    b = Builder()
    color = b.accessor(values * 3, dtype, normalized=dtype != "f4")
    b.node(mesh=b.mesh({"POSITION": b.accessor(CORNERS), "COLOR_0": color}))
    colors = gltf.read(b.glb(tmp_path / "a.glb")).meshes[0].colors
    assert colors == pytest.approx(np.array([wanted] * 3))


def test_every_attribute(tmp_path):
    b = Builder()
    b.node(
        mesh=b.mesh(
            {
                "POSITION": b.accessor(CORNERS),
                "NORMAL": b.accessor([[0, 0, 2], [0, 3, 0], [1, 0, 0]]),
                "TANGENT": b.accessor([[2, 0, 0, 1], [0, 1, 0, -1], [0, 0, 5, 1]]),
                "TEXCOORD_0": b.accessor([[0, 0], [1, 0], [0, 1]]),
                "TEXCOORD_1": b.accessor([[0, 0], [255, 51], [0, 255]], "u1", normalized=True),
                "TEXCOORD_2": b.accessor([[0, 0], [1, 0], [0, 1]]),
                "_TEMPERATURE": b.accessor([1, 2, 3]),
            }
        )
    )
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    mesh = scene.meshes[0]
    assert mesh.normals.tolist() == [[0, 0, 1], [0, 1, 0], [1, 0, 0]]
    assert mesh.tangents.tolist() == [[1, 0, 0, 1], [0, 1, 0, -1], [0, 0, 1, 1]]
    assert mesh.uv.tolist() == [[0, 0], [1, 0], [0, 1]]
    assert mesh.uv1 == pytest.approx(np.array([[0, 0], [1, 0.2], [0, 1]]))
    assert scene.warnings == ["mesh attribute 'TEXCOORD_2' is not used (1 use)"]


def test_quantized_attributes(tmp_path):
    b = Builder()
    b.json["extensionsRequired"] = b.json["extensionsUsed"] = ["KHR_mesh_quantization"]
    b.node(
        mesh=b.mesh(
            {
                "POSITION": b.accessor([[0, 0, 0], [100, 0, 0], [0, 200, -5]], "i2"),
                "NORMAL": b.accessor(
                    [[0, 0, 127], [0, -128, 0], [90, 0, 90]], "i1", normalized=True
                ),
                "TEXCOORD_0": b.accessor([[0, 0], [7, 0], [0, 9]], "u2"),
            }
        )
    )
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    mesh = scene.meshes[0]
    assert mesh.positions.tolist() == [[0, 0, 0], [100, 0, 0], [0, 200, -5]]
    assert mesh.normals == pytest.approx(
        np.array([[0, 0, 1], [0, -1, 0], [math.sqrt(0.5), 0, math.sqrt(0.5)]])
    )
    assert mesh.uv.tolist() == [[0, 0], [7, 0], [0, 9]]
    assert scene.warnings == []


def test_interleaved_with_stride_and_offset(tmp_path):
    b = Builder()
    rows = [(*p, *n, u) for p, n, u in zip(CORNERS, [[0, 0, 1]] * 3, [10, 20, 30], strict=True)]
    data = b"\xff" * 8 + b"".join(struct.pack("<6fHxx", *row) for row in rows)
    view = b.view(data, byteStride=28)
    common = {"bufferView": view, "componentType": 5126, "count": 3, "type": "VEC3"}
    position = b.add("accessors", common | {"byteOffset": 8})
    normal = b.add("accessors", common | {"byteOffset": 20})
    corners = b.add(
        "accessors",
        {
            "bufferView": b.view(struct.pack("<BxxxBxxxB", 2, 0, 1), byteStride=4),
            "componentType": 5121,
            "count": 3,
            "type": "SCALAR",
        },
    )
    b.node(mesh=b.mesh({"POSITION": position, "NORMAL": normal}, indices=corners))
    mesh = gltf.read(b.glb(tmp_path / "a.glb")).meshes[0]
    assert mesh.positions.tolist() == CORNERS
    assert mesh.normals.tolist() == [[0, 0, 1]] * 3
    assert mesh.indices.tolist() == [[2, 0, 1]]


@pytest.mark.parametrize("dtype", ["u1", "u2", "u4"])
@pytest.mark.parametrize("base", [True, False])
def test_sparse(tmp_path, dtype, base):
    b = Builder()
    sparse = {
        "count": 2,
        "indices": {
            "bufferView": b.view(np.array([1, 3], "<" + dtype).tobytes()),
            "componentType": {"u1": 5121, "u2": 5123, "u4": 5125}[dtype],
        },
        "values": {"bufferView": b.view(struct.pack("<6f", 7, 8, 9, 4, 5, 6))},
    }
    if base:
        position = b.accessor(FAR, sparse=sparse)
    else:
        position = b.add(
            "accessors", {"componentType": 5126, "count": 6, "type": "VEC3", "sparse": sparse}
        )
    b.node(mesh=b.mesh({"POSITION": position}))
    wanted = np.array(FAR if base else np.zeros((6, 3)), np.float32)
    wanted[[1, 3]] = [[7, 8, 9], [4, 5, 6]]
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    assert scene.meshes[0].positions.tolist() == wanted.tolist()


def test_accessor_without_buffer_view_is_zeros(tmp_path):
    b = triangle()
    zeros = b.add("accessors", {"componentType": 5126, "count": 3, "type": "VEC2"})
    b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = zeros
    assert gltf.read(b.glb(tmp_path / "a.glb")).meshes[0].uv.tolist() == [[0, 0]] * 3


def test_normals_of_length_zero_become_face_normals(tmp_path):
    b = Builder()
    normal = b.accessor([[0, 0, 0], [0, 1, 0], [0, 0, 0]])
    b.node(mesh=b.mesh({"POSITION": b.accessor(CORNERS), "NORMAL": normal}))
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    assert scene.meshes[0].normals.tolist() == [[0, 0, 1], [0, 1, 0], [0, 0, 1]]
    assert scene.warnings == ["a vertex normal of length 0 is replaced (2 uses)"]


def test_tangents_of_length_zero_are_dropped(tmp_path):
    b = Builder()
    tangent = b.accessor([[1, 0, 0, 1], [0, 0, 0, 1], [1, 0, 0, 1]])
    b.node(mesh=b.mesh({"POSITION": b.accessor(CORNERS), "TANGENT": tangent}))
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    assert scene.meshes[0].tangents is None
    assert "tangents of length 0" in scene.warnings[0]


def test_one_mesh_three_instances(tmp_path):
    b = triangle()
    b.node(mesh=0, name="second", translation=[1, 2, 3])
    b.add("meshes", {"primitives": b.json["meshes"][0]["primitives"]})
    b.node(mesh=1, name="third")
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    assert len(scene.meshes) == 1
    assert [i.mesh for i in scene.instances] == [0, 0, 0]
    assert [i.name for i in scene.instances] == ["tri", "second", "third"]
    assert scene.instances[1].transform[:3, 3].tolist() == [1, 2, 3]


def test_several_primitives_of_a_mesh(tmp_path):
    b = triangle()
    b.json["materials"] = [{"name": "red"}]
    b.json["meshes"][0]["name"] = "pair"
    b.json["meshes"][0]["primitives"].append(
        {"attributes": {"POSITION": b.accessor(FAR)}, "material": 0}
    )
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    assert [m.name for m in scene.meshes] == ["pair/0", "pair/1"]
    assert [scene.materials[i.material].name for i in scene.instances] == ["default", "red"]
    assert scene.nodes["tri"] == [0, 1]


def test_hierarchy_with_trs_and_matrix(tmp_path):
    b = triangle()
    half = math.sqrt(0.5)
    leaf = b.child(mesh=0, name="leaf", scale=[2, 3, 4])
    turned = b.child(children=[leaf], rotation=[0, 0, half, half], name="turned")
    matrix = np.eye(4)
    matrix[:3, 3] = (10, 20, 30)
    b.node(children=[turned], matrix=matrix.T.ravel().tolist(), name="top")
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    # Quarter turn about z of diag(2, 3, 4), then the shift.
    wanted = [[0, -3, 0, 10], [2, 0, 0, 20], [0, 0, 4, 30], [0, 0, 0, 1]]
    assert scene.instances[1].transform == pytest.approx(np.array(wanted), abs=1e-12)
    assert scene.nodes == {"tri": [0], "top": [1], "turned": [1], "leaf": [1]}
    assert scene.node_positions["leaf"].tolist() == [10, 20, 30]


def test_nodes_hold_their_descendants(tmp_path):
    b = triangle()
    leaves = [b.child(mesh=0, name=f"leaf{i}") for i in range(3)]
    mid = b.child(mesh=0, name="mid", children=leaves[:2])
    b.node(name="top", children=[mid, leaves[2]])
    b.node(mesh=0, name="alone")
    nodes = gltf.read(b.glb(tmp_path / "a.glb")).nodes
    assert nodes["top"] == [1, 2, 3, 4]
    assert nodes["mid"] == [1, 2, 3]
    assert nodes["leaf1"] == [3]
    assert nodes["leaf2"] == [4]
    assert nodes["alone"] == [5]


def test_duplicate_and_missing_names(tmp_path):
    b = triangle()
    for name in ("tri", "tri", "tri.001"):
        b.node(mesh=0, name=name)
    b.json["meshes"][0]["name"] = "leaf"
    b.node(mesh=0)
    b.node()
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    names = ["tri", "tri.001", "tri.002", "tri.001.001", "leaf", "node5"]
    assert list(scene.nodes) == names
    assert list(scene.node_positions) == names


def test_names_are_printable(tmp_path):
    b = triangle()
    b.json["nodes"][0]["name"] = "a\x1b[31m\ud800b\n"
    (name,) = gltf.read(b.glb(tmp_path / "a.glb")).nodes
    assert name == "a\ufffd[31m\ufffdb\ufffd"
    name.encode()


def test_several_scenes(tmp_path):
    b = triangle()
    b.json["scenes"].append({"nodes": [b.child(mesh=0, name="other")]})
    path = b.glb(tmp_path / "a.glb")
    assert list(gltf.read(path).nodes) == ["tri"]
    assert list(gltf.read(path, scene_index=1).nodes) == ["other"]
    b.json["scene"] = 1
    assert list(gltf.read(b.glb(path)).nodes) == ["other"]
    with pytest.raises(InputError, match=r"scenes: wanted an index in 0 \.\. 1, got 2"):
        gltf.read(path, scene_index=2)


def test_no_scenes_shows_all_roots(tmp_path):
    b = triangle()
    del b.json["scenes"], b.json["scene"]
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    assert len(scene.instances) == 1
    assert scene.warnings == ["the file has no scene: all nodes are shown (1 use)"]


def test_what_is_sheared_flat_stands_in_the_world(tmp_path):
    b = triangle()
    columns = [(1, 0, 0, 0), (0, 1, 0, 0), (1e9, 0, 1, 0), (0, 0, 0, 1)]
    b.node(mesh=0, name="sheared", matrix=[number for column in columns for number in column])
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    (sheared,) = (one for one in scene.instances if one.name == "sheared")
    assert np.array_equal(sheared.transform, np.eye(4))
    assert scene.meshes[sheared.mesh].positions.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    assert not scene.warnings


def test_scaled_to_nothing_is_hidden_and_flat_is_kept(tmp_path):
    b = triangle()
    b.node(mesh=0, name="hidden", scale=[0, 0, 0])
    b.node(mesh=0, name="shadow", scale=[2, 0, 1], translation=[0, 5, 0])
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    assert scene.nodes == {"tri": [0], "hidden": [], "shadow": [1]}
    flat = scene.instances[1]
    assert np.array_equal(flat.transform, np.eye(4))
    assert scene.meshes[flat.mesh].positions.tolist() == [[0, 5, 0], [2, 5, 0], [0, 5, 0]]
    assert scene.warnings == ["a mesh that its node scales to zero is left out (1 use)"]


def test_mirrored_transform_is_kept(tmp_path):
    b = triangle()
    b.node(mesh=0, name="mirror", scale=[-1, 1, 1])
    transform = gltf.read(b.glb(tmp_path / "a.glb")).instances[1].transform
    assert transform.tolist() == np.diag([-1, 1, 1, 1]).tolist()


def test_optional_unknown_extensions_are_counted(tmp_path):
    b = triangle()
    b.json["extensionsUsed"] = ["VENDOR_materials_felt", "KHR_lights_punctual", "VENDOR_x"]
    felt = {"extensions": {"VENDOR_materials_felt": {}, "KHR_materials_ior": {}}}
    b.json["materials"] = [felt, felt, {"extensions": {"NOT_listed": {}}}]
    assert gltf.read(b.glb(tmp_path / "a.glb")).warnings == [
        "extension 'VENDOR_materials_felt' is not supported (2 uses)",
        "extension 'VENDOR_x' is not supported (0 uses)",
        "extension 'NOT_listed' is not supported (1 use)",
    ]


def test_trailing_bytes_and_unknown_chunks_are_forgiven(tmp_path):
    path = triangle().glb(tmp_path / "a.glb")
    data = path.read_bytes()
    extra = struct.pack("<I4s", 4, b"XTRA") + b"1234"
    data = data[:8] + struct.pack("<I", len(data) + len(extra)) + data[12:] + extra
    path.write_bytes(data + b"junk")
    scene = gltf.read(path)
    assert len(scene.meshes) == 1
    assert scene.warnings == ["a byte after the stated end of the file (4 uses)"]


def chain(depth: int) -> Builder:
    b = triangle()
    nodes = [{"children": [i + 2]} for i in range(depth)] + [{"mesh": 0, "name": "end"}]
    nodes[0]["name"] = "top"
    b.json["nodes"] = [b.json["nodes"][0], *nodes]
    b.json["scenes"] = [{"nodes": [0, 1]}]
    return b


def test_deep_and_wide_trees_are_quick(tmp_path):
    start = time.perf_counter()
    scene = gltf.read(chain(100_000).glb(tmp_path / "a.glb"))
    assert scene.nodes["top"] == scene.nodes["end"] == [1]
    # A chain of meshes would need depth^2 / 2 entries.
    b = chain(5000)
    for node in b.json["nodes"]:
        node["mesh"] = 0
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    assert len(scene.instances) == 5002
    assert scene.nodes["end"] == [5001]
    assert "selects its own meshes only" in scene.warnings[-1]
    assert time.perf_counter() - start < 60


def test_time_must_be_finite(tmp_path):
    with pytest.raises(UsageError, match="time: wanted a finite number"):
        gltf.read(triangle().glb(tmp_path / "a.glb"), time=math.nan)


def test_glb_bytes_helper_is_what_the_reader_expects(tmp_path):
    (tmp_path / "a.glb").write_bytes(glb_bytes(b'{"asset":{"version":"2.0"}}'))
    assert gltf.read(tmp_path / "a.glb").instances == []
