"""Nodes of Blender's materials against Cycles' pictures, and by hand. Needs bpy."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("bpy")

import bpy
import OpenImageIO as oiio

from daguerre.errors import InputError

from .node_scenes import (
    SIZE,
    Read,
    Tree,
    cycles,
    emptied,
    picture,
    random_picture,
    stage,
)

#: Factor on a value before it is added to 1, so that no colour is negative.
SMALL = 0.005


@pytest.fixture(autouse=True)
def empty():
    emptied()


def pixels(seed, low, high):
    return lambda tree: tree.texture(random_picture(f"p{seed}", seed, low, high)).outputs["Color"]


def one(tree, source, channel=0):
    """A channel of a source."""
    return tree.node("SeparateColor", {0: source(tree)}).outputs[channel]


def output(node, name):
    return next(s for s in node.outputs if s.identifier == name)


def compared(build, folder, tolerance=3e-6):
    """Asserts that a value is that of Cycles at each texel; returns what was read."""
    tree = Tree()
    small = tree.node(
        "VectorMath",
        {0: build(tree), 1: (SMALL,) * 3, 2: (1.0,) * 3},
        operation="MULTIPLY_ADD",
    )
    tree.shine(small.outputs["Vector"])
    stage(tree.material)
    read = Read(tree.material)
    np.testing.assert_allclose(read.shines(), cycles(folder), atol=tolerance)
    assert not read.sentences
    return read


def choices(kind, name):
    emptied()
    node = Tree().node(kind)
    return [one.identifier for one in node.bl_rna.properties[name].enum_items]


@pytest.mark.parametrize("operation", choices("Math", "operation"))
def test_math(operation, tmp_path):
    def build(tree):
        inputs = {i: one(tree, pixels(i, -2, 2), i) for i in range(3)}
        node = tree.node("Math", operation=operation)
        for socket, source in zip(node.inputs, inputs.values(), strict=True):
            tree.links.new(source, socket)
        return node.outputs[0]

    compared(build, tmp_path)


@pytest.mark.parametrize("operation", choices("VectorMath", "operation"))
def test_vector_math(operation, tmp_path):
    def build(tree):
        low = 0.2 if operation == "DIVIDE" else -2
        node = tree.node("VectorMath", operation=operation)
        for i in range(3):
            tree.links.new(pixels(i, low, 2)(tree), node.inputs[i])
        next(s for s in node.inputs if s.identifier == "Scale").default_value = 0.7
        number = operation in ("DOT_PRODUCT", "LENGTH", "DISTANCE")
        return node.outputs["Value" if number else "Vector"]

    compared(build, tmp_path)


@pytest.mark.parametrize("mode", choices("MixRGB", "blend_type"))
@pytest.mark.parametrize("clamped", [False, True])
def test_blend_modes(mode, clamped, tmp_path):
    def build(tree):
        inputs = {
            "Factor_Float": one(tree, pixels(2, -0.2, 1.2)),
            "A_Color": pixels(0, 0, 1.2)(tree),
            "B_Color": pixels(1, 0, 1.2)(tree),
        }
        how = {"data_type": "RGBA", "blend_type": mode, "clamp_result": clamped}
        return output(tree.node("Mix", inputs, **how), "Result_Color")

    compared(build, tmp_path)


def test_mix_of_older_files(tmp_path):
    def build(tree):
        inputs = {
            "Fac": one(tree, pixels(2, -0.2, 1.2)),
            "Color1": pixels(0, 0, 1)(tree),
            "Color2": pixels(1, 0, 1)(tree),
        }
        return tree.node("MixRGB", inputs, blend_type="OVERLAY", use_clamp=True).outputs[0]

    compared(build, tmp_path)


@pytest.mark.parametrize("each", [False, True])
def test_mix_of_vectors_and_numbers(each, tmp_path):
    def build(tree):
        a, b = pixels(0, 0, 1)(tree), pixels(1, 0, 1)(tree)
        how = {"data_type": "VECTOR", "factor_mode": "NON_UNIFORM" if each else "UNIFORM"}
        share = "Factor_Vector" if each else "Factor_Float"
        value = (0.1, 0.5, 0.8) if each else 0.3
        mixed = output(
            tree.node("Mix", {"A_Vector": a, "B_Vector": b, share: value}, **how), "Result_Vector"
        )
        inputs = {"A_Float": mixed, "B_Float": 0.4, "Factor_Float": 0.2}
        number = output(tree.node("Mix", inputs, data_type="FLOAT"), "Result_Float")
        return tree.node("CombineXYZ", {0: number, 1: one(tree, lambda _: mixed, 1)}).outputs[0]

    compared(build, tmp_path)


ADJUSTMENTS = {
    "Invert": {"Fac": 0.3},
    "Gamma": {"Gamma": 2.2},
    "BrightContrast": {"Bright": 0.3, "Contrast": 0.4},
    "HueSaturation": {"Hue": 0.7, "Saturation": 1.3, "Value": 0.8, "Fac": 0.9},
    "RGBToBW": {},
}


@pytest.mark.parametrize("kind", ADJUSTMENTS)
def test_adjustments(kind, tmp_path):
    def build(tree):
        return tree.node(kind, {"Color": pixels(0, -0.3, 1.5)(tree), **ADJUSTMENTS[kind]}).outputs[
            0
        ]

    compared(build, tmp_path)


@pytest.mark.parametrize("interpolation", ["LINEAR", "CONSTANT", "EASE", "B_SPLINE", "CARDINAL"])
@pytest.mark.parametrize("name", ["Color", "Alpha"])
def test_ramp(interpolation, name, tmp_path):
    def build(tree):
        node = tree.node("ValToRGB", {"Fac": one(tree, pixels(0, -0.3, 1.5))})
        node.color_ramp.elements.new(0.4).color = (1, 0.2, 0.1, 0.5)
        node.color_ramp.interpolation = interpolation
        return node.outputs[name]

    compared(build, tmp_path)


def test_jump_of_a_ramp_is_sharp():
    tree = Tree()
    node = tree.node("ValToRGB")
    node.color_ramp.interpolation = "CONSTANT"
    node.color_ramp.elements[1].position = 0.7
    for share, color in ((0.69999, 0.0), (0.70001, 1.0)):
        node.inputs["Fac"].default_value = share
        tree.shine(node.outputs["Color"])
        np.testing.assert_allclose(Read(tree.material).shines(), color)


@pytest.mark.parametrize("kind", ["RGBCurve", "VectorCurve", "FloatCurve"])
def test_curves(kind, tmp_path):
    def build(tree):
        name = {"RGBCurve": "Color", "VectorCurve": "Vector", "FloatCurve": "Value"}[kind]
        share = "Factor" if kind == "FloatCurve" else "Fac"
        node = tree.node(kind, {name: pixels(0, -0.3, 1.5)(tree), share: 0.8})
        for i, curve in enumerate(node.mapping.curves):
            curve.points.new(0.3 + 0.1 * i, 0.6 - 0.1 * i)
        node.mapping.update()
        return node.outputs[0]

    compared(build, tmp_path, 1e-5)


@pytest.mark.parametrize("mode", ["RGB", "HSV", "HSL"])
def test_channels(mode, tmp_path):
    def apart(tree):
        node = tree.node("SeparateColor", {0: pixels(0, 0, 1)(tree)}, mode=mode)
        return tree.node("CombineXYZ", {i: node.outputs[i] for i in range(3)}).outputs[0]

    def joined(tree):
        node = tree.node("SeparateXYZ", {0: pixels(0, 0, 1)(tree)})
        inputs = {i: node.outputs[i] for i in range(3)}
        return tree.node("CombineColor", inputs, mode=mode).outputs[0]

    compared(apart, tmp_path)
    emptied()
    compared(joined, tmp_path)


@pytest.mark.parametrize("clamped", [False, True])
@pytest.mark.parametrize("how", ["LINEAR", "STEPPED", "SMOOTHSTEP", "SMOOTHERSTEP"])
def test_map_range(how, clamped, tmp_path):
    options = {"interpolation_type": how, "clamp": clamped}

    def number(tree):
        inputs = {0: one(tree, pixels(0, -1, 2)), 1: -0.2, 2: 1.1, 3: 0.3, 4: -2.0}
        return tree.node("MapRange", inputs, **options).outputs["Result"]

    def vector(tree):
        inputs = {
            "Vector": pixels(0, -1, 2)(tree),
            "From_Min_FLOAT3": (-0.2, 0.1, 0.0),
            "To_Max_FLOAT3": (2.0, -1.0, 3.0),
        }
        node = tree.node("MapRange", inputs, data_type="FLOAT_VECTOR", **options)
        return node.outputs["Vector"]

    compared(number, tmp_path)
    emptied()
    compared(vector, tmp_path)


@pytest.mark.parametrize("how", ["MINMAX", "RANGE"])
def test_clamp(how, tmp_path):
    def build(tree):
        inputs = {0: one(tree, pixels(0, -1, 2)), 1: 0.8, 2: 0.1}
        return tree.node("Clamp", inputs, clamp_type=how).outputs[0]

    compared(build, tmp_path)


def test_numbers_of_colors_and_vectors(tmp_path):
    def build(tree):
        color = pixels(0, 0, 1)(tree)
        vector = tree.node("VectorMath", {0: color, 1: (0.1, 0.2, 0.3)}).outputs[0]
        grey = tree.node("Math", {0: color, 1: 0.0}).outputs[0]
        mean = tree.node("Math", {0: vector, 1: 0.0}).outputs[0]
        value, rgb = tree.node("Value"), tree.node("RGB")
        value.outputs[0].default_value, rgb.outputs[0].default_value = 0.3, (0.2, 0.4, 0.9, 1)
        total = tree.node("Math", {0: value.outputs[0], 1: rgb.outputs[0]}).outputs[0]
        return tree.node("CombineXYZ", {0: grey, 1: mean, 2: total}).outputs[0]

    compared(build, tmp_path)


SPACES = ["sRGB", "Non-Color", "Linear Rec.709", "Linear Rec.2020", "Linear DCI-P3 D65"]
SPACES += ["Display P3", "Rec.1886", "Rec.2020", "ACEScg", "ACES2065-1", "scene_linear"]


def some_bytes(seed=5, *, opaque=True):
    found = np.rint(np.random.default_rng(seed).uniform(0, 1, (SIZE, SIZE, 4)) * 255) / 255
    found[:, :, 3] = 1 if opaque else np.maximum(found[:, :, 3], 0.3)
    return found


@pytest.mark.parametrize("space", SPACES)
def test_color_spaces(space, tmp_path):
    def build(tree):
        return tree.texture(picture("p", some_bytes(), space, floats=False)).outputs["Color"]

    # Cycles keeps converted bytes as floats of 16 bits: 2^-11 of values up to 2.
    compared(build, tmp_path, SMALL * 3e-3)


def test_unknown_color_space_is_noted():
    tree = Tree()
    image = picture("p", some_bytes(), "Filmic sRGB", floats=False)
    tree.shine(tree.texture(image).outputs["Color"])
    assert Read(tree.material).sentences == [
        "colour space 'Filmic sRGB' is unknown: read as linear Rec.709 (1 use)"
    ]


@pytest.mark.parametrize("linked", [False, True])
@pytest.mark.parametrize("mode", ["STRAIGHT", "PREMUL", "CHANNEL_PACKED", "NONE"])
@pytest.mark.parametrize("space", ["sRGB", "Linear Rec.709", "Non-Color"])
@pytest.mark.parametrize("floats", [False, True])
def test_opacity_of_pictures(floats, space, mode, linked, tmp_path):
    kept = "STRAIGHT" if floats else "PREMUL"
    if bpy.app.version >= (5, 1) and mode == kept and space != "Non-Color":
        pytest.skip("Blender 5.2 multiplies pixels that a script makes in another way; not files")

    def build(tree):
        image = picture("p", some_bytes(opaque=False), space, floats=floats)
        image.alpha_mode = mode
        node = tree.texture(image)
        tint = node.outputs["Alpha"] if linked else (0.5, 0.5, 0.5)
        return tree.node("VectorMath", {0: node.outputs["Color"], 1: tint}).outputs[0]

    # Blender multiplies bytes with opacity in 8 bits: 1/2 of a step, divided by the least opacity.
    compared(build, tmp_path, 3e-6 if floats else SMALL * 0.5 / 255 / 0.3 * 4)


@pytest.mark.parametrize("how", ["packed", "file"])
@pytest.mark.parametrize("suffix", [".png", ".exr"])
def test_pictures_of_files(how, suffix, tmp_path):
    path = tmp_path / f"picture{suffix}"
    out = oiio.ImageOutput.create(str(path))
    out.open(str(path), oiio.ImageSpec(SIZE, SIZE, 3, "uint8" if suffix == ".png" else "float"))
    out.write_image(some_bytes()[:, :, :3].astype(np.float32))
    out.close()

    def build(tree):
        image = bpy.data.images.load(str(path))
        if how == "packed":
            image.pack()
            path.unlink()
        return tree.texture(image).outputs["Color"]

    read = compared(build, tmp_path)
    assert len(read.scene.textures) == 1


def test_missing_picture_is_magenta():
    tree = Tree()
    image = bpy.data.images.new("p", 4, 4)
    image.source, image.filepath = "FILE", "/nowhere/at/all.png"
    tree.shine(tree.texture(image).outputs["Color"])
    read = Read(tree.material)
    np.testing.assert_allclose(read.shines(), [1, 0, 1])
    assert read.sentences == ["an image without pixels is magenta (1 use)"]


def looked_up(read, slot, points):
    """Texels of a texture at points (u, v) of a mesh of Blender, the nearest ones."""
    a, b, c, d, e, f = slot.transform
    pixels, wrap = read.pixels(slot), read.scene.textures[slot.texture].wrap
    height, width = pixels.shape[:2]
    found = []
    for u, v in points:
        at = [a * u + b * (1 - v) + c, d * u + e * (1 - v) + f]
        index = []
        for x, count, how in zip(at, (width, height), wrap, strict=True):
            if how == "repeat":
                x = x % 1
            elif how == "mirror":
                x = 1 - abs(x % 2 - 1)
            index.append(min(max(int(np.floor(x * count)), 0), count - 1))
        found.append(pixels[index[1], index[0], :3])
    return np.array(found)


def texels():
    """Points of the square in the middle of its pixels, row 0 on top."""
    at = (np.arange(SIZE) + 0.5) / SIZE
    return [(u, v) for v in at[::-1] for u in at]


def placed(build, folder):
    """Asserts that a texture lies as in Cycles."""
    tree = Tree()
    tree.shine(build(tree))
    stage(tree.material)
    read = Read(tree.material)
    slot = read.kind.emissive_texture
    found = looked_up(read, slot, texels()) * np.array(read.kind.emissive) / 683.0
    theirs = cycles(folder).reshape(-1, 3)
    np.testing.assert_allclose(found, theirs, atol=1e-6)
    return read


@pytest.mark.parametrize("extension", ["REPEAT", "EXTEND", "CLIP", "MIRROR"])
def test_extension(extension, tmp_path):
    def build(tree):
        inputs = {"Location": (-0.6, -0.7, 0.0), "Scale": (2.0, 2.5, 1.0)}
        uv = tree.node("TexCoord").outputs["UV"]
        mapping = tree.node("Mapping", {"Vector": uv, **inputs})
        node = tree.texture(random_picture("p", 1), extension=extension)
        tree.links.new(mapping.outputs[0], node.inputs[0])
        return node.outputs[0]

    placed(build, tmp_path)


@pytest.mark.parametrize("kind", ["POINT", "TEXTURE", "VECTOR"])
def test_mapping(kind, tmp_path):
    def build(tree):
        inputs = {
            "Location": (0.213, -0.331, 0.4),
            "Rotation": (0.3, 0.2, 0.7),
            "Scale": (1.3, 0.8, 2.0),
        }
        if kind == "VECTOR":
            del inputs["Location"]
        inputs["Vector"] = tree.node("UVMap").outputs["UV"]
        mapping = tree.node("Mapping", inputs, vector_type=kind)
        node = tree.texture(random_picture("p", 1))
        tree.links.new(mapping.outputs[0], node.inputs[0])
        return node.outputs[0]

    placed(build, tmp_path)


def test_coordinates_by_vector_math(tmp_path):
    def build(tree):
        uv = tree.node("TexCoord").outputs["UV"]
        moved = tree.node(
            "VectorMath", {0: uv, 1: (0.3, 1.7, 0), 2: (0.2, 0.1, 0)}, operation="MULTIPLY_ADD"
        )
        scaled = tree.node("VectorMath", {0: moved.outputs[0]}, operation="SCALE")
        next(s for s in scaled.inputs if s.identifier == "Scale").default_value = 1.4
        node = tree.texture(random_picture("p", 1))
        tree.links.new(scaled.outputs[0], node.inputs[0])
        return node.outputs[0]

    placed(build, tmp_path)


def test_udim(tmp_path):
    tiles = {1001: (0.1, 0.2, 0.3), 1002: (0.9, 0.5, 0.1), 1011: (0.3, 0.8, 0.2)}
    for number, color in tiles.items():
        path = tmp_path / f"t.{number}.png"
        out = oiio.ImageOutput.create(str(path))
        out.open(str(path), oiio.ImageSpec(4, 4, 3, "uint8"))
        out.write_image(np.full((4, 4, 3), color, np.float32))
        out.close()
    image = bpy.data.images.load(str(tmp_path / "t.1001.png"))
    image.source, image.filepath = "TILED", str(tmp_path / "t.<UDIM>.png")
    for number in (1002, 1011):
        image.tiles.new(number)
    image.colorspace_settings.name = "Non-Color"
    tree = Tree()
    tree.shine(tree.texture(image).outputs[0])
    read = Read(tree.material)
    points = {1001: (0.5, 0.5), 1002: (1.5, 0.5), 1011: (0.5, 1.5)}
    found = looked_up(read, read.kind.emissive_texture, points.values())
    if found.dtype == np.uint8:
        found = found / 255
    np.testing.assert_allclose(found, list(tiles.values()), atol=0.5 / 255)


def test_layers_of_coordinates_and_colors():
    tree = Tree()
    second = tree.texture(random_picture("p", 1))
    tree.links.new(tree.node("UVMap", uv_map="Second").outputs[0], second.inputs[0])
    color = tree.node("VertexColor", layer_name="Paint").outputs["Color"]
    shader = tree.node("BsdfPrincipled", {"Base Color": color, "Roughness": second.outputs[0]})
    tree.surface(shader)
    read = Read(tree.material)
    assert read.materials.uv_sets(tree.material) == ("Second",)
    assert read.materials.color_attribute(tree.material) == "Paint"
    assert read.kind.metallic_roughness_texture.uv_set == 0
    shader.inputs["Metallic"].default_value = 0.0
    tree.links.new(tree.texture(random_picture("q", 2)).outputs[0], shader.inputs["Base Color"])
    read = Read(tree.material)
    assert read.materials.uv_sets(tree.material) == ("", "Second")
    assert read.materials.color_attribute(tree.material) is None
    assert read.kind.metallic_roughness_texture.uv_set == 1


def test_groups_reroutes_and_muted_nodes(tmp_path):
    def group():
        made = bpy.data.node_groups.new("G", "ShaderNodeTree")
        for name, kind in (("A", "NodeSocketColor"), ("B", "NodeSocketFloat")):
            made.interface.new_socket(name, in_out="INPUT", socket_type=kind)
        made.interface.new_socket("Out", in_out="OUTPUT", socket_type="NodeSocketColor")
        inside, out = made.nodes.new("NodeGroupInput"), made.nodes.new("NodeGroupOutput")
        gamma, muted = made.nodes.new("ShaderNodeGamma"), made.nodes.new("ShaderNodeInvert")
        muted.mute = True
        reroute = made.nodes.new("NodeReroute")
        made.links.new(inside.outputs["A"], reroute.inputs[0])
        made.links.new(reroute.outputs[0], muted.inputs["Color"])
        made.links.new(muted.outputs[0], gamma.inputs["Color"])
        made.links.new(inside.outputs["B"], gamma.inputs["Gamma"])
        made.links.new(gamma.outputs[0], out.inputs["Out"])
        return made

    def build(tree):
        made = group()
        sockets = []
        for exponent in (0.5, 2.0):  # the same group twice, with other values
            node = tree.node("Group")
            node.node_tree = made
            node.inputs["B"].default_value = exponent
            tree.links.new(pixels(1, 0, 1)(tree), node.inputs["A"])
            sockets.append(node.outputs[0])
        return tree.node("VectorMath", dict(enumerate(sockets)), operation="SUBTRACT").outputs[0]

    compared(build, tmp_path)


def nested(inside):
    """Group with one colour that passes through another group, or a Gamma of 2."""
    made = bpy.data.node_groups.new("N", "ShaderNodeTree")
    made.interface.new_socket("A", in_out="INPUT", socket_type="NodeSocketColor")
    made.interface.new_socket("Out", in_out="OUTPUT", socket_type="NodeSocketColor")
    begin, end = made.nodes.new("NodeGroupInput"), made.nodes.new("NodeGroupOutput")
    node = made.nodes.new("ShaderNodeGroup" if inside else "ShaderNodeGamma")
    if inside:
        node.node_tree = inside
    else:
        node.inputs["Gamma"].default_value = 2.0
    made.links.new(begin.outputs[0], node.inputs[0])
    made.links.new(node.outputs[0], end.inputs[0])
    return made


def test_groups_pass_inputs_to_groups_inside(tmp_path):
    def build(tree):
        node = tree.node("Group")
        node.node_tree = nested(nested(nested(None)))
        tree.links.new(pixels(1, 0, 1)(tree), node.inputs[0])
        return node.outputs[0]

    compared(build, tmp_path)


def test_groups_inside_each_other_are_limited(monkeypatch):
    monkeypatch.setattr("daguerre.blender.shading.network.MAX_NODES", 500)
    trees = []
    for level in range(12):  # 2^12 nodes in twelve groups
        made = bpy.data.node_groups.new(f"G{level}", "ShaderNodeTree")
        made.interface.new_socket("Out", in_out="OUTPUT", socket_type="NodeSocketFloat")
        add, out = made.nodes.new("ShaderNodeMath"), made.nodes.new("NodeGroupOutput")
        for i in range(2 if trees else 0):
            node = made.nodes.new("ShaderNodeGroup")
            node.node_tree = trees[-1]
            made.links.new(node.outputs[0], add.inputs[i])
        made.links.new(add.outputs[0], out.inputs[0])
        trees.append(made)
    tree = Tree()
    node = tree.node("Group")
    node.node_tree = trees[-1]
    tree.shine(node.outputs[0])
    with pytest.raises(InputError, match=r"material 'M': wanted at most 500 shading nodes"):
        Read(tree.material)


def test_unknown_nodes_are_counted_and_the_socket_keeps_its_value():
    tree = Tree()
    unknown = tree.node("ObjectInfo").outputs["Random"]
    shader = tree.node("BsdfPrincipled", {"Roughness": 0.37, "Metallic": 0.21})
    for name in ("Roughness", "Metallic"):
        tree.links.new(unknown, shader.inputs[name])
    tree.surface(shader)
    read = Read(tree.material)
    assert read.kind.roughness == pytest.approx(0.37)
    assert read.kind.metallic == pytest.approx(0.21)
    assert read.sentences == ["shading node 'ShaderNodeObjectInfo' is not supported (1 use)"]


PATTERNS = ["Noise", "Voronoi", "Wave", "Gradient", "Magic", "Brick", "Checker"]


@pytest.mark.parametrize("kind", PATTERNS)
def test_patterns_without_a_surface_become_their_mean(kind):
    tree = Tree()
    node = tree.node(f"Tex{kind}")
    if kind == "Checker":
        node.inputs["Color1"].default_value = (0.2, 0.4, 0.8, 1)
        node.inputs["Color2"].default_value = (0.6, 0.8, 0.0, 1)
    tree.shine(node.outputs["Color"])
    read = Read(tree.material)
    expected = (0.4, 0.6, 0.4) if kind == "Checker" else (0.5, 0.5, 0.5)
    np.testing.assert_allclose(read.shines(), expected, rtol=1e-6)
    assert read.sentences == [f"Tex{kind}: the pattern is replaced by its mean (1 use)"]


@pytest.mark.parametrize("kind", ["Generated", "Object"])
def test_other_coordinates_are_noted_where_they_are_read(kind):
    tree = Tree()
    node = tree.texture(random_picture("p", 1))
    tree.links.new(tree.node("TexCoord").outputs[kind], node.inputs[0])
    tree.shine(node.outputs[0])
    assert Read(tree.material).sentences == [
        f"TexCoord: '{kind}' coordinates are read as 'UV' (1 use)"
    ]
