"""The languages that a lens is exported to say the same, and what the plan says."""

import ctypes
import itertools
import math
import re
import shutil
import subprocess
from dataclasses import replace

import numpy as np
import pytest

from daguerre.export import aim, languages, lens_code, osl
from daguerre.export.expression import Function, Name
from daguerre.export.facts import facts
from daguerre.export.horner import derivative, horner
from tests.support.lenses.lens_plans import evaluated, made_up

PLANS = {
    "symmetric": made_up(),
    "one segment": made_up(segments=1),
    "blades": made_up(blades=True),
    "no symmetry": made_up(symmetric=False),
    "no aim": made_up(aim=False),
    "fisheye": made_up(wide=1.8),
}
plans = pytest.mark.parametrize("plan", PLANS.values(), ids=PLANS.keys())


def _rays(count=300):
    rng = np.random.default_rng(3)
    film, slope = rng.uniform(-16, 16, (2, count)), None
    slope = (rng.uniform(-9.5, 9.5, (2, count)) - film) / -50
    nm, f_stop = rng.uniform(400, 700, count), rng.choice([1.4, 2.0, 2.8, 8.0], count)
    return np.ascontiguousarray(np.stack([*film, *slope, nm, f_stop], axis=1))


def _samples(count=300):
    rng = np.random.default_rng(4)
    columns = [*rng.uniform(-16, 16, (2, count)), *rng.random((2, count))]
    return np.stack([*columns, rng.uniform(400, 700, count), np.full(count, 2.0)], axis=1)


def _in_numpy(plan, rays, samples):
    evaluate, sample = aim.callables(plan)
    outputs = [np.broadcast_arrays(*f(*x.T)) for f, x in ((evaluate, rays), (sample, samples))]
    return [np.stack(o, axis=1) for o in outputs]


def _compiled(source, number, tmp_path, compiler, suffix):
    """Runs evaluate and sample of a C or C++ text on rows of six numbers."""
    if shutil.which(compiler) is None:
        pytest.skip(f"no {compiler} on this machine")
    name = re.search(r"(\w+)_evaluate\(", source)[1]
    calls = ""
    in_c, address = suffix == ".c", "&" if suffix == ".c" else ""
    for function, outputs in (("evaluate", 10), ("sample", 7)):
        out = ", ".join(f"{address}o[{i}]" for i in range(outputs))
        calls += (
            ("" if in_c else 'extern "C" ') + f"void run_{function}"
            f"(const {number} *in, {number} *out, int n) {{\n"
            f"  for (int i = 0; i < n; ++i) {{ const {number} *a = in + 6 * i; "
            f"{number} *o = out + {outputs} * i;\n"
            f"    {name}_{function}(a[0], a[1], a[2], a[3], a[4], a[5], {out}); }} }}\n"
        )
    file, library = tmp_path / f"lens{suffix}", tmp_path / "lens.so"
    file.write_text(source + calls)
    flags = ["-O1", "-Wall", "-Wextra", "-Werror", "-Wno-unused-function", "-shared", "-fPIC"]
    if number == "float":
        flags.append("-fsingle-precision-constant")
    subprocess.run([compiler, *flags, str(file), "-o", str(library), "-lm"], check=True)
    loaded = ctypes.CDLL(str(library))
    type_of = np.float64 if number == "double" else np.float32

    def run(function, rows, outputs):
        rows = np.ascontiguousarray(rows, dtype=type_of)
        out = np.zeros((len(rows), outputs), dtype=type_of)
        pointers = (x.ctypes.data_as(ctypes.c_void_p) for x in (rows, out))
        loaded["run_" + function](*pointers, len(rows))
        return out

    return run


