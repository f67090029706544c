"""The engine in Blender: pictures by F12, passes, regions, stops, errors and files."""

import gc
import threading
import time
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import OpenImageIO as oiio
import pytest

import daguerre as dg
from daguerre import memory
from daguerre.rendering import Cancelled
from tests.support.blender import blender_extension
from tests.support.blender.blender_extension import FACTOR, camera, scene

bpy = pytest.importorskip("bpy", reason="no bpy in this Python")

SIZE = 40, 30


@pytest.fixture(scope="module")
def module():
    with blender_extension.registered() as found:
        yield found


@pytest.fixture
def shot(module, tmp_path, monkeypatch):
    """Blender's default scene with the engine; a stand-in for the translation."""
    bpy.ops.wm.read_factory_settings()
    blender_extension.stand_in(monkeypatch, lens="pinhole")
    return blender_extension.staged(tmp_path, SIZE)


def ours(crop=None, **more):
    settings = dg.RenderSettings.of(resolution=SIZE, spp=4, light_paths="off", crop=crop, **more)
    return dg.render(scene(), camera(lens="pinhole"), settings=settings)


def drawn(tmp_path, part=0, name="out.exr"):
    """The picture that Blender wrote, (H, W, C), the top row first."""
    return oiio.ImageBuf(str(tmp_path / name), part, 0).get_pixels()


def test_f12_gives_the_bits_of_a_render(shot, tmp_path):
    assert bpy.ops.render.render(write_still=True) == {"FINISHED"}
    frame, found = ours(), drawn(tmp_path)
    np.testing.assert_array_equal(found[..., :3], frame.rgb * np.float32(FACTOR))
    np.testing.assert_array_equal(found[..., 3], 1)
    assert found[: SIZE[1] // 4].mean() > found[-SIZE[1] // 4 :].mean()  # the sky is bright on top


def test_a_transparent_film_has_our_alpha(shot, tmp_path):
    shot.render.film_transparent = True
    bpy.ops.render.render(write_still=True)
    frame, found = ours(background="transparent"), drawn(tmp_path)
    np.testing.assert_array_equal(found[..., 3], frame.alpha)
    np.testing.assert_array_equal(found[..., :3], frame.rgb * np.float32(FACTOR))
    assert 0 < frame.alpha.mean() < 1


def test_the_last_frame_is_shown_after_those_on_the_way(shot, tmp_path, monkeypatch, module):
    shot.daguerre.spp = 16
    seen = []
    real = module.passes.combined

    def watched(frame, shot):
        seen.append(int(frame.samples.min()))
        return real(frame, shot)

    monkeypatch.setattr(module.passes, "combined", watched)
    bpy.ops.render.render()
    assert len(seen) > 2
    assert seen == sorted(seen)
    assert seen[-1] == 16


def test_passes_have_our_names_and_values(shot, tmp_path):
    shot.daguerre.passes = {"depth", "N", "object_id"}
    shot.render.image_settings.media_type = "MULTI_LAYER_IMAGE"
    shot.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
    bpy.ops.render.render(write_still=True)
    planes = {}
    for part in range(4):
        buffer = oiio.ImageBuf(str(tmp_path / "out.exr"), part, 0)
        for index, name in enumerate(buffer.spec().channelnames):
            planes[name.removeprefix("ViewLayer.")] = buffer.get_pixels()[..., index]
    frame = ours(aovs=True)
    np.testing.assert_array_equal(planes["depth.Z"], frame.aovs["depth.Z"])
    np.testing.assert_array_equal(planes["object_id.X"], frame.aovs["object_id"])
    for part in "XYZ":
        np.testing.assert_array_equal(planes[f"N.{part}"], frame.aovs[f"N.{part}"])
    np.testing.assert_array_equal(planes["Combined.R"], frame.rgb[..., 0] * np.float32(FACTOR))


@pytest.mark.parametrize("edges", [(0.25, 0.5, 0.75, 1.0), (0.11, 0.07, 0.93, 0.61)])
@pytest.mark.parametrize("cuts", [False, True])
def test_a_render_region_is_drawn_where_it_stands(shot, tmp_path, edges, cuts):
    render = shot.render
    render.use_border, render.use_crop_to_border = True, cuts
    render.border_min_x, render.border_min_y, render.border_max_x, render.border_max_y = edges
    bpy.ops.render.render(write_still=True)
    left, right = int(edges[0] * SIZE[0]), int(edges[2] * SIZE[0])
    top, bottom = SIZE[1] - int(edges[3] * SIZE[1]), SIZE[1] - int(edges[1] * SIZE[1])
    whole, found = ours().rgb * np.float32(FACTOR), drawn(tmp_path)[..., :3]
    wanted = whole[top:bottom, left:right]
    if not cuts:
        wanted, part = np.zeros_like(whole), wanted
        wanted[top:bottom, left:right] = part
    np.testing.assert_array_equal(found, wanted)


def test_two_eyes_see_two_pictures(shot, tmp_path):
    shot.render.use_multiview = shot.render.film_transparent = True
    shot.render.image_settings.views_format = "INDIVIDUAL"
    bpy.ops.render.render(write_still=True)
    left, right = drawn(tmp_path, name="out_L.exr"), drawn(tmp_path, name="out_R.exr")
    assert left.shape == right.shape
    columns = np.arange(SIZE[0])
    seen = [(columns * one[..., 3]).sum() / one[..., 3].sum() for one in (left, right)]
    assert seen[0] - seen[1] > 0.1  # the left eye sees the triangle farther to the right


def test_an_animation_draws_each_frame(shot, tmp_path):
    shot.frame_start, shot.frame_end = 3, 4
    shot.render.filepath = str(tmp_path / "f")
    bpy.ops.render.render(animation=True)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["f0003.exr", "f0004.exr"]


def raising(error):
    def scene_of(depsgraph, frame_set=None):
        raise error

    return scene_of


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (dg.InputError("mesh Cube: points: wanted finite numbers, got nan"), "mesh Cube: points"),
        (MemoryError(), "wanted more memory"),
        (KeyError("uv"), "internal error (KeyError: 'uv'); please report it"),
    ],
)
def test_an_error_becomes_one_report(shot, module, monkeypatch, capfd, error, words):
    monkeypatch.setattr(module.translation, "scene_of", raising(error))
    with pytest.raises(RuntimeError, match="Daguerre: ") as caught:
        bpy.ops.render.render()
    assert words in str(caught.value)
    assert "Traceback" not in str(caught.value) + "".join(capfd.readouterr())


