"""Cameras and scenes as a notebook shows them: tables of names and values."""

from __future__ import annotations

from typing import Any
from xml.etree import ElementTree

import numpy as np

import daguerre as dg


def rows(value: Any) -> dict[str, str]:
    table = ElementTree.fromstring(value._repr_html_())
    found = {}
    for row in table.findall("tr"):
        name, text = ("".join(cell.itertext()) for cell in row)
        found[name] = text
    return found


def test_a_camera_shows_where_it_stands_and_what_was_chosen() -> None:
    pose = np.eye(4)
    pose[:3, 3] = 0.05, 1.72, 3
    camera = dg.Camera(pose, lens="sonnar-50mm-f2", f_stop=4.0, focus_distance=0.73, tilt=(2, 0))
    assert rows(camera) == {
        "stands at": "(0.05, 1.72, 3) m",
        "looks along": "(0, 0, -1)",
        "lens": "'sonnar-50mm-f2'",
        "f_stop": "4",
        "focus_distance": "0.73 m",
        "tilt": "(2, 0) deg",
    }
    pull = dg.keys([(0.0, 1.0), (1.0, 2.0)])
    assert rows(dg.Camera(focus_distance=pull))["moving"] == "focus_distance"


def test_a_scene_shows_counts_and_what_it_does_not_understand() -> None:
    scene = dg.Scene()
    mesh = scene.add_mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    for place in range(2):
        scene.add_instance(mesh, dg.Diffuse((1, 1, 1)), np.eye(4), name=f"one {place}")
    scene.add_light(dg.PointLight(intensity=(1, 1, 1)), np.eye(4))
    scene.set_environment(color=(0.1, 0.1, 0.2))
    scene.note("<b> is not known")
    shown = rows(scene)
    assert shown["meshes"] == "1 (1 triangles)"
    assert shown["instances"] == "2 (2 triangles)"
    assert shown["lights"] == "1 PointLight"
    assert "(0.1, 0.1, 0.2)" in shown["environment"]
    assert shown["cameras"] == "none"
    assert shown["time"] == "0 s"
    assert shown["warnings"] == "<b> is not known"
    assert "animation" not in shown
