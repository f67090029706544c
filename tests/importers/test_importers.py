"""The importers' contract (docs/importers.md): what every scene format of the table keeps."""

from __future__ import annotations

import ast
import copy
import importlib.util
import pickle
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pxr import UsdGeom, UsdLux

import daguerre as dg
from daguerre.files import formats
from daguerre.files.formats import Format, register
from tests.support.formats import motion_files, stages
from tests.support.formats.make_gltf import Builder
from tests.support.scene import scenes

ROOT = Path(__file__).resolve().parents[2]
#: The card of every sample: 2 m x 1 m, in the plane z = -3, its middle on the axis; named "card".
CARD = [(-1, -0.5, -3), (1, -0.5, -3), (1, 0.5, -3), (-1, 0.5, -3)]


@dataclass(frozen=True)
class Samples:
    """Files of a format.

    Attributes:
        card: Writes the card, as told above, and one thing that no reader understands.
        broken: Bytes of files that are wrong, and what the error says of the place.
        moving: Writes a file in which something moves; None: the format has no motion.
        camera: Whether the card's file has a camera.
    """

    card: Callable[[Path], Path]
    broken: dict[str, tuple[bytes, str]]
    moving: Callable[[Path], Path] | None = None
    camera: bool = False


def _gltf_card(folder: Path) -> Path:
    b = Builder()
    corners = np.array(CARD) - (0, 0, -3)  # the node moves it back
    b.mesh({"POSITION": b.accessor(corners)}, indices=b.accessor([0, 1, 2, 0, 2, 3], "u2"))
    b.json["meshes"][0]["primitives"].append({"mode": 1, "attributes": {"POSITION": 0}})
    b.node(mesh=0, name="card", translation=[0, 0, -3])
    return b.glb(folder / "card.glb")


def _gltf(**members: Any) -> bytes:
    import json

    return json.dumps({"asset": {"version": "2.0"}, **members}).encode()


_HUGE = {"bufferView": 0, "componentType": 5126, "count": 1 << 40, "type": "VEC3"}
_VIEW = {"buffer": 0, "byteLength": 36}
_MESH = {"primitives": [{"attributes": {"POSITION": 0}}]}


def _gltf_with(accessor: dict[str, Any]) -> bytes:
    return _gltf(
        buffers=[{"byteLength": 36, "uri": "data:;base64," + "A" * 48}],
        bufferViews=[_VIEW],
        accessors=[accessor],
        meshes=[_MESH],
        nodes=[{"mesh": 0}],
    )


GLTF = Samples(
    _gltf_card,
    {
        "empty.gltf": (b"", "empty file"),
        "cut_off.gltf": (_gltf()[:-4], "JSON"),
        "no_number.gltf": (_gltf(nodes=[{"translation": [1, "x", 3]}]), r"nodes\[0\].translation"),
        "no_mesh.gltf": (_gltf(nodes=[{"mesh": 7}]), r"nodes\[0\].mesh"),
        "greedy.gltf": (_gltf_with(_HUGE), r"accessors\[0\]"),
        "zeros.gltf": (
            _gltf_with({k: v for k, v in _HUGE.items() if k != "bufferView"}),
            r"accessors\[0\].count",
        ),
        "noise.glb": (bytes(range(256)), "header"),
    },
    lambda folder: motion_files.coated().glb(folder / "moving.glb"),
)


def _obj_card(folder: Path) -> Path:
    points = "".join(f"v {x} {y} {z}\n" for x, y, z in CARD)
    path = folder / "card.obj"
    path.write_text(f"# a card\no card\n{points}curv 0 1\nf 1 2 3 4\n")
    return path