def test_a_scene_without_a_camera_and_a_lens_that_is_none_are_reports(shot, module, monkeypatch):
    blender_extension.stand_in(monkeypatch, lens="no-such-lens")
    with pytest.raises(RuntimeError, match="no-such-lens"):
        bpy.ops.render.render()
    blender_extension.stand_in(monkeypatch, lens="pinhole")
    assert bpy.ops.render.render() == {"FINISHED"}  # and the next one is drawn


class Impatient:
    """Blender's engine, whose user cancels at a moment."""

    def __init__(self, engine, stops_at):
        self._engine, self._stops_at = engine, stops_at

    def test_break(self):
        return time.monotonic() > self._stops_at

    def __getattr__(self, name):
        return getattr(self._engine, name)


def test_a_cancelled_picture_ends_in_a_second(shot, module, monkeypatch):
    shot.daguerre.spp = 1_000_000
    stops_at, real = time.monotonic() + 1.0, module.engine.Drawing
    monkeypatch.setattr(
        module.engine, "Drawing", lambda engine, *rest: real(Impatient(engine, stops_at), *rest)
    )
    bpy.ops.render.render()
    assert 0 < time.monotonic() - stops_at < 1


class Follower:
    """Engine for drawings outside of Blender."""

    def __init__(self, stops_after=np.inf):
        self.stops_at = time.monotonic() + stops_after
        self.fractions, self.texts, self.used = [], [], []

    def test_break(self):
        return time.monotonic() > self.stops_at

    def update_progress(self, progress):
        self.fractions.append(progress)

    def update_stats(self, stats, info):
        self.texts.append(info)

    def update_memory_stats(self, memory_used=0, memory_peak=0):
        self.used.append((memory_used, memory_peak))


def shot_of(module, **more):
    settings = dg.RenderSettings.of(**{"resolution": SIZE, "spp": 4, "light_paths": "off"} | more)
    return module.translation.Shot(scene(), camera(lens="pinhole"), settings, FACTOR)