@pytest.mark.skipif(not shutil.which("glslangValidator"), reason="no glslangValidator here")
@pytest.mark.parametrize("version", ["330", "300 es"])
def test_glsl_is_valid(version, tmp_path):
    plan = PLANS["blades"]
    name = languages.identifier(plan.name)
    text = f"""#version {version}
precision highp float;
{languages.glsl_file(plan, ["A lens."])}
out vec4 colour;
void main() {{
    float x, y, z, dx, dy, dz, weight;
    {name}_sample(1.0, 2.0, 0.5, 0.25, 550.0, 2.8, x, y, z, dx, dy, dz, weight);
    colour = vec4(dx, dy, dz, weight);
}}
"""
    file = tmp_path / "lens.frag"
    file.write_text(text)
    done = subprocess.run(["glslangValidator", str(file)], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def test_osl_is_straight_and_has_no_name_of_its_globals():
    text = osl.osl_file(aim.with_aim(PLANS["symmetric"]), ["A lens."])
    code = re.sub(r'//.*|"[^"]*"', "", text)
    assert not re.search(r"\b(for|while|pow)\b", code)
    taken = {"P", "I", "N", "Ng", "u", "v", "dPdu", "dPdv", "time", "dtime", "dPdtime", "Ci"}
    declared = re.findall(r"\b(?:float|int|color|vector|point) (\w+)", code)
    assert not taken & set(declared)


def test_horner_and_its_derivative():
    rng = np.random.default_rng(1)
    terms = {e: rng.standard_normal() for e in itertools.product(range(3), range(2), range(4))}
    names = [Name(n) for n in "abc"]
    values = dict(zip("abc", (0.3, -1.2, 0.7), strict=True))
    for place in (None, 0, 1, 2):
        wanted = 0.0
        for e, c in terms.items():
            factors = [v**k for v, k in zip(values.values(), e, strict=True)]
            if place is not None:
                k, v = e[place], list(values.values())[place]
                factors[place] = k * v ** (k - 1) if k else 0.0
            wanted += c * math.prod(factors)
        f = Function("p", ("a", "b", "c"), ("out",))
        used = terms if place is None else derivative(terms, place)
        f.let("out", horner(f, used, names))
        room = {"np": np}
        exec(languages.NumPy().define(f).replace("return out", "return float(out)"), room)
        assert room["p"](**values) == pytest.approx(wanted, rel=1e-12)


@pytest.mark.parametrize("symmetric", [True, False])
def test_the_density_is_the_aims_jacobian(symmetric):
    """Central differences of a rough vector by its second point."""
    rough = made_up(symmetric=symmetric, rough=0.2).aim.slope
    f = Function("v", ("fx", "fy", "ax", "ay", "l"), ("x", "y", "j"))
    fx, fy, ax, ay, wave = (Name(n) for n in f.inputs)
    at = lens_code.coordinates(f, symmetric, (fx, fy), (ax, ay), wave)
    values = (*lens_code.vector(f, rough, at), lens_code.slope_jacobian(f, rough, at))
    for name, value in zip(f.outputs, values, strict=True):
        f.let(name, value)
    room = {"np": np}
    exec(languages.NumPy().define(f), room)
    v, h = room["v"], 1e-5
    point = (0.4, -0.5, 0.3, 0.6, -0.2)
    columns = []
    for k in (2, 3):
        up, down = ([x + s * h * (i == k) for i, x in enumerate(point)] for s in (1, -1))
        columns.append((np.array(v(*up)[:2]) - v(*down)[:2]) / (2 * h))
    assert v(*point)[2] == pytest.approx(np.linalg.det(columns), rel=1e-6)


@plans
def test_numpy_says_what_the_plan_says(plan):
    rays = _rays()
    got = _in_numpy(plan, rays, _samples())[0]
    wanted = np.array([evaluated(plan, r[:2], r[2:4], r[4], r[5]) for r in rays])
    np.testing.assert_allclose(got, wanted, rtol=1e-10, atol=1e-10)
    assert 0.2 < wanted[:, -1].mean() < 0.9  # both fates are seen


@plans
def test_c_equals_numpy(plan, tmp_path):
    rays, samples = _rays(), _samples()
    run = _compiled(languages.c_file(plan, ["A lens."]), "double", tmp_path, "gcc", ".c")
    evaluated_there, drawn_there = _in_numpy(plan, rays, samples)
    np.testing.assert_allclose(run("evaluate", rays, 10), evaluated_there, rtol=0, atol=1e-11)
    np.testing.assert_allclose(run("sample", samples, 7), drawn_there, rtol=0, atol=1e-11)


def test_no_language_has_a_variable_that_nothing_reads():
    plan = made_up(segments=1, rough=0.0005, inner=0.0, symmetric=False)
    text = languages.c_file(plan, [])
    names = re.findall(r"double (\w+) =", text)
    assert len(names) > 20
    assert [name for name in names if len(re.findall(rf"\b{name}\b", text)) < 2] == []


@plans
def test_glsl_equals_numpy(plan, tmp_path):
    """GLSL is compiled as C++: its out parameters as references."""
    source = languages.glsl_file(plan, ["A lens."]).replace("out float ", "float &")
    source = "#include <cmath>\n#include <algorithm>\nusing namespace std;\n" + source
    rays, samples = _rays(), _samples()
    run = _compiled(source, "float", tmp_path, "g++", ".cpp")
    evaluated_there, drawn_there = _in_numpy(plan, rays, samples)
    got = run("evaluate", rays, 10)
    same = got[:, -1] == evaluated_there[:, -1]  # but for rays that graze a rim
    assert same.mean() > 0.99
    np.testing.assert_allclose(got[same], evaluated_there[same], rtol=0, atol=2e-5)
    drawn = run("sample", samples, 7)
    same = (drawn[:, -1] > 0) == (drawn_there[:, -1] > 0)
    assert same.mean() > 0.99
    np.testing.assert_allclose(drawn[same], drawn_there[same], rtol=1e-4, atol=2e-6)


@pytest.mark.parametrize("kind", [{}, {"blades": True}, {"symmetric": False}])
@pytest.mark.parametrize("film", [(0.0, 0.0), (9.0, -7.0)])
def test_the_aim_and_the_whole_pupil_expose_alike(kind, film):
    """Two ways to draw, one integral: the density is that of the aim's slopes."""
    plan = aim.with_aim(made_up(segments=1, rough=0.0005, inner=0.0, **kind))
    assert plan.aim is not None
    assert plan.aim.enlargement < 1.04
    u1, u2 = np.random.default_rng(2).random((2, 40000))
    means = []
    for drawn in (plan, replace(plan, aim=None)):
        weight = aim.callables(drawn)[1](*film, u1, u2, 550.0, 2.8)[-1]
        means.append((weight.mean(), weight.std() / 200))
    (by_aim, e1), (by_pupil, e2) = means
    assert abs(by_aim - by_pupil) < 4 * math.hypot(e1, e2)
    assert e1 < 0.6 * e2
    if film == (0.0, 0.0):
        assert by_aim == pytest.approx(1, abs=0.02)


@pytest.mark.parametrize(
    "name",
    [
        '"""; raise SystemExit(9); """',
        '"""\nraise SystemExit(9)\n"""',
        "\\",
        "\\N{x}",
        'a"',
        "*/ x \\\n y",
    ],
)
def test_no_word_of_a_lens_file_becomes_code(name: str) -> None:
    """Exported code is run by whoever gets it; a lens's name and source are a stranger's."""
    setting = {"zoom_mm": None, "focus_m": None, "source": name, "f_stop": 2.0}
    error = {"direction_rad": (0, 0), "film_um": (0, 0), "transmittance": (0, 0), "rays": 1}
    data = {
        "lens": name, "degree": 3, "setting": setting, "error": {"all": error},
        "film": {"half": (18, 12)}, "symmetry": {"axial": True},
    }  # fmt: skip
    plan, said = replace(PLANS["one segment"], name=name), facts(data)
    assert all(line.isprintable() for line in said)
    room: dict[str, object] = {}
    exec(compile(languages.numpy_file(plan, said), "exported", "exec"), room)
    assert str(room["__doc__"]).startswith(said[0])
    for text in (languages.c_file(plan, said), languages.glsl_file(plan, said)):
        head = text.splitlines()[: len(said)]
        assert all(line.startswith("//") and not line.endswith("\\") for line in head)
