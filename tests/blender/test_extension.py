"""Panels, properties and operators of the extension for Blender."""

import shlex
from types import SimpleNamespace

import pytest

import daguerre as dg
from daguerre.camera.parameters import CAMERA_FLAGS, SHUTTER
from daguerre.rendering.parameters import TABLE
from daguerre.viewfinder.dials import Dials
from tests.support.blender import blender_extension

bpy = pytest.importorskip("bpy", reason="no bpy in this Python")

LENS_NAMES = {"lens", "lens_file", "lens_model", "zoom", "focus_mode", "tilt_x", "tilt_y"}
IRIS_NAMES = {"f_stop", "t_stop", "use_t_stop", "blades", "blade_rotation", "blade_curvature"}
BODY_NAMES = {"sensor", "iso", "exposure_mode", "meter", "ev", "shutter_mode", "shutter_time"}
SHUTTER_NAMES = {"shutter_angle", "shutter_type", "rolling_side", "rolling_time"}
STRAY_NAMES = {"flare", "scatter", "diffraction", "dispersion"}
NAMES = LENS_NAMES | IRIS_NAMES | BODY_NAMES | SHUTTER_NAMES | STRAY_NAMES
SCENE_NAMES = ["light_paths", "spp", "noise", "denoise", "look", "photograph", "raw", "passes"]


@pytest.fixture
def extension():
    """The extension, registered in an empty Blender with a camera."""
    with blender_extension.registered() as found:
        yield found


def camera_group():
    return bpy.context.scene.camera.data.daguerre


def test_properties_have_their_names_and_the_limits_of_the_parameters(extension):
    group, scene = camera_group(), bpy.context.scene.daguerre
    assert not NAMES - set(group.bl_rna.properties.keys())
    assert set(SCENE_NAMES) <= set(scene.bl_rna.properties.keys())
    group.blades, group.blade_curvature, group.tilt_x, scene.spp = 100, 3, 90, 0
    assert (group.blades, group.blade_curvature, group.tilt_x, scene.spp) == (64, 1, 45, 1)
    for rna in (group.bl_rna, scene.bl_rna):
        for name in {*NAMES, *SCENE_NAMES} & set(rna.properties.keys()):
            words = rna.properties[name].description
            assert words, name
            assert not {"{", "}"} & set(words), name
            assert "spp" not in words.split(), name  # a word of the command line
            for item in getattr(rna.properties[name], "enum_items", ()):
                assert item.description, (name, item.identifier)


def test_registering_twice_leaves_nothing_behind(extension):
    extension.unregister()
    assert not hasattr(bpy.types.Scene, "daguerre")
    assert not hasattr(bpy.types.Camera, "daguerre")
    ours = "daguerre_extension"
    for panel in bpy.types.Panel.__subclasses__():
        if not panel.__module__.startswith(ours):
            assert "DAGUERRE" not in getattr(panel, "COMPAT_ENGINES", ()), panel
    assert not hasattr(bpy.ops.daguerre.copy_command, "poll") or "copy_command" not in dir(
        bpy.ops.daguerre
    )
    extension.register()
    assert hasattr(bpy.context.scene, "daguerre")


def test_the_menu_has_every_lens_with_its_year_stop_and_image_circle(extension):
    items = {key: (name, words) for key, name, words in extension.choices.LENSES}
    assert set(dg.lenses.names()) <= set(items)
    name, words = items["asahi-super-takumar-50mm-f1.4"]
    assert name == "Super-Takumar 50 mm f/1.4 (1969)"
    assert "f/1.4 wide open" in words
    assert "50 mm" in words
    assert "image circle 43.3 mm" in words  # sqrt(36^2 + 24^2)


def test_the_search_has_the_kinds_of_a_lens(extension):
    lines = {key: line for key, line, _ in extension.choices.SEARCHED}
    assert {"zoom", "wide", "normal"} <= set(lines["canon-ef-24-70mm-f2.8"].split(", "))


def test_the_search_sets_a_lens_and_takes_it_back(extension):
    bpy.ops.daguerre.choose_lens("EXEC_DEFAULT", lens="double-gauss-50mm-f2")
    assert camera_group().lens == "double-gauss-50mm-f2"
    assert camera_group().is_property_set("lens")
    bpy.ops.daguerre.choose_lens("EXEC_DEFAULT", lens="blender")
    assert not camera_group().is_property_set("lens")


