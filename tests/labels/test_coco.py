"""COCO files: by pycocotools where it is there, by a reader of our own, and from the command."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.labels.coco import CocoFile, runs_of
from tests.labels.test_annotations import family
from tests.rendering.test_truth import PINHOLE, at
from tests.support.formats.make_gltf import CORNERS, Builder

SIZE = (120, 90)
FLAGS = ["--res", "48x36", "--sky", "1,1,1", "--spp", "1", "--max-depth", "1", "--quiet"]


def decoded(runs: dict[str, Any]) -> np.ndarray:
    """Where a mask is, by COCO's words: runs of 0 and 1 in turn, column by column."""
    height, width = runs["size"]
    flat = np.repeat(np.arange(len(runs["counts"])) % 2, runs["counts"])
    return flat.reshape(width, height).T.astype(bool)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_runs_are_those_of_the_labels() -> None:
    labels = np.random.default_rng(1).integers(0, 4, (7, 5))
    labels[:, 0] = 2  # begins with one, so the first run is of no pixel
    labels[-1, -1] = 3  # ends with one
    runs = runs_of(labels)
    for label in (1, 2, 3):
        found = {"size": labels.shape, "counts": runs[label]}
        np.testing.assert_array_equal(decoded(found), labels == label)
        assert sum(runs[label]) == labels.size
    assert runs[2][0] == 0
    assert 0 not in runs
    assert runs_of(np.zeros((3, 4), int)) == {}


def written(folder: Path) -> tuple[Any, Any]:
    seen = dg.annotate(family(), PINHOLE, resolution=SIZE, crop=(10, 0, 110, 80))
    file = CocoFile(folder / "coco.json")
    file.add(seen, folder / "pictures" / "one.png", {"frame": 3})
    file.write()
    return seen, json.loads((folder / "coco.json").read_text())


def test_a_file_has_what_coco_has(folder: Path) -> None:
    seen, made = written(folder)
    assert set(made) == {"info", "licenses", "images", "annotations", "categories"}
    image = made["images"][0]
    assert {k: image[k] for k in ("id", "file_name", "width", "height", "frame")} == {
        "id": 1, "file_name": "pictures/one.png", "width": 100, "height": 80, "frame": 3
    }  # fmt: skip
    assert image["intrinsics"]["camera_matrix"][0][2] == pytest.approx(60 - 0.5 - 10)
    assert [c["name"] for c in made["categories"]] == ["Chair", "Floor", "Lamp", "Table"]
    for i, (one, thing) in enumerate(zip(made["annotations"], seen.things, strict=True)):
        assert (one["id"], one["image_id"], one["iscrowd"]) == (i + 1, 1, 0)
        mask = decoded(one["segmentation"])
        np.testing.assert_array_equal(mask, seen.mask(i))
        assert one["area"] == mask.sum() == thing.area
        rows, columns = np.nonzero(mask)
        box = [columns.min(), rows.min(), np.ptp(columns) + 1, np.ptp(rows) + 1]
        assert one["bbox"] == box
        np.testing.assert_allclose(one["bbox_full"], thing.full_box, rtol=1e-8)
        np.testing.assert_allclose(one["bbox3d"]["center"], thing.camera_box3.center, rtol=1e-8)