OBJ = Samples(
    _obj_card,
    {
        "no_number.obj": (b"v 1 2 3\nv 1 x 3\n", "line 2: v"),
        "few.obj": (b"v 1 2\n", "line 1: v"),
        "infinite.obj": (b"v 1 2 inf\n", "line 1: v"),
        "no_point.obj": (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "line 4: f"),
        "before.obj": (b"v 0 0 0\nf -1 -2 -3\n", "line 2: f"),
        "zero.obj": (b"v 0 0 0\nf 0 0 0\n", "line 2: f"),
        "edge.obj": (b"v 0 0 0\nf 1 1\n", "line 2: f"),
        "noise.obj": (b"v \xff\xfe\n", "UTF-8"),
    },
)


def _usd_card(folder: Path) -> Path:
    stage = stages.new_stage(folder / "card.usda", metres=0.01, up="Z")
    corners = [(100 * x, -100 * (z + 3), 100 * y) for x, y, z in CARD]  # the prim moves it back
    stages.place(stages.mesh(stage, "/card", corners), at=(0, 300, 0))
    stage.DefinePrim("/patch", "NurbsPatch")
    return stages.save(stage)


def _usd_moving(folder: Path) -> Path:
    stage = stages.new_stage(folder / "moving.usda")
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(48)
    turn = UsdGeom.Xformable(stages.cube(stage, "/cube", "catmullClark")).AddRotateYOp()
    turn.Set(0.0, 0)
    turn.Set(170.0, 48)
    points = stages.mesh(stage, "/card").GetPointsAttr()
    points.Set(stages.vectors(stages.SQUARE), 0)
    points.Set(stages.vectors(2 * np.array(stages.SQUARE)), 48)
    lamp = UsdLux.SphereLight.Define(stage, "/lamp")
    lamp.GetIntensityAttr().Set(1.0, 0)
    lamp.GetIntensityAttr().Set(9.0, 48)
    return stages.save(stage)


def _usd(*lines: str) -> bytes:
    return "\n".join(["#usda 1.0", *lines, ""]).encode()


USD = Samples(
    _usd_card,
    {
        "empty.usda": (b"", "usda"),
        "half.usda": (_usd('def Xform "a" {'), "Expected"),
        "noise.usdc": (bytes(range(256)), "usdc"),
        "noise.usdz": (bytes(range(256)), "usdz"),
        "no_unit.usda": (_usd("(", "    metersPerUnit = 0", ")"), "metersPerUnit"),
        "no_time.usda": (_usd("(", "    timeCodesPerSecond = -1", ")"), "timeCodesPerSecond"),
        "sideways.usda": (_usd("(", '    upAxis = "X"', ")"), "upAxis"),
        "lies.usda": (
            _usd(
                'def Mesh "m" {',
                "int[] faceVertexCounts = [3]",
                "int[] faceVertexIndices = [0, 1, 7]",
                "point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]",
                "}",
            ),
            "/m: faceVertexIndices",
        ),
        "outside.usda": (_usd("(", "    subLayers = [@../../x.usda@]", ")"), "leaves the stage"),
        "web.usda": (_usd("(", "    subLayers = [@http://a.b/x.usda@]", ")"), "refused"),
    },
    _usd_moving,
)


def _pbrt_card(folder: Path) -> Path:
    corners = " ".join(f"{x} {y} {-3 - z}" for x, y, z in CARD)  # pbrt's z points ahead
    path = folder / "card.pbrt"
    path.write_text(
        f"""WorldBegin
        Shape "nurbs" "integer nu" 4
        ObjectBegin "card" # its front faces the origin
            ReverseOrientation
            Shape "trianglemesh" "point3 P" [{corners}] "integer indices" [0 1 2 0 2 3]
        ObjectEnd
        Translate 0 0 3
        ObjectInstance "card"
        """
    )
    return path


def _pbrt_moving(folder: Path) -> Path:
    path = folder / "moving.pbrt"
    path.write_text(
        """Camera "perspective" WorldBegin
        TransformTimes 0 2
        ActiveTransform EndTime
        Rotate 90 0 1 0
        ActiveTransform All
        Shape "disk"
        """
    )
    return path


def _pbrt(*lines: str) -> bytes:
    return "\n".join(["WorldBegin", *lines, ""]).encode()