def test_a_change_reaches_the_evaluated_camera_and_scene(extension):
    """Translators read evaluated data."""
    context = bpy.context
    seen = context.scene.camera.evaluated_get(context.evaluated_depsgraph_get()).data.daguerre
    assert seen.lens == "blender"
    camera_group().lens, camera_group().f_stop = "thin", 2.5
    camera_group().use_t_stop, camera_group().blades = True, 9
    seen = context.scene.camera.evaluated_get(context.evaluated_depsgraph_get()).data.daguerre
    assert (seen.lens, seen.f_stop, seen.use_t_stop, seen.blades) == ("thin", 2.5, True, 9)
    assert seen.is_property_set("lens")


def panels(extension):
    return extension.panels._CLASSES


@pytest.mark.parametrize(
    ("lens", "there", "not_there"),
    [
        ("blender", set(), {"f_stop", "t_stop", "zoom", "lens_file"}),
        ("pinhole", set(), {"f_stop", "t_stop", "zoom", "lens_file"}),
        ("file", {"lens_file", "f_stop", "zoom"}, {"t_stop"}),
        ("double-gauss-50mm-f2", {"f_stop", "tilt_x", "blades"}, {"lens_file", "blade_rotation"}),
    ],
)
def test_panels_show_what_matters(extension, lens, there, not_there):
    group = camera_group()
    group.lens = lens
    shown = set()
    for panel in panels(extension):
        given = panel.group(SimpleNamespace(scene=bpy.context.scene, camera=bpy.data.cameras[0]))
        names = set(panel.shown(SimpleNamespace(rows=panel.rows), given))
        assert names <= set(given.bl_rna.properties.keys()), panel
        shown |= names
    assert there <= shown
    assert not not_there & shown


def test_every_property_is_in_a_panel_in_some_state(extension):
    """Switches every menu and flag through its values."""
    group, scene = camera_group(), bpy.context.scene.daguerre
    states = [
        {},
        {"lens": "file", "use_t_stop": True, "blades": 5, "rolling_side": "top"},
        {"lens": "thin", "shutter_mode": "time", "exposure_mode": "auto", "use_t_stop": False},
        {"shutter_mode": "angle", "exposure_mode": "manual"},
    ]
    scene.photograph = True
    context = SimpleNamespace(scene=bpy.context.scene, camera=bpy.data.cameras[0])
    shown = {"lens"}  # by the button of the search
    for state in states:
        for name, value in state.items():
            setattr(group, name, value)
        for panel in panels(extension):
            shown |= set(panel.shown(SimpleNamespace(rows=panel.rows), panel.group(context)))
    assert shown == {*NAMES, *SCENE_NAMES}


def test_panels_show_for_the_engine_alone(extension):
    context = SimpleNamespace(scene=bpy.context.scene, camera=None, engine="CYCLES")
    assert not any(panel.poll(context) for panel in panels(extension))
    context.engine = "DAGUERRE"
    seen = [panel.poll(context) for panel in panels(extension)]
    assert any(seen)
    assert not all(seen)  # those of a camera need one
    context.camera = bpy.data.cameras[0]
    assert all(panel.poll(context) for panel in panels(extension))


def test_blender_s_own_panels_show_too(extension):
    for name in (
        "DATA_PT_lens",
        "RENDER_PT_format",
        "EEVEE_MATERIAL_PT_surface",
        "RENDER_PT_output",
    ):
        assert "DAGUERRE" in getattr(bpy.types, name).COMPAT_ENGINES, name
    assert "DAGUERRE" not in bpy.types.RENDER_PT_simplify.COMPAT_ENGINES


CAMERAS = [
    {},
    {"lens": "double-gauss-50mm-f2", "f_stop": 2.8, "focus_distance": 1.2345678901234567},
    {"lens": "thin", "focal_length": 35.5, "t_stop": 2.0, "sensor_size": (23.7, 15.6)},
    {"lens": "pinhole", "shift": (-1.5, 2.0), "shutter_time": 1 / 48, "shutter_type": "leaf"},
    {"blades": 7, "blade_rotation": -12.5, "blade_curvature": 0.25, "tilt": (1.0, -3.0)},
    {"sensor": "nikon-d5100", "iso": 640.0, "exposure_compensation": -1.5, "near_clip": 0.1},
    {"rolling_shutter": dg.RollingShutter("left", readout_time=0.0166), "shutter_angle": 172.8},
    {"rolling_shutter": dg.RollingShutter("top", line_time=1.5e-5), "focus_distance": float("inf")},
]


