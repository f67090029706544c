"""Materials of Blender: socket by socket, mixes of shaders, and light against Cycles. Needs bpy."""

from __future__ import annotations

import math

import numpy as np
import pytest

pytest.importorskip("bpy")

import bpy

import daguerre as dg
from daguerre.blender.materials import Materials
from daguerre.errors import InputError
from daguerre.files.notes import Notes

from .node_scenes import CD_PER_W, SIZE, Read, Tree, cycles, emptied, picture, random_picture, stage

COLOR = (0.25, 0.5, 0.8)


@pytest.fixture(autouse=True)
def empty():
    emptied()


def principled(**sockets):
    """Material of a Principled BSDF whose sockets have some values; _ stands for a space."""
    tree = Tree()
    inputs = {name.replace("_", " "): value for name, value in sockets.items()}
    tree.surface(tree.node("BsdfPrincipled", inputs))
    return Read(tree.material)


def read(build):
    tree = Tree()
    tree.surface(build(tree))
    return Read(tree.material)


FIELDS = [
    ({"Base_Color": COLOR}, {"base_color": COLOR, "metallic": 0.0, "emissive": (0, 0, 0)}),
    ({}, {"double_sided": True, "alpha_mode": "opaque", "transmission": 0.0, "clearcoat": 0.0}),
    ({"Metallic": 0.3}, {"metallic": 0.3}),
    ({"Roughness": 0.3}, {"roughness": 0.3}),
    ({"IOR": 1.8}, {"ior": 1.8}),
    ({"Alpha": 0.3}, {"base_alpha": 0.3, "alpha_mode": "blend"}),
    ({}, {"specular": 1.0, "specular_color": (1.0, 1.0, 1.0)}),
    ({"Specular_IOR_Level": 1.0}, {"specular_color": (2.0, 2.0, 2.0)}),
    ({"Specular_IOR_Level": 0.0}, {"specular": 0.0}),
    ({"Specular_IOR_Level": 0.25, "Specular_Tint": COLOR}, {"specular_color": (0.125, 0.25, 0.4)}),
    ({"Transmission_Weight": 1.0, "Base_Color": (0.25, 0.49, 0.81)},
     {"transmission": 1.0, "base_color": (0.5, 0.7, 0.9), "thickness": 1.0}),
    ({"Transmission_Weight": 0.5, "Base_Color": (0.25, 0.25, 0.25)},
     {"transmission": 0.5, "base_color": (0.375, 0.375, 0.375)}),
    ({"Coat_Weight": 0.6, "Coat_Roughness": 0.2}, {"clearcoat": 0.6, "clearcoat_roughness": 0.2}),
    ({"Coat_Weight": 0.5, "Coat_Tint": (0.2, 0.4, 1.0), "Base_Color": (0.5, 0.5, 0.5)},
     {"base_color": (0.3, 0.35, 0.5)}),
    ({"Sheen_Weight": 0.5, "Sheen_Tint": COLOR, "Sheen_Roughness": 0.4},
     {"sheen_color": (0.125, 0.25, 0.4), "sheen_roughness": 0.4}),
    ({"Emission_Color": COLOR, "Emission_Strength": 2.0}, {"emissive": (341.5, 683.0, 1092.8)}),
    ({"Thin_Film_Thickness": 300.0, "Thin_Film_IOR": 1.4},
     {"iridescence": 1.0, "iridescence_ior": 1.4, "iridescence_thickness_max_nm": 300.0}),
]  # fmt: skip


@pytest.mark.parametrize(("sockets", "fields"), FIELDS)
def test_principled_socket(sockets, fields):
    found = principled(**sockets)
    for name, value in fields.items():
        kept = getattr(found.kind, name)
        if isinstance(value, str | bool):
            assert kept == value, name
        else:
            np.testing.assert_allclose(kept, value, rtol=1e-6, err_msg=name)
    assert not found.sentences


def test_anisotropy():
    """Widths r^2 / q and r^2 q with q = sqrt(1 - 0.9 a), as glTF's r and s."""
    found = principled(Roughness=0.5, Anisotropic=0.8, Anisotropic_Rotation=0.25)
    q = math.sqrt(1 - 0.9 * 0.8)
    across, along = 0.25 * q, 0.25 / q
    assert found.kind.roughness == pytest.approx(math.sqrt(across))
    share = found.kind.anisotropy**2
    assert across + (1 - across) * share == pytest.approx(along)
    assert found.kind.anisotropy_rotation == pytest.approx(90.0)


