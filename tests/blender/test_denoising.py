"""Blender's own denoiser in the place of the package that its extension does not bring."""

from types import SimpleNamespace

import numpy as np
import pytest

import daguerre as dg
from daguerre.rendering import denoise
from daguerre.rendering.denoiser import of_library
from tests.support.blender import blender_extension
from tests.support.blender.blender_layout import drawn

bpy = pytest.importorskip("bpy", reason="no bpy in this Python")


@pytest.fixture
def extension(monkeypatch):
    """The extension where the package is not installed."""
    with blender_extension.registered() as found:
        extras = found.denoising.extras
        monkeypatch.setattr(extras, "missing", lambda module: module == denoise.MODULE)
        yield found
    found.denoising._loaded.cache_clear()


@pytest.fixture
def blenders(extension):
    found = extension.denoising.of_blender()
    if found is None:
        pytest.skip("this Blender has no shared library of Open Image Denoise")
    return found


def test_it_takes_noise_away_as_the_package_does(blenders):
    rng = np.random.default_rng(1)
    y, x = np.mgrid[:64, :96].astype(np.float32)
    clean = np.dstack([1 + x / 96, 2 + 0 * x, 1 + y / 64]) * (1 + (x > 48))[..., None]
    albedo = np.dstack([0.4 + 0.4 * (x > 48)] * 3)
    normal = np.dstack([0 * x, 0 * x, 1 + 0 * x])
    images = {
        "color": clean * rng.exponential(1, clean.shape), "albedo": albedo, "normal": normal,
    }  # fmt: skip
    images = {name: image.astype(np.float32) for name, image in images.items()}
    found = blenders.run(**images)
    assert blenders.name.startswith("Open Image Denoise 2.")
    errors = [np.sqrt(((one / clean - 1) ** 2).mean()) for one in (images["color"], found)]
    assert errors[1] < 0.1 * errors[0]
    assert np.isfinite(blenders.run(albedo=images["albedo"])).all()
    if not denoise.extras.find_spec(denoise.MODULE):
        return
    wanted = denoise._run(**images)
    np.testing.assert_allclose(found.mean((0, 1)), wanted.mean((0, 1)), rtol=0.01)
    assert np.sqrt(((found / wanted - 1) ** 2).mean()) < 0.03


def test_a_frame_is_denoised_and_says_by_what(blenders):
    scene, camera = blender_extension.scene(), blender_extension.camera()
    frame = dg.render(scene, camera, spp=4, resolution=(48, 32), aovs=True)
    best = dg.render(scene, camera, spp=512, resolution=(48, 32))
    clean = denoise.denoised(frame, blenders)
    assert clean.metadata["denoised"] == blenders.name
    away = [np.abs(one.rgb - best.rgb).mean() for one in (frame, clean)]
    assert away[1] < 0.7 * away[0]


def test_a_picture_that_is_refused_is_one_error(blenders):
    odd = np.ones((8, 8, 3), np.float32)
    with pytest.raises(dg.InputError, match="denoise: Open Image Denoise failed: "):
        blenders.run(color=odd, normal=odd)  # it takes normals only with albedo


def test_the_engine_uses_it(extension, blenders, monkeypatch):
    extension.drawing.check_denoiser()
    monkeypatch.setattr(denoise, "denoise", lambda frame: pytest.fail("the package is missing"))
    frame = dg.render(
        blender_extension.scene(), blender_extension.camera(), resolution=(16, 16), aovs=True
    )
    session = SimpleNamespace(frame=lambda: frame)
    found = extension.drawing._finished(session, denoises=True)
    np.testing.assert_array_equal(found.rgb, denoise.denoised(frame, blenders).rgb)


def test_no_library_is_one_line_in_the_panel(extension, monkeypatch, tmp_path):
    path = tmp_path / "libOpenImageDenoise.so.2"
    path.write_bytes(b"\x7fELF" + b"\0" * 100)
    for files in ([], [path]):
        extension.denoising._loaded.cache_clear()
        monkeypatch.setattr(extension.denoising, "libraries", lambda files=files: files)
        assert not extension.denoising.is_there()
    context = SimpleNamespace(scene=bpy.context.scene)
    panel = extension.panels.DAGUERRE_PT_sampling
    assert not drawn(panel, context).texts
    bpy.context.scene.daguerre.denoise = True
    assert drawn(panel, context).texts == ["No denoiser here: use the compositor's Denoise node"]
    with pytest.raises(dg.UsageError, match="mitsuba-oidn"):
        extension.drawing.check_denoiser()


def test_another_library_is_refused(tmp_path):
    import ctypes.util

    with pytest.raises(dg.UsageError, match="wanted Open Image Denoise 2"):
        of_library(ctypes.util.find_library("c"))
    with pytest.raises(dg.UsageError, match="wanted Open Image Denoise 2"):
        of_library(tmp_path / "none.so")
