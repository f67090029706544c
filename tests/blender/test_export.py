"""The exported scene: the copied command draws the bits of F12, in a process of its own."""

from __future__ import annotations

import shlex
import subprocess
import sys

import numpy as np
import OpenImageIO as oiio
import pytest

import daguerre as dg
from daguerre.blender.settings import factor_of, settings_of
from daguerre.importers.gltf.reader import read
from tests.support.blender import blender_extension

bpy = pytest.importorskip("bpy", reason="needs bpy, the wheel of Blender")

SIZE = 48, 36


@pytest.fixture
def made(tmp_path):
    """Blender's default scene with the engine."""
    with blender_extension.registered():
        yield blender_extension.staged(tmp_path, SIZE)


def drawn(path):
    """Colours of a picture file, float32, (H, W, 3)."""
    return oiio.ImageBuf(str(path)).get_pixels(oiio.FLOAT)[..., :3]


def exported(folder):
    """Exports the scene; returns its file and the words of its command."""
    path = folder / "scene.glb"
    assert bpy.ops.daguerre.export_scene("EXEC_DEFAULT", filepath=str(path)) == {"FINISHED"}
    script = path.with_suffix(".sh").read_text()
    return path, shlex.split(script.split("\n", 1)[1])


def by_command(words):
    """The picture of a command, drawn in a process of its own."""
    assert words[:2] == ["daguerre", "render"]
    line = [sys.executable, "-m", "daguerre", *words[1:]]
    run = subprocess.run(line, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    return drawn(words[words.index("-o") + 1]), run.stderr


def check_same(scene, folder):
    """Checks that F12 and the copied command draw the same bits; returns the picture."""
    bpy.ops.render.render(write_still=True)
    ours = drawn(scene.render.filepath)
    _, words = exported(folder)
    theirs, said = by_command(words)
    factor = np.float32(factor_of(scene))
    np.testing.assert_array_equal(ours, theirs * factor)
    assert ours.std() > 0
    assert "plain glTF" not in said
    return ours


def test_the_default_scene(made, tmp_path):
    check_same(made, tmp_path)


def test_area_lamps_and_a_world_with_a_picture(made, tmp_path):
    bpy.data.lights[0].type = "AREA"
    bpy.data.lights[0].size = 0.5
    picture = bpy.data.images.new("sky", 16, 8, float_buffer=True)
    numbers = np.random.default_rng(1).random((8, 16, 4)).astype(np.float32)
    picture.pixels.foreach_set(numbers.ravel())
    picture.update()
    tree = made.world.node_tree
    node = tree.nodes.new("ShaderNodeTexEnvironment")
    node.image = picture
    tree.links.new(node.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    seen = check_same(made, tmp_path)
    found = dg.load(tmp_path / "scene.glb")
    assert found.environment.image is not None
    assert np.ptp(seen[0], axis=0).max() > 0  # the sky shows


def test_hair_instances_and_a_picture_on_a_surface(made, tmp_path):
    cube = bpy.data.objects["Cube"]
    picture = bpy.data.images.new("checks", 8, 8)
    picture.pixels.foreach_set(np.random.default_rng(2).random(8 * 8 * 4).astype(np.float32))
    tree = cube.active_material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = picture
    tree.links.new(node.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    for k in range(3):
        copy = bpy.data.objects.new(f"copy {k}", cube.data)
        copy.location = (2.5 * k - 3, 2.5, 0)
        made.collection.objects.link(copy)
    curves = bpy.data.hair_curves.new("fur")
    curves.add_curves([6] * 40)
    points = np.random.default_rng(3).normal((1.5, -1.5, 0.5), 1.2, (240, 3))
    curves.position_data.foreach_set("vector", points.astype(np.float32).ravel())
    made.collection.objects.link(bpy.data.objects.new("fur", curves))
    check_same(made, tmp_path)
    found = dg.load(tmp_path / "scene.glb")
    assert sum(type(mesh).__name__ == "Curves" for mesh in found.meshes) == 1
    assert len({one.mesh for one in found.instances if one.name.startswith(("copy", "Cube"))}) == 1
    assert found.textures


def armature(cube):
    """Bends a finer cube by a bone that turns."""
    cube.modifiers.new("parts", "SUBSURF").levels = 2
    data = bpy.data.armatures.new("bones")
    arm = bpy.data.objects.new("bones", data)
    bpy.context.scene.collection.objects.link(arm)
    bpy.context.view_layer.objects.active = arm
    bpy.ops.object.mode_set(mode="EDIT")
    bone = data.edit_bones.new("bone")
    bone.head, bone.tail = (0, 0, 0), (0, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    group = cube.vertex_groups.new(name="bone")
    group.add([0, 2, 4, 6], 1.0, "REPLACE")
    cube.modifiers.new("bend", "ARMATURE").object = arm
    turned = arm.pose.bones["bone"]
    turned.rotation_mode = "XYZ"
    for frame, angle in ((0, 0.0), (4, 2.0)):
        turned.rotation_euler.x = angle
        turned.keyframe_insert("rotation_euler", frame=frame)


def test_a_blurred_object_an_armature_a_lamp_and_a_camera(made, tmp_path):
    made.render.use_motion_blur = True
    armature(bpy.data.objects["Cube"])
    lamp, eye = bpy.data.objects["Light"], made.camera
    ball = bpy.data.objects.new("ball", bpy.data.objects["Cube"].data.copy())
    made.collection.objects.link(ball)
    for thing, way in ((lamp, 1.0), (eye, 0.1), (ball, 4.0)):
        for frame in (0, 4):
            thing.location.x += way * frame / 4
            thing.keyframe_insert("location", frame=frame)
    made.camera.data.dof.use_dof = True
    made.camera.data.dof.aperture_fstop = 0.5
    made.frame_set(2)
    check_same(made, tmp_path)
    found = dg.load(tmp_path / "scene.glb")
    assert {"meshes 0", "lights 0"} <= {name for name, _ in found.motion.parts()}
    assert found.cameras["Camera"].motion


def test_the_shutter_of_the_panel_blurs(made, tmp_path):
    """Blender's own motion blur is off."""
    cube, group = bpy.data.objects["Cube"], made.camera.data.daguerre
    for frame in (0, 4):
        cube.location.x = frame
        cube.keyframe_insert("location", frame=frame)
    made.frame_set(2)
    group.shutter_mode, group.shutter_angle = "angle", 0.0
    sharp = check_same(made, tmp_path)
    group.shutter_angle = 360.0
    blurred = check_same(made, tmp_path)
    assert np.abs(blurred - sharp).mean() > 0.05 * sharp.mean()
    (path,) = dg.load(tmp_path / "scene.glb").motion.instances.values()
    np.testing.assert_allclose(path.times[[0, -1]] * 24, (-0.5, 0.5))


def test_the_panel_shows_the_samples_that_are_drawn(made):
    """Cycles' samples count without the extension alone."""
    made.cycles.samples = 7
    made.daguerre.property_unset("spp")
    assert settings_of(made).sampling.spp == made.daguerre.spp == 64
    made.daguerre.spp = 5
    assert settings_of(made).sampling.spp == 5


def test_what_a_render_alone_shows_is_exported(made, tmp_path):
    """A render has levels of subdivision and hidden objects of its own."""
    cube = bpy.data.objects["Cube"]
    smooth = cube.modifiers.new("parts", "SUBSURF")
    smooth.levels, smooth.render_levels = 0, 3
    lamp = bpy.data.objects.new("unseen", bpy.data.lights[0].copy())
    made.collection.objects.link(lamp)
    lamp.hide_render = True
    check_same(made, tmp_path)
    found = dg.load(tmp_path / "scene.glb")
    assert max(len(mesh.indices) for mesh in found.meshes) == 12 * 64
    assert len(found.lights) == 1


def test_the_command_is_short_as_the_file_holds_the_lens(made, tmp_path):
    group = made.camera.data.daguerre
    group.lens, group.f_stop = "double-gauss-50mm-f2", 4.0
    _, words = exported(tmp_path)
    assert not [word for word in words if word.startswith(("--lens", "--f-stop", "--shutter"))]
    assert dg.load(tmp_path / "scene.glb").camera().lens == "double-gauss-50mm-f2"
    file = tmp_path / "my lens.json"
    source = dg.lenses.library.FOLDER / "double-gauss-50mm-f2.json"
    file.write_bytes(source.read_bytes())
    group.lens, group.lens_file = "file", str(file)
    _, words = exported(tmp_path)
    assert not [word for word in words if word.startswith("--lens")]
    file.unlink()
    found = dg.load(tmp_path / "scene.glb").camera().lens
    assert found.surfaces == dg.lenses.load("double-gauss-50mm-f2").surfaces
    file.write_bytes(source.read_bytes())
    check_same(made, tmp_path)


def test_the_state_of_blender_is_as_before(made, tmp_path):
    made.render.engine = "BLENDER_WORKBENCH"
    exported(tmp_path)
    assert made.render.engine == "BLENDER_WORKBENCH"
    assert blender_extension.extension().taking.taker is None


def test_the_picture_that_is_shown_stays(made, tmp_path):
    """Until the export has drawn nothing, F12's picture is in the slot that is shown."""

    def saved(name):
        shown = next(one for one in bpy.data.images if one.type == "RENDER_RESULT")
        shown.save_render(str(tmp_path / name), scene=made)
        return drawn(tmp_path / name)

    bpy.ops.render.render()
    before = saved("before.exr")
    assert before.std() > 0
    exported(tmp_path)
    np.testing.assert_array_equal(saved("after.exr"), before)


def test_the_file_is_plain_gltf_for_other_programs(made, tmp_path):
    path, _ = exported(tmp_path)
    exact, plain = dg.load(path), read(path, animated=True)
    assert "plain glTF" not in " ".join(exact.warnings)
    assert "plain glTF is read" in " ".join(plain.warnings)
    assert exact.environment is not None
    assert plain.environment is None
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert bpy.ops.import_scene.gltf(filepath=str(path)) == {"FINISHED"}
    assert {"Cube", "Camera", "Light"} <= {thing.name for thing in bpy.data.objects}