@pytest.mark.parametrize("values", CAMERAS)
def test_the_command_line_has_the_camera_to_the_bit(extension, values, tmp_path):
    camera = dg.Camera(**values)
    settings = dg.RenderSettings.of(
        resolution=(64, 48), spp=7, noise=0.0123, light_paths="off", crop=(1, 2, 30, 40)
    )
    path = tmp_path / "my scene.glb"
    words = shlex.split(extension.command.command(path, "Cam", camera, settings))
    assert words[:4] == ["daguerre", "render", str(path), "--camera=Cam"]
    assert words[-2:] == ["-o", str(tmp_path / "my scene.exr")]
    given = dict(word.split("=", 1) for word in words[4:-2])
    assert given.pop("--res") == "64x48"
    flags = {flag: row for row in (*CAMERA_FLAGS, *SHUTTER, *TABLE.values()) for flag in row.flags}
    texts = {flags[flag].name: text for flag, text in given.items()}
    ours = {name: texts.pop(name) for name in list(texts) if name in TABLE}
    read = {n: extension.command._read(TABLE[n], text) for n, text in ours.items()}
    assert dg.RenderSettings.of(resolution=(64, 48), **read) == settings
    wanted = (
        camera if camera.sensor is None else camera.with_(sensor=dg.sensors.load(camera.sensor))
    )
    assert Dials.of(texts).camera(dg.Camera()) == wanted


def test_a_switch_has_its_word_in_the_command_line(extension, tmp_path):
    path, settings = tmp_path / "a.glb", dg.RenderSettings()
    for dispersion, words in ((True, 0), (False, 1)):
        camera = dg.Camera(lens="double-gauss-50mm-f2", dispersion=dispersion)
        text = extension.command.command(path, "C", camera, settings)
        assert shlex.split(text).count("--no-dispersion") == words


def test_a_value_without_a_text_is_an_error(extension, tmp_path):
    camera = dg.Camera(lens=dg.lenses.load("double-gauss-50mm-f2"))
    with pytest.raises(dg.UsageError, match="--lens"):
        extension.command.command(tmp_path / "a.glb", "C", camera, dg.RenderSettings())


def test_the_export_writes_scene_and_command(extension, tmp_path, monkeypatch):
    blender_extension.stand_in(monkeypatch, lens="double-gauss-50mm-f2", f_stop=4.0)
    path = tmp_path / "out.glb"
    assert bpy.ops.daguerre.export_scene("EXEC_DEFAULT", filepath=str(path)) == {"FINISHED"}
    exact, plain = dg.load(path), dg.load(path, animated=True)
    assert exact.environment == blender_extension.scene().environment
    assert "Camera" in plain.cameras
    assert plain.instances
    text = path.with_suffix(".sh").read_text()
    assert f"daguerre render {path} --camera=Camera --res=" in text
    assert "--lens" not in text  # the file has it


def test_the_command_has_what_the_file_has_not(extension, tmp_path):
    held = dg.Camera(lens="double-gauss-50mm-f2", f_stop=4.0)
    settings = dg.RenderSettings.of(resolution=(8, 6))

    def words(camera, name="A, B", **more):
        return shlex.split(
            extension.command.command(tmp_path / "a.glb", name, camera, settings, held, **more)
        )[3:-2]

    assert words(held) == ["--camera=A\\, B", "--res=8x6"]
    assert words(held, "C", denoises=True) == ["--camera=C", "--res=8x6", "--denoise"]
    assert words(held.with_(f_stop=8.0), "C") == ["--camera=C", "--f-stop=8.0", "--res=8x6"]
    other = held.with_(lens="nikon-af-s-70-200mm-f2.8", zoom=100.0)
    found = words(other, "C")
    assert "--lens=nikon-af-s-70-200mm-f2.8" in found
    assert [word for word in found if word.startswith("--zoom=100.0")]


def test_the_command_is_copied_and_errors_become_reports(extension, monkeypatch):
    blender_extension.stand_in(monkeypatch, lens="double-gauss-50mm-f2")
    assert bpy.ops.daguerre.copy_command() == {"FINISHED"}

    def broken(depsgraph, frame_set=None):
        raise dg.InputError("mesh Cube: points: wanted finite numbers, got nan")

    monkeypatch.setattr(extension.translation, "scene_of", broken)
    with pytest.raises(RuntimeError, match="Daguerre: mesh Cube: points") as caught:
        bpy.ops.daguerre.copy_command()
    assert "Traceback" not in str(caught.value)
