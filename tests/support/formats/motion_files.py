"""Small glTF files that are animated, one for each way a file can move something."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import daguerre as dg
from tests.support.formats.make_gltf import Builder, png
from tests.support.pictures.blur import Case, case, without_motion
from tests.support.scene import scenes
from tests.support.scene.motion_scenes import OPEN, TIME, pattern

QUAD = [0, 1, 2, 0, 2, 3]
UV = [(0, 1), (1, 1), (1, 0), (0, 0)]
SPAN = [0.75, 1.25]  # longer than the exposure, s
YFOV = 2 * math.atan(12 / 35)  # of 35 mm on 24 mm
STEPS = [0.75, 0.9, 1.25]


def about_z(degrees: float) -> list[float]:
    """A quaternion."""
    half = math.radians(degrees) / 2
    return [0, 0, math.sin(half), math.cos(half)]


def glowing_card(**attributes: Any) -> Builder:
    """A square of 1 m that shines with a pattern, at node 0, 3 m ahead."""
    b = Builder()
    texture = b.image(png((pattern() * 255).astype(np.uint8)), sampler=0)
    b.add("samplers", {"magFilter": 9728, "minFilter": 9728})
    paint = {
        "pbrMetallicRoughness": {"baseColorTexture": {"index": texture}},
        "extensions": {"KHR_materials_unlit": {}},
        "doubleSided": True,
    }
    b.add("materials", paint)
    points, _ = scenes.quad(0.5)
    b.mesh(
        {"POSITION": b.accessor(points), "TEXCOORD_0": b.accessor(UV)}
        | {name: b.accessor(values) for name, values in attributes.items()},
        indices=b.accessor(QUAD, "u2"),
        material=0,
    )
    b.node(mesh=0, name="card", translation=[0, 0, -3])
    return b


def animate(
    b: Builder, target: int | str, path: str, times: Any, values: Any, mode: str = "LINEAR"
):
    """Adds an animation of a node's property, or of what a pointer leads to."""
    sampler = {"input": b.accessor(times), "output": b.accessor(values), "interpolation": mode}
    where: dict[str, Any] = {"node": target, "path": path}
    if isinstance(target, str):
        where = {
            "path": "pointer",
            "extensions": {"KHR_animation_pointer": {"pointer": target + "/" + path}},
        }
    channels = [{"sampler": 0, "target": where}]
    b.add("animations", {"samplers": [sampler], "channels": channels})


def below(b: Builder, **values: Any) -> int:
    """Puts node 0 below a new root, and says which that is."""
    parent = b.node(children=[0], **values)
    b.json["scenes"][0]["nodes"].remove(0)
    return parent


def lit(b: Builder) -> Builder:
    """Paint in place of the glow, and a sun that shines on it aslant."""
    b.json["materials"][0].pop("extensions")
    b.json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 0.2
    b.json["extensions"] = {
        "KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3}]}
    }
    b.node(extensions={"KHR_lights_punctual": {"light": 0}}, rotation=[-0.3, 0.2, 0, 0.9327])
    return b


# Nodes -----------------------------------------------------------------------------------------


def channels(mode: str) -> Callable[[], Builder]:
    """Translation, rotation and scale, each by an interpolation of glTF."""

    def make() -> Builder:
        b = glowing_card()
        paths = {
            "translation": [[-0.7, 0, -3], [0.5, 0.5, -3], [0.7, -0.3, -2.5]],
            "rotation": [about_z(0), about_z(100), about_z(170)],
            "scale": [[1, 1, 1], [0.5, 1.5, 1], [1.2, -0.8, 1]],
        }
        for path, values in paths.items():
            if mode == "CUBICSPLINE":
                slope = np.array(values[1]) * 2
                values = [row for v in values for row in (slope, v, slope)]
            animate(b, 0, path, STEPS, values, mode)
        return b

    return make


def nested() -> Builder:
    """Turning below what turns and travels: no segment of it is decomposed."""
    b = glowing_card()
    b.json["nodes"][0]["translation"] = [0.5, 0, 0]
    parent = below(b)
    animate(b, 0, "rotation", SPAN, [about_z(0), about_z(170)])
    animate(b, parent, "rotation", SPAN, [about_z(90), about_z(-80)])
    animate(b, parent, "translation", STEPS, [[-0.5, 0, -3], [0, 0, -3], [0.3, 0, -2]])
    return b