_DEEP = b"WorldBegin\n" + b"AttributeBegin\n" * 20_000
PBRT = Samples(
    _pbrt_card,
    {
        "empty.pbrt": (b"", "line 1, column 1: the file ends without WorldBegin"),
        "string.pbrt": (_pbrt('Shape "sphere'), "line 2, column 7: .*unterminated string"),
        "list.pbrt": (
            _pbrt('Shape "sphere" "float radius" [1'),
            "line 2, column 31: Shape: unterm",
        ),
        "block.pbrt": (_pbrt("AttributeBegin"), "line 2, column 1: AttributeBegin: unterminated"),
        "deep.pbrt": (_DEEP, "line 10002, column 1: AttributeBegin: too many nested blocks"),
        "unmatched.pbrt": (_pbrt("AttributeEnd"), "column 1: AttributeEnd: no matching Attr"),
        "no_number.pbrt": (
            _pbrt("Translate 1 two 3"),
            "line 2, column 13: Translate: wanted a num",
        ),
        "expression.pbrt": (_pbrt('Shape "disk" "float radius" [1-2]'), "line 2, column 30: Shape"),
        "infinite.pbrt": (_pbrt("Scale 1 1e999 1"), "line 2, column 9: Scale: wanted a number"),
        "unknown.pbrt": (_pbrt("AttributeBegan"), "line 2, column 1: wanted a directive"),
        "lies.pbrt": (
            _pbrt(
                'Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0]',
                '    "integer indices" [0 1 7]',
            ),
            "line 3, column 5: Shape: indices: wanted indices of 0 .. 2, got 7",
        ),
        "circle.pbrt": (_pbrt('Include "circle.pbrt"'), "line 2, column 1: Include: .*circle"),
        "outside.pbrt": (_pbrt('Include "../../etc/passwd"'), "Include: name: leaves the scene's"),
        "texture.pbrt": (
            _pbrt('Texture "a" "spectrum" "scale" "texture tex" "a"')
            + b'Material "diffuse" "texture reflectance" "a" Shape "disk"',
            "Texture: tex: too many nested textures",
        ),
        "material.pbrt": (
            _pbrt('NamedMaterial "a"', 'Shape "disk"'),
            "line 3.*Shape: wanted a mat",
        ),
        "camera.pbrt": (b'Camera "orthographic" WorldBegin', "line 1, column 1: Camera: kind"),
        "type.pbrt": (_pbrt('Shape "disk" "float radius" "x"'), "line 2, column 14: Shape: radius"),
    },
    _pbrt_moving,
)


def _mitsuba(*lines: str, version: str = "3.0.0") -> bytes:
    return "\n".join([f'<scene version="{version}">', *lines, "</scene>"]).encode()


def _mitsuba_card(folder: Path) -> Path:
    path = folder / "card.xml"
    path.write_bytes(
        _mitsuba(
            '<shape type="rectangle" id="card"><transform name="to_world">',
            '<scale x="1" y="0.5"/><translate z="-3"/></transform></shape>',
            '<emitter type="sunsky"/>',
        )
    )
    return path


MITSUBA = Samples(
    _mitsuba_card,
    {
        "empty.xml": (b"", "XML"),
        "half.xml": (_mitsuba()[:-4], "XML"),
        "noise.xml": (bytes(range(256)), "XML"),
        "other.xml": (b"<html/>", "line 1, column 1: <html>"),
        "entities.xml": (b'<!DOCTYPE a [<!ENTITY b "c">]><scene/>', "document type"),
        "no_version.xml": (b"<scene/>", "line 1, column 1: <scene>: wanted a version"),
        "no_number.xml": (
            _mitsuba('<shape type="sphere"><float name="radius" value="x"/></shape>'),
            "line 2, column 22: <float name='radius'>",
        ),
        "negative.xml": (
            _mitsuba('<shape type="sphere"><float name="radius" value="-1"/></shape>'),
            "line 2, column 22: <float name='radius'>",
        ),
        "nobody.xml": (
            _mitsuba('<shape type="sphere"><ref id="x"/></shape>'),
            "line 2, column 22: <ref",
        ),
        "outside.xml": (_mitsuba('<include filename="../../x.xml"/>'), "leaves the scene's folder"),
        "missing.xml": (_mitsuba('<include filename="x.xml"/>'), "no such file"),
        "circle.xml": (_mitsuba('<include filename="circle.xml"/>'), "too many nested includes"),
    },
)
SAMPLES = {"glTF 2.0": GLTF, "Wavefront OBJ": OBJ, "OpenUSD": USD, "pbrt": PBRT, "Mitsuba": MITSUBA}