def test_progress_samples_time_and_memory_are_told(module):
    tells = Follower()
    frame = module.drawing.Drawing(tells, shot_of(module, spp=64), lambda f: None).run(
        denoises=False
    )
    np.testing.assert_array_equal(frame.samples, 64)
    assert tells.fractions == sorted(tells.fractions)
    assert tells.fractions[-1] == 1
    assert "64/64 spp" in tells.texts[-1]
    assert "Mem " in tells.texts[-1]
    assert any("Remaining " in text for text in tells.texts)
    assert all(0 < used <= peak for used, peak in tells.used)


def test_adaptive_sampling_tells_its_noise(module):
    tells = Follower()
    module.drawing.Drawing(tells, shot_of(module, spp=64, noise=0.2), lambda f: None).run(
        denoises=False
    )
    assert any("noise" in text and "wanted 0.2" in text for text in tells.texts)


def test_a_step_that_does_not_listen_is_left_behind(module):
    done, tells = threading.Event(), Follower(stops_after=0.1)
    began = time.monotonic()
    with pytest.raises(Cancelled):
        module.drawing.cancellable(lambda: done.wait(20), tells.test_break)
    assert time.monotonic() - began < 1
    done.set()


def test_the_error_of_a_step_is_raised_here(module):
    with pytest.raises(ZeroDivisionError):
        module.drawing.cancellable(lambda: 1 / 0, lambda: False)
    assert module.drawing.cancellable(lambda: 5, lambda: False) == 5


@pytest.mark.parametrize(
    ("seconds", "text"), [(0.04, "00:00.0"), (62.53, "01:02.5"), (7384, "2:03:04")]
)
def test_time_is_written_as_blender_does(module, seconds, text):
    assert module.drawing.clock(seconds) == text


def test_a_denoiser_that_is_missing_costs_a_warning(shot, tmp_path, module, monkeypatch, capfd):
    def missing():
        raise dg.UsageError("denoise: wanted the package mitsuba-oidn, which is not installed")

    monkeypatch.setattr(module.engine, "check_denoiser", missing)
    shot.daguerre.denoise = True
    assert bpy.ops.render.render(write_still=True) == {"FINISHED"}
    assert "not denoised: denoise: wanted the package" in "".join(capfd.readouterr())
    np.testing.assert_array_equal(drawn(tmp_path)[..., :3], ours().rgb * np.float32(FACTOR))


def test_the_picture_is_denoised(shot, tmp_path):
    pytest.importorskip("mitsuba_oidn", reason="no denoiser here")
    shot.daguerre.denoise = True
    bpy.ops.render.render(write_still=True)
    from daguerre.rendering.denoise import denoise

    clean = denoise(ours(aovs=True)).rgb * np.float32(FACTOR)
    np.testing.assert_allclose(drawn(tmp_path)[..., :3], clean, rtol=1e-3, atol=1e-4)
    assert np.abs(clean - ours().rgb * np.float32(FACTOR)).max() > 0.01


def test_a_photograph_and_its_raw_file_lie_beside_the_render(shot, tmp_path, monkeypatch):
    blender_extension.stand_in(monkeypatch, lens="pinhole", iso=1e6)
    shot.daguerre.photograph = shot.daguerre.raw = True
    shot.daguerre.look = "filmic"
    shot.camera.data.daguerre.iso = 1e6
    bpy.ops.render.render(write_still=True)
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {"out.exr", "out_photograph.png", "out_photograph.dng"}
    assert oiio.ImageBuf(str(tmp_path / "out_photograph.png")).spec().width == SIZE[0]


@pytest.mark.parametrize(("name", "stem"), [("", "render"), ("a.v2", "a.v2"), ("b.exr", "b")])
def test_a_photograph_is_named_as_the_render(shot, module, tmp_path, name, stem):
    shot.render.filepath = f"{tmp_path}/{name}"
    found = module.photograph.paths(shot, numbered=False)
    assert found == [tmp_path / f"{stem}_photograph.png"]


def test_the_photograph_is_metered_if_asked(module):
    group = SimpleNamespace(exposure_mode="auto", iso=200.0)
    asked = module.photograph.photograph_of(camera(sensor="nikon-d5100"), "film", group)
    assert (asked.iso, asked.look) == (None, "film")
    assert asked.sensor == dg.sensors.load("nikon-d5100")
    group.exposure_mode = "manual"
    assert module.photograph.photograph_of(camera(), "film", group).iso == 200