NOTED = [
    ({"Subsurface_Weight": 0.5}, "subsurface scattering is shown as diffuse light of its colour"),
    ({"Coat_Weight": 0.5, "Coat_IOR": 1.7}, "a coat has the index of refraction 1.5"),
    ({"Diffuse_Roughness": 0.5}, "'Diffuse Roughness' is not supported"),
    ({"Metallic": 1.0, "Specular_Tint": COLOR},
     "'Specular Tint' does not colour the edges of metals"),
    ({"Anisotropic": 0.5}, "highlights are stretched along the texture coordinates"),
]  # fmt: skip


@pytest.mark.parametrize(("sockets", "sentence"), NOTED)
def test_principled_notes(sockets, sentence):
    assert principled(**sockets).sentences == [f"BsdfPrincipled: {sentence} (1 use)"]


def test_index_below_one_is_inverted():
    assert principled(IOR=0.5).kind.ior == pytest.approx(2.0)


def test_pictures_in_sockets_keep_their_bytes():
    tree = Tree()
    pixels = np.ones((SIZE, SIZE, 4))
    pixels[:, :, :3] = np.random.default_rng(3).uniform(0, 1, (SIZE, SIZE, 3))
    image = picture("p", pixels, "sRGB", floats=False)
    tree.surface(tree.node("BsdfPrincipled", {"Base Color": tree.texture(image).outputs[0]}))
    found = Read(tree.material)
    (texture,) = found.scene.textures
    assert texture.srgb
    assert texture.pixels.dtype == np.uint8
    np.testing.assert_array_equal(texture.pixels, np.rint(pixels[:, :, :3] * 255))
    assert texture.filter == "nearest"


def test_channels_of_one_picture():
    """Roughness in green, metallic in blue."""
    tree = Tree()
    parts = tree.node("SeparateColor", {0: tree.texture(random_picture("p", 1)).outputs[0]})
    inputs = {"Roughness": parts.outputs["Red"], "Metallic": parts.outputs["Blue"]}
    tree.surface(tree.node("BsdfPrincipled", inputs))
    found = Read(tree.material)
    pixels = found.pixels(found.kind.metallic_roughness_texture)
    image = np.array(bpy.data.images["p"].pixels).reshape(SIZE, SIZE, 4)[::-1]
    np.testing.assert_allclose(pixels[:, :, 1:3], image[:, :, [0, 2]], atol=1e-6)


def test_mean_of_a_picture_where_the_renderer_has_numbers():
    tree = Tree()
    flat = picture("p", np.full((SIZE, SIZE, 4), 1.0) * (1.5, 1.5, 1.5, 1))
    tree.surface(tree.node("BsdfPrincipled", {"IOR": tree.texture(flat).outputs[0]}))
    found = Read(tree.material)
    assert found.kind.ior == pytest.approx(1.5, rel=1e-6)
    assert found.sentences == ["BsdfPrincipled: the mean of the picture in 'IOR' is used (1 use)"]


SHADERS = {
    "diffuse": lambda t: t.node("BsdfDiffuse", {0: COLOR}),
    "grey": lambda t: t.node("BsdfDiffuse", {0: (0.4, 0.4, 0.4)}),
    "glossy": lambda t: t.node("BsdfGlossy", {0: COLOR, "Roughness": 0.3}),
    "transparent": lambda t: t.node("BsdfTransparent"),
    "half": lambda t: t.node("BsdfTransparent", {0: (0.5, 0.5, 0.5)}),
    "translucent": lambda t: t.node("BsdfTranslucent", {0: COLOR}),
    "emission": lambda t: t.node("Emission", {0: COLOR, 1: 3.0}),
    "metal": lambda t: t.node(
        "BsdfPrincipled", {"Base Color": COLOR, "Metallic": 1.0, "Roughness": 0.3}
    ),
    "plastic": lambda t: t.node("BsdfPrincipled", {"Base Color": COLOR, "Roughness": 0.3}),
    "lamp": lambda t: t.node(
        "BsdfPrincipled", {"Alpha": 0.3, "Emission Color": COLOR, "Emission Strength": 2.0}
    ),
    "glass": lambda t: t.node("BsdfGlass", {0: COLOR, "IOR": 1.4, "Roughness": 0.2}),
    "refraction": lambda t: t.node("BsdfRefraction", {0: COLOR, "IOR": 1.4}),
    "sheen": lambda t: t.node("BsdfSheen", {0: COLOR, "Roughness": 0.4}),
    "copper": lambda t: t.node(
        "BsdfMetallic",
        {"IOR": (0.27, 0.68, 1.32), "Extinction": (3.61, 2.63, 2.29), "Roughness": 0.2},
        fresnel_type="PHYSICAL_CONDUCTOR",
    ),
    "toon": lambda t: t.node("BsdfToon", {0: COLOR}),
    "holdout": lambda t: t.node("Holdout"),
}