def _example() -> Format:
    """The toy importer registers itself; its row is taken back when the tests are over."""
    spec = importlib.util.spec_from_file_location("import_obj", ROOT / "examples/import_obj.py")
    assert spec is not None
    assert spec.loader is not None
    spec.loader.exec_module(importlib.util.module_from_spec(spec))
    return formats.formats("scene")[-1]


@pytest.fixture(scope="module", autouse=True)
def _table() -> Iterator[None]:
    rows = list(formats._FORMATS)
    _example()
    yield
    formats._FORMATS[:] = rows


@pytest.fixture(params=sorted(SAMPLES))
def row(request: pytest.FixtureRequest) -> Format:
    return next(row for row in formats.formats("scene") if row.name == request.param)


@pytest.fixture
def samples(row: Format) -> Samples:
    return SAMPLES[row.name]


def test_every_format_of_the_table_has_samples() -> None:
    assert {row.name for row in formats.formats("scene")} == set(SAMPLES)


def test_the_example_is_short() -> None:
    assert len((ROOT / "examples" / "import_obj.py").read_text().splitlines()) <= 80


def test_the_card_is_where_it_stands(samples: Samples, tmp_path: Path) -> None:
    path = samples.card(tmp_path)
    scene = dg.load(path, time=1.5)
    assert (scene.path, scene.time) == (path, 1.5)
    (i,) = scene.nodes["card"]
    instance = scene.instances[i]
    points = scene.meshes[instance.mesh].positions @ instance.transform[:3, :3].T
    points = points + instance.transform[:3, 3]
    assert np.allclose(np.sort(points, axis=0), np.sort(np.array(CARD, float), axis=0))
    a, b, c = points[scene.meshes[instance.mesh].indices[0]]
    side = np.sign(np.linalg.det(instance.transform))  # a mirror image keeps its front
    assert side * np.cross(b - a, c - a)[2] > 0  # it faces +z


def test_what_was_filled_fits_together(samples: Samples, tmp_path: Path) -> None:
    scene = dg.load(samples.card(tmp_path))
    for instance in scene.instances:
        assert 0 <= instance.mesh < len(scene.meshes)
        assert 0 <= instance.material < len(scene.materials)
        assert instance.transform.shape == (4, 4)
        assert instance.transform.dtype == np.float64
        assert instance.name in scene.nodes
    for mesh in scene.meshes:
        assert not mesh.positions.flags.writeable
        assert mesh.indices.max(initial=0) < len(mesh.positions)
    assert set(scene.nodes) == set(scene.node_positions)
    assert all(np.shape(place) == (3,) for place in scene.node_positions.values())


def test_a_file_without_a_camera_gets_one_and_says_so(samples: Samples, tmp_path: Path) -> None:
    scene = dg.load(samples.card(tmp_path))
    assert (scene.default_camera == "framing") is not samples.camera
    assert any("'framing'" in note for note in scene.warnings) is not samples.camera