@pytest.mark.parametrize("mode", ["light", "manual", "auto"])
def test_the_panel_s_mode_governs_the_photograph_alone(shot, tmp_path, monkeypatch, mode):
    values = {"iso": 800.0} if mode == "manual" else {"exposure": mode}
    values |= {"exposure_compensation": -2.0} if mode == "light" else {}
    blender_extension.stand_in(monkeypatch, lens="pinhole", shutter_time=1.0, **values)
    shot.daguerre.photograph = True
    group = shot.camera.data.daguerre
    group.exposure_mode, group.iso = mode, 800.0
    bpy.ops.render.render(write_still=True)
    frame = ours()
    np.testing.assert_array_equal(drawn(tmp_path)[..., :3], frame.rgb * np.float32(FACTOR))
    got = oiio.ImageBuf(str(tmp_path / "out_photograph.png")).get_pixels(oiio.UINT8)
    with_mode = camera(lens="pinhole", shutter_time=1.0, **{"exposure": mode} | values)
    settings = dg.RenderSettings.of(resolution=SIZE, spp=4, light_paths="off")
    wanted = dg.render(scene(), with_mode, settings=settings).display()
    assert 10 < wanted.mean() < 245
    assert np.abs(np.asarray(got, int) - wanted.astype(int)).max() <= 1


def test_the_frames_and_eyes_of_a_render_share_what_the_meter_chose(shot, module, monkeypatch):
    blender_extension.stand_in(monkeypatch, lens="pinhole", exposure="auto")
    metered = []
    choose = module.metering.choose

    def counted(scene, camera, settings):
        metered.append(camera)
        return choose(scene, camera, settings)

    monkeypatch.setattr(module.metering, "choose", counted)
    shot.daguerre.photograph = True
    shot.frame_start, shot.frame_end = 1, 3
    shot.render.use_multiview = True
    bpy.ops.render.render(animation=True)
    assert len(metered) == 1
    np.testing.assert_array_equal(metered[0].transform, camera().transform)  # between the eyes
    bpy.ops.render.render()
    assert len(metered) == 2


@pytest.mark.parametrize(("number", "pattern"), [(1, "centre"), (2, "spot"), (3, "matrix")])
def test_metering_patterns_of_old_files_are_auto(shot, tmp_path, module, capfd, number, pattern):
    """Before 1.0 the menu of modes was manual and the patterns, which files keep as numbers."""
    group = shot.camera.data.daguerre
    group.exposure_mode = "light"
    group.bl_system_properties_get()["exposure_mode"] = number
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "old.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "old.blend"))
    scene, group = bpy.context.scene, bpy.context.scene.camera.data.daguerre
    assert (group.exposure_mode, group.meter) == ("auto", pattern)
    scene.daguerre.photograph = True
    bpy.ops.render.render(write_still=True)
    assert f"exposure mode '{pattern}' of before 1.0 is now auto" in "".join(capfd.readouterr())
    group.meter = "highlight"
    assert (group.exposure_mode, group.meter) == ("auto", "highlight")
    group.exposure_mode = "manual"
    assert module.metering.old_meter(group) is None


def test_twenty_renders_leave_no_memory_and_no_thread_behind(shot):
    """A leak grows in every batch; the pools of the allocator grow in some."""

    def rendered(count):
        for _ in range(count):
            bpy.ops.render.render()
        gc.collect()
        return memory.own_bytes()

    shot.render.resolution_x, shot.render.resolution_y = 320, 240  # 1.2 MB for one picture
    shot.daguerre.spp = 1
    used, threads = [rendered(5)], threading.active_count()
    used += [rendered(20) for _ in range(3)]
    assert np.diff(used).min() < 2e6  # a picture each would be 24.6 MB
    assert threading.active_count() == threads


def test_flat_pixels_begin_at_the_bottom_left(module):
    pixels = np.arange(12, dtype=np.float32).reshape(2, 3, 2)
    found = module.passes.flat(pixels)
    np.testing.assert_array_equal(found, [6, 7, 8, 9, 10, 11, 0, 1, 2, 3, 4, 5])


def test_a_group_without_channels_in_the_frame_has_no_pass(module):
    rows = [row for row in module.passes.BY_NAME.values() if row.name in ("depth", "N")]
    frame = ours(aovs=True)
    without = replace(frame, aovs={"depth.Z": frame.aovs["depth.Z"]})
    assert [name for name, _ in module.passes.planes(without, rows, shot_of(module))] == [
        "Combined",
        "depth",
    ]
