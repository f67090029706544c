"""A fitted lens leaves Daguerre: what its code says is what the fit says, and nearly the lens."""

import ctypes
import json
import shutil
import subprocess

import numpy as np
import pytest

import daguerre as dg
from daguerre import export, lenses
from daguerre.export import aim, code, from_fit
from daguerre.files import formats
from daguerre.polynomial import Iris, LensFit, fit
from tests.export.test_export_code import _compiled

CASES = {
    "double gauss": {"lens": "double-gauss-50mm-f2", "focus": 1.5},
    "fisheye": {"lens": "fisheye-16mm-f2.8", "segments": 2},
    "blades": {"lens": "double-gauss-50mm-f2", "iris": Iris.polygon(7, 10.0, -0.3), "f_stop": 4.0},
    "anamorphic": {"lens": "schneider-anamorphic-60mm", "degree": 5},
}


@pytest.fixture(scope="module")
def double_gauss():
    return fit("double-gauss-50mm-f2", focus=1.5)


def film_rays(made, count=2000, seed=5):
    """Film points, slopes and wavelengths over the domain of a fit, and a little beyond."""
    rng = np.random.default_rng(seed)
    film, pupil = made.to_dict()["film"], made.to_dict()["pupil"]
    f, q = rng.uniform(-1.02, 1.02, (2, count, 2))
    slope = (q - f * pupil["by_film"] - pupil["shift"]) / pupil["by_slope"]
    points = np.array(film["center"]) + f * film["half"]
    return points, slope, rng.uniform(400, 700, count)


def plan(made):
    return aim.with_aim(from_fit.plan_of(made.to_dict()))


def check_evaluation(made, outputs, points, slope, nm):
    """Ten columns of evaluate() against the fit."""
    said = made.evaluate(points, slope, nm)
    inside = np.all(np.abs(said.iris) < 50, axis=1)  # far outside, the polynomials are anything
    got = outputs[inside]
    apart = got[:, :3] - said.origins[inside]
    across = np.cross(apart, said.directions[inside])
    np.testing.assert_allclose(across, 0, atol=1e-7)
    # Rays that graze the sphere at the front meet it at the root of a small difference.
    np.testing.assert_allclose(apart, 0, atol=1e-4)
    np.testing.assert_allclose(got[:, 3:6], said.directions[inside], atol=1e-9)
    np.testing.assert_allclose(got[:, 6:8], said.iris[inside], atol=1e-8)
    passes = got[:, 9] == 0
    light = np.clip(said.transmittance[inside], 0, 1) * passes
    np.testing.assert_allclose(got[:, 8], light, atol=1e-9)
    shape = made.setting.iris
    if shape is None:
        radius = made.to_dict()["iris"]["radius"]
        wanted = said.within & (np.hypot(*said.iris.T) <= radius)
        np.testing.assert_array_equal(passes, wanted[inside])
    assert not np.any(passes & ~said.within[inside])
    assert 0.1 < passes.mean() < 0.9


@pytest.mark.parametrize("case", CASES.values(), ids=CASES.keys())
def test_numpy_says_what_the_fit_says(case):
    made = fit(**case)
    points, slope, nm = film_rays(made)
    evaluate, _ = aim.callables(plan(made))
    outputs = evaluate(*points.T, *slope.T, nm, made.setting.f_stop)
    check_evaluation(made, np.stack(np.broadcast_arrays(*outputs), axis=1), points, slope, nm)


def test_c_says_what_the_fit_says(double_gauss, tmp_path):
    points, slope, nm = film_rays(double_gauss)
    rows = np.column_stack([points, slope, nm, np.full(len(nm), double_gauss.setting.f_stop)])
    run = _compiled(code(double_gauss.to_dict(), ".c"), "double", tmp_path, "gcc", ".c")
    check_evaluation(double_gauss, run("evaluate", rows, 10), points, slope, nm)


def test_c_compiles_alone_and_in_several_files_without_a_warning(double_gauss, tmp_path):
    if shutil.which("gcc") is None:
        pytest.skip("gcc is not installed")
    double_gauss.save(tmp_path / "lens.c")
    strict = ["gcc", "-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror"]
    lens = "double_gauss_50_mm_f_2"
    for name in ("one", "two"):
        used = f"{lens}_evaluate(0, 0, 0, 0, 550, 4, o, o, o, o, o, o, o, o, o, o);"
        used += f"{lens}_sample(0, 0, 0, 0, 550, 4, o, o, o, o, o, o, o);"
        used = f"void use_{name}(double *o);\nvoid use_{name}(double *o) {{ {used} }}"
        text = f'#define DAGUERRE_API static\n#include "lens.c"\n#include "lens.c"\n{used}\n'
        (tmp_path / f"{name}.c").write_text(text)
    subprocess.run([*strict, "-shared", "-fPIC", "lens.c", "-o", "a.so"], cwd=tmp_path, check=True)
    both = [*strict, "-shared", "-fPIC", "one.c", "two.c", "-o", "b.so"]
    subprocess.run(both, cwd=tmp_path, check=True)
    assert hasattr(ctypes.CDLL(str(tmp_path / "a.so")), f"{lens}_sample")