def instanced() -> Builder:
    """Instances below a node that moves."""
    b = glowing_card()
    columns = {
        "TRANSLATION": b.accessor([[-0.8, 0, 0], [0.8, 0.3, 0], [0, -0.7, 0.5]]),
        "SCALE": b.accessor([[0.5, 0.5, 1], [0.7, 0.7, 1], [0.4, 0.4, 1]]),
    }
    extension = {"EXT_mesh_gpu_instancing": {"attributes": columns}}
    b.json["nodes"][0]["extensions"] = extension
    parent = below(b)
    animate(b, parent, "rotation", SPAN, [about_z(-40), about_z(60)])
    return b


def hidden() -> Builder:
    """Visible for a part of the exposure."""
    b = glowing_card()
    b.json["nodes"][0]["extensions"] = {"KHR_node_visibility": {"visible": True}}
    values = {"input": b.accessor([0.0, 0.95, 1.1]), "output": b.accessor([0, 1, 0], "u1")}
    pointer = "/nodes/0/extensions/KHR_node_visibility/visible"
    extension = {"KHR_animation_pointer": {"pointer": pointer}}
    channel = {"sampler": 0, "target": {"path": "pointer", "extensions": extension}}
    b.add(
        "animations",
        {"samplers": [values | {"interpolation": "STEP"}], "channels": [channel]},
    )
    return b


def through_nothing() -> Builder:
    """Shrinks to nothing and comes back mirrored."""
    b = glowing_card()
    animate(b, 0, "scale", SPAN, [[1.5, 1, 1], [-1.2, 1, 1]])
    return b


def on_a_disc() -> Builder:
    """Keys end in the middle of the exposure: what comes then stands still."""
    b = glowing_card()
    animate(b, 0, "translation", [0.0, 0.95], [[-9, 0, -3], [0.3, 0, -3]])
    return b


# Vertices --------------------------------------------------------------------------------------


def skinned() -> Builder:
    """A strip bent by two joints, smooth and lit."""
    points = [[x, y, 0] for x in np.linspace(-0.8, 0.8, 9) for y in (-0.4, 0.4)]
    weights = [[1 - w, w, 0, 0] for w in np.linspace(0, 1, 9) for _ in (0, 1)]
    faces = [i for a in range(0, 16, 2) for i in (a, a + 2, a + 3, a, a + 3, a + 1)]
    b = Builder()
    b.add("materials", {"doubleSided": True, "pbrMetallicRoughness": {"metallicFactor": 0}})
    count = len(points)
    b.mesh(
        {
            "POSITION": b.accessor(points),
            "NORMAL": b.accessor([[0, 0, 1]] * count),
            "JOINTS_0": b.accessor([[0, 1, 0, 0]] * count, "u1"),
            "WEIGHTS_0": b.accessor(weights),
        },
        indices=b.accessor(faces, "u2"),
        material=0,
    )
    b.node(mesh=0, skin=0, name="arm")
    root = b.node(children=[2], translation=[0, 0, -3])
    joint = b.child(name="hand")
    b.add("skins", {"joints": [root, joint]})
    quarter = [0, math.sin(0.6), 0, math.cos(0.6)]
    animate(b, joint, "rotation", SPAN, [about_z(-60), quarter])
    animate(b, root, "translation", SPAN, [[-0.2, 0, -3], [0.2, 0.3, -3]])
    lights = {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3}]}}
    b.json["extensions"] = lights
    b.node(extensions={"KHR_lights_punctual": {"light": 0}}, rotation=[-0.3, 0.2, 0, 0.9327])
    return b


