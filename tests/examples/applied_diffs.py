"""Measures a build with the diffs of examples/ applied; prints JSON."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

import daguerre as dg
from daguerre import _core
from daguerre.setup.camera import set_up
from daguerre.setup.scene import build

SIZE = (36, 24)
FOCAL, FOCUS, INDEX = 25.0, 1.5, 1.5168


def singlet(**changes: Any) -> dg.Camera:
    return dg.Camera(lens="singlet", focal_length=FOCAL, f_stop=2, focus_distance=FOCUS).with_(
        **changes
    )


def bundles() -> dict[str, Any]:
    """Where rays of film points come closest, by the tangent of the field angle."""
    core = set_up(dg.Scene(), singlet(), SIZE, None).core
    u = np.random.default_rng(1).random((256, 2), np.float32)
    tangents, found, weights = (0.0, 0.3, 0.6), [], []
    for tangent in tangents:
        film = np.tile(np.array([[FOCAL * tangent, 0]], np.float32), (len(u), 1))
        o, d, w = core.rays(film, u, np.full(len(u), 550, np.float32))
        slope, start = d[:, :2] / -d[:, 2:], o[:, :2]
        # Least squares over the bundle: the depth at which start + depth * slope spreads least.
        ds, do = slope - slope.mean(axis=0), start - start.mean(axis=0)
        found.append(float(-(ds * do).sum() / (ds * ds).sum()))
        weights.append(float(w.mean()))
    chief = core.chief_rays()
    film_mm = np.array([[3.0, -2.0], [15.0, 10.0]])
    back = chief.film_points(chief.rays(film_mm)[1], True)
    wanted = [1 / (1 / FOCUS + t * t / (2e-3 * INDEX * FOCAL)) for t in tangents]
    return {
        "depths": found,
        "wanted": wanted,
        "weights": weights,
        "back": float(abs(back - film_mm).max()),
    }


def lamps() -> dg.Scene:
    """A lamp near a corner, out of focus, before nothing."""
    scene, pose = dg.Scene(), np.eye(4)
    pose[:3, 3] = -0.65, 0.4, -1.25
    scene.add_light(dg.SphereLight(luminance=(900, 700, 400), radius=0.03), pose)
    return scene


def light(camera: dg.Camera, **settings: Any) -> list[float]:
    """Mean of a picture, and where the middle of its light is, px."""
    frame = dg.render(lamps(), camera, resolution=SIZE, max_depth=1, **settings)
    green = frame.rgb[..., 1].astype(np.float64)
    y, x = np.indices(green.shape)
    return [float(green.mean()), *(float((green * k).sum() / green.sum()) for k in (x, y))]


def techniques(camera: dg.Camera) -> list[list[float]]:
    """The same light by camera rays, and by light paths that go through the lens backward."""
    return [
        light(camera, spp=16384, light_paths="off"),
        light(camera, spp=64, light_paths=(20000.0, 0.0)),
    ]


def slope() -> list[float]:
    """Least and largest slope of a roof of 30 degrees, in a picture that it fills."""
    scene, roof = dg.Scene(), np.eye(4)
    c, s = np.cos(np.radians(30)), np.sin(np.radians(30))
    roof[:3, :3] = [[1, 0, 0], [0, c, s], [0, -s, c]]
    roof[2, 3] = -3
    points = np.array([[-9, 0, -9], [9, 0, -9], [9, 0, 9], [-9, 0, 9]], np.float32)
    scene.add_instance(scene.add_mesh(points, np.array([[0, 1, 2], [0, 2, 3]])), transform=roof)
    scene.set_environment(color=(1, 1, 1))
    camera = dg.Camera(np.array([[1, 0, 0, 0], [0, 0, 1, 3], [0, -1, 0, -3], [0, 0, 0, 1.0]]))
    found = dg.render(scene, camera, resolution=SIZE, spp=4, aovs=True).aovs["slope.Z"]
    return [float(found.min()), float(found.max())]


def bright() -> list[float]:
    """Y of bright samples: under dim and bright skies, of a merged film, and of a saved one."""
    found = []
    for luminance in (0.5, 2.0):
        scene = dg.Scene()
        scene.set_environment(color=(luminance,) * 3)
        core = _core.RenderSettings()
        core.resolution, core.sensor_size_mm, core.threads = SIZE, (36.0, 24.0), 1
        layout = _core.FilmLayout(width=SIZE[0], height=SIZE[1], bright=True)
        films = _core.Film(layout), _core.Film(layout), _core.Film(layout)
        camera = set_up(scene, dg.Camera(), SIZE, None).core
        for film, samples in zip(films, ((0, 8), (8, 16), (0, 16)), strict=False):
            _core.render(build(scene), camera, film, core, *samples)
        films[0].merge(films[1])
        found.append(float(films[2].means("bright")[..., 1].mean()))
    again = _core.Film(layout)
    again.set_state("sums", np.array(films[2].state("sums")))
    again.set_state("bright", np.array(films[2].state("bright")))
    return [*found, *(float(film.means("bright")[..., 1].mean()) for film in (films[0], again))]


def albedos() -> list[float]:
    """Light of a rough matte plane under an even sky, seen from 0 and from 60 degrees."""
    found = []
    for degrees in (0, 60):
        scene, pose = dg.Scene(), np.eye(4)
        points = np.array([[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], np.float32)
        matte = dg.Material(dg.Diffuse((0.5, 0.5, 0.5), roughness=0.8))
        scene.add_instance(scene.add_mesh(points, np.array([[0, 1, 2], [0, 2, 3]])), matte)
        scene.set_environment(color=(1, 1, 1))
        c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        pose[:3, :3] = [[c, 0, s], [0, 1, 0], [-s, 0, c]]
        pose[:3, 3] = 2 * pose[:3, 2]
        camera = dg.Camera(pose, lens="pinhole", focal_length=5000)
        found.append(float(dg.render(scene, camera, resolution=(8, 8), spp=1024).rgb.mean()))
    return found


def rough_diffuse_refusal() -> str:
    """Error of a roughness beside a transmittance."""
    scene = dg.Scene()
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
    thin = dg.Material(dg.Diffuse(transmittance=(0.1, 0.1, 0.1), roughness=1))
    scene.add_instance(scene.add_mesh(points, np.array([[0, 1, 2]])), thin)
    try:
        dg.render(scene, dg.Camera(), resolution=SIZE, spp=1)
    except dg.DaguerreError as error:
        return str(error)
    return ""


def refusal() -> str:
    try:
        dg.render(lamps(), singlet(tilt=(3, 0)), resolution=SIZE, spp=1)
    except dg.UsageError as error:
        return str(error)
    return ""


if __name__ == "__main__":
    pull = dg.keys([(-1.0, 0.8), (1.0, 3.0)])
    print(
        json.dumps(
            {
                "bundles": bundles(),
                "still": techniques(singlet()),
                "focusing": techniques(singlet(focus_distance=pull, shutter_time=0.5)),
                "slope": slope(),
                "bright": bright(),
                "albedos": albedos(),
                "rough_diffuse_refusal": rough_diffuse_refusal(),
                "refusal": refusal(),
            }
        )
    )
