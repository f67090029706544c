"""KHR_animation_pointer: every kind of value that can move, at a time; and every way to miss it."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from daguerre.errors import InputError
from daguerre.files.json_item import Item
from daguerre.importers.gltf import reader as gltf
from daguerre.importers.gltf.pointers import parse
from tests.support.formats.make_gltf import CORNERS, Builder, png, triangle

HALF = math.sqrt(0.5)


def point(b: Builder, pointer, keys, values, mode=None, dtype="f4", **accessor) -> None:
    """Adds an animation of what the pointer leads to."""
    sampler = {"input": b.accessor(keys), "output": b.accessor(values, dtype, **accessor)}
    if mode:
        sampler["interpolation"] = mode
    extension = {"KHR_animation_pointer": {"pointer": pointer}}
    channel = {"sampler": 0, "target": {"path": "pointer", "extensions": extension}}
    b.add("animations", {"samplers": [sampler], "channels": [channel]})


def load(b: Builder, tmp_path, time: float = 0.0):
    return gltf.read(b.glb(tmp_path / "a.glb"), time=time)


def material(b: Builder, tmp_path, time: float = 0.0):
    scene = load(b, tmp_path, time)
    assert scene.warnings == []
    return scene.materials[0].kind


def painted(**values) -> Builder:
    b = triangle()
    b.add("materials", values)
    b.json["meshes"][0]["primitives"][0]["material"] = 0
    return b


# Nodes -----------------------------------------------------------------------------------------


def test_node_transforms(tmp_path):
    b = triangle()
    point(b, "/nodes/0/translation", [0, 2], [[0, 0, 0], [4, 0, 0]])
    point(b, "/nodes/0/rotation", [0, 2], [[0, 0, 0, 1], [0, 0, HALF, HALF]])
    point(b, "/nodes/0/scale", [0, 2], [[1, 1, 1], [3, 3, 3]])
    scene = load(b, tmp_path, 1.0)
    eighth = 2 * HALF  # scale 2, turned by 45 degrees
    wanted = [[eighth, -eighth, 0, 2], [eighth, eighth, 0, 0], [0, 0, 2, 0], [0, 0, 0, 1]]
    assert scene.instances[0].transform == pytest.approx(np.array(wanted), abs=1e-6)
    assert scene.warnings == []


def morphing() -> Builder:
    b = Builder()
    targets = [{"POSITION": b.accessor([[k, 0, 0]] * 3)} for k in (1, 10, 100)]
    b.mesh({"POSITION": b.accessor(CORNERS)}, targets=targets)
    b.node(mesh=0)
    return b


@pytest.mark.parametrize(
    ("mesh", "node", "pointer", "values", "wanted"),
    [
        (None, None, "/nodes/0/weights", [0.5, 1, 2], 210.5),
        (None, None, "/meshes/0/weights", [0.5, 1, 2], 210.5),
        ([3, 3, 3], None, "/nodes/0/weights", [0.5, 1, 2], 210.5),
        ([3, 3, 3], None, "/meshes/0/weights/1", [5], 353),
        ([3, 3, 3], None, "/nodes/0/weights/1", [5], 353),
        ([3, 3, 3], [4, 4, 4], "/nodes/0/weights/1", [5], 454),
        ([3, 3, 3], [4, 4, 4], "/meshes/0/weights/1", [5], 444),
        (None, None, "/nodes/0/weights/1", [5], 50),
        (None, None, "/meshes/0/weights/1", [5], 50),
    ],
)
def test_weights(tmp_path, mesh, node, pointer, values, wanted):
    b = morphing()
    b.json["meshes"][0] |= {"weights": mesh} if mesh else {}
    b.json["nodes"][0] |= {"weights": node} if node else {}
    point(b, pointer, [0], values)
    scene = load(b, tmp_path)
    assert scene.meshes[0].positions[0, 0] == pytest.approx(wanted)
    assert scene.warnings == []


def test_one_weight_of_a_node_leaves_its_mesh_alone(tmp_path):
    b = morphing()
    b.json["meshes"][0]["weights"] = [3, 3, 3]
    b.node(mesh=0)
    point(b, "/nodes/0/weights/2", [0], [5])
    scene = load(b, tmp_path)
    assert [scene.meshes[i.mesh].positions[0, 0] for i in scene.instances] == [533, 333]


@pytest.mark.parametrize(("time", "shown"), [(0, 0), (0.99, 0), (1, 1), (1.5, 1), (2, 0), (9, 0)])
def test_visibility(tmp_path, time, shown):
    b = triangle()
    b.json["nodes"][0]["extensions"] = {"KHR_node_visibility": {}}
    pointer = "/nodes/0/extensions/KHR_node_visibility/visible"
    point(b, pointer, [0, 1, 2], [0, 7, 0], "STEP", "u1")
    assert sum(i.shown for i in load(b, tmp_path, time).instances) == shown


# Materials -------------------------------------------------------------------------------------


def test_core_factors(tmp_path):
    b = painted(pbrMetallicRoughness={"metallicFactor": 1}, emissiveFactor=[1, 1, 1])
    pbr = "/materials/0/pbrMetallicRoughness/"
    point(b, pbr + "baseColorFactor", [0, 1], [[0, 0, 0, 1], [1, 0.5, 0.25, 0]])
    point(b, pbr + "metallicFactor", [0, 1], [0, 255], dtype="u1", normalized=True)
    point(b, pbr + "roughnessFactor", [0, 1], [0, 0.5])
    point(b, "/materials/0/emissiveFactor", [0, 1], [[0, 0, 0], [1, 2, 4]], "STEP")
    point(b, "/materials/0/alphaCutoff", [0, 1], [0, 1])
    kind = material(b, tmp_path, 0.5)
    assert kind.base_color == pytest.approx((0.5, 0.25, 0.125))
    assert (kind.base_alpha, kind.metallic, kind.roughness) == pytest.approx((0.5, 0.5, 0.25))
    assert (kind.emissive, kind.alpha_cutoff) == ((0, 0, 0), 0.5)
    assert material(b, tmp_path, 1.0).emissive == (1, 2, 4)


def test_a_spline_of_a_factor(tmp_path):
    b = painted(pbrMetallicRoughness={})
    # t^2 on [0, 1]: tangents 0 and 2.
    point(
        b,
        "/materials/0/pbrMetallicRoughness/roughnessFactor",
        [0, 1],
        [0, 0, 0, 2, 1, 2],
        "CUBICSPLINE",
    )
    assert material(b, tmp_path, 0.3).roughness == pytest.approx(0.09)


def test_factors_of_extensions(tmp_path):
    names = ("emissive_strength", "ior", "specular", "transmission", "volume")
    b = painted(
        extensions={f"KHR_materials_{name}": {} for name in names}, emissiveFactor=[1, 1, 1]
    )
    start = "/materials/0/extensions/KHR_materials_"
    point(b, start + "emissive_strength/emissiveStrength", [0, 1], [2, 6])
    point(b, start + "ior/ior", [0, 1], [1, 2])
    point(b, start + "specular/specularFactor", [0, 1], [0, 1])
    point(b, start + "specular/specularColorFactor", [0, 1], [[0, 0, 0], [1, 2, 3]])
    point(b, start + "transmission/transmissionFactor", [0, 1], [0, 1])
    point(b, start + "volume/thicknessFactor", [0, 1], [0, 8])
    point(b, start + "volume/attenuationDistance", [0, 1], [1, 3])
    point(b, start + "volume/attenuationColor", [0, 1], [[0, 0, 0], [1, 1, 1]])
    kind = material(b, tmp_path, 0.5)
    assert kind.emissive == (4, 4, 4)
    assert (kind.ior, kind.specular, kind.transmission, kind.thickness) == (1.5, 0.5, 0.5, 4)
    assert kind.specular_color == (0.5, 1, 1.5)
    assert (kind.attenuation_distance, kind.attenuation_color) == (2, (0.5, 0.5, 0.5))


def test_texture_transforms(tmp_path):
    transform = {"KHR_texture_transform": {"offset": [0, 0]}}
    texture = {"index": 0, "extensions": transform}
    b = painted(pbrMetallicRoughness={"baseColorTexture": texture})
    b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = b.accessor([[0, 0]] * 3)
    b.image(png(np.zeros((2, 2, 3), np.uint8)))
    start = "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/"
    point(b, start + "offset", [0, 1], [[0, 0], [2, 4]])
    point(b, start + "scale", [0, 1], [[1, 1], [3, 5]])
    point(b, start + "rotation", [0, 1], [0, math.pi])
    slot = material(b, tmp_path, 0.5).base_color_texture
    # A quarter turn with scale (2, 3): (u, v) -> (1 + 3 v, 2 - 2 u).
    assert slot.transform == pytest.approx((0, 3, 1, -2, 0, 2), abs=1e-6)


def test_texture_scale_and_strength(tmp_path):
    b = painted(normalTexture={"index": 0})
    b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = b.accessor([[0, 0]] * 3)
    b.image(png(np.zeros((2, 2, 3), np.uint8)))
    point(b, "/materials/0/normalTexture/scale", [0, 1], [0, 3])
    assert material(b, tmp_path, 0.5).normal_scale == 1.5


# Cameras and lights ----------------------------------------------------------------------------


def test_camera_and_focus_pull(tmp_path):
    b = triangle()
    lens = {"extras": {"daguerre": {"fStop": 2}}}
    b.add("cameras", {"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}} | lens)
    b.node(camera=0, name="eye")
    point(b, "/cameras/0/perspective/yfov", [0, 1], [0.5, 1.5])
    point(b, "/cameras/0/perspective/znear", [0, 1], [1, 2])
    point(b, "/cameras/0/extras/daguerre/focusDistance", [0, 1], [2, 4])
    point(b, "/cameras/0/extras/daguerre/fStop", [0, 1], [2, 8])
    scene = load(b, tmp_path, 0.5)
    camera = scene.camera("eye")
    assert camera.focal_length == pytest.approx(12 / math.tan(0.5))
    assert (camera.focus_distance, camera.f_stop) == (3, 5)
    assert scene.warnings == []


def test_lights(tmp_path):
    b = triangle()
    lamp = {"type": "spot", "spot": {}}
    b.json["extensions"] = {"KHR_lights_punctual": {"lights": [lamp]}}
    b.node(extensions={"KHR_lights_punctual": {"light": 0}})
    start = "/extensions/KHR_lights_punctual/lights/0/"
    point(b, start + "color", [0, 1], [[0, 0, 0], [1, 0.5, 0.25]])
    point(b, start + "intensity", [0, 1], [0, 8])
    point(b, start + "range", [0, 1], [1, 3])
    point(b, start + "spot/innerConeAngle", [0, 1], [0, 0.4])
    point(b, start + "spot/outerConeAngle", [0, 1], [0.5, 0.7])
    scene = load(b, tmp_path, 0.5)
    light, _ = scene.lights[0]
    assert light.intensity == pytest.approx((2, 1, 0.5))
    angles = [math.radians(a) for a in (light.inner_angle, light.outer_angle)]
    assert [light.range, *angles] == pytest.approx([2, 0.2, 0.6])
    assert scene.warnings == []


# Pointers themselves ---------------------------------------------------------------------------


@example(["~1", "~0", "~01", "/"])
@given(st.lists(st.text(max_size=5), min_size=1, max_size=5))
def test_rfc_6901_escapes(tokens):
    text = "".join("/" + t.replace("~", "~0").replace("/", "~1") for t in tokens)
    assert parse(Item(text, "a.glb")) == tokens


def test_escaped_names_are_found(tmp_path):
    b = painted(extensions={"A/B~C": {"x": 1}})
    point(b, "/materials/0/extensions/A~1B~0C/x", [0], [5])
    assert load(b, tmp_path).warnings == ["extension 'A/B~C' is not supported (1 use)"]


@pytest.mark.parametrize(
    "pointer",
    [
        "/",
        "/asset/version",
        "/nodes/0",
        "/nodes/0/mesh",
        "/nodes/0/name",
        "/nodes/0/matrix",
        "/nodes/0/translation/0",
        "/nodes/0/extensions/KHR_node_visibility/visible",
        "/nodes.length",
        "/accessors/0/count",
        "/bufferViews/0/byteOffset",
        "/materials/0/name",
        "/materials/0/doubleSided",
        "/materials/0/alphaMode",
        "/materials/0/emissiveFactor/0",
        "/materials/0/extensions/KHR_materials_ior/ior",
        "/materials/0/normalTexture/index",
        "/materials/0/normalTexture/extensions/KHR_texture_transform/offset",
        "/materials/0/normalTexture",
        "/meshes/0/primitives/0/mode",
        "/meshes/0/weights/0/x",
        "/extensions/KHR_lights_punctual/lights/0/color",
    ],
)
def test_what_cannot_move_is_told_and_left(tmp_path, pointer):
    b = painted(name="m", emissiveFactor=[1, 1, 1], normalTexture={"index": 0}, doubleSided=True)
    b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = b.accessor([[0, 0]] * 3)
    b.image(png(np.zeros((2, 2, 3), np.uint8)))
    point(b, pointer, [0], [3])
    scene = load(b, tmp_path)
    (note,) = scene.warnings
    shape = pointer.replace("/0", "/{}")
    assert note.startswith("an animation of '" + shape[:40])
    assert note.endswith("is left out: it cannot be animated (1 use)")
    assert scene.materials[0].kind.emissive == (1, 1, 1)


def test_the_last_of_two_animations_wins_however_they_are_written(tmp_path):
    b = triangle()
    sampler = {"input": b.accessor([0]), "output": b.accessor([[1, 0, 0]])}
    channel = {"sampler": 0, "target": {"node": 0, "path": "translation"}}
    b.add("animations", {"samplers": [sampler], "channels": [channel]})
    point(b, "/nodes/0/translation", [0], [[2, 0, 0]])
    scene = load(b, tmp_path)
    assert scene.instances[0].transform[0, 3] == 2
    assert "a second animation of the same translation replaces the first" in scene.warnings[0]


POINTER = r"animations\[0\]\.channels\[0\]\.target\.extensions\.KHR_animation_pointer\.pointer: "
OUTPUT = r"animations\[0\]\.samplers\[0\]\.output: "
BAD = {
    "no slash": ("nodes/0/scale", [[1, 1, 1]], POINTER + "wanted a JSON pointer such as"),
    "empty": ("", [[1, 1, 1]], POINTER + "wanted a JSON pointer such as"),
    "escape": ("/nodes/0/a~2", [[1, 1, 1]], POINTER + "wanted a JSON pointer such as"),
    "number": (3, [[1, 1, 1]], POINTER + "wrong type: wanted a string"),
    "node": ("/nodes/1/scale", [[1, 1, 1]], POINTER + r"index out of range: wanted 0 \.\. 0"),
    "negative": ("/nodes/-1/scale", [[1, 1, 1]], POINTER + "index out of range: .* got '-1'"),
    "leading zero": ("/nodes/00/scale", [[1, 1, 1]], POINTER + "index out of range"),
    "other digits": ("/nodes/\u0660/scale", [[1, 1, 1]], POINTER + "index out of range"),
    "long": ("/nodes/" + "9" * 9999 + "/scale", [[1, 1, 1]], POINTER + "index out of range"),
    "weight": ("/meshes/0/weights/0", [1], POINTER + "index out of range: wanted no index"),
    "too wide": ("/nodes/0/scale", [[1, 1, 1, 1]], OUTPUT + ".* wanted VEC3, got VEC4"),
    "too narrow": (
        "/materials/0/emissiveFactor",
        [1],
        OUTPUT + "wrong accessor type: wanted VEC3, got SCALAR",
    ),
    "flag of floats": (
        "/nodes/0/extensions/KHR_node_visibility/visible",
        [1],
        OUTPUT + "wanted SCALAR of component type 5121 and STEP",
    ),
    "out of range": (
        "/materials/0/alphaCutoff",
        [-1],
        r"materials\[0\]\.alphaCutoff: out of range: wanted at least 0, got -1",
    ),
    "of a wrong kind": (
        "/materials/0/pbrMetallicRoughness/roughnessFactor",
        [[1, 1]],
        r"materials\[0\]\.pbrMetallicRoughness\.roughnessFactor: wrong type: wanted a number",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_pointers(tmp_path, case):
    pointer, values, wanted = BAD[case]
    b = painted(emissiveFactor=[1, 1, 1], pbrMetallicRoughness={})
    b.json["nodes"][0]["extensions"] = {"KHR_node_visibility": {}}
    point(b, pointer, [0], values)
    with pytest.raises(InputError, match=wanted):
        load(b, tmp_path)


def test_visibility_of_wrong_mode_and_count(tmp_path):
    for mode, values, wanted in (
        ("LINEAR", [0, 1], "STEP for true or false"),
        ("STEP", [0, 1, 0], "wrong number of key values: wanted 2, got 3"),
    ):
        b = triangle()
        b.json["nodes"][0]["extensions"] = {"KHR_node_visibility": {}}
        pointer = "/nodes/0/extensions/KHR_node_visibility/visible"
        point(b, pointer, [0, 1], values, mode, "u1")
        with pytest.raises(InputError, match=wanted):
            load(b, tmp_path)


def test_many_channels_of_one_sampler_are_quick(tmp_path):
    start = time.perf_counter()
    b = painted(pbrMetallicRoughness={})
    keys = np.arange(300_000)
    point(b, "/materials/0/pbrMetallicRoughness/roughnessFactor", keys, np.zeros(len(keys)))
    b.json["animations"][0]["channels"] *= 5000
    load(b, tmp_path, 123.4)
    # Weights that are copied to nodes are counted.
    b = morphing()
    b.json["meshes"][0]["primitives"][0]["targets"] = [{}] * 100_000
    for k in range(50):
        b.node(mesh=0)
        point(b, f"/nodes/{k + 1}/weights/7", [0], [1])
    with pytest.raises(InputError, match="too many weights of single nodes: the limit is 4194304"):
        load(b, tmp_path)
    assert time.perf_counter() - start < 20
