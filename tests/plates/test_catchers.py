"""Catchers as users mark them: in Python, in files, on the command line; and the rules of bits."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.rendering.passes import pass_of, write_pass
from daguerre.rendering.session import Session
from tests.plates.test_truth import CASES, SIZE

CASE = CASES["matte ground"]
SMALL = (24, 16)


def session(**options: Any) -> Session:
    camera = CASE.camera.with_(sensor="nikon-d5100")
    return Session(CASE.scene("caught"), camera, resolution=SMALL, seed=4, **options)


def test_threads_ranges_and_merges_have_the_same_bits(tmp_path: Path) -> None:
    whole = session(threads=1)
    whole.draw(0, 6)
    parts = []
    for k, (a, b) in enumerate(((0, 2), (2, 6))):
        one = session(threads=3)
        one.draw(a, b)
        parts.append(tmp_path / f"{k}.exr")
        write_pass(parts[-1], one.frame(), pass_of(one))
    frame, merged = whole.frame(), dg.merge(parts)
    for name in ("rgb", "alpha", "catcher", "catcher_ratio", "catcher_channels"):
        wanted, got = getattr(frame, name), getattr(merged, name)
        assert np.array_equal(wanted, got), name
    assert frame.catcher is not None
    assert np.abs(frame.catcher).max() > 0.05


def test_layers_come_back_from_a_file(tmp_path: Path) -> None:
    one = session()
    one.draw(0, 4)
    frame = one.frame()
    frame.save(tmp_path / "a.exr")
    again = dg.load_frame(tmp_path / "a.exr")
    for name in ("catcher", "catcher_ratio", "catcher_channels", "catcher_ratio_channels"):
        assert np.array_equal(getattr(again, name), getattr(frame, name)), name


def test_overscan_and_crops_have_the_layers_too() -> None:
    plain, wide = session(), session(overscan=4)
    for one in (plain, wide):
        one.draw(0, 4)
    around = wide.frame()
    assert around.catcher is not None
    assert around.catcher.shape == (24, 32, 3)
    inner = around.without_overscan()
    assert np.array_equal(inner.catcher, plain.frame().catcher)


def test_noise_is_judged_with_what_is_caught() -> None:
    frame = dg.render(CASE.scene("caught"), CASE.camera, resolution=SIZE, noise=0.02, seed=1)
    assert frame.samples is not None
    assert frame.catcher is not None
    shadow = (frame.catcher[..., 1] < -0.05) & (frame.alpha == 0)
    nothing = (frame.catcher == 0).all(axis=2) & (frame.alpha == 0)
    assert shadow.sum() > 30
    assert nothing.sum() > 200
    assert frame.samples[shadow].mean() > 1.3 * frame.samples[nothing].mean()


def test_effects_are_marked_by_name() -> None:
    scene = CASE.scene("full")
    scene.set_catcher("ground", "gi, shadow")
    assert scene.instances[0].catcher == ("shadow", "gi")
    scene.set_catcher("ground", "holdout")
    assert scene.instances[0].catcher == ()
    frame = dg.render(scene, CASE.camera, resolution=SMALL, spp=4)
    assert frame.catcher is not None
    assert frame.catcher_ratio is not None
    free = frame.alpha == 0
    np.testing.assert_allclose(frame.catcher[free], 0, atol=1e-6)
    np.testing.assert_allclose(frame.catcher_ratio[free], 1, atol=1e-5)


@pytest.mark.parametrize(
    ("node", "effects", "words"),
    [
        ("Ground", "shadow", r"catcher: no node named 'Ground' \(did you mean 'ground'\?\)"),
        ("ground", "shadows", "wanted shadow, reflection, gi, or holdout, got 'shadows'"),
        ("ground", "", "wanted shadow, reflection, gi, or holdout"),
        ("ground", "holdout,gi", "wanted shadow, reflection, gi, or holdout"),
    ],
)
def test_wrong_names_are_refused(node: str, effects: str, words: str) -> None:
    with pytest.raises(dg.UsageError, match=words):
        CASE.scene("full").set_catcher(node, effects)


def test_what_is_the_plates_own_is_refused() -> None:
    scene = CASE.scene("caught")
    for options in ({"bands": 8}, {"diffraction": True}, {"light_paths": (100, 0)}):
        with pytest.raises(dg.UsageError, match="with catchers"):
            dg.render(scene, CASE.camera, resolution=SMALL, spp=1, **options)


def ground_and_ball(path: Path, extras: Any) -> Path:
    """A glTF file of two triangles each, the first one a ground with extras."""
    corners = np.array([(-2, 0, -2), (-2, 0, 2), (2, 0, 2), (0, 1, 0)], np.float32)
    triangles = np.array([0, 1, 2, 0, 2, 3], np.uint16)
    data = corners.tobytes() + triangles.tobytes()
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    box = {"min": corners.min(0).tolist(), "max": corners.max(0).tolist()}
    document = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": len(data), "uri": uri}],
        "bufferViews": [
            {"buffer": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 12},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", **box},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "cameras": [
            {"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1, "aspectRatio": 1.5}}
        ],
        "nodes": [
            {"name": "set", "children": [1], "extras": extras},
            {"name": "ground", "mesh": 0},
            {"name": "thing", "mesh": 0, "scale": [0.2, 0.2, 0.2], "translation": [0, 0.3, 0]},
            {"name": "eye", "camera": 0, "translation": [0, 1, 4]},
        ],
    }
    path.write_text(json.dumps(document))
    return path


@pytest.mark.parametrize(
    ("extras", "wanted"),
    [
        ({"catcher": True}, ("shadow", "reflection", "gi")),
        ({"catcher": 1}, ("shadow", "reflection", "gi")),
        ({"catcher": "gi"}, ("gi",)),
        ({"catcher": "holdout"}, ()),
        ({"catcher": False}, None),
        ({"other": 1}, None),
    ],
)
def test_gltf_marks_a_node_and_what_is_below(tmp_path: Path, extras: Any, wanted: Any) -> None:
    scene = dg.load(ground_and_ball(tmp_path / "a.gltf", extras))
    assert [i.catcher for i in scene.instances] == [wanted, None]


def test_gltf_that_marks_nonsense_is_refused(tmp_path: Path) -> None:
    for value, words in ((3.5, "wanted true or names of effects"), ("all", "got 'all'")):
        path = ground_and_ball(tmp_path / "a.gltf", {"catcher": value})
        with pytest.raises(dg.InputError, match=words):
            dg.load(path)


def test_the_command_line_marks_nodes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = ground_and_ball(tmp_path / "a.gltf", {})
    out = tmp_path / "a.exr"
    flags = ["--sky", "1,1,1", "--spp", "4", "--res", "24x16", "-o", str(out), "--quiet"]
    assert main(["render", str(path), *flags, "--catcher", "ground:shadow"]) == 0
    frame = dg.load_frame(out)
    assert frame.catcher is not None
    assert np.abs(frame.catcher).max() > 0
    assert main(["render", str(path), *flags, "--catcher", "grund"]) == 2
    assert "no node named 'grund' (did you mean 'ground'?)" in capsys.readouterr().err
    assert main(["render", str(path), *flags, "--catcher", "ground:shade"]) == 2
    assert "wanted shadow, reflection, gi, or holdout, got 'shade'" in capsys.readouterr().err
    assert main(["render", str(path), *flags, "--background", "clear"]) == 2