def mixed(a, b, share, kind="MixShader"):
    def build(tree):
        pair = [SHADERS[name](tree).outputs[0] for name in (a, b)]
        inputs = dict(zip(("Shader", "Shader_001"), pair, strict=True))
        return tree.node(kind, {**inputs, **({} if share is None else {"Fac": share})})

    return build


def test_other_shaders():
    glass = read(SHADERS["glass"]).kind
    assert (glass.transmission, glass.thickness) == (1.0, 1.0)
    np.testing.assert_allclose(glass.specular_color, COLOR, rtol=1e-6)
    assert (glass.ior, glass.roughness) == pytest.approx((1.4, 0.2))
    assert read(SHADERS["refraction"]).kind.specular == 0.0
    gloss = read(SHADERS["glossy"]).kind
    assert (gloss.ior, gloss.specular) == pytest.approx((0.0, 0.8))
    np.testing.assert_allclose(np.array(gloss.specular_color) * gloss.specular, COLOR, rtol=1e-6)
    np.testing.assert_allclose(read(SHADERS["sheen"]).kind.sheen_color, COLOR, rtol=1e-6)
    copper = read(SHADERS["copper"]).kind
    n, k = np.array((0.27, 0.68, 1.32)), np.array((3.61, 2.63, 2.29))
    index = n + 1j * k
    np.testing.assert_allclose(copper.base_color, np.abs((index - 1) / (index + 1)) ** 2, rtol=1e-5)
    through = read(SHADERS["translucent"]).kind
    assert through.diffuse_transmission == 1.0
    np.testing.assert_allclose(through.diffuse_transmission_color, COLOR, rtol=1e-6)
    half = read(SHADERS["half"]).kind
    assert (half.base_alpha, half.alpha_mode) == (pytest.approx(0.5), "blend")


def test_shaders_without_a_counterpart_are_counted():
    toon = read(SHADERS["toon"])
    np.testing.assert_allclose(toon.kind.base_color, COLOR, rtol=1e-6)
    assert toon.sentences == [
        "BsdfToon: the shader is not supported: it is diffuse light of its colour (1 use)"
    ]
    assert read(SHADERS["holdout"]).sentences == [
        "Holdout: the shader is not supported: it is black (1 use)"
    ]


def lit(build, folder, samples=256, degrees=40.0):
    """Light of a square under a white sky, by Daguerre and by Cycles, linear Rec.709."""
    tree = Tree()
    tree.surface(build(tree))
    stage(tree.material, light=1.0)
    angle, far = math.radians(degrees), 20.0
    camera = bpy.context.scene.camera
    camera.data.type, camera.data.lens, camera.data.sensor_width = "PERSP", 1000.0, 36.0
    camera.location = (0, -far * math.sin(angle), far * math.cos(angle))
    camera.rotation_euler = (angle, 0, 0)
    found = Read(tree.material)
    scene = found.scene
    square = [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]]
    mesh = scene.add_mesh(
        np.array(square, float), [[0, 1, 2], [0, 2, 3]], uv=[[0, 1], [1, 1], [1, 0], [0, 0]]
    )
    scene.add_instance(mesh, found.index)
    scene.set_environment(color=(CD_PER_W,) * 3)
    at = dg.look_at((0, far * math.cos(angle), far * math.sin(angle)), (0, 0, 0))
    seen = dg.Camera(at, focal_length=1000.0, sensor_size=(36.0, 36.0))
    frame = dg.render(scene, seen, resolution=(SIZE, SIZE), spp=samples, threads=1)
    ours = frame.xyz.mean((0, 1)) @ np.linalg.inv(RGB_TO_XYZ).T / CD_PER_W
    return found, ours, cycles(folder, samples).mean((0, 1))


