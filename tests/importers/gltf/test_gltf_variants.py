"""KHR_materials_variants: which material a primitive gets, and what a file may get wrong."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

import daguerre as dg
from daguerre.cli import app
from tests.support.formats.make_gltf import Builder, triangle

NAME = "KHR_materials_variants"
WHERE = rf"meshes\[0\]\.primitives\[0\]\.extensions\.{NAME}\.mappings"


def shoe(mappings, names=("red", "night blue", "green")) -> Builder:
    b = triangle()
    for name in ("plain", "first", "second"):
        b.add("materials", {"name": name})
    primitive = b.json["meshes"][0]["primitives"][0]
    primitive["material"] = 0
    primitive["extensions"] = {NAME: {"mappings": mappings}}
    b.json["extensions"] = {NAME: {"variants": [{"name": name} for name in names]}}
    return b


TWO = [{"material": 1, "variants": [0, 1]}, {"material": 2, "variants": [2], "name": "x"}]


@pytest.mark.parametrize(
    ("variant", "material"),
    [(None, "plain"), ("red", "first"), ("night blue", "first"), ("green", "second")],
)
def test_a_variant_chooses_materials(tmp_path, variant, material):
    scene = dg.load(shoe(TWO).glb(tmp_path / "a.glb"), variant=variant)
    assert scene.materials[scene.instances[0].material].name == material
    assert scene.variants == ["red", "night blue", "green"]
    assert not any("not understood" in text for text in scene.warnings)


def test_what_no_mapping_names_keeps_its_material(tmp_path):
    scene = dg.load(shoe(TWO[:1]).glb(tmp_path / "a.glb"), variant="green")
    assert scene.materials[scene.instances[0].material].name == "plain"


def test_unknown_names_are_refused(tmp_path):
    path = shoe(TWO).glb(tmp_path / "a.glb")
    with pytest.raises(dg.InputError, match=r"no variant named 'gren' \(did you mean 'green'"):
        dg.load(path, variant="gren")
    with pytest.raises(dg.InputError, match=r"no variant named 'red': the file has none"):
        dg.load(triangle().glb(tmp_path / "b.glb"), variant="red")


@pytest.mark.parametrize(
    ("mappings", "message"),
    [
        ([{"material": 3, "variants": [0]}], WHERE + r"\[0\]\.material: index out of range"),
        ([{"material": 1, "variants": [3]}], WHERE + r"\[0\]\.variants\[0\]: index out of range"),
        ([{"material": 1}], WHERE + r"\[0\]\.variants: missing"),
        ([{"variants": [0]}], WHERE + r"\[0\]\.material: missing"),
        (
            [TWO[0], {"material": 2, "variants": [2, 0]}],
            r"\[1\]\.variants\[1\]: variant 0 appears twice",
        ),
        ({}, WHERE + r": wrong type: wanted a list"),
    ],
)
def test_mappings_are_checked_though_none_is_chosen(tmp_path, mappings, message):
    with pytest.raises(dg.InputError, match=message):
        dg.load(shoe(mappings).glb(tmp_path / "a.glb"))


def test_names_are_text(tmp_path):
    b = shoe(TWO)
    b.json["extensions"][NAME]["variants"][1] = {}
    with pytest.raises(dg.InputError, match=rf"extensions\.{NAME}\.variants\[1\]\.name: missing"):
        dg.load(b.glb(tmp_path / "a.glb"))


def test_the_command_line_lists_and_chooses(tmp_path):
    path = str(shoe(TWO).glb(tmp_path / "a.glb"))
    shown = CliRunner().invoke(app, ["info", path])
    assert "variants     red, night blue, green" in shown.output
    facts = json.loads(CliRunner().invoke(app, ["info", path, "--json"]).output)
    assert facts["variants"] == ["red", "night blue", "green"]
    draw = ["render", path, "-o", str(tmp_path / "a.exr"), "--dry-run", "--sky", "1,1,1"]
    assert CliRunner().invoke(app, [*draw, "--variant", "green"]).exit_code == 0
    refused = CliRunner().invoke(app, [*draw, "--variant", "pink"])
    assert isinstance(refused.exception, dg.InputError)