def morphed() -> Builder:
    """Two targets, positions and normals, lit."""
    b = lit(glowing_card(NORMAL=[[0, 0, 1]] * 4))
    wide = [[-0.6, 0, 0], [0.6, 0, 0], [0.2, 0.5, 0.3], [0, 0, 0]]
    bent = [[0, 0.4, 0], [0, -0.5, 0], [0.3, 0, 0], [0, 0.5, 0.4]]
    tilt = [[0.5, 0, -0.1]] * 4
    b.json["meshes"][0]["primitives"][0]["targets"] = [
        {"POSITION": b.accessor(wide), "NORMAL": b.accessor(tilt)},
        {"POSITION": b.accessor(bent)},
    ]
    animate(b, 0, "weights", STEPS, [0, 1, 1, 0.3, 0.2, 1])
    return b


# Targets of the pointers -----------------------------------------------------------------------


def materials() -> Builder:
    """Base colour, texture transform and what a coat adds."""
    b = glowing_card()
    texture = b.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]
    texture["extensions"] = {"KHR_texture_transform": {"offset": [0, 0]}}
    factors = "/materials/0/pbrMetallicRoughness"
    colors = [[1, 0.2, 0.2, 1], [0.2, 1, 0.2, 1], [0.2, 0.2, 1, 1]]
    animate(b, factors, "baseColorFactor", STEPS, colors)
    transform = factors + "/baseColorTexture/extensions/KHR_texture_transform"
    animate(b, transform, "offset", SPAN, [[0, 0], [0.6, 0.2]])
    animate(b, transform, "rotation", SPAN, [[0], [1.2]])
    return b


def coated() -> Builder:
    """Roughness, metal and a clear coat under a lamp that changes."""
    b = lit(glowing_card(NORMAL=[[0, 0, 1]] * 4))
    b.json["materials"][0]["extensions"] = {"KHR_materials_clearcoat": {"clearcoatFactor": 0}}
    animate(b, "/materials/0/pbrMetallicRoughness", "roughnessFactor", SPAN, [[0.3], [0.9]])
    coat = "/materials/0/extensions/KHR_materials_clearcoat"
    animate(b, coat, "clearcoatFactor", SPAN, [[0], [1]])
    lamp = "/extensions/KHR_lights_punctual/lights/0"
    animate(b, lamp, "intensity", SPAN, [[1], [6]])
    animate(b, lamp, "color", SPAN, [[1, 1, 1], [1, 0.3, 0.1]])
    animate(b, 1, "rotation", SPAN, [[-0.3, 0.2, 0, 0.9327], [-0.6, -0.2, 0, 0.7746]])
    return b


def camera() -> Builder:
    """The camera of the file pans, and its field of view narrows."""
    b = glowing_card()
    b.add("cameras", {"type": "perspective", "perspective": {"yfov": YFOV}})
    eye = b.node(camera=0, name="eye")
    animate(b, eye, "translation", SPAN, [[-0.3, 0, 0], [0.3, 0.1, -0.3]])
    animate(b, eye, "rotation", SPAN, [about_z(-10), about_z(25)])
    animate(b, "/cameras/0/perspective", "yfov", SPAN, [[0.9], [0.4]])
    return b


ALL: dict[str, Callable[[], Builder]] = {
    **{mode: channels(mode) for mode in ("LINEAR", "STEP", "CUBICSPLINE")},
    "nested": nested,
    "instancing": instanced,
    "visibility": hidden,
    "scale through zero": through_nothing,
    "keys that end": on_a_disc,
    "skin": skinned,
    "morph": morphed,
    "materials": materials,
    "coat and lamp": coated,
    "camera": camera,
}


def file_case(name: str, folder: Path) -> Case:
    """The file as read at the time of the frame; still frames as read at theirs."""
    b = ALL[name]()
    if "cameras" not in b.json:
        b.add("cameras", {"type": "perspective", "perspective": {"yfov": YFOV}})
        b.node(camera=0, name="eye")
    path = b.glb(folder / "moves.glb")

    def read(t: float) -> tuple[dg.Scene, dg.Camera]:
        scene = dg.load(path, time=t)
        assert scene.warnings == []
        scene.set_environment(color=(0.3, 0.4, 0.5))
        return scene, scene.camera("eye").with_(lens="pinhole")

    def still(t: float) -> tuple[dg.Scene, dg.Camera]:
        scene, camera = read(t)
        return without_motion(scene), camera.frozen_at(t).with_(shutter_time=0.0)

    return replace(case(*read(TIME), OPEN), still=still)
