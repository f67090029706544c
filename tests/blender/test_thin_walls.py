"""Thin walls of Blender 5.2: light on both sides of a sheet against Cycles. Needs bpy."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("bpy")

import bpy

import daguerre as dg
from tests.support.blender.blender_pictures import camera, card, empty, picture

from .node_scenes import CD_PER_W, Read

COLOR = (0.25, 0.5, 0.8)
RGB_TO_XYZ = np.array(
    [[0.4123908, 0.3575843, 0.1804808], [0.2126390, 0.7151687, 0.0721923],
     [0.0193308, 0.1191948, 0.9505322]]
)  # fmt: skip


def sheet(**sockets):
    """A square of a thin wall in an empty scene; _ stands for a space."""
    empty((8, 8), 64)
    bpy.context.scene.cycles.max_bounces = 4
    material = card(4.0).data.materials[0]
    tree = material.node_tree
    shader = tree.nodes.new("ShaderNodeBsdfPrincipled")
    if "Thin Wall" not in shader.inputs:
        pytest.skip(f"Blender {bpy.app.version_string} has no thin walls")
    values = {"Base Color": (*COLOR, 1.0), "Thin Wall": True, "Specular IOR Level": 0.0}
    for name, value in (values | sockets).items():
        shader.inputs[name.replace("_", " ")].default_value = value
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def by_cycles(above, below):
    """Colour of the sheet from above, under a sky of two halves."""
    tree = bpy.context.scene.world.node_tree
    place, parts = (tree.nodes.new(f"ShaderNode{name}") for name in ("TexCoord", "SeparateXYZ"))
    step, mixed = (tree.nodes.new(f"ShaderNode{name}") for name in ("Math", "MapRange"))
    step.operation = "GREATER_THAN"
    step.inputs[1].default_value = 0.0
    mixed.inputs["To Min"].default_value, mixed.inputs["To Max"].default_value = below, above
    background = tree.nodes["Background"]
    background.inputs["Strength"].default_value = 1.0
    for source, target in (
        (place.outputs["Generated"], parts.inputs[0]),
        (parts.outputs["Z"], step.inputs[0]),
        (step.outputs[0], mixed.inputs["Value"]),
        (mixed.outputs[0], background.inputs["Color"]),
    ):
        tree.links.new(source, target)
    camera((0, 0, 2), lens=500)
    return picture().mean(axis=(0, 1))


def by_daguerre(material, over, under):
    """Colour of the same sheet by the renderer, in Blender's values."""
    found = Read(material)
    corners = [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]]
    mesh = found.scene.add_mesh(np.array(corners, float), [[0, 1, 2], [0, 2, 3]])
    found.scene.add_instance(mesh, found.index)
    sky = np.full((64, 8, 3), CD_PER_W * under, np.float32)
    sky[:32] = CD_PER_W * over
    found.scene.set_environment(sky)
    above = dg.look_at((0, 2, 0.001), (0, 0, 0))
    seen = dg.Camera(above, focal_length=500.0, sensor_size=(36.0, 36.0))
    frame = dg.render(found.scene, seen, resolution=(8, 8), spp=256, threads=1)
    return frame.xyz.mean((0, 1)) @ np.linalg.inv(RGB_TO_XYZ).T / CD_PER_W


@pytest.mark.parametrize("halves", [(1.0, 0.0), (0.0, 1.0)])
@pytest.mark.parametrize(
    "sockets",
    [
        {},
        {"Subsurface_Weight": 1.0},
        {"Subsurface_Weight": 0.5, "Subsurface_Anisotropy": 0.5},
        {"Subsurface_Weight": 1.0, "Subsurface_Anisotropy": -0.4},
        {"Transmission_Weight": 1.0, "Roughness": 0.0, "IOR": 1.0},
    ],
)
def test_light_on_both_sides_of_a_sheet_is_that_of_cycles(sockets, halves):
    material = sheet(**sockets)
    ours, theirs = by_daguerre(material, *halves), by_cycles(*halves)
    np.testing.assert_allclose(ours, theirs, atol=0.01)


def test_a_sheet_of_glass_bends_nothing_and_has_its_colour_once():
    kind = Read(sheet(Transmission_Weight=1.0)).kind
    assert (kind.transmission, kind.thickness) == (1.0, 0.0)
    np.testing.assert_allclose(kind.base_color, COLOR, rtol=1e-6)