RGB_TO_XYZ = np.array(
    [[0.4123908, 0.3575843, 0.1804808], [0.2126390, 0.7151687, 0.0721923],
     [0.0193308, 0.1191948, 0.9505322]]
)  # fmt: skip

EXACT = [
    ("diffuse", "grey", 0.3), ("diffuse", "glossy", 0.3), ("glossy", "diffuse", 0.3),
    ("diffuse", "transparent", 0.3), ("transparent", "emission", 0.3),
    ("diffuse", "emission", 0.3), ("diffuse", "translucent", 0.3), ("lamp", "transparent", 0.4),
    ("plastic", "transparent", 0.3), ("plastic", "emission", 0.3), ("glossy", "emission", 0.6),
    ("lamp", "emission", 0.4),
]  # fmt: skip


@pytest.mark.parametrize(("a", "b", "share"), EXACT)
def test_mixes_shine_as_in_cycles(a, b, share, tmp_path):
    found, ours, theirs = lit(mixed(a, b, share), tmp_path)
    np.testing.assert_allclose(ours, theirs, rtol=0.025)
    assert not found.sentences


SUMS = [("diffuse", "emission"), ("glossy", "emission"), ("lamp", "emission")]


@pytest.mark.parametrize(("a", "b"), SUMS)
def test_sums_shine_as_in_cycles(a, b, tmp_path):
    found, ours, theirs = lit(mixed(a, b, None, "AddShader"), tmp_path)
    np.testing.assert_allclose(ours, theirs, rtol=0.025)
    assert not found.sentences


@pytest.mark.parametrize("name", ["diffuse", "glossy", "metal", "plastic", "lamp", "translucent"])
def test_shaders_shine_as_in_cycles(name, tmp_path):
    _, ours, theirs = lit(SHADERS[name], tmp_path)
    np.testing.assert_allclose(ours, theirs, rtol=0.025)


def test_sum_of_diffuse_light():
    kind = read(mixed("diffuse", "diffuse", None, "AddShader")).kind
    np.testing.assert_allclose(kind.base_color, (0.5, 1.0, 1.0), rtol=1e-6)


def test_mixes_that_are_not_exact_are_counted():
    sentence = "MixShader: two kinds of shaders become one with mixed parameters (1 use)"
    found = read(mixed("plastic", "metal", 0.25))
    assert found.kind.metallic == pytest.approx(0.25)
    assert found.sentences == [sentence]
    added = read(mixed("plastic", "metal", None, "AddShader"))
    assert added.sentences == [
        "AddShader: a sum of shaders is not exact: one of them scatters light (1 use)"
    ]


def test_share_of_a_mix_may_be_a_picture():
    tree = Tree()
    image = random_picture("p", 1)
    tree.surface(mixed("diffuse", "transparent", tree.texture(image).outputs["Color"])(tree))
    found = Read(tree.material)
    pixels = np.array(image.pixels).reshape(SIZE, SIZE, 4)[::-1, :, :3]
    grey = pixels @ (0.2126, 0.7152, 0.0722)
    alpha = found.pixels(found.kind.base_color_texture)[:, :, 3] * found.kind.base_alpha
    np.testing.assert_allclose(alpha, 1 - grey, atol=1e-6)
    np.testing.assert_allclose(found.kind.base_color, COLOR, rtol=1e-6)


def test_fresnel_chooses_gloss_at_grazing_angles():
    def build(tree):
        return mixed("grey", "glossy", tree.node("Fresnel", {"IOR": 1.5}).outputs[0])(tree)

    kind = read(build).kind
    assert (kind.ior, kind.specular) == (0.0, 1.0)
    np.testing.assert_allclose(kind.specular_color, np.array(COLOR) * 0.04, rtol=1e-5)
    np.testing.assert_allclose(kind.base_color, 0.4, rtol=1e-6)


