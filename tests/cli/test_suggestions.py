"""Suggestions after a wrong name: nearest spelling, any case, some of the words."""

from __future__ import annotations

import numpy as np
import pytest

import daguerre as dg
from daguerre import sensors, stocks
from daguerre.cli import main
from daguerre.errors import did_you_mean, suggest
from daguerre.scene.node_names import no_node
from daguerre.scene.packed.values import _camera
from tests.support.scene import scenes

NODES = ["World/Table/Top", "World/Lamp/Top", "World/Lamp/Shade", "ground"]


@pytest.mark.parametrize(
    ("name", "known", "hint"),
    [
        ("tble", ["table", "chair"], " (did you mean 'table'?)"),
        ("TABLE", ["table", "chair"], " (did you mean 'table'?)"),
        ("table", ["Table", "TABLE"], " (did you mean 'TABLE' or 'Table'?)"),
        ("a7r", ["nikon-d5100", "sony-a7r-ii"], " (did you mean 'sony-a7r-ii'?)"),
        ("400 portra", ["kodak-portra-400-new", "x"], " (did you mean 'kodak-portra-400-new'?)"),
        ("x", ["abcdefg"], ""),
        ("", ["abcdefg"], ""),
        ("()", ["abcdefg"], ""),
    ],
)
def test_names_are_suggested(name: str, known: list[str], hint: str) -> None:
    assert suggest(name, known) == hint


def test_a_long_list_is_counted() -> None:
    assert did_you_mean([]) == ""
    assert did_you_mean(["a", "b", "c", "d"]) == " (did you mean 'a', 'b', 'c' or 1 other?)"
    assert did_you_mean([*"abcdef"]) == " (did you mean 'a', 'b', 'c' or 3 others?)"


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("Top", "(did you mean 'World/Table/Top' or 'World/Lamp/Top'?)"),
        ("shade", "(did you mean 'World/Lamp/Shade'?)"),
        ("Shad", "(did you mean 'World/Lamp/Shade'?)"),
        ("Ground", "(did you mean 'ground'?)"),
        ("xyzxyz", "(known: "),
    ],
)
def test_the_last_part_of_a_path_suggests_its_node(name: str, hint: str) -> None:
    assert f"no node named {name!r} {hint}" in no_node(name, NODES)


def test_a_part_of_several_paths_suggests_them_all() -> None:
    nodes = ["A/Lamp/Top", "B/Lamp/Top", "C/Chair/Top"]
    assert no_node("Lamp/Top", nodes).endswith("(did you mean 'A/Lamp/Top' or 'B/Lamp/Top'?)")


def test_nodes_cameras_sensors_and_stocks_say_it_alike(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = scenes.lamp_room()
    scene.add_node("Table", np.zeros(3))
    scene.add_camera("main", dg.Camera())
    scene.camera_aliases["Master"] = "main"
    monkeypatch.setattr(dg, "load", lambda path, **_: scene)
    for flag, wrong, right in (
        ("--focus-on", "tble", "Table"),
        ("--catcher", "tble", "Table"),
        ("--camera", "master2", "Master"),
        ("--sensor", "A7R-II", "sony-a7r-ii"),
        ("--lens", "pinhol", "pinhole"),
        ("--lens", "canon 50mm 1.4", "canon-rf-50mm-f1.2"),
        ("--lens", "cannon", "canon-35mm-f1.8"),
    ):
        assert main(["info", "room.glb", flag, wrong]) in (2, 3)
        assert f"(did you mean '{right}'" in capsys.readouterr().err
    with pytest.raises(dg.InputError, match=r"sensor 'a7r': .* \(did you mean 'sony-a7r-ii'"):
        sensors.load("a7r")
    with pytest.raises(dg.InputError, match=r"stock '800': .* \(did you mean 'generic-tungsten"):
        stocks.load("800")


def test_a_scene_file_with_a_wrong_lens_says_it_alike() -> None:
    for wrong, right in (("canon 50mm 1.4", "canon-rf-50mm-f1.2"), ("pinhol", "pinhole")):
        with pytest.raises(dg.InputError, match=f"did you mean '{right}'"):
            _camera(lens=wrong)
    with pytest.raises(dg.InputError, match="did you mean 'sony-a7r-ii'"):
        _camera(sensor="a7r")
