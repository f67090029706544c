"""OBJ files: corners of all kinds, negative indices, odd lines, errors with their line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.files.notes import Notes
from daguerre.importers.meshes import obj
from daguerre.importers.meshes.file_mesh import FileMesh

_SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
_UV = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
_NORMALS = "vn 0 0 1\nvn 0 1 0\n"


def read(tmp_path: Path, text: str | bytes, notes: Notes | None = None) -> FileMesh:
    path = tmp_path / "mesh.obj"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return obj.read(path, Notes() if notes is None else notes)


def test_plain_polygons_share_vertices(tmp_path: Path) -> None:
    mesh = read(tmp_path, _SQUARE + "f 1 2 3 4\nf 1 2 3\n")
    assert mesh.corners.tolist() == [0, 1, 2, 3, 0, 1, 2]
    assert mesh.sizes is not None
    assert mesh.sizes.tolist() == [4, 3]
    assert mesh.positions[2].tolist() == [1, 1, 0]
    assert mesh.normals is mesh.uv is None


@pytest.mark.parametrize(
    ("corner", "uv", "normals"), [("{0}/{0}", 1, 0), ("{0}//1", 0, 1), ("{0}/{0}/1", 1, 1)]
)
def test_corners_name_their_values(tmp_path: Path, corner: str, uv: int, normals: int) -> None:
    words = " ".join(corner.format(i) for i in (1, 3, 4))
    mesh = read(tmp_path, _SQUARE + _UV + _NORMALS + f"f {words}\n")
    assert mesh.sizes is None
    points = mesh.positions[mesh.corners]
    assert points[:, :2].tolist() == [[0, 0], [1, 1], [0, 1]]
    assert (mesh.uv is not None) == bool(uv)
    assert (mesh.normals is not None) == bool(normals)
    if mesh.uv is not None:
        np.testing.assert_array_equal(mesh.uv[mesh.corners], points[:, :2])
    if mesh.normals is not None:
        assert (mesh.normals == (0, 0, 1)).all()


def test_vertices_part_where_values_differ(tmp_path: Path) -> None:
    """The middle of a fold: one point, two normals; equal corners stay one vertex."""
    mesh = read(
        tmp_path, _SQUARE + _NORMALS + "f 1//1 2//1 3//1\nf 1//2 3//2 4//2\nf 3//2 1//2 2//1\n"
    )
    assert len(mesh.positions) == 6
    want = [0, 0, 0, 1, 1, 1, 1, 1, 0]
    assert mesh.normals is not None
    assert mesh.normals[mesh.corners][:, 1].tolist() == want


def test_negative_indices_count_back_from_their_line(tmp_path: Path) -> None:
    text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 5 5 5\nvt 9 9\nf -1/-1 2/1 -2/-1\n"
    notes = Notes()
    mesh = read(tmp_path, text, notes)
    points = mesh.positions[mesh.corners]
    assert points.tolist()[:3] == [[0, 0, 0], [1, 0, 0], [1, 1, 0]]
    assert points.tolist()[3:] == [[5, 5, 5], [1, 0, 0], [1, 1, 0]]
    assert mesh.uv is None  # the first face has none
    assert notes.sentences() == ["texture coordinates that some corners lack are left out (1 use)"]


def test_odd_lines(tmp_path: Path) -> None:
    """Comments, blanks, indents, tabs, line ends of DOS, continued lines, words behind numbers."""
    text = (
        "# v 9 9 9\r\n\r\n  \t v\t0  0 0 1\r\nv 1 0 0 # comment f 7\r\nv 1 1 0 .5 .5 .5\r\n"
        "g f v\r\nusemtl vt\r\n" + " " * 200 + "v 2 2 2\r\nf 1 \\\r\n 2 \\\r\n3 4 \t\r\n"
        "vt .5\r\nl 1 2\r\nl 2 3\r\nvp 1 2\r\nf 1 2\r\n f\t3 2 1"
    )
    notes = Notes()
    mesh = read(tmp_path, text, notes)
    assert mesh.positions.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [2, 2, 2]]
    assert mesh.corners.tolist() == [0, 1, 2, 3, 2, 1, 0]
    assert notes.sentences() == [
        "the statement 'l' of an OBJ file is not used (2 uses)",
        "the statement 'vp' of an OBJ file is not used (1 use)",
        "faces with fewer than 3 corners are left out (1 use)",
    ]
    again = read(tmp_path, text.replace("\r\n", "\r").replace("\\\r", "  "))
    np.testing.assert_array_equal(again.positions, mesh.positions)


def test_a_random_mesh_is_that_of_a_plain_reader(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    points, uv, normals = rng.random((50, 3)), rng.random((40, 2)), rng.normal(size=(30, 3))
    lines, want = [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()], []
    lines += [f"vt {u!r} {v!r}" for u, v in uv.tolist()]
    lines += [f"vn {x!r} {y!r} {z!r}" for x, y, z in normals.tolist()]
    for _ in range(500):
        corners = int(rng.integers(3, 7))
        index = np.stack([rng.integers(0, n, corners) for n in (50, 40, 30)], axis=1)
        lines.append("f " + " ".join("/".join(map(str, one + 1)) for one in index))
        want.append(index)
    mesh = read(tmp_path, "\n".join(lines))
    all_of_them = np.concatenate(want)
    assert mesh.sizes is not None
    assert mesh.sizes.tolist() == [len(one) for one in want]
    for values, table, column in (
        (mesh.positions, points, 0), (mesh.uv, uv, 1), (mesh.normals, normals, 2)
    ):  # fmt: skip
        assert values is not None
        np.testing.assert_array_equal(
            values[mesh.corners], table.astype("f4")[all_of_them[:, column]]
        )
    rows = {tuple(one) for one in all_of_them.tolist()}
    assert len(mesh.positions) == len(rows)


def test_files_without_faces_or_vertices(tmp_path: Path) -> None:
    for text in ("", "\n\n", "# nothing", "v 1 2 3"):
        mesh = read(tmp_path, text)
        assert len(mesh.corners) == 0


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("v 1 2\n", "line 1: v: wanted 3 numbers, got 2"),
        ("v\n", "line 1: v: wanted 3 numbers, got 0"),
        ("v 1 2 3\nv 1 2 x\n", "line 2: v: wanted a number, got 'x'"),
        ("v 1 2 nan\n", "line 1: v: wanted finite numbers"),
        ("v 1 2 1e39\n", "line 1: v: wanted finite numbers"),
        ("vt\n", "line 1: vt: wanted 2 numbers, got 0"),
        ("\nvn 1 2\n", "line 2: vn: wanted 3 numbers, got 2"),
        (_SQUARE + "f 1 2 5\n", "line 5: f: wanted a vertex of 1 .. 4, got '5'"),
        (_SQUARE + "f 1 2 0\n", "line 5: f: wanted indices of at least 1, got '0'"),
        (_SQUARE + "f 1 2 -5\n", "line 5: f: wanted a vertex of 1 .. 4, got '-5'"),
        ("f -1 -1 -1\n" + _SQUARE, "line 1: f: wanted a vertex of 1 .. 4, got '-1'"),
        (_SQUARE + "f 1/1 2 3\n", "line 5: f: wanted a texture coordinate of 1 .. 0, got '1/1'"),
        (_SQUARE + _UV + "f 1//1 2 3\n", "line 9: f: wanted a normal of 1 .. 0, got '1//1'"),
        (_SQUARE + "f 1 2 3\nf 1 /2 3\n", "line 6: f: wanted a vertex, got '/2'"),
        (_SQUARE + "f 1 2 3/1/1/1\n",
         "line 5: f: wanted at most 3 numbers per corner, got '3/1/1/1'"),
        (_SQUARE + "f 1 2 3.5\n", "line 5: f: wanted a whole number, got '3.5'"),
        (_SQUARE + "f 1 2 99999999999999999999\n", "line 5: f: wanted a whole number, got '9999"),
        (_SQUARE + "f 1 2 a/b\n", "line 5: f: wanted a whole number, got 'a'"),
        (b"v 1 2 \xff\n", "line 1: v: wanted a number, got"),
        (b"v 1 2 3\n\x7fELF\0\0\n", "line 2: wanted text, got a zero byte"),
    ],
)  # fmt: skip
def test_errors_name_their_line(tmp_path: Path, text: str | bytes, told: str) -> None:
    with pytest.raises(dg.InputError, match=told) as caught:
        read(tmp_path, text)
    assert str(caught.value).startswith(str(tmp_path / "mesh.obj"))
