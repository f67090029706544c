"""Calls of the core with numbers, lists and arrays that nobody checked.

``python -m tests.core.hostile BEGIN STEP`` makes cases from one on and writes the number and the
name of each before it is made: what ends the process is named by the last line.
"""

from __future__ import annotations

import faulthandler
import math
import resource
import signal
import sys
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

import daguerre as dg
from daguerre import _core, lenses
from daguerre.setup.core_materials import common_values, kind_name, kind_values

#: Bytes of memory that cases may take, and s of CPU time of one.
ROOM, SECONDS = 3 << 30, 10
STATUS = Path("/proc/self/status")
LENS = "canon-serenar-50mm-f1.8"
Call = tuple[Callable[..., Any], list[Any]]


class Few(int):
    """A number of things to make: no test for billions of them."""


class Share(float):
    """A number of things for each sample, likewise."""


#: Cases that once ended the process, or never ended.
KNOWN = {
    "Glass.table: 1: empty",
    "Prescription.rays: 2: all 0",
    "Prescription.trace: 2: all 0",
    "GhostLens.spots: 2: empty",
    "GhostLens.spots: 3: empty",
    "GhostLens.path: 0: [0]=65536",
    "GhostLens.path of four: 0: [0]=2147483647",
    "GhostLens.path of four: 0: [3]=min",
    "wavelength_nodes: 2: 0",
    "LensFit: 0: symmetry=[0]=not",
    "LensFit: 0: segments=empty",
    "LensFit: 0: mounts=short",
    "LensFit: of nothing",
    "FitFunctions: 0: all -2147483648",
    "Camera.change_lens: 1: None",
    "ChiefRays.rays: 0: all nan",
    "IrisShape.outline: 0: one 1e+30",
    "defocus: 1: all 1e+30",
    "ShutterTime: 1: inf",
    "ShutterTime: 2: empty",
    "motion_blur: 1: all 1e+30",
    "motion_blur: 2: one -1e+30",
    "remap: 3: None",
    "remap_nearest: 0: empty 1",
    "remap_nearest: 4: 65536",
    "pixel_integrals: 3: all -2147483648",
    "Shot: 0: empty 0",
    "Shot: 1: empty 0",
    "expose: 0: low_pass_px=1000000000.0",
    "expose: 0: crosstalk=inf",
    "expose: 0: dark=nan",
    "mean_of_next_colour: 0: empty 1",
    "see: 0: resolution=[0]=0",
    "see: 0: sensor_size_mm=[0]=nan",
    "see_mean: 0: sensor_center_mm=[0]=inf",
    "mean_motion: 0: sensor_size_mm=[0]=1e+308",
    "silhouettes: 0: sensor_center_mm=[1]=nan",
}

F32, F64, I32, U32, U8 = np.float32, np.float64, np.int32, np.uint32, np.uint8
FLOATS = (0.0, -1.0, math.nan, math.inf, -math.inf, 1e308, 1e-320, 1e9, -1e9)
INTS = (0, -1, 1, 7, 1 << 16, (1 << 31) - 1, -(1 << 31))


def variants(value: Any) -> Iterator[tuple[str, Any]]:
    """Values that may stand in the place of one, of a kind that the core takes."""
    if isinstance(value, bool):
        yield "not", not value
    elif isinstance(value, int):
        for n in INTS[:4] if isinstance(value, Few) else INTS:
            yield str(n), n
        yield "min", -(1 << 31)
    elif isinstance(value, float):
        for x in FLOATS[:-2] if isinstance(value, Share) else FLOATS:
            yield str(x), x
    elif isinstance(value, str):
        yield "''", ""
        yield "other", "other"
    elif isinstance(value, np.ndarray):
        yield from _arrays(value)
    elif isinstance(value, dict):
        for key, part in value.items():
            for name, other in variants(part):
                yield f"{key}={name}", {**value, key: other}
    elif isinstance(value, tuple | list):
        yield from _lists(value)


def _lists(value: Any) -> Iterator[tuple[str, Any]]:
    kind = type(value)
    yield "empty", kind()
    yield "short", kind(value[:-1])
    yield "long", kind([*value, *value])
    yield "None", kind([None] * len(value))
    for at in sorted({0, len(value) - 1} & set(range(len(value)))):
        for name, other in variants(value[at]):
            yield f"[{at}]={name}", kind([*value[:at], other, *value[at + 1 :]])


