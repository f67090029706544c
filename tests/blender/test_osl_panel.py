"""The panel that puts a lens on a camera of Cycles."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

import daguerre as dg
from tests.support.blender import blender_extension
from tests.support.blender.blender_layout import drawn

bpy = pytest.importorskip("bpy", reason="no bpy in this Python")

LENS = "double-gauss-50mm-f2"
SIZE = 96, 64
#: Variance of the filter of the pixels, both axes, px^2.
PIXELS = 0.2


@pytest.fixture
def camera():
    """The camera of an empty scene before an even row of small lamps, 2 m away."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    extension = blender_extension.extension()
    extension.register()
    scene, data = bpy.context.scene, bpy.data.cameras.new("camera")
    scene.camera = bpy.data.objects.new("camera", data)
    scene.collection.objects.link(scene.camera)
    data.clip_start, data.dof.focus_distance = 1e-3, 2.0
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    yield data
    extension.unregister()


def lamp(x, depth, radius=0.004):
    bpy.ops.mesh.primitive_uv_sphere_add(radius=radius, location=(x, 0, -depth))
    material = bpy.data.materials.new("lamp")
    tree = material.node_tree
    tree.nodes.clear()
    light, output = (tree.nodes.new(f"ShaderNode{n}") for n in ("Emission", "OutputMaterial"))
    light.inputs["Strength"].default_value = 1000.0
    tree.links.new(light.outputs[0], output.inputs["Surface"])
    bpy.context.object.data.materials.append(material)


def picture(tmp_path, spp=64, size=SIZE):
    """Picture of Cycles, shape (H, W), row 0 on top."""
    import OpenImageIO as oiio

    scene, path = bpy.context.scene, tmp_path / "out.exr"
    scene.cycles.device, scene.cycles.samples = "CPU", spp
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    render = scene.render
    render.resolution_x, render.resolution_y = size
    render.image_settings.file_format, render.filepath = "OPEN_EXR", str(path)
    render.image_settings.color_depth = "32"
    render.threads_mode, render.threads = "FIXED", 1
    bpy.ops.render.render(write_still=True)
    return oiio.ImageBuf(str(path)).get_pixels()[..., :3].astype(float).mean(axis=2)


def middle_and_spread(image):
    """Centroid and RMS radius of the light, px."""
    rows, columns = np.mgrid[: image.shape[0], : image.shape[1]]
    total = image.sum()
    x, y = (image * columns).sum() / total, (image * rows).sum() / total
    square = (image * ((columns - x) ** 2 + (rows - y) ** 2)).sum() / total
    return x, math.sqrt(square)


def shader():
    """Text of the shader that was written."""
    (text,) = bpy.data.texts
    return text.as_string()


def use(**values):
    for name, value in values.items():
        setattr(bpy.data.cameras[0].daguerre, name, value)
    return bpy.ops.daguerre.write_osl()