def test_what_is_not_understood_is_noted_once_with_a_count(
    samples: Samples, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    scene = dg.load(samples.card(tmp_path))
    assert [note for note in scene.warnings if note.endswith("(1 use)")]
    assert len(set(scene.warnings)) == len(scene.warnings)
    assert capfd.readouterr() == ("", "")


def test_what_is_wrong_is_one_error_that_names_file_and_place(
    samples: Samples, tmp_path: Path
) -> None:
    for name, (data, place) in samples.broken.items():
        path = tmp_path / name
        path.write_bytes(data)
        with pytest.raises(dg.InputError, match=place) as caught:
            dg.load(path)
        assert str(caught.value).startswith(f"{path}: "), name
        assert len(str(caught.value).splitlines()) == 1
        assert len(str(caught.value)) < 500 + len(str(path))


def test_a_file_cut_off_anywhere_is_read_or_refused(
    row: Format, samples: Samples, tmp_path: Path
) -> None:
    whole = samples.card(tmp_path).read_bytes()
    path = tmp_path / f"cut{row.suffixes[0]}"
    for end in range(0, len(whole), max(1, len(whole) // 53)):
        path.write_bytes(whole[:end])
        told = f"{path}: "
        try:
            dg.load(path)
        except dg.InputError as error:
            told = str(error)
        assert told.startswith(f"{path}: ")


def test_no_file_and_a_folder_are_refused(row: Format, tmp_path: Path) -> None:
    for path in (tmp_path / f"none{row.suffixes[0]}", tmp_path / f"folder{row.suffixes[0]}"):
        if path.stem == "folder":
            path.mkdir()
        with pytest.raises(dg.InputError, match=path.name):
            dg.load(path)


def test_options_that_the_format_lacks_are_refused(
    row: Format, samples: Samples, tmp_path: Path
) -> None:
    path = samples.card(tmp_path)
    with pytest.raises(dg.UsageError, match=rf"no option 'colour': {row.name} takes") as caught:
        dg.load(path, colour="red")
    assert all(name in str(caught.value) for name in row.takes or ())
    for name, value in {"variant": "x", "allow_dirs": (tmp_path,)}.items():
        if name not in (row.takes or ()):
            with pytest.raises(dg.UsageError, match=f"no option {name!r}"):
                dg.load(path, **{name: value})
    assert dg.load(path, variant=None, allow_dirs=()) == dg.load(path)  # absent is absent
    with pytest.raises(dg.UsageError, match="time: wanted a number"):
        dg.load(path, time=float("nan"))


def test_the_same_file_is_the_same_scene_and_travels(samples: Samples, tmp_path: Path) -> None:
    for write in filter(None, (samples.card, samples.moving)):
        path = write(tmp_path)
        scene = dg.load(path)
        assert scene == dg.load(path)
        data = pickle.dumps(scene)
        path.unlink()
        other = pickle.loads(data)
        assert other == scene == copy.deepcopy(scene)
        assert other.at(0.9) == scene.at(0.9)


def test_a_moving_scene_is_asked_by_two_threads(samples: Samples, tmp_path: Path) -> None:
    if samples.moving is None:
        scene = dg.load(samples.card(tmp_path))
        assert not scene.motion
        assert scene.duration is None
        return
    scene = dg.load(samples.moving(tmp_path))
    assert scene.motion
    assert scene.duration is not None
    moments = (0.8, 1.2)
    alone = {t: scene.at(t) for t in moments}
    assert alone[0.8] != alone[1.2]
    same: list[bool] = []

    def ask(t: float) -> None:
        same.extend(scene.at(t) == alone[t] for _ in range(50))

    threads = [threading.Thread(target=ask, args=(t,)) for t in moments]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert same == [True] * 100


def test_it_can_be_drawn(samples: Samples, tmp_path: Path) -> None:
    scene = dg.load(samples.card(tmp_path))
    scene.set_environment(color=(1, 1, 1))
    eye = dg.Camera(transform=scenes.at(0, 0, 0), lens="pinhole", focal_length=36.0)
    frame = dg.render(scene, eye, resolution=(36, 24), spp=4, aovs=True)
    assert np.isfinite(frame.rgb).all()
    assert frame.aovs["depth.Z"][12, 18] == pytest.approx(3, abs=1e-4)
    assert frame.alpha[12, 18] == 1
    assert frame.alpha[0, 0] == 0


# The table ------------------------------------------------------------------------------------


def test_a_suffix_belongs_to_one_format(row: Format) -> None:
    with pytest.raises(dg.UsageError, match=f"belongs to {row.name} already"):
        register(replace(row, name="another"))
    before = formats.formats("scene")
    register(row)  # of the same name: replaced
    assert {one.name for one in before} == {one.name for one in formats.formats("scene")}


def test_an_unknown_suffix_names_those_that_are_known(tmp_path: Path) -> None:
    with pytest.raises(dg.InputError, match=r"x\.stl: format: wanted \.glb, .*\.obj, got \.stl"):
        dg.load(tmp_path / "x.stl")


def test_a_package_that_is_missing_is_named(tmp_path: Path) -> None:
    how = ("no_such_package", "pip install no_such_package")
    register(Format("Alembic", "scene", (".abc",), reads="no_such_package.reader:read", needs=how))
    with pytest.raises(dg.UsageError, match="Alembic needs no_such_package: pip install no_such"):
        dg.load(tmp_path / "x.abc")
    formats._FORMATS[:] = [row for row in formats._FORMATS if row.name != "Alembic"]


def test_every_function_of_the_table_is_there() -> None:
    for row in formats._FORMATS:
        for function in (row.reads, row.writes):
            if isinstance(function, str):
                module, _, name = function.partition(":")
                assert callable(getattr(importlib.import_module(module), name)), function


# No field of a scene is written behind its methods ----------------------------------------------

_LISTS = {name for name in dg.Scene.__dataclass_fields__ if name not in ("path", "time")}
_CHANGES = ("append", "extend", "insert", "update", "setdefault", "pop", "clear", "remove")


def _writes(tree: ast.AST) -> Iterator[ast.AST]:
    """Places that set a field of a scene, or an element of it, or call what changes it."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign | ast.AugAssign | ast.Delete | ast.AnnAssign):
            targets = getattr(node, "targets", None) or [getattr(node, "target", None)]
            yield from (node for target in targets if _of_scene(target))
        elif (
            isinstance(node, ast.Call)
            and isinstance(node.func, ast.Attribute)
            and node.func.attr in _CHANGES
            and _of_scene(node.func.value)
        ):
            yield node


def _of_scene(node: ast.AST | None) -> bool:
    """Whether this is ``scene.lights``, ``self._scene.motion.meshes[3]`` and the like."""
    while isinstance(node, ast.Attribute | ast.Subscript):
        if isinstance(node, ast.Attribute) and node.attr in _LISTS:
            owner = node.value
            name = owner.attr if isinstance(owner, ast.Attribute) else getattr(owner, "id", "")
            if name.strip("_") == "scene":
                return True
        node = node.value
    return False


def test_readers_use_the_methods_of_a_scene() -> None:
    files = [*(ROOT / "python/daguerre/importers").rglob("*.py"), ROOT / "examples/import_obj.py"]
    found = [
        f"{file.name}:{node.lineno}"  # type: ignore[attr-defined]
        for file in files
        for node in _writes(ast.parse(file.read_text()))
    ]
    assert found == []


@pytest.mark.parametrize(
    "line",
    [
        "scene.duration = 3",
        "self._scene.motion.meshes[index] = over",
        "self.scene.camera_aliases.setdefault(a, b)",
        "scene.lights.append(light)",
        "scene.warnings += notes",
        "del scene.nodes[name]",
    ],
)
def test_that_test_sees_what_it_is_for(line: str) -> None:
    assert list(_writes(ast.parse(line)))


def test_a_strict_reader_refuses_what_it_would_leave_out(samples: Samples, tmp_path: Path) -> None:
    path = samples.card(tmp_path)
    with pytest.raises(dg.InputError, match=r"card\.\w+: strict: the file has notes: .*1 use"):
        dg.load(path, strict=True)


def test_a_strict_reader_reads_what_it_understands(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "whole.usda")
    stages.mesh(stage, "/card")
    assert dg.load(stages.save(stage), strict=True).default_camera == "framing"