def _arrays(value: Any) -> Iterator[tuple[str, Any]]:
    for axis in range(value.ndim):
        yield f"empty {axis}", value.take([], axis)
        yield f"short {axis}", value.take(range(value.shape[axis] - 1), axis)
        yield f"long {axis}", np.concatenate([value, value], axis)
    if value.dtype.kind == "f":
        numbers: tuple[Any, ...] = (math.nan, math.inf, -math.inf, 0, -1, 1e30, -1e30, 1e-38, 1e5)
    else:
        info = np.iinfo(value.dtype)
        numbers = (0, 1, info.max, info.min, info.max // 2)
    for x in numbers:
        yield f"all {x}", np.full_like(value, x)
        if value.size:
            one = value.copy()
            one.flat[value.size // 2] = x
            yield f"one {x}", one


@cache
def lens() -> Any:
    return lenses.load(LENS)


@cache
def fitted() -> Any:
    """A fit; the core reads it in place, so a case gets its own by its data."""
    from daguerre import polynomial

    return polynomial.fit(lens(), 3, segments=2).to_dict()


def fit() -> Any:
    from daguerre.polynomial.fit_data import from_dict

    return from_dict(fitted())


def made_with(make: Any, use: Any) -> Callable[..., Any]:
    """A record of fields, then what uses it."""
    return lambda fields, *rest: use(make(**fields), *rest)


def changed(make: Any, use: Any) -> Callable[..., Any]:
    """An object whose fields are set, then what uses it."""

    def call(fields: dict[str, Any], *rest: Any) -> Any:
        thing = make()
        for name, value in fields.items():
            setattr(thing, name, value)
        return use(thing, *rest)

    return call


def scene(objects: bool = True) -> Any:
    made = dg.Scene()
    mesh = made.add_mesh([(-1, -1, 0), (1, -1, 0), (0, 1, 0)], [(0, 1, 2)])
    if objects:
        made.add_instance(mesh, dg.Diffuse((0.5, 0.5, 0.5)), np.eye(4), name="thing")
        made.add_light(dg.PointLight((10, 10, 10)), np.eye(4))
    made.set_environment(color=(1, 1, 1))
    return made


def shot(camera: dg.Camera | None = None) -> Any:
    """Scene, camera and settings of the core, of a small picture."""
    one = dg.Session(scene(), camera or dg.Camera(), resolution=(8, 6))
    return one.prepared.core_scene, one.prepared.setup.core, one.light_plan.core


def built(call: Callable[..., Any]) -> Callable[..., Any]:
    """Builds, looks at and draws a scene with what a call adds."""

    def run(*arguments: Any) -> Any:
        builder = _core.SceneBuilder()
        builder.add_material("grey", *GREY)
        builder.add_texture(
            "dots", np.ones((2, 2, 3), F32), False, *["repeat"] * 2, "linear", "linear"
        )
        builder.add_mesh("first", *TRIANGLE, *[None] * 5)
        builder.add_instance("first", 0, 0, np.eye(4))
        call(builder, *arguments)
        return _drawn(builder.build())

    return run


def _drawn(made: Any) -> Any:
    made.first_hit((0, 0, 2), (0, 0, -1))
    _, camera, settings = shot()
    film = _core.Film(_core.FilmLayout(width=8, height=6, catchers=True))
    _core.render(made, camera, film, settings, 0, 2)
    return film.mean_rgb()


TRIANGLE = (
    np.array([(-1, -1, 0), (1, -1, 0), (0, 1, 0)], F32),
    np.array([(0, 1, 2)], U32),
)


def calls() -> Iterator[tuple[str, Call]]:
    """Each function of the core, with arguments that it takes."""
    for part in (
        _small,
        _of_lenses,
        _of_polynomials,
        _of_fits,
        _of_cameras,
        _of_pictures,
        _of_films,
    ):
        yield from part().items()
    yield from _of_profiles().items()
    yield from _of_scenes().items()
    yield from _of_renders().items()


def _small() -> dict[str, Call]:
    c = _core
    times, matrices = np.array([0.0, 1.0]), np.stack([np.eye(4), np.eye(4)])
    motion = c.Motion.keys(times, matrices)
    half = [0.5, 0.5]
    shutter = c.Shutter(0.01, c.OpeningCurve(), "top", 0.001, False, (8, 6))
    return {
        "unpack_meshopt: attributes": (
            c.unpack_meshopt,
            [np.full(64, 0xA0, U8), "ATTRIBUTES", Few(4), Few(4)],
        ),
        "unpack_meshopt: triangles": (
            c.unpack_meshopt,
            [np.full(64, 0xE1, U8), "TRIANGLES", Few(6), Few(2)],
        ),
        "unpack_meshopt: indices": (
            c.unpack_meshopt,
            [np.full(64, 0xD1, U8), "INDICES", Few(6), Few(2)],
        ),
        "Motion.still": (lambda m: c.Motion.still(m).at(0.5), [np.eye(4)]),
        "Motion.keys": (
            lambda *a: c.Motion.keys(*a).many(times),
            [times, matrices, "slerp", (0.0, 0.0, 0.0)],
        ),
        "Motion.spinning": (
            lambda *a: motion.spinning(*a).many(times),
            [(0.0, 1.0, 0.0), 1.0, (0.0, 0.0, 0.0), 0.5],
        ),
        "Motion.over": (lambda *a: motion.over(*a).at(0.5), [0.0, 1.0]),
        "Motion.at": (motion.at, [0.5]),
        "Motion.many": (motion.many, [times]),
        "air_index": (c.air_index, [550.0]),
        "Glass.constant": (lambda *a: c.Glass.constant(*a).index(550.0), [1.5]),
        "Glass.abbe": (lambda *a: c.Glass.abbe(*a).index(550.0), [1.5, 60.0]),
        "Glass.table": (lambda *a: c.Glass.table(*a).index(550.0), [[400.0, 700.0], [1.5, 1.6]]),
        "Glass.sellmeier": (lambda *a: c.Glass.sellmeier(*a).index(550.0), [[1.0], [0.01], 0.0]),
        "Glass.polynomial": (lambda *a: c.Glass.polynomial(*a).index(550.0), [[2.25], [0.0]]),
        "Glass.with_absorption": (
            lambda *a: c.Glass.water().with_absorption(*a).absorption_per_mm(550.0),
            [[400.0, 700.0], [0.1, 0.2]],
        ),
        "Glass.index": (c.Glass.table([400, 500, 600, 700], [1.5] * 4).index, [550.0]),
        "Glass.absorption_per_mm": (
            c.Glass.water().with_absorption([400, 700], [0.1, 0.2]).absorption_per_mm,
            [550.0],
        ),
        "colour_tables": (c.colour_tables, [[400.0, 550.0]]),
        "rgb_from_xyz": (c.rgb_from_xyz, [(0.5, 0.5, 0.5)]),
        "ProjectionModel": (
            lambda *a: c.ProjectionModel(*a).unproject(np.ones((2, 2))),
            ["opencv", [0.1, 0.01, 0.0, 0.0]],
        ),
        "ProjectionModel.project": (c.ProjectionModel("opencv", [0.1]).project, [np.ones((2, 3))]),
        "ProjectionModel.unproject": (c.ProjectionModel("eucm", half).unproject, [np.ones((2, 2))]),
        "OpeningCurve.trapezoid": (c.OpeningCurve.trapezoid, [0.8]),
        "OpeningCurve.points": (
            lambda *a: c.Shutter(0.01, c.OpeningCurve.points(*a), "none", 0.0, True, (8, 6)).moment(
                0, 0, 0.3
            ),
            [np.array([0.0, 0.5, 1.0]), np.array([0.0, 1.0, 0.0])],
        ),
        "Shutter": (
            lambda e, s, t, leaf, size: c.Shutter(e, c.OpeningCurve(), s, t, leaf, size).moment(
                3, 4, 0.5
            ),
            [0.01, "left", 0.001, False, (8, 6)],
        ),
        "Shutter.within": (lambda *a: shutter.within(*a).moment(3, 4, 0.5), [2, 3]),
        "Shutter.moment": (shutter.moment, [3, 4, 0.5]),
    }


def _of_lenses() -> dict[str, Call]:
    c, p = _core, lens().prescription
    origins = np.array([[0, 0, -50.0], [1, 0, -50], [0, 1, -50]])
    ahead, nm = np.tile([0.0, 0, 1], (3, 1)), np.array([480.0, 550, 620])
    stack, iris = c.SensorStack(1.0, 1.5, 1.0, 0.1), c.Iris()
    ghosts = c.GhostLens(p, 60.0, iris, 10.0, stack, 22.0)
    lobe = (0.01, -1.5)
    finish = (0.04, 0.001, lobe)
    scatter = c.LensScatter(finish, finish, 1.0, lobe)
    walks = c.ScatterLens(p, 60.0, iris, 10.0, stack, 22.0, scatter)
    surface: dict[str, Any] = {
        "conic": 0.0,
        "asphere": {4: 1e-6},
        "curvature_x": 0.0,
        "conic_x": 0.0,
        "inner_semi_diameter": 0.0,
        "semi_diameter_after": 0.0,
        "decenter": (0.0, 0.0, 0.0),
        "tilt": (0.0, 0.0, 0.0),
        "coating": "",
        "ripple": (0.0, 0.0, 0),
    }

    def table(fields: dict[str, Any], *numbers: Any) -> Any:
        glass, air = c.Glass.constant(1.5), c.Glass.constant(1.0)
        curvature, thickness, semi, kind = numbers
        first = c.Surface(curvature, thickness, semi, glass, False, kind, **fields)
        rest = [
            c.Surface(-0.02, 5.0, 8.0, air, False, "spherical"),
            c.Surface(0, 40.0, 6.0, air, True, "spherical"),
        ]
        made = c.Prescription("made", [first, *rest], air, "mgf2", 2.0)
        made.rays(origins, ahead, nm, True)
        return made.first_order(550.0).efl

    return {
        "Surface": (table, [surface, 0.02, 5.0, 8.0, "aspheric"]),
        "Prescription.rays": (p.rays, [origins, ahead, nm, True, True, (0, 3)]),
        "Prescription.rays straight": (p.rays, [origins, ahead, nm, False, False]),
        "Prescription.trace": (p.trace, [origins, ahead, nm, 60.0, True]),
        "Prescription.jacobian": (p.jacobian, [(0.0, 0.0, -50.0), (0.0, 0.0, 1.0), 550.0, 60.0]),
        "Prescription.path": (p.path, [origins[:1], ahead[:1], 550.0, True]),
        "Prescription.first_order": (p.first_order, [550.0, "x"]),
        "Prescription.film_position": (p.film_position, [2.0, True]),
        "Prescription.best_focus": (p.best_focus, [4.0, 2.0, False, [(480.0, 1.0), (550.0, 2.0)]]),
        "Prescription.seidel": (p.seidel, [550.0, 10.0, 0.3, -1000.0, 486.0, 656.0]),
        "SensorStack": (c.SensorStack, [1.0, 1.5, 1.0, 0.1]),
        "GhostLens": (
            lambda z, r, d: c.GhostLens(p, z, iris, r, stack, d).spots(
                0.1, (18.0, 12.0), [550.0], [1.0], 64
            ),
            [60.0, 10.0, 22.0],
        ),
        "GhostLens.spots": (
            ghosts.spots,
            [0.1, (18.0, 12.0), [480.0, 550.0], [0.5, 0.5], Few(64), True],
        ),
        "GhostLens.path": (ghosts.path, [(3, 1), (0.0, 1.0, -50.0), (0.0, 0.0, 1.0), 550.0]),
        "GhostLens.path of four": (
            ghosts.path,
            [(3, 1, 5, 2), (0.0, 1.0, -50.0), (0.0, 0.0, 1.0), 550.0],
        ),
        "LensScatter": (c.LensScatter, [finish, finish, 1.0, lobe]),
        "ScatterLens": (
            lambda z, r, d: c.ScatterLens(p, z, iris, r, stack, d, scatter).from_film(
                (1, 1), 1, 550, 16
            ),
            [60.0, 10.0, 22.0],
        ),
        "ScatterLens.from_film": (walks.from_film, [(1.0, 2.0), 1.0, 550.0, Few(16), 3]),
    }


def _of_polynomials() -> dict[str, Call]:
    c, p = _core, lens().prescription
    ray, nm = (0.0, 0.0, 0.0, 0.0), [480.0, 550.0, 620.0]
    surface = c.Surface(0.02, 5.0, 8.0, c.Glass.constant(1.5), False, "spherical")
    system = c.polynomial_of_lens(p, 3, nm, (-1.0, 60.0), None, True, None, ray)
    rays, each = np.zeros((3, 4)), np.array(nm)

    def rebuilt(degree: int, nodes: Any, origin: Any, coefficients: Any) -> Any:
        return c.PolynomialSystem(degree, nodes, origin, coefficients).evaluate(rays, each)

    return {
        "PolynomialSystem": (rebuilt, [3, nm, [ray] * 3, system.coefficients()]),
        "PolynomialSystem.evaluate": (system.evaluate, [rays, each]),
        "PolynomialSystem.jacobian": (system.jacobian, [rays, each]),
        "PolynomialSystem.at": (system.at, [550.0]),
        "PolynomialSystem.truncated": (system.truncated, [2]),
        "PolynomialSystem.after": (
            lambda d, n: c.polynomial_propagation(1.0, d, n, [ray]).after(system),
            [3, nm],
        ),
        "polynomial_propagation": (c.polynomial_propagation, [1.0, 3, nm, [ray] * 3]),
        "polynomial_refraction": (
            lambda *a: c.polynomial_refraction(surface, *a),
            [[1.0] * 3, [1.5] * 3, 3, nm, [ray] * 3],
        ),
        "polynomial_reflection": (
            lambda *a: c.polynomial_reflection(surface, *a),
            [3, nm, [ray] * 3],
        ),
        "polynomial_placement": (
            c.polynomial_placement,
            [(0.1, 0.0, 0.0), (1.0, 0.0, 0.0), True, 3, nm, [ray] * 3],
        ),
        "polynomial_of_lens": (
            lambda *a: c.polynomial_of_lens(p, *a),
            [3, nm, (-1.0, 60.0), (0, 3), True, 0, ray],
        ),
        "wavelength_nodes": (c.wavelength_nodes, [400.0, 700.0, Few(3)]),
    }


def _of_fits() -> dict[str, Call]:
    c, p = _core, lens().prescription
    film, slopes, nm = np.ones((3, 2)), np.full((3, 2), 0.01), np.array([480.0, 550, 620])
    points, ahead = np.tile([0.0, 1, -50], (3, 1)), np.tile([0.0, 0, -1], (3, 1))
    grid = np.random.default_rng(3).uniform(-1, 1, (4, 64, 2))
    many = [20 * grid[0], 0.1 * grid[1], np.linspace(400, 700, 64)]
    request = {
        "film_z_mm": 60.0,
        "film_radius_mm": 22.0,
        "film_half_mm": (18.0, 12.0),
        "degree": 3,
        "segments": Few(2),
        "terms": Few(0),
    }
    fields: dict[str, Any] = {
        "degree": 3,
        "symmetry": (True, True, True),
        "entrance_pupil_z": 20.0,
        "front_z": 0.0,
        "front_curvature": 0.02,
        "iris_radius": 10.0,
        "iris_outer": 1.0,
        "film_center": (0.0, 0.0),
        "film_half": (18.0, 12.0),
        "film_plane": [(0.0, 0.0, 60.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)],
        "segments": fit().segments,
        "mounts": fit().mounts,
    }
    functions = fit().segments[0].direction.x

    def unchecked(made: Any) -> Any:
        return made.evaluate(film, slopes, nm), made.to_film(points, ahead, nm)

    def used(made: Any) -> Any:
        made.check()
        return unchecked(made)

    def with_functions(powers: Any, coefficients: Any) -> Any:
        made, ours = fit(), c.FitFunctions(powers, coefficients)
        parts = made.segments
        parts[0].direction.x = ours
        made.segments = parts
        return unchecked(made)

    return {
        "LensFit.fit": (
            made_with(c.LensFitRequest, lambda r, f: unchecked(c.LensFit.fit(p, f, r))),
            [request, 4.0],
        ),
        "LensFit checked": (changed(fit, used), [fields]),
        "LensFit": (changed(fit, unchecked), [fields]),
        "LensFit: of nothing": (lambda n: [unchecked(c.LensFit()) for _ in range(n)], [Few(1)]),
        "FitFunctions": (with_functions, [functions.powers, functions.coefficients]),
        "LensFit.evaluate": (fit().evaluate, [film, slopes, nm]),
        "LensFit.to_film": (fit().to_film, [points, ahead, nm]),
        "LensFit.describe": (fit().describe, [points, ahead]),
        "LensFit.refitted": (fit().refitted, [*many, many[0].copy(), many[1].copy()]),
        "LensFit.seconds_a_ray": (fit().seconds_a_ray, [film, slopes, nm, Few(1)]),
    }


def _of_cameras() -> dict[str, Call]:
    c, p = _core, lens().prescription
    still, iris = c.Motion.still(np.eye(4)), c.Iris()
    film, u = np.ones((3, 2), F32), np.full((3, 2), 0.3, F32)
    nm = np.array([480, 550, 620], F32)
    settings = {
        "f_stop": 4.0,
        "focus_distance_m": 2.0,
        "half_diagonal_mm": 22.0,
        "film_z_mm": 62.0,
        "tilt_deg": (0.0, 0.0),
        "film_center_mm": (0.0, 0.0),
        "film_half_mm": (0.0, 0.0),
    }
    exact = c.ExactLens(
        p, c.ExactLensSettings(f_stop=4.0, focus_distance_m=2.0, half_diagonal_mm=22.0)
    )
    fitted_settings = {
        "f_stop": 4.0,
        "focus_distance_m": 2.0,
        "half_diagonal_mm": 22.0,
        "fit_degree": 3,
    }
    model = c.ProjectionModel("opencv", [0.1])

    def seen(camera: Any) -> Any:
        chief = camera.chief_rays()
        return (
            camera.rays(film, u, nm),
            chief.rays(film.astype(F64)),
            chief.sees(camera, film.astype(F64)),
            chief.film_points(np.array([[0.0, 1, -5]])),
        )

    def pinhole() -> Any:
        return c.Camera.pinhole(still, 50.0)

    def changing(times: Any, cameras: Any) -> Any:
        camera = pinhole()
        camera.change_lens(times, cameras)
        return seen(camera)

    def setting(*arguments: Any) -> Any:
        camera = c.Camera.exact(still, exact)
        camera.change_setting(*arguments)
        return seen(camera)

    times = np.array([0, 1], F32)
    return {
        "Iris.polygon": (
            lambda *a: seen(c.Camera.thin(still, 50, 10, 2, c.Iris.polygon(*a))),
            [6, 10.0, 0.5],
        ),
        "Iris.image": (
            lambda p: seen(c.Camera.thin(still, 50, 10, 2, c.Iris.image(p))),
            [np.ones((4, 5), F32)],
        ),
        "ExactLens": (
            made_with(
                c.ExactLensSettings, lambda s: seen(c.Camera.exact(still, c.ExactLens(p, s)))
            ),
            [settings],
        ),
        "ExactLens fitted": (
            made_with(
                c.ExactLensSettings, lambda s: seen(c.Camera.exact(still, c.ExactLens(p, s)))
            ),
            [fitted_settings],
        ),
        "ExactLens.with_dirt": (
            lambda *a: exact.with_dirt(*a).generate(film, u, nm),
            [np.ones((4, 5), F32), np.ones((3, 2), F32)],
        ),
        "ExactLens.chief_direction": (exact.chief_direction, [1.0, 2.0]),
        "ExactLens.generate": (exact.generate, [film, u, nm]),
        "ExactLens.time_generate": (exact.time_generate, [film, u, nm, Few(1)]),
        "ThickLens": (
            lambda *a: seen(c.Camera.thick(still, c.ThickLens(p, a[0], iris, *a[1:]))),
            [4.0, 2.0, True, 62.0, (0.0, 0.0)],
        ),
        "Camera.pinhole": (lambda *a: seen(c.Camera.pinhole(still, *a)), [50.0, True]),
        "Camera.thin": (
            lambda a, b, d, e, f: seen(c.Camera.thin(still, a, b, d, iris, e, f)),
            [50.0, 10.0, 2.0, True, (1.0, 2.0)],
        ),
        "Camera.projection": (
            lambda *a: seen(c.Camera.projection(still, model, *a, iris)),
            [(50.0, 50.0), (0.0, 0.0), 10.0, 2.0],
        ),
        "Camera.change_lens": (changing, [times, [pinhole(), pinhole()]]),
        "Camera.change_setting": (setting, [times, np.ones(2, F32), np.zeros((2, 2), F32)]),
        "Camera.rays pinhole": (pinhole().rays, [film, u, nm]),
        "Camera.rays exact": (c.Camera.exact(still, exact).rays, [film, u, nm]),
        "ChiefRays.rays": (c.Camera.exact(still, exact).chief_rays().rays, [film.astype(F64)]),
        "ChiefRays.sees": (
            lambda f: c.Camera.exact(still, exact).chief_rays().sees(pinhole(), f),
            [film.astype(F64)],
        ),
        "ChiefRays.film_points": (
            c.Camera.exact(still, exact).chief_rays().film_points,
            [np.array([[0.0, 1, -5]]), False],
        ),
    }


def _of_pictures() -> dict[str, Call]:
    c = _core
    image, light = np.full((6, 8, 4), 0.5, F32), np.full((6, 8, 3), 0.5, F32)
    plane, flow = np.ones((6, 8), F32), np.ones((6, 8, 2), F32)
    shape = c.IrisShape.outline(np.array([(-1.0, -1), (1, -1), (1, 1), (-1, 1)]))
    shutter = c.ShutterTime(-0.25, 0.25, [0.0, 1.0])
    nodes, exact = np.zeros((4, 4, 2), F32), np.full((1, 1), -1, I32)
    cells = np.zeros((1, 16, 16, 2), F32)
    own = c.SourceMap(nodes, exact, cells, 0)
    words = np.ones((6, 8), U32)
    electrons, pattern = np.ones((2, 3), F32), np.array([[0, 1], [1, 0]], U8)
    fields = {
        "low_pass_px": 0.7,
        "crosstalk": 0.1,
        "prnu": 0.01,
        "dsnu": 0.1,
        "dark": 0.1,
        "hot_share": 0.1,
        "hot_dark": 1.0,
        "full_well": 100.0,
        "read_noise": 1.0,
        "gain": 1.0,
        "black_dn": 4,
        "highest_dn": 255,
    }

    def remapped(nodes: Any, exact: Any, cells: Any, top: Any) -> Any:
        made = c.SourceMap(nodes, exact, cells, top)
        made.displacements(8, 0, 6)
        made.displacements_at(np.array([[3.0, 4]]))
        return c.remap(light, 0, 6, [made], [0, 0, 0], (0, 6), "cubic", True)

    def developed(fields: dict[str, Any], pixels: Any, out: Any) -> Any:
        return c.develop_picture(pixels, out, c.Development(**fields))

    how = {
        "balance": (1.0, 1.0, 1.0),
        "full": (1.0, 1.0, 1.0),
        "luminance": (0.3, 0.6, 0.1),
        "rgb_from_balanced": [1.0, 0, 0, 0, 1, 0, 0, 0, 1],
        "highlights": "blend",
        "tone": [float(x) for x in c.curve_breakpoints()],
        "encode": [float(x) for x in c.curve_breakpoints()],
    }
    return {
        "IrisShape.outline": (
            lambda p: c.defocus(image, plane * 3, c.IrisShape.outline(p), (0, 6)),
            [np.array([(-1.0, -1), (1, -1), (1, 1), (-1, 1)])],
        ),
        "IrisShape.image": (
            lambda p: c.defocus(image, plane * 3, c.IrisShape.image(p), (0, 6)),
            [np.ones((4, 5), F32)],
        ),
        "defocus": (lambda i, r, rows: c.defocus(i, r, shape, rows), [image, plane * 3, (0, 6)]),
        "rounded_blur": (c.rounded_blur, [3.0]),
        "ShutterTime": (
            lambda *a: c.motion_blur(image, flow, flow, plane, 0.1, c.ShutterTime(*a), (0, 6)),
            [-0.25, 0.25, [0.0, 0.5, 1.0]],
        ),
        "motion_blur": (
            lambda i, a, b, n, s, rows: c.motion_blur(i, a, b, n, s, shutter, rows),
            [image, flow, flow.copy(), plane, 0.1, (0, 6)],
        ),
        "grain_pattern": (c.grain_pattern, [0, 0, 8, 6, 1.5, 3, 1]),
        "SourceMap": (remapped, [nodes, exact, cells, 0]),
        "SourceMap.exact": (remapped, [nodes, exact * 0, cells, 0]),
        "SourceMap.displacements": (own.displacements, [8, 0, 6]),
        "SourceMap.displacements_at": (own.displacements_at, [np.array([[3.0, 4], [5, 6]])]),
        "remap": (c.remap, [light, 0, 6, [own], [0, 0, 0], (0, 6), "cubic", True]),
        "remap_nearest": (
            lambda w, f, h, b, e: c.remap_nearest(w, f, h, own, b, e),
            [words, 0, 6, 0, 6],
        ),
        "pixel_integrals": (
            c.pixel_integrals,
            [
                plane,
                np.array([0, 2], I32),
                np.ones((2, 2), F32),
                np.array([0, 2, 4], I32),
                np.ones((3, 2), F32),
            ],
        ),
        "Shot": (lambda e, p: c.expose(light, c.Shot(e, p)), [electrons, pattern]),
        "expose": (
            changed(
                lambda: c.Shot(electrons, pattern),
                lambda s, x: (c.expose(x, s), c.expected_electrons(x, s)),
            ),
            [fields, light],
        ),
        "develop_picture": (developed, [how, light, light.copy()]),
        "develop_picture of a raw": (developed, [how, np.ones((6, 8, 3), np.uint16), light.copy()]),
        "sharpen": (c.sharpen, [light.copy(), (0.3, 0.6, 0.1), 0.5, 1.0]),
        "mean_of_next_colour": (c.mean_of_next_colour, [plane, Few(2)]),
    }


def _of_films() -> dict[str, Call]:
    c = _core
    layout: dict[str, Any] = {
        "width": 8,
        "height": 6,
        "offset_x": 0,
        "offset_y": 0,
        "aovs": True,
        "splats": True,
        "flare": True,
        "halves": True,
        "coverage": True,
        "objects": True,
        "catchers": True,
        "bands": 4,
        "channels": 0,
    }
    plain = {**layout, "objects": False, "coverage": False, "channels": 2}

    def film(fields: dict[str, Any] = layout) -> Any:
        return c.Film(c.FilmLayout(**fields))

    def read(made: Any) -> Any:
        out = [made.mean_rgb(), made.variance_rgb(), made.sample_counts(), made.bad_samples]
        out += [made.coverage(), made.ranked(np.arange(3, dtype=U32), 2), made.catcher_rgb(True)]
        out += [made.state(part).sum() for part in made.state_parts()]
        return [
            *out,
            made.mean_bands(),
            made.splats_rgb(),
            made.flare_rgb(),
            made.half_rgb(True, False),
        ]

    def restored(part: str, words: Any) -> Any:
        made = film()
        made.set_state(part, words)
        return read(made)

    def merged(fields: Any) -> Any:
        made = film()
        made.merge(film(fields))
        return read(made)

    def answering(curves: Any) -> Any:
        made = film(plain)
        made.set_responses(curves)
        return made.mean_channels(), made.catcher_channels(True)

    parts, drawn = film().state_parts(), film()
    _core.render(*shot()[:2], drawn, shot()[2], 0, 2)
    return {
        "Film": (made_with(c.FilmLayout, lambda lay: read(c.Film(lay))), [layout]),
        "Film.pixel_bytes": (made_with(c.FilmLayout, c.Film.pixel_bytes), [layout]),
        "Film of channels": (
            made_with(c.FilmLayout, lambda lay: c.Film(lay).mean_channels()),
            [plain],
        ),
        "Film.set_responses": (answering, [np.ones((2, 401))]),
        "Film.place": (film().place, [2, 3]),
        "Film.merge": (merged, [layout]),
        "Film.ranked": (film().ranked, [np.arange(3, dtype=U32), Few(2)]),
        "Film.relative_variance": (film().relative_variance, [0.1]),
        "Film.aov": (film().aov, [c.FILM_AOVS[0]]),
        "Film.state": (film().state, [parts[0]]),
        **{
            f"Film.set_state {part}": (restored, [part, np.array(film().state(part))])
            for part in parts
        },
        "Film.set_state of objects": (restored, ["objects", np.array(drawn.state("objects"))]),
    }


AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
LAMP = (-1, *AXES)
#: Kind, its values and those of all materials, of a grey one.
GREY = ("diffuse", kind_values(dg.Diffuse()), common_values(dg.Material(), -1))


def profile(*given: Any) -> Any:
    """A light profile of the core, of a cone, a focus and a table."""
    scale, angle, softness, exponent, tint, *table = given or _profile_parts()
    cones, focuses = [(angle, softness)], [(exponent, tint)]
    return _core.LightProfile.make(scale, cones, focuses, [tuple(table)])


def _profile_parts() -> list[Any]:
    theta, phi = np.array([0, 1, 2], F32), np.array([0, 1, 2 * np.float32(np.pi)], F32)
    return [1.0, 1.5, 0.5, 2.0, (0.5, 0.5, 0.5), theta, phi, np.ones((3, 3), F32)]


def _of_profiles() -> dict[str, Call]:
    return {
        "LightProfile.make": (profile, _profile_parts()),
        "LightProfile.factors": (profile().factors, [np.ones((4, 3), F32)]),
    }


def _of_scenes() -> dict[str, Call]:
    c = _core
    positions, triangles = TRIANGLE
    uv, four = np.zeros((3, 2), F32), np.ones((3, 4), F32)
    motion = c.Motion.keys(np.array([0.0, 1.0]), np.stack([np.eye(4)] * 2))
    slot = (0, 0, (1.0, 0.0, 0.0, 0.0, 1.0, 0.0))
    gltf = _surfaces(slot)["gltf"]
    shining = {**GREY[2], "emission": (0.5, 0.5, 0.5), "two_sided_emission": True, "profile": 0}
    for name in ("opacity_texture", "normal_texture", "emission_texture"):
        shining[name] = slot

    def instance(b: Any, *a: Any) -> Any:
        return b.add_instance("more", *a)

    def meshed(b: Any, *a: Any) -> Any:
        return b.add_instance("more", b.add_mesh("more", *a), 0, np.eye(4))

    def made(kind: str) -> Callable[..., Any]:
        def call(b: Any, *a: Any) -> Any:
            b.add_profile(profile())
            return b.add_instance(
                "more",
                b.add_mesh("more", positions, triangles, None, uv, uv, None, None),
                b.add_material("more", kind, *a),
                np.eye(4),
            )

        return call

    def lamp(kind: str) -> Callable[..., Any]:
        def call(b: Any, *a: Any) -> Any:
            b.add_profile(profile())
            return getattr(b, kind)(*a[:-4], a[-4:])

        return call

    def folded(b: Any, times: Any) -> Any:
        for _ in range(2):
            b.add_material("key", *GREY[:2], {**GREY[2], "emission": (1, 1, 1)})
        b.add_instance("more", 0, 1, np.eye(4))
        b.fold_materials(times)

    def folded_lights(b: Any, times: Any) -> Any:
        for _ in range(2):
            b.add_point_light((0, 1, 2), (1, 1, 1), 5, LAMP)
        b.fold_lights(times)

    def textured(b: Any, *a: Any) -> Any:
        b.add_texture("more", *a)
        return made("gltf")(b, {**gltf, "base_color_texture": (1, *slot[1:])}, GREY[2])

    def caught(b: Any, *a: Any) -> Any:
        return b.set_catcher(*a)

    rgb = (0.5, 0.5, 0.5)
    found: dict[str, tuple[Any, list[Any]]] = {
        "add_mesh": (meshed, [positions, triangles, positions, uv, uv, four, four]),
        "add_mesh of steps": (
            meshed,
            [np.stack([positions] * 2), triangles, np.stack([positions] * 2), uv, uv, None, four],
        ),
        "add_texture": (
            textured,
            [np.ones((2, 3, 3), F32), True, "repeat", "clamp", "linear", "linear_mipmap_linear"],
        ),
        "add_texture of bytes": (
            textured,
            [np.ones((2, 3, 4), U8), True, "mirror", "clamp", "nearest", "nearest"],
        ),
        "add_instance": (instance, [0, 0, np.eye(4), [(0.0, 1.0)]]),
        "add_instance moving": (
            lambda b, m, k, s: instance(b, m, k, motion, s),
            [0, 0, [(0.0, 1.0)]],
        ),
        "set_catcher": (caught, [0, True, True, True]),
        **{f"add_material {k}": (made(k), [v, shining]) for k, v in _surfaces(slot).items()},
        "add_material": (lambda b, *a: b.add_material("more", *a), list(GREY)),
        "add_profile": (lambda b, p: b.add_profile(p), [profile()]),
        "add_point_light": (lamp("add_point_light"), [(0.0, 1.0, 2.0), rgb, 5.0, 0, *AXES]),
        "add_spot_light": (
            lambda b, *a: b.add_spot_light(*a),
            [(0.0, 1.0, 2.0), (0.0, -1.0, 0.0), rgb, 0.2, 0.5, 5.0],
        ),
        "add_directional_light": (
            lambda b, *a: b.add_directional_light(*a),
            [(0.0, -1.0, 0.0), rgb, 0.01],
        ),
        "add_sphere_light": (lamp("add_sphere_light"), [(0.0, 1.0, 2.0), 0.2, rgb, 0, *AXES]),
        "set_environment_image": (
            lambda b, *a: b.set_environment_image(*a),
            [np.ones((2, 4, 3), F32), 1.0, np.eye(4)],
        ),
        "set_environment_color": (lambda b, *a: b.set_environment_color(*a), [rgb]),
        "set_interval": (lambda b, *a: b.set_interval(*a), [0.0, 1.0]),
        "fold_materials": (folded, [[0.0, 1.0]]),
        "fold_lights": (folded_lights, [[0.0, 1.0]]),
        "key_environment": (
            lambda b, *a: (b.set_environment_color(rgb), b.key_environment(*a)),
            [[0.0, 1.0], [(rgb, 0.0), (rgb, 1.0)]],
        ),
    }
    return {name: (built(call), arguments) for name, (call, arguments) in found.items()}


def _surfaces(slot: Any) -> dict[str, dict[str, Any]]:
    """Materials of all kinds with all parts, whose textures are one picture."""
    green = dg.Spectrum((400, 700), (0.2, 0.8))
    kinds: tuple[Any, ...] = (
        dg.Diffuse(green, transmittance=(0.1, 0.2, 0.1)),
        dg.Conductor(green, eta=green, k=(3, 2, 2), alpha_v=0.3),
        dg.Dielectric(alpha=0.2, alpha_v=0.4, dispersion=0.02, energy_compensation=True),
        dg.Coated(dg.Conductor(eta=green, k=green), alpha=0.1, thickness=1e-4, absorption=green),
        dg.Mix(0, 0, 0.25),
        dg.Boundary(),
        dg.Gltf(),
    )
    found = {kind_name(kind): kind_values(kind) for kind in kinds}
    return {
        kind: {k: slot if k.endswith("_texture") else v for k, v in values.items()}
        for kind, values in found.items()
    }


def _of_renders() -> dict[str, Call]:
    c = _core
    world, camera, _ = shot()
    groups = np.zeros(1, U32)
    crop = (0, 0, Few(8), Few(6))

    def settings(fields: dict[str, Any]) -> Any:
        made = shot()[2]
        for name, value in fields.items():
            setattr(made, name, value)
        return made

    def film(fields: Any = None) -> Any:
        return c.Film(c.FilmLayout(**(fields or {"width": 8, "height": 6})))

    def drawn(fields: Any, lay: Any, begin: int, end: int) -> Any:
        how = settings(fields)
        how.prepare_light(world, camera)
        return c.render(world, camera, film(lay), how, begin, end)

    def rounded(begin: Any, count: Any, first: Any, last: Any) -> Any:
        part = c.SampleRound(begin, np.array(count, U32), first, last)
        return c.render_round(world, camera, film(), settings({}), part)

    def filtered(kind: str, radius: float) -> Any:
        return c.render(world, camera, film(), settings({"filter": c.Filter(kind, radius)}), 0, 1)

    def plated(pixels: Any, fields: Any) -> Any:
        how = settings({})
        how.set_plate(world, camera, settings(fields), pixels)
        return c.render(world, camera, film(), how, 0, 1)

    fields: dict[str, Any] = {
        "resolution": (8, 6),
        "sensor_size_mm": (36.0, 24.0),
        "sensor_center_mm": (0.0, 0.0),
        "window": (0, 0, 8, 6),
        "hole": (2, 2, 3, 3),
        "seed": 3,
        "threads": Few(1),
        "max_depth": 3,
        "light_paths": (Share(0.5), Share(0.5)),
        "flare": 0.0,
        "flare_order": 2,
        "scatter": 0.0,
        "technique": "both",
        "dispersion": "reproject",
        "strategy": "mis",
        "transparent": True,
        "see_through": True,
    }
    frame = {
        key: fields[key] for key in ("resolution", "sensor_size_mm", "sensor_center_mm", "threads")
    }
    layout = {"width": 8, "height": 6, "offset_x": 0, "offset_y": 0, "splats": True, "bands": 0}
    counts = np.full((6, 8), 2, U32)
    truth = c.see(world, camera, settings({}), crop)
    return {
        "Scene.first_hit": (world.first_hit, [(0.0, 0.0, 5.0), (0.0, 0.0, -1.0)]),
        "render": (drawn, [fields, layout, Few(0), Few(2)]),
        "pilot": (lambda f: c.pilot(world, camera, settings(f)), [frame]),
        "render_round": (rounded, [counts, [[Few(2)] * 8] * 6, 0, c.ROUND_PARTS]),
        "Filter": (filtered, ["gaussian", 1.5]),
        "set_plate": (plated, [np.ones((6, 8, 3), F32), frame]),
        "ray_map": (lambda f, r, w: c.ray_map(camera, settings(f), r, w), [frame, crop, True]),
        "see": (
            lambda f, r: c.see(world, camera, settings(f), r).plane(c.TRUTH_PLANES[0]),
            [frame, crop],
        ),
        "see_mean": (
            lambda f, r, n: c.see_mean(world, camera, settings(f), r, n),
            [frame, crop, Few(2)],
        ),
        "Truth.plane": (truth.plane, [c.TRUTH_PLANES[0]]),
        "Truth.places": (lambda f: truth.places(world, camera, settings(f)), [frame]),
        "mean_motion": (
            lambda f, g, r, n: c.mean_motion(
                world, camera, settings(f), world, camera, settings(g), r, n
            ),
            [frame, dict(frame), crop, Few(2)],
        ),
        "silhouettes": (
            lambda f, r, g, n: c.silhouettes(world, camera, settings(f), r, g, n),
            [frame, crop, groups, Few(1)],
        ),
        "outlines": (
            lambda f, g, n: c.outlines(world, camera, settings(f), g, n),
            [frame, groups, Few(1)],
        ),
    }


def cases() -> Iterator[tuple[str, Callable[[], Any]]]:
    """Each call as it should be, then with one argument of each kind of wrong."""
    for name, (call, arguments) in calls():
        yield name, lambda call=call, given=arguments: call(*given)
        for at, value in enumerate(arguments):
            for what, other in variants(value):
                given = [*arguments[:at], other, *arguments[at + 1 :]]
                yield f"{name}: {at}: {what}", lambda call=call, given=given: call(*given)


def main(begin: int, step: int = 1) -> None:
    """Each ``step``-th case from one on, and all good ones, each after a line with its name.

    A good one that is refused gets another line.
    """
    faulthandler.enable()
    status = STATUS.read_text().splitlines()
    used = next(line for line in status if line.startswith("VmData")).split()[1]
    most = (int(used) << 10) + ROOM
    resource.setrlimit(resource.RLIMIT_DATA, (most, most))
    for number, (name, call) in enumerate(cases()):
        good = ":" not in name
        if number < begin or not (good or number % step == 0 or name in KNOWN):
            continue
        print(number, name, flush=True)
        signal.setitimer(signal.ITIMER_PROF, SECONDS)  # no handler: it ends the process
        try:
            call()
        except Exception as error:  # of any class: a process that lives is all that is asked for
            if good:
                print("REFUSED", name, error, flush=True)
        signal.setitimer(signal.ITIMER_PROF, 0)
    print("END", flush=True)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