def test_drawn_rays_go_back_through_the_glass_to_their_film_points(double_gauss):
    """The camera's frame, and the picture upright: traced exactly, within the stated error."""
    made, rng = double_gauss, np.random.default_rng(8)
    film = rng.uniform(-1, 1, (500, 2)) * (17.5, 11.5)
    *ray, weight = aim.callables(plan(made))[1](*film.T, *rng.random((2, 500)), 550.0, 2.8)
    drawn = weight > 0
    assert drawn.mean() > 0.8
    origin, direction = np.stack(ray[:3], axis=1), np.stack(ray[3:], axis=1)
    in_lens = 1e3 * origin + [0, 0, made.to_dict()["entrance_pupil_z"]] + 30.0 * direction
    lens = lenses.load("double-gauss-50mm-f2").focused(1.5)
    nm = np.full(500, 550.0)
    points, out, *_ = lens.lens.prescription.rays(in_lens, -direction, nm, False, True)
    t = (lens.film_z_mm - points[:, 2]) / out[:, 2]
    landed = points[:, :2] + t[:, None] * out[:, :2]
    error = 1e3 * np.hypot(*(landed + film).T)[drawn]  # um; the picture is upside down
    rms, worst = made.error.film_um
    assert np.sqrt(np.mean(error**2)) < 1.5 * rms
    assert error.max() < 1.5 * worst


@pytest.mark.parametrize("f_stop", [2.0, 5.6])
def test_exposure_is_that_of_the_exact_camera(double_gauss, f_stop):
    """A white world: vignetting and brightness, against a picture through the glass itself."""
    f_stop = max(f_stop, double_gauss.setting.f_stop)
    scene = dg.Scene()
    scene.set_environment(color=(1.0, 1.0, 1.0))
    camera = dg.Camera(lens="double-gauss-50mm-f2", focus_distance=1.5, f_stop=f_stop)
    picture = dg.render(scene, camera, spp=128, resolution=(72, 48)).rgb @ (0.2126, 0.7152, 0.0722)
    blocks = picture.reshape(4, 12, 6, 12).mean(axis=(1, 3))
    corner = np.stack(np.meshgrid(np.arange(6), np.arange(4)), axis=-1)[..., None, :]
    even = aim.quasi_random(4, 2000)
    place = np.moveaxis((corner + even[:, :2] - (3, 2)) * (6, -6), -1, 0)
    sample, u = aim.callables(plan(double_gauss))[1], even[:, 2:].T
    weights = zip(aim.EXPOSURE_NM, aim.EXPOSURE_WEIGHTS, strict=True)
    mean = sum(share * sample(*place, *u, nm, f_stop)[-1].mean(axis=-1) for nm, share in weights)
    np.testing.assert_allclose(mean, blocks, rtol=0.03)
    assert mean.mean() == pytest.approx(blocks.mean(), rel=0.004)


def test_json_and_back(double_gauss, tmp_path):
    file = tmp_path / "lens.json"
    double_gauss.save(file)
    data = json.loads(file.read_text())
    again = LensFit.from_dict(data)
    assert again.setting == double_gauss.setting
    assert json.loads(json.dumps(again.to_dict())) == data
    points, slope, nm = film_rays(double_gauss, 50)
    np.testing.assert_array_equal(
        again.evaluate(points, slope, nm).directions,
        double_gauss.evaluate(points, slope, nm).directions,
    )


@pytest.mark.parametrize("suffix", [".c", ".glsl", ".osl", ".py"])
def test_the_head_says_what_lens_it_is(double_gauss, suffix):
    head = code(double_gauss.to_dict(), suffix)[:1200]
    for text in ("degree 7", "US 2,673,491", "f/2,", "1.5 m", dg.__version__, "Apache-2.0"):
        assert text in head


def test_what_code_cannot_express(double_gauss, tmp_path):
    data = double_gauss.to_dict()
    picture = fit("double-gauss-50mm-f2", degree=1, iris=Iris.image(np.ones((4, 4), np.float32)))
    with pytest.raises(
        dg.InputError, match="iris: wanted a round iris or blades, got an aperture_image"
    ):
        picture.save(tmp_path / "lens.osl")
    picture.save(tmp_path / "lens.json")
    tilted = {**data, "film": {**data["film"]}}
    tilted["film"]["plane"] = {**data["film"]["plane"], "x": [0.99, 0, 0.14]}
    with pytest.raises(dg.InputError, match="film: wanted it centred on the lens's axis"):
        code(tilted, ".osl")
    with pytest.raises(dg.InputError, match="setting: wanted the f-stop"):
        code({**data, "setting": None}, ".c")
    assert formats.written("fit") == export.SUFFIXES
    with pytest.raises(
        dg.UsageError, match=r"lens.txt: .* ending in .c, .glsl, .osl, .py or .json, got '.txt'"
    ):
        double_gauss.save("lens.txt")
    with pytest.raises(
        dg.InputError, match="lens fit: setting: wanted the numbers of a lens setting"
    ):
        LensFit.from_dict({**data, "setting": {"focus_m": "near"}})
    large = {**data, "segments": 80 * data["segments"]}
    with pytest.raises(dg.UsageError, match=r"at most 20000 coefficients, got .*lower degree"):
        code(large, ".osl")