def test_many_mixes_of_the_same_two_are_fast():
    tree = Tree()
    shader = SHADERS["diffuse"](tree)
    for _ in range(400):
        inputs = {"Shader": shader.outputs[0], "Shader_001": shader.outputs[0]}
        shader = tree.node("MixShader", inputs)
    tree.surface(shader)
    np.testing.assert_allclose(Read(tree.material).kind.base_color, COLOR, rtol=1e-5)


def test_material_without_a_surface_is_black():
    found = Read(Tree().material)
    assert found.kind.base_color == (0.0, 0.0, 0.0)
    assert found.sentences == ["a material without a surface is black (1 use)"]


def test_no_material_is_plain_grey():
    scene = dg.Scene()
    materials = Materials(scene, Notes())
    assert materials.index(None) == materials.index(None) == 0
    assert scene.materials[0].kind == dg.Diffuse((0.8, 0.8, 0.8))


def test_each_material_is_added_once():
    tree = Tree()
    tree.surface(SHADERS["diffuse"](tree))
    found = Read(tree.material)
    assert found.materials.index(tree.material) == found.index
    assert len(found.scene.materials) == 1


def test_volume_and_displacement_are_noted():
    tree = Tree()
    tree.surface(SHADERS["diffuse"](tree))
    tree.links.new(tree.node("VolumeScatter").outputs[0], tree.output.inputs["Volume"])
    tree.links.new(tree.node("Displacement").outputs[0], tree.output.inputs["Displacement"])
    assert Read(tree.material).sentences == [
        "the volume of a material is not supported (1 use)",
        "the displacement of a material is not supported (1 use)",
    ]


def test_pictures_beyond_the_limit_are_an_error(monkeypatch):
    monkeypatch.setattr("daguerre.blender.shading.pictures.MAX_BYTES", 100)
    tree = Tree()
    tree.shine(tree.texture(random_picture("p", 1)).outputs[0])
    with pytest.raises(InputError, match=r"material 'M': node 'Image Texture': wanted at most"):
        Read(tree.material)


