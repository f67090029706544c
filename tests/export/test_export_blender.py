"""An exported lens in Blender's own renderer. Needs bpy, here or in DAGUERRE_BLENDER_PYTHON."""

import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest

import daguerre as dg
from daguerre.export import aim, code, from_fit
from daguerre.polynomial import fit

PYTHON = os.environ.get("DAGUERRE_BLENDER_PYTHON") or (
    sys.executable if importlib.util.find_spec("bpy") else None
)
pytestmark = pytest.mark.skipif(
    PYTHON is None, reason="no bpy here, and no Python that has it in DAGUERRE_BLENDER_PYTHON"
)

NAME, FOCUS, SENSOR = "double-gauss-50mm-f2", 1.5, 36.0
RESOLUTION = (48, 32)


@pytest.fixture(scope="module")
def lens(tmp_path_factory):
    """The fit's data, and the exported file."""
    data = fit(NAME, degree=7, focus=FOCUS).to_dict()
    path = tmp_path_factory.mktemp("blender") / "lens.osl"
    path.write_text(code(data, ".osl"))
    return data, path


def blender(path, tmp_path, **job):
    """A picture (H, W, 3), row 0 at the top."""
    output = tmp_path / "out.exr"
    job = {
        "lens": str(path),
        "output": str(output),
        "sensor_width": SENSOR,
        "resolution": RESOLUTION,
        "spp": 64,
        "lamps": [],
        "world": "black",
        "parameters": {},
        **job,
    }
    file = tmp_path / "job.json"
    file.write_text(json.dumps(job))
    script = Path(__file__).parents[1] / "support" / "blender" / "blender_job.py"
    subprocess.run([PYTHON, str(script), str(file)], check=True, capture_output=True, timeout=300)
    return oiio.ImageBuf(str(output)).get_pixels()[..., :3].astype(float)


def means(data, f_stop, nm, film=SENSOR, size=RESOLUTION):
    """Mean weight, and weighted mean direction (world, y up), of each pixel's middle."""
    _, sample = aim.callables(aim.with_aim(from_fit.plan_of(data)))
    width, height = size
    pitch = film / width
    total, direction = np.zeros((height, width)), np.zeros((height, width, 3))
    u1, u2 = np.random.default_rng(1).random((2, 2000, 1))
    film_x = (np.arange(width) + 0.5 - width / 2) * pitch
    for row in range(height):
        film_y = (height / 2 - row - 0.5) * pitch
        *_, dx, dy, dz, weight = sample(film_x, film_y, u1, u2, nm, f_stop)
        total[row] = weight.mean(axis=0)
        mean = np.stack([(weight * d).mean(axis=0) for d in (dx, dy, dz)], axis=-1)
        direction[row] = mean / total[row][:, None]
    return total, direction


@pytest.mark.parametrize("f_stop", [2.0, 8.0])
def test_a_white_world(lens, tmp_path, f_stop):
    """Vignetting as in numpy, and 1 in the middle at every stop."""
    data, path = lens
    f_stop = max(f_stop, data["setting"]["f_stop"])
    parameters = {"f_stop": f_stop, "chromatic": 0}
    picture = blender(path, tmp_path, world="white", parameters=parameters)
    wanted, _ = means(data, f_stop, 549.0)
    blocks = [p.reshape(4, 8, 6, 8).mean(axis=(1, 3)) for p in (picture[..., 1], wanted)]
    np.testing.assert_allclose(*blocks, atol=0.025)
    assert picture.mean() == pytest.approx(wanted.mean(), rel=0.003)
    middle = picture[14:18, 22:26].mean()
    assert middle == pytest.approx(1, abs=0.02)


def test_colours_are_the_wavelengths(lens, tmp_path):
    """Each channel has the mean of its own wavelength: three times a third."""
    data, path = lens
    picture = blender(path, tmp_path, world="white", spp=256)
    for channel, nm in enumerate((611.0, 549.0, 464.0)):
        wanted = means(data, data["setting"]["f_stop"], nm)[0].mean()
        assert picture[..., channel].mean() == pytest.approx(wanted, rel=0.004)


@pytest.mark.parametrize(("film", "size"), [(SENSOR, RESOLUTION), (24.0, (48, 27))])
def test_directions(lens, tmp_path, film, size):
    """Upright, not mirrored, distorted as the lens, on any film: to a twentieth of a pixel."""
    data, path = lens
    f_stop = 8.0
    job = {"sensor_width": film, "resolution": size}
    job["parameters"] = {"f_stop": f_stop, "chromatic": 0}
    white = blender(path, tmp_path, world="white", **job)
    seen = blender(path, tmp_path, world="direction", **job)
    direction = 2 * seen / white - 1
    _, wanted = means(data, f_stop, 549.0, film, size)
    pixel = film / size[0] / 50
    assert np.abs(direction - wanted).max() < 0.5 * pixel  # the pixel filter's noise
    assert np.abs((direction - wanted).mean(axis=(0, 1))).max() < 0.05 * pixel


def test_bokeh_is_that_of_the_exact_lens(lens, tmp_path):
    """A lamp toward the corner, before the focus: the outline against Daguerre's own picture."""
    data, path = lens
    place, radius, size = (0.11, 0.07, -0.4), 0.003, (240, 160)
    job = {"lamps": [[*place, radius, 1000.0]], "resolution": size, "spp": 256}
    there = blender(path, tmp_path, **job, parameters={"chromatic": 0})[..., 1]
    scene = dg.Scene()
    pose = np.eye(4)
    pose[:3, 3] = place
    scene.add_light(dg.SphereLight(luminance=(1000.0,) * 3, radius=radius), pose)
    camera = dg.Camera(lens=NAME, focus_distance=FOCUS, f_stop=data["setting"]["f_stop"])
    here = dg.render(scene, camera, spp=256, resolution=size).rgb[..., 1]
    outlines = [_blurred(p) > 0.3 * np.quantile(_blurred(p), 0.995) for p in (there, here)]
    union = np.logical_or(*outlines).sum()
    assert union > 100
    assert np.logical_and(*outlines).sum() / union > 0.9
    assert there.sum() == pytest.approx(here.sum(), rel=0.05)


def _blurred(picture):
    """Mean of 3 x 3 pixels."""
    padded = np.pad(picture, 1)
    shifts = [(i, j) for i in range(3) for j in range(3)]
    return sum(padded[i : i + len(picture), j : j + picture.shape[1]] for i, j in shifts) / 9