@pytest.mark.filterwarnings("ignore:__array__ implementation:DeprecationWarning")  # of its own
def test_pycocotools_reads_it(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    coco = pytest.importorskip("pycocotools.coco")
    masks = pytest.importorskip("pycocotools.mask")
    seen, _ = written(folder)
    read = coco.COCO(str(folder / "coco.json"))
    capsys.readouterr()
    names = [c["name"] for c in read.loadCats(read.getCatIds())]
    assert names == ["Chair", "Floor", "Lamp", "Table"]
    found = read.loadAnns(read.getAnnIds(imgIds=[1]))
    assert len(found) == len(seen.things) == 5
    for i, one in enumerate(found):
        runs = read.annToRLE(one)
        np.testing.assert_array_equal(masks.decode(runs), seen.mask(i))
        assert int(masks.area(runs)) == one["area"]
        assert masks.toBbox(runs).tolist() == one["bbox"]


def gltf(folder: Path, *, moves: bool = False) -> None:
    """Two triangles of one node and a copy of it before two cameras."""
    made = Builder()
    near = made.accessor(CORNERS)
    far = made.accessor(np.add(CORNERS, (0, 0, -0.5)))
    three = made.accessor([0, 1, 2], "u2")
    parts = [{"attributes": {"POSITION": p}, "indices": three} for p in (near, far)]
    mesh = made.add("meshes", {"primitives": parts})
    made.node(mesh=mesh, name="Tent")
    made.node(mesh=mesh, name="Tent.001", translation=[-1.5, 0, 0])
    made.add("cameras", {"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.01}})
    made.node(camera=0, name="a", translation=[0, 0.3, 4.0])
    made.node(camera=0, name="b", translation=[0.5, 0.3, 4.0])
    if moves:
        times, ways = made.accessor([0.0, 1.0]), made.accessor([[0.0, 0, 0], [2.4, 0, 0]])
        channel = {"sampler": 0, "target": {"node": 0, "path": "translation"}}
        sampler = {"input": times, "output": ways}
        made.add("animations", {"channels": [channel], "samplers": [sampler]})
    made.glb(folder / "s.glb")


def test_the_command_writes_one_file_of_all_pictures(folder: Path) -> None:
    gltf(folder, moves=True)
    command = ["render", "s.glb", "-o", "out/x.####.png", "-o", "out/x.####.exr", *FLAGS]
    command += ["--frames", "0-2", "--fps", "24", "--coco", "c.json", "--shutter", "0"]
    (folder / "out").mkdir()
    assert main(command) == 0
    made = json.loads((folder / "c.json").read_text())
    assert [i["file_name"] for i in made["images"]] == [f"out/x.{n:04d}.png" for n in range(3)]
    assert [i["frame"] for i in made["images"]] == [0, 1, 2]
    assert [i["time"] for i in made["images"]] == pytest.approx([0, 1 / 24, 2 / 24])
    assert [a["node"] for a in made["annotations"]] == ["Tent", "Tent.001"] * 3
    assert {a["category_id"] for a in made["annotations"]} == {1}
    assert [a["id"] for a in made["annotations"]] == list(range(1, 7))
    moving = [a["bbox3d_world"]["center"][0] for a in made["annotations"][::2]]
    np.testing.assert_allclose(np.diff(moving), 0.1, rtol=1e-6)
    assert made["annotations"][0]["bbox3d"]["size"][2] == pytest.approx(0.5)  # both primitives
    # Complete pictures are not drawn again, but noted as well.
    before = (folder / "c.json").read_bytes()
    (folder / "c.json").unlink()
    (folder / "out" / "x.0001.png").unlink()
    assert main([*command, "--resume"]) == 0
    assert (folder / "c.json").read_bytes() == before


def test_the_cameras_of_a_rig_are_told_apart(folder: Path) -> None:
    gltf(folder)
    flags = ["--camera", "a,b", "--coco", "c.json", "--aov", "object_id"]
    assert main(["render", "s.glb", "-o", "x.{camera}.exr", *FLAGS, *flags]) == 0
    made = json.loads((folder / "c.json").read_text())
    assert [(i["file_name"], i["camera"]) for i in made["images"]] == [
        ("x.a.exr", "a"), ("x.b.exr", "b")
    ]  # fmt: skip
    assert [a["image_id"] for a in made["annotations"]] == [1, 1, 2, 2]
    left, right = (a["bbox3d"]["center"][0] for a in made["annotations"][::2])
    assert left - right == pytest.approx(0.5)


def test_annotations_change_nothing_of_the_picture(folder: Path) -> None:
    gltf(folder)
    flags = ["--aov", "depth", "--threads", "1"]
    for name, coco in (("a", ["--coco", "c.json"]), ("b", [])):
        assert main(["render", "s.glb", "-o", f"{name}.exr", *FLAGS, *flags, *coco]) == 0
    a, b = (dg.load_frame(folder / f"{name}.exr") for name in "ab")
    np.testing.assert_array_equal(a.rgb, b.rgb)
    np.testing.assert_array_equal(a.aovs["depth.Z"], b.aovs["depth.Z"])
    assert a.metadata.get("gt_time") == b.metadata.get("gt_time")


@pytest.mark.parametrize(
    ("flags", "code", "message"),
    [
        (["--coco", "c.txt"], 2, "--coco: wanted a name ending in .json, got c.txt"),
        (["--coco", "no/such/c.json"], 5, "c.json"),
        (["--categories", "k.json"], 2, "--categories needs --coco FILE.json"),
        (
            ["--coco", "k.json", "--categories", "k.json"],
            2,
            "k.json: cannot write: this command reads this file",
        ),
        (["--coco", "c.json", "--categories", "none.json"], 3, "none.json: no such file"),
        (["--coco", "c.json", "--categories", "k.json"], 2, "did you mean 'Tent'"),
    ],
)
def test_what_is_refused(
    folder: Path, flags: list[str], code: int, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    gltf(folder)
    (folder / "k.json").write_text('{"Tnet": "tent"}')
    assert main(["render", "s.glb", "-o", "a.exr", *FLAGS, *flags]) == code
    error = capsys.readouterr().err
    assert message in error
    assert "Traceback" not in error
    assert not (folder / "a.exr").exists()


def test_a_thing_out_of_sight_is_not_in_the_file(folder: Path) -> None:
    scene = family()
    scene.add_instance(0, transform=at(z=5), name="Behind")
    seen = dg.annotate(scene, PINHOLE, resolution=SIZE)
    assert "Behind" not in [thing.name for thing in seen.things]
    assert "Behind" in [category.name for category in seen.categories]