def baked_normals(tree):
    """Normals in the frame of the texture coordinates by Cycles' bake, row 0 on top."""
    image = bpy.data.images.new("baked", SIZE, SIZE, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    node = tree.node("TexImage", image=image)
    tree.nodes.active = node
    scene = bpy.context.scene
    scene.cycles.samples = 1
    scene.render.bake.margin = 0
    square = next(one for one in bpy.data.objects if one.type == "MESH")
    bpy.context.view_layer.objects.active = square
    square.select_set(True)
    bpy.ops.object.bake(type="NORMAL", normal_space="TANGENT")
    encoded = np.array(image.pixels).reshape(SIZE, SIZE, 4)[::-1, :, :3]
    return 2 * encoded - 1


def our_normals(found):
    kind = found.kind
    normal = 2 * found.pixels(kind.normal_texture)[:, :, :3].astype(float) - 1
    if found.pixels(kind.normal_texture).dtype == np.uint8:
        normal = 2 * found.pixels(kind.normal_texture)[:, :, :3] / 255 - 1
    normal[:, :, :2] *= kind.normal_scale
    return normal / np.linalg.norm(normal, axis=2, keepdims=True)


@pytest.mark.parametrize("strength", [1.0, 0.4, 1.5])
def test_normal_map(strength):
    tree = Tree()
    rng = np.random.default_rng(1)
    normals = rng.uniform(-0.4, 0.4, (SIZE, SIZE, 3))
    normals[:, :, 2] = 1
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    pixels = np.concatenate([(normals + 1) / 2, np.ones((SIZE, SIZE, 1))], axis=2)
    color = tree.texture(picture("p", pixels)).outputs[0]
    bent = tree.node("NormalMap", {"Color": color, "Strength": strength})
    tree.surface(tree.node("BsdfPrincipled", {"Normal": bent.outputs[0]}))
    stage(tree.material)
    found = Read(tree.material)
    np.testing.assert_allclose(our_normals(found), baked_normals(tree), atol=2e-3)


@pytest.mark.parametrize("strength", [1.0, 0.5])
@pytest.mark.parametrize("invert", [False, True])
def test_bump(strength, invert):
    """A height that is even across texels of a linear filter has the slopes of both renderers."""
    tree = Tree()
    u, v = np.meshgrid((np.arange(SIZE) + 0.5) / SIZE, 1 - (np.arange(SIZE) + 0.5) / SIZE)
    pixels = np.ones((SIZE, SIZE, 4))
    pixels[:, :, :3] = (0.3 * u + 0.5 * v)[:, :, None]
    node = tree.texture(picture("p", pixels), interpolation="Linear", extension="EXTEND")
    inputs = {"Height": node.outputs[0], "Distance": 0.8, "Strength": strength}
    bump = tree.node("Bump", inputs, invert=invert)
    tree.surface(tree.node("BsdfPrincipled", {"Normal": bump.outputs[0]}))
    stage(tree.material)  # 2 units wide: one unit of texture coordinates is 2 units long
    found = Read(tree.material)
    ours, theirs = our_normals(found), baked_normals(tree)
    np.testing.assert_allclose(ours[2:-2, 2:-2], theirs[2:-2, 2:-2], atol=5e-3)


def test_bump_of_a_number_is_flat_and_other_spaces_are_noted():
    tree = Tree()
    bump = tree.node("Bump", {"Height": 0.3})
    tree.surface(tree.node("BsdfPrincipled", {"Normal": bump.outputs[0]}))
    found = Read(tree.material)
    assert found.kind.normal_texture is None
    assert not found.sentences
    emptied()
    tree = Tree()
    color = tree.texture(random_picture("p", 1)).outputs[0]
    bent = tree.node("NormalMap", {"Color": color}, space="WORLD")
    tree.surface(tree.node("BsdfPrincipled", {"Normal": bent.outputs[0]}))
    found = Read(tree.material)
    assert found.kind.normal_texture is None
    assert found.sentences == ["NormalMap: normals in the space WORLD are left out (1 use)"]


UNSUPPORTED = "shading: arithmetic on colours of vertices is not supported"


def test_colors_of_vertices_that_cannot_be_computed_make_a_grey_material():
    tree = Tree()
    color = tree.node("VertexColor", {}, layer_name="Paint").outputs["Color"]
    bent = tree.node("NormalMap", {"Color": color})
    tree.surface(tree.node("BsdfPrincipled", {"Normal": bent.outputs[0]}))
    found = Read(tree.material)
    assert found.sentences == [
        "shading: arithmetic on colours of vertices is not supported (1 use)"
    ]
    emptied()
    tree = Tree()
    color = tree.node("VertexColor", {}, layer_name="Paint").outputs["Color"]
    tree.surface(tree.node("BsdfPrincipled", {"Normal": color}))
    found = Read(tree.material)
    np.testing.assert_allclose(found.kind.base_color, 0.8, rtol=1e-6)
    assert found.sentences == [f"{UNSUPPORTED}: the material is grey (1 use)"]


def test_values_that_are_not_finite_are_an_error():
    tree = Tree()
    node = tree.node("Value")
    node.outputs[0].default_value = math.nan
    tree.surface(tree.node("BsdfPrincipled", {"Roughness": node.outputs[0]}))
    with pytest.raises(InputError, match=r"material 'M': node 'Value': wanted finite numbers"):
        Read(tree.material)


def test_bumps_follow_the_size_of_the_mesh():
    """A unit of texture coordinates that is twice as long halves the slopes."""
    slopes = []
    for scale in (1.0, 2.0):
        emptied()
        tree = Tree()
        u = np.tile((np.arange(SIZE) + 0.5) / SIZE, (SIZE, 1))
        pixels = np.ones((SIZE, SIZE, 4))
        pixels[:, :, :3] = u[:, :, None]
        node = tree.texture(picture("p", pixels), extension="EXTEND")
        bump = tree.node("Bump", {"Height": node.outputs[0], "Distance": 0.5})
        tree.surface(tree.node("BsdfPrincipled", {"Normal": bump.outputs[0]}))
        stage(tree.material)
        square = next(one for one in bpy.data.objects if one.type == "MESH")
        square.scale = (scale,) * 3
        bpy.context.view_layer.update()
        normal = our_normals(Read(tree.material))[4, 4]
        slopes.append(-normal[0] / normal[2])
    np.testing.assert_allclose(slopes, [0.25, 0.125], rtol=1e-4)
