"""PLY files: text and both byte orders, polygons, names of values, lies and bombs."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.color.srgb import to_linear
from daguerre.files.notes import Notes
from daguerre.importers import file_bytes
from daguerre.importers.meshes import ply, text_numbers
from daguerre.importers.meshes.file_mesh import FileMesh
from tests.support.formats import mesh_files as write

#: A pyramid of a quadrangle and triangles.
POINTS = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1)], np.float32)
FACES = [(3, 2, 1, 0), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
COLUMNS = dict(zip("xyz", POINTS.T, strict=True))


def read(tmp_path: Path, data: bytes, notes: Notes | None = None) -> FileMesh:
    path = tmp_path / "mesh.ply"
    path.write_bytes(data)
    return ply.read(path, Notes() if notes is None else notes)


def faces_of(mesh: FileMesh) -> list[tuple[int, ...]]:
    sizes = np.full(len(mesh.corners) // 3, 3) if mesh.sizes is None else mesh.sizes
    return [tuple(one.tolist()) for one in np.split(mesh.corners, np.cumsum(sizes)[:-1])]


@pytest.mark.parametrize("order", ["", "<", ">"])
@pytest.mark.parametrize(
    ("length", "index"), [("u1", "i4"), ("i4", "u4"), ("u2", "u2"), ("i1", "i1")]
)
def test_polygons_in_every_byte_order(tmp_path: Path, order: str, length: str, index: str) -> None:
    mesh = read(tmp_path, write.ply(COLUMNS, FACES, order, length=length, index=index))
    np.testing.assert_array_equal(mesh.positions, POINTS)
    assert faces_of(mesh) == FACES
    assert mesh.normals is mesh.uv is mesh.colors is None
    assert "5 vertices, 5 faces" in repr(mesh)


@pytest.mark.parametrize("order", ["", "<", ">"])
@pytest.mark.parametrize("name", ["vertex_index", "vertex_indices"])
def test_triangles_alone_have_no_sizes(tmp_path: Path, order: str, name: str) -> None:
    mesh = read(tmp_path, write.ply(COLUMNS, FACES[1:], order, name=name))
    assert mesh.sizes is None
    assert faces_of(mesh) == FACES[1:]


@pytest.mark.parametrize("order", ["", "<", ">"])
@pytest.mark.parametrize("names", ["u v", "s t", "texture_u texture_v", "texture_s texture_t"])
def test_normals_and_texture_coordinates(tmp_path: Path, order: str, names: str) -> None:
    rng = np.random.default_rng(1)
    normals, uv = rng.normal(size=(5, 3)), rng.random((5, 2))
    columns = {
        "other": POINTS[:, 0],
        **COLUMNS, **dict(zip(("nx", "ny", "nz"), normals.T, strict=True)),
        **dict(zip(names.split(), uv.T, strict=True)),
    }  # fmt: skip
    notes = Notes()
    mesh = read(tmp_path, write.ply(columns, FACES, order, kinds={"x": "f8", "nx": "f8"}), notes)
    np.testing.assert_array_equal(mesh.positions, POINTS)
    np.testing.assert_allclose(mesh.normals, normals, rtol=1e-6)
    np.testing.assert_allclose(mesh.uv, uv, rtol=1e-6)
    assert len(notes.sentences()) == 1
    assert "of vertices of a PLY file is not used (1 use)" in notes.sentences()[0]


@pytest.mark.parametrize("order", ["", "<", ">"])
def test_colours_of_bytes_are_srgb_and_of_floats_linear(tmp_path: Path, order: str) -> None:
    red = np.array([0, 64, 128, 192, 255])
    columns = COLUMNS | {"red": red, "green": red[::-1], "blue": 0 * red, "alpha": red}
    kinds = dict.fromkeys(("red", "green", "blue", "alpha"), "u1")
    colors = read(tmp_path, write.ply(columns, FACES, order, kinds=kinds)).colors
    assert colors is not None
    np.testing.assert_allclose(colors[:, 0], to_linear(red / 255), rtol=1e-5)
    np.testing.assert_allclose(colors[:, 3], red / 255, rtol=1e-6)
    plain = COLUMNS | {"r": red / 255, "g": red / 255, "b": red / 255}
    colors = read(tmp_path, write.ply(plain, FACES, order)).colors
    assert colors is not None
    np.testing.assert_allclose(colors, np.repeat(red[:, None] / 255, 3, axis=1), rtol=1e-6)


@pytest.mark.parametrize("order", ["", "<", ">"])
def test_texture_coordinates_of_corners_part_vertices(tmp_path: Path, order: str) -> None:
    """Each face has an image of its own; corners that agree stay one vertex."""
    uv = [[(k + i) / 8 for k in range(2 * len(face))] for i, face in enumerate(FACES)]
    mesh = read(tmp_path, write.ply(COLUMNS, FACES, order, uv=uv))
    assert mesh.uv is not None
    flat = np.concatenate([np.reshape(one, (-1, 2)) for one in uv])
    np.testing.assert_allclose(mesh.uv[mesh.corners], flat, rtol=1e-6)
    np.testing.assert_array_equal(mesh.positions[mesh.corners], POINTS[np.concatenate(FACES)])
    same = [[0.5] * (2 * len(face)) for face in FACES]
    assert len(read(tmp_path, write.ply(COLUMNS, FACES, order, uv=same)).positions) == 5
    notes = Notes()
    odd = [*same[:-1], [0.5, 0.5]]
    assert read(tmp_path, write.ply(COLUMNS, FACES, order, uv=odd), notes).uv is None
    assert any("some corners of faces lack" in note for note in notes.sentences())


@pytest.mark.parametrize("order", ["<", ">"])
def test_short_and_long_runs_of_sizes_give_the_same_faces(tmp_path: Path, order: str) -> None:
    """Runs of thousands, faces that alternate, and a few large ones, in one file."""
    rng = np.random.default_rng(2)
    sizes = [3] * 5000 + [3, 4] * 3000 + [4] * 2000 + list(rng.integers(3, 9, 5000)) + [40, 3, 200]
    faces = [tuple(rng.integers(0, 5, n).tolist()) for n in sizes]
    mesh = read(tmp_path, write.ply(COLUMNS, faces, order))
    assert mesh.sizes is not None
    assert mesh.sizes.tolist() == sizes
    np.testing.assert_array_equal(mesh.corners, np.concatenate(faces))
    other = read(tmp_path, write.ply(COLUMNS, faces, order, length="i4", index="u1"))
    np.testing.assert_array_equal(other.corners, mesh.corners)


@pytest.mark.parametrize("order", ["", "<", ">"])
def test_numbers_beside_lists_and_several_lists(tmp_path: Path, order: str) -> None:
    """Values before, between and behind lists of many sizes are found in each row."""
    head = [*_VERTEX, "element face 3", "property uchar red", "property list int short other",
            "property uchar green", "property list uchar ushort vertex_indices",
            "property uchar blue"]  # fmt: skip
    rows: list[tuple[int, list[int], int, list[int], int]] = [
        (255, [-1], 0, [0, 1, 2, 3], 51), (0, [], 255, [0, 1, 4], 0),
        (51, [5, 6], 0, [1, 2, 4], 255),
    ]  # fmt: skip
    body = POINTS.astype(order + "f4").tobytes()
    for red, other, green, corners, blue in rows:
        body += bytes([red]) + np.array([len(other)], order + "i4").tobytes()
        body += np.array(other, order + "i2").tobytes() + bytes([green, len(corners)])
        body += np.array(corners, order + "u2").tobytes() + bytes([blue])
    if not order:
        lines = [" ".join(map(str, point)) for point in POINTS.tolist()]
        for red, other, green, corners, blue in rows:
            numbers = red, len(other), *other, green, len(corners), *corners, blue
            lines.append(" ".join(map(str, numbers)))
        body = "\n".join(lines).encode()
    mesh = read(tmp_path, _lie(*head, body=body, order=order))
    assert faces_of(mesh) == [(0, 1, 2, 3), (0, 1, 4), (1, 2, 4)]
    assert mesh.face_colors is not None
    wanted = to_linear(np.array([[255, 0, 51], [0, 255, 0], [51, 0, 255]]) / 255)
    np.testing.assert_allclose(mesh.face_colors, wanted, rtol=1e-5)


@pytest.mark.parametrize("piece", [1, 7, 1 << 22])
def test_words_that_only_python_takes_for_numbers(
    monkeypatch: pytest.MonkeyPatch, piece: int
) -> None:
    """The core leaves them; numbers before and behind them, and lines, stay."""
    monkeypatch.setattr(text_numbers, "_PIECE", piece)
    found = text_numbers.numbers(b"1 +2\n-inf 1e-400 .5\n\n1e400 7.25 infinity\n8")
    assert found.tolist() == [1, 2, -np.inf, 0, 0.5, np.inf, 7.25, np.inf, 8]
    assert text_numbers.numbers(b" 12 +34\n-5 ", int).tolist() == [12, 34, -5]
    for text, kind, line, word in (
        (b"1 2\ninf 4\n5 0x10 1_0", float, 2, "'0x10'"), (b"1\n2\n\n3 4_5", float, 3, "'4_5'"),
        (b"1\n2.0", int, 1, "'2.0'"), (b"1\n\n99999999999999999999", int, 2, "'9999"),
        (b"nan(1)", float, 0, "'nan(1)'"),
    ):  # fmt: skip
        with pytest.raises(text_numbers.NotANumberError) as caught:
            text_numbers.numbers(text, kind)
        assert caught.value.line == line
        assert caught.value.word.startswith(word)


def test_gzipped_files(tmp_path: Path) -> None:
    """By their bytes, whatever the name is; several members, and padding behind them."""
    data = write.ply(COLUMNS, FACES)
    for packed in (
        gzip.compress(data),
        gzip.compress(data[:100]) + gzip.compress(data[100:]),
        gzip.compress(data) + bytes(20),
    ):
        assert faces_of(read(tmp_path, packed)) == FACES


def test_other_elements_and_line_ends(tmp_path: Path) -> None:
    head = ["obj_info x", "element camera 2", "property float a", "property list uchar int b",
            "element vertex 3", "property float x", "property float y", "property float z",
            "element nothing 5", "element face 1", "property uchar flags",
            "property list uchar int vertex_index"]  # fmt: skip
    text = write.ply_header("", *head).replace(b"\n", b"\r\n")
    text += b"1 2 7 8 1 0\r\n0 0 0\r\n1 0 0 0 1 0\r\n9 3 0 1 2\r\n"
    notes = Notes()
    mesh = read(tmp_path, text, notes)
    assert faces_of(mesh) == [(0, 1, 2)]
    assert len(notes.sentences()) == 3
    assert "'camera'" in notes.sentences()[0]


def test_small_faces_and_more_data_are_notes(tmp_path: Path) -> None:
    notes = Notes()
    faces = [(0, 1), (0, 1, 4), (2,), ()]
    mesh = read(tmp_path, write.ply(COLUMNS, faces) + b"more", notes)
    assert faces_of(mesh) == [(0, 1, 4)]
    assert "faces with fewer than 3 corners are left out (3 uses)" in notes.sentences()
    assert "data after the last element of a PLY file are not used (1 use)" in notes.sentences()


def test_a_mesh_goes_to_a_scene(tmp_path: Path) -> None:
    red = np.ones(5)
    mesh = read(tmp_path, write.ply(COLUMNS | {"r": red, "g": red, "b": red}, FACES))
    scene = dg.Scene()
    made = scene.meshes[mesh.add_to(scene, "pyramid")]
    assert made.name == "pyramid"
    assert len(made.indices) == 6
    assert made.colors is None
    assert scene.meshes[mesh.add_to(scene, colors=True)].colors is not None


_VERTEX = ("element vertex 5", "property float x", "property float y", "property float z")
_FACE = ("element face 1", "property list uchar int vertex_indices")
_BODY = POINTS.tobytes() + b"\x03" + np.array([0, 1, 4], "<i4").tobytes()


def _lie(*lines: str, body: bytes = _BODY, order: str = "<") -> bytes:
    return write.ply_header(order, *lines) + body


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"", "line 1: end_header is missing"),
        (b"plyx\n", "line 1: wanted ply, got 'plyx'"),
        (b"ply\nformat ascii 2.0\n", "line 2: wanted format, element, .* got 'format ascii 2.0'"),
        (b"ply\nformat ascii 1.0\nformat ascii 1.0\n", "line 3: wanted format, element"),
        (b"ply\nend_header\n", "line 2: wanted a line format, got 'none'"),
        (b"ply\nformat ascii 1.0\nproperty float x\n", "line 3: wanted an element before"),
        (_lie("element vertex -1"), "line 3: wanted a number of rows up to 2147483647, got '-1'"),
        (_lie("element vertex 9999999999"), "line 3: wanted a number of rows"),
        (
            _lie("element vertex 2147483647", *_VERTEX[1:]),
            "element vertex: truncated: wanted 2147483647 rows",
        ),
        (_lie(*_VERTEX, *_VERTEX), "line 7: wanted each element once, got 'vertex again'"),
        (_lie(*_VERTEX, "property float x"), "line 7: wanted each property once, got 'x again'"),
        (_lie(*_VERTEX, "property quad w"),
         "line 7: wanted a property of char, .* 'property quad w'"),
        (_lie(*_VERTEX, "property list float int w"),
         "line 7: wanted a whole number as the length"),
        (_lie(*_VERTEX[:3], *_FACE), "vertex: the properties x, y and z are missing"),
        (_lie(*_FACE, body=b"\x00"), "the element vertex is missing"),
        (_lie(*_VERTEX), "the element face is missing"),
        (
            _lie(*_VERTEX, "element face 1", "property int vertex_indices"),
            "face: the list vertex_indices",
        ),
        (_lie(*_VERTEX, *_FACE, body=_BODY[:-1]), "element face: truncated: wanted 1 rows"),
        (_lie(*_VERTEX, *_FACE, body=_BODY[:-13]), "element face: truncated: wanted 1 rows"),
        (_lie(*_VERTEX, *_FACE, body=_BODY[:50]), "element vertex: truncated: wanted 5 rows"),
        (
            _lie(*_VERTEX, "element face 900000000", _FACE[1]),
            "element face: truncated: wanted 900000000 rows",
        ),
        (_lie(*_VERTEX, *_FACE, body=_BODY[:-4] + b"\5\0\0\0"),
         "face: corner 2: wanted a vertex of 0 .. 4, got 5"),
        (_lie(*_VERTEX, *_FACE, body=_BODY[:-4] + b"\xff" * 4), "face: corner 2: .* got -1"),
        (_lie(*_VERTEX, _FACE[0],
         "property list int int vertex_indices", body=_BODY[:60] + b"\xff" * 16),
         "wanted a whole number as the length of a list, got -1"),
        (_lie(*_VERTEX, _FACE[0],
         "property list uint int vertex_indices", body=_BODY[:60] + b"\xff" * 16),
         "element face: truncated: wanted 1 rows"),
        (_lie(*_VERTEX, *_FACE, body=b"\0\0\xc0\x7f" + _BODY[4:]),
         "vertex: x 0: wanted finite numbers"),
        (_lie(*_VERTEX, *_FACE, order="", body=b"0 0 0\n1 x 0\n"),
         "line 11: wanted a number, got 'x'"),
        (_lie(*_VERTEX, *_FACE, order="", body=b"0 " * 15 + b"2.5 0 1 2"),
         "as the length of a list, got 2.5"),
        (_lie(*_VERTEX, *_FACE, order="", body=b"0 " * 15 + b"nan 0 1 2"),
         "as the length of a list, got nan"),
        (_lie(*_VERTEX, *_FACE, order="", body=b"0 " * 15 + b"inf 0 1 2"),
         "as the length of a list, got inf"),
        (_lie(*_VERTEX, *_FACE, order="", body=b"0 " * 15 + b"3 0 1 2.5"),
         "corner 2: wanted a vertex .* got 2.5"),
        (_lie(*_VERTEX, *_FACE, order="", body=b"0 " * 15 + b"3 0 1 nan"),
         "corner 2: wanted a vertex .* got nan"),
        (_lie(*_VERTEX, *_FACE, order="", body=b"1_0 " * 20),
         "line 10: wanted a number, got '1_0'"),
        (_lie(*_VERTEX, *_FACE, order="", body=b"1e39 " * 15 + b"3 0 1 2"),
         "vertex: x 0: wanted finite numbers"),
        (_lie(*_VERTEX, *(f"property float p{i}" for i in range(1000))),
         "wanted at most 1000 properties"),
        (gzip.compress(_lie(*_VERTEX, *_FACE))[:-9], "damaged gzip data"),
        (b"\x1f\x8bnonsense", "damaged gzip data"),
    ],
)  # fmt: skip
def test_lies_are_one_error_with_a_place(tmp_path: Path, data: bytes, told: str) -> None:
    with pytest.raises(dg.InputError, match=told) as caught:
        read(tmp_path, data)
    assert str(caught.value).startswith(str(tmp_path / "mesh.ply"))
    assert len(str(caught.value)) < 500


def test_bombs_are_refused_before_memory_is_taken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(file_bytes, "ALWAYS", 1 << 16)
    bomb = gzip.compress(bytes(20_000_000), 9)
    with pytest.raises(dg.InputError, match=r"too much unpacked data: the limit is"):
        read(tmp_path, bomb)
    monkeypatch.setattr(file_bytes.memory, "left_bytes", lambda: 1000)
    with pytest.raises(dg.InputError, match="free memory"):
        read(tmp_path, bytes(100_000))


def test_what_is_no_file_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(dg.InputError, match="no such file"):
        ply.read(tmp_path / "none.ply", Notes())
    with pytest.raises(dg.InputError, match="wanted a file, got a folder"):
        ply.read(tmp_path, Notes())