def test_a_lamp_is_where_the_focal_length_puts_it_and_sharp_in_focus(camera, tmp_path):
    lamp(0.5, 2.0)
    pinhole = picture(tmp_path)
    assert use(lens=LENS, f_stop=4.0) == {"FINISHED"}
    assert (camera.type, camera.custom_mode) == ("CUSTOM", "INTERNAL")
    assert "shader" in shader()
    assert camera.cycles_custom["f_stop"] == 4.0
    seen, spread = middle_and_spread(picture(tmp_path))
    ours = dg.Camera(lens=LENS, f_stop=4.0, focus_distance=2.0, sensor_size=(36, 24))
    rays = dg.raymap(ours, SIZE, frame="world")
    x, _, z = rays.direction[SIZE[1] // 2].T
    slope = x / -z
    wanted = np.interp(0.25, slope, np.arange(SIZE[0]))
    assert seen == pytest.approx(wanted, abs=0.15)
    assert spread < 1.2
    assert middle_and_spread(pinhole)[0] == pytest.approx(seen, abs=3)  # 50 mm, too
    camera.type, camera.lens = "PERSP", 35
    assert abs(middle_and_spread(picture(tmp_path))[0] - seen) > 3


def test_a_lamp_out_of_focus_has_the_blur_of_the_stop(camera, tmp_path):
    """A disc of the diameter f^2 (s - z) / (N z (s - f)), blurred by the lamp and the pixels."""
    radius, far, near = 2.0, 2000.0, 350.0  # mm
    lamp(0.0, near / 1000, radius / 1000)
    efl = dg.lenses.load(LENS).first_order().efl
    for f_stop in (2.1, 4.2):
        assert use(lens=LENS, f_stop=f_stop) == {"FINISHED"}
        spread = middle_and_spread(picture(tmp_path, 512))[1]
        disc = efl**2 / f_stop * (far - near) / near / (far - efl)
        image = radius * efl / near
        wanted = math.sqrt((disc**2 / 8 + image**2 / 2) * (SIZE[0] / 36) ** 2 + PIXELS)
        assert spread == pytest.approx(wanted, rel=0.07), f_stop


def test_a_picture_on_end_with_a_shift_has_the_framing_of_blender_s_camera(camera, tmp_path):
    lamp(0.3, 2.0)
    camera.shift_x = 0.1
    camera.lens, camera.sensor_width = 51.2, 36
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y = size = SIZE[::-1]
    wanted = middle_and_spread(picture(tmp_path, size=size))[0]
    assert use(lens=LENS, f_stop=4.0) == {"FINISHED"}
    for _ in range(2):
        assert middle_and_spread(picture(tmp_path, size=size))[0] == pytest.approx(wanted, abs=1)
        film = blender_extension.extension().translation.camera_of(
            bpy.context.scene.camera, bpy.context.scene
        )
        assert film.sensor_size == pytest.approx((24, 36))
        assert film.shift == pytest.approx((3.6, 0))
        camera.type = "PERSP"  # with the film that the shader got


def test_units_sensor_and_dispersion_reach_the_shader(camera):
    bpy.context.scene.unit_settings.scale_length = 0.1
    camera.dof.focus_distance = 20
    assert use(lens=LENS, f_stop=8, sensor="nikon-d5100", dispersion=False) == {"FINISHED"}
    assert camera.cycles_custom["metres"] == pytest.approx(0.1)
    assert not camera.cycles_custom["chromatic"]
    assert (camera.sensor_width, camera.sensor_height) == pytest.approx(
        dg.sensors.load("nikon-d5100").size
    )
    assert "in focus at 2 m" in shader()


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"lens": "thin"}, "lens: wanted one with a prescription, got thin"),
        ({"lens": LENS, "f_stop": 1.0}, "f-stop: wanted f/"),
        ({"lens": LENS, "focus_mode": "auto"}, "focus: wanted a distance or an object"),
        ({"lens": LENS, "lens_model": "pinhole"}, "lens_model: wanted exact, got pinhole"),
        ({"lens": "sony-fe-70-200mm-f2.8", "zoom": 300}, "zoom: wanted"),
        ({"lens": "file", "lens_file": "/nowhere/lens.json"}, "/nowhere/lens.json"),
    ],
)
def test_what_cannot_be_is_a_report_and_leaves_the_camera(camera, values, words):
    with pytest.raises(RuntimeError, match="Daguerre: ") as caught:
        use(**values)
    assert words in str(caught.value)
    assert "Traceback" not in str(caught.value)
    assert camera.type == "PERSP"


def test_a_compiler_that_fails_is_a_report(camera, monkeypatch):
    module = blender_extension.extension().osl_camera
    monkeypatch.setattr(module, "_fitted", lambda camera: (SimpleNamespace(to_dict=dict), 2.0))
    monkeypatch.setattr(module.export, "code", lambda data, suffix: "shader {")
    with pytest.raises(RuntimeError, match="wanted to compile the lens"):
        use(lens=LENS)
    assert camera.type == "PERSP"


def test_the_panel_shows_for_cycles_alone(camera):
    panel = blender_extension.extension().osl_panel.DAGUERRE_PT_osl
    context = SimpleNamespace(scene=bpy.context.scene, camera=camera, engine="CYCLES")
    assert panel.poll(context)
    camera.daguerre.lens = LENS
    layout = drawn(panel, context)
    assert ("operator", "daguerre.write_osl") in layout.drawn
    names = {name for kind, name in layout.drawn if kind == "prop"}
    assert {"f_stop", "zoom", "focus_distance", "sensor"} <= names
    assert not panel.poll(SimpleNamespace(**{**vars(context), "engine": "DAGUERRE"}))


def test_daguerre_draws_a_camera_with_such_a_shader(camera):
    camera.daguerre.lens = LENS
    camera.type = "CUSTOM"
    thing, scene = bpy.context.scene.camera, bpy.context.scene
    found = blender_extension.extension().translation.camera_of(thing, scene)
    assert (found.lens, found.focus_distance) == (LENS, 2.0)
    camera.daguerre.lens = "thin"
    with pytest.raises(dg.InputError, match="wanted PERSP or PANO, got CUSTOM"):
        blender_extension.extension().translation.camera_of(thing, scene)
