"""Renders held against closed forms, against each other, and against planted faults."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.rendering.session import Session
from tests.support.pictures.statistical import batch_means, differences
from tests.support.scene import scenes

SMALL = (32, 24)

MATERIALS = {
    "diffuse": (dg.Diffuse((1, 1, 1)), 1e-2),
    "mirror": (dg.Conductor((1, 1, 1), 0.0), 1e-2),
    "glass": (dg.Dielectric(1.5), 1e-2),
    "gltf white diffuse": (dg.Gltf(metallic=0.0, roughness=1.0, specular=0.0), 1e-2),
    "gltf mirror": (dg.Gltf(metallic=1.0, roughness=0.0), 1e-2),
    "gltf glass": (
        dg.Gltf(metallic=0.0, roughness=0.0, transmission=1.0, thickness=1.0),
        1e-2,
    ),
    "dispersive glass": (dg.Dielectric(1.5, dispersion=1.0), 2e-2),
}
LOSSY = {
    "rough conductor": dg.Conductor((1, 1, 1), 0.3),
    "rough glass": dg.Dielectric(1.5, 0.3),
    "gltf plastic": dg.Gltf(metallic=0.0, roughness=0.5),
    "gltf metal": dg.Gltf(metallic=1.0, roughness=0.5),
    "gltf frosted": dg.Gltf(metallic=0.0, roughness=0.4, transmission=1.0, thickness=1.0),
    "gltf thin": dg.Gltf(metallic=0.0, roughness=0.2, transmission=1.0),
}


@pytest.mark.parametrize("name", MATERIALS)
def test_lossless_materials_vanish_in_a_furnace(name: str) -> None:
    kind, tolerance = MATERIALS[name]
    scene = scenes.furnace(dg.Material(kind))
    camera = dg.Camera(lens="pinhole", focal_length=40)
    frame = dg.render(scene, camera, resolution=SMALL, spp=256, max_depth=64, filter="box")
    assert frame.rgb.mean(axis=(0, 1)) == pytest.approx([1, 1, 1], abs=tolerance)
    assert np.abs(frame.rgb - 1).mean() < 0.05


@pytest.mark.parametrize("name", LOSSY)
def test_other_materials_never_gain_energy(name: str) -> None:
    scene = scenes.furnace(dg.Material(LOSSY[name]))
    camera = dg.Camera(lens="pinhole", focal_length=40)
    frame = dg.render(scene, camera, resolution=SMALL, spp=256, max_depth=64, filter="box")
    middle = frame.rgb[8:16, 12:20].mean()
    assert 0.5 < middle < 1.01


@pytest.mark.parametrize("filter_name", ["box", "gaussian", "blackman_harris", "mitchell", "tent"])
@pytest.mark.parametrize("lens", ["pinhole", "thin"])
def test_a_white_world_is_one_for_ideal_cameras(lens: str, filter_name: str) -> None:
    camera = dg.Camera(lens=lens, f_stop=None if lens == "pinhole" else 1.4, focus_distance=2)
    frame = dg.render(scenes.furnace(), camera, resolution=SMALL, spp=256, filter=filter_name)
    assert frame.rgb.mean(axis=(0, 1)) == pytest.approx([1, 1, 1], abs=3e-3)
    assert frame.rgb == pytest.approx(np.ones_like(frame.rgb), abs=0.12)


@pytest.mark.parametrize("blades", [0, 3, 5, 6, 9])
def test_exposure_does_not_depend_on_the_blades(blades: int) -> None:
    camera = dg.Camera(lens="thin", f_stop=2, focus_distance=2, blades=blades)
    frame = dg.render(scenes.furnace(), camera, resolution=SMALL, spp=64, filter="box")
    assert frame.rgb.mean() == pytest.approx(1, abs=3e-3)


def test_the_exact_lens_sees_a_white_world_as_one_on_the_axis() -> None:
    camera = dg.Camera(lens="double-gauss-50mm-f2", f_stop=4, focus_distance=math.inf)
    frame = dg.render(scenes.furnace(), camera, resolution=(60, 40), spp=256, filter="box")
    assert frame.rgb[18:22, 28:32].mean(axis=(0, 1))[1] == pytest.approx(1, abs=0.02)
    assert 0.1 < frame.rgb[0, 0, 1] < frame.rgb[20, 30, 1]  # corners are darker, not black
    rotated = frame.rgb[::-1, ::-1]
    assert frame.rgb == pytest.approx(rotated, abs=0.25)


def test_the_picture_is_upright_and_not_mirrored() -> None:
    scene = dg.Scene()
    points, faces = scenes.quad(0.2)
    mesh = scene.add_mesh(points, faces)
    for position, color in (
        ((-0.5, 0.4, -3), (5, 0, 0)),
        ((0.5, 0.4, -3), (0, 5, 0)),
        ((-0.5, -0.4, -3), (0, 0, 5)),
    ):
        transform = np.eye(4)
        transform[:3, 3] = position
        scene.add_instance(mesh, dg.Material(dg.Diffuse((0, 0, 0)), emission=color), transform)
    for lens in ("pinhole", "thin", "double-gauss-50mm-f2"):
        camera = dg.Camera(
            lens=lens, focal_length=None if "double" in lens else 50.0, focus_distance=3.0
        )
        rgb = dg.render(scene, camera, resolution=(48, 32), spp=16).rgb
        top, bottom = rgb[:16].mean(axis=(0,)), rgb[16:].mean(axis=(0,))
        assert top[:24, 0].sum() > 10 * top[24:, 0].sum(), lens
        assert top[24:, 1].sum() > 10 * top[:24, 1].sum(), lens
        assert bottom[:24, 2].sum() > 10 * bottom[24:, 2].sum(), lens
        assert bottom[:, 2].sum() > 10 * top[:, 2].sum(), lens


def _lamp(distance: float, radius: float) -> dg.Scene:
    scene = dg.Scene()
    transform = np.eye(4)
    transform[2, 3] = -distance
    scene.add_light(dg.SphereLight((1000, 1000, 1000), radius), transform)
    return scene


@pytest.mark.parametrize("breathing", [False, True])
def test_circle_of_confusion_follows_the_formula(breathing: bool) -> None:
    f, n, focus, s = 50.0, 2.0, 1.0, 2.0
    camera = dg.Camera(
        lens="thin",
        focal_length=f,
        f_stop=n,
        focus_distance=focus,
        sensor_size=(12, 8),
        focus_breathing=breathing,
    )
    radius = 0.004
    # The diameter's noise is 0.3 % with so many light paths; `auto` takes twenty times as many.
    options = {"resolution": (240, 160), "filter": "box", "light_paths": (4000, 0)}
    rgb = dg.render(_lamp(s, radius), camera, spp=16, **options).rgb[..., 1]
    # Second moment of a uniform disc of diameter c is c^2 / 16 along each axis.
    y, x = np.mgrid[:160, :240] + 0.5
    weight = rgb / rgb.sum()
    variance = (weight * (x - 120) ** 2).sum(), (weight * (y - 80) ** 2).sum()
    image_distance = f * focus * 1e3 / (focus * 1e3 - f) if breathing else f
    expected_mm = f / n * abs(s - focus) / s * image_distance / (focus * 1e3)
    if breathing:  # Source: the thin lens formula of the circle of confusion.
        assert expected_mm == pytest.approx((s - focus) / s * f**2 / (n * (focus * 1e3 - f)))
    lamp_mm = radius / s * image_distance  # the disc is blurred by the lamp's own picture
    for v in variance:
        disc = math.sqrt(16 * v * (12 / 240) ** 2 - 4 * lamp_mm**2)
        assert disc == pytest.approx(expected_mm, rel=0.02)


def test_thin_lens_becomes_a_pinhole_as_it_closes() -> None:
    scene = scenes.lamp_room()
    options = {"resolution": SMALL, "filter": "box"}
    pinhole = batch_means(scene, dg.Camera(lens="pinhole"), 8, 32, **options)
    closed = dg.Camera(lens="thin", aperture_diameter=1e-3, focus_distance=5)
    opened = dg.Camera(lens="thin", aperture_diameter=1500, focus_distance=20)
    assert not differences(pinhole, batch_means(scene, closed, 8, 32, seed=50, **options))
    assert differences(pinhole, batch_means(scene, opened, 8, 32, seed=50, **options))


@pytest.mark.parametrize("strategy", ["light", "bsdf"])
def test_one_strategy_alone_agrees_with_both(strategy: str) -> None:
    scene = scenes.lamp_room()
    camera = dg.Camera(lens="pinhole", focal_length=30)
    options = {"resolution": SMALL, "filter": "box"}
    both = batch_means(scene, camera, 10, 128, **options)
    alone = batch_means(scene, camera, 10, 512, seed=50, strategy=strategy, **options)
    assert not differences(both, alone)
    assert differences(both, alone * 1.02)  # a 2 % error of a density would be seen


def test_reprojected_wavelengths_agree_with_the_hero_alone() -> None:
    """White quads at the edge of a fast lens's field, where lateral colour spreads over pixels."""
    scene = dg.Scene()
    points, faces = scenes.quad(0.05)
    mesh = scene.add_mesh(points, faces)
    for x, y in ((-1.0, 0.6), (-0.8, -0.6), (0.9, 0.5), (0.1, 0.0)):
        transform = np.eye(4)
        transform[:3, 3] = (x, y, -3)
        scene.add_instance(mesh, dg.Material(dg.Diffuse((0, 0, 0)), emission=(3, 3, 3)), transform)
    scene.set_environment(color=(0.1, 0.1, 0.1))
    camera = dg.Camera(lens="double-gauss-50mm-f2", f_stop=2, focus_distance=3)
    for filter_name in ("box", "mitchell"):
        options = {"resolution": (96, 64), "filter": filter_name, "crop": (0, 0, 40, 32)}
        both = batch_means(scene, camera, 12, 16, **options)
        hero = batch_means(scene, camera, 12, 64, seed=50, dispersion="end_secondary", **options)
        assert not differences(both, hero)
        assert differences(both * 1.02, hero)


def prisms() -> dg.Scene:
    """Lit signs behind a clear and a frosted prism of strong dispersion, toward the upper left."""
    scene = dg.Scene()
    scene.set_environment(color=(0.3, 0.3, 0.3))
    points, faces = scenes.quad(0.12)
    lamp = dg.Material(dg.Diffuse((0, 0, 0)), emission=(3, 3, 3))
    sign = scene.add_mesh(points, faces)
    wedge = np.array([(-1, -1, 0), (1, -1, 0), (0, 1, 0)], float)
    depth = np.array((0, 0, 1), float)
    corners = np.concatenate([wedge + depth, wedge - depth]) * 0.35
    sides = [(0, 1, 2), (3, 5, 4), (0, 3, 4), (0, 4, 1), (1, 4, 5), (1, 5, 2), (2, 5, 3), (2, 3, 0)]
    prism = scene.add_mesh(corners, np.array(sides))
    for x, alpha in ((-1.05, 0.0), (-0.45, 0.1)):
        glass = dg.Material(dg.Dielectric(1.7, alpha, dispersion=2.0))
        scene.add_instance(prism, glass, scenes.at(x, 0.4, -3))
        scene.add_instance(sign, lamp, scenes.at(x, 0.9, -4))
    return scene


@pytest.mark.parametrize(
    ("resolution", "crop", "spp"),
    [
        ((96, 64), (0, 0, 48, 40), 16),
        # Here the lens's own colours fall outside of the crop, so the hero is weighed otherwise.
        pytest.param((7680, 5120), (600, 800, 608, 808), 300, marks=pytest.mark.slow),
    ],
)
def test_dispersive_glass_agrees_through_the_exact_lens_with_the_hero_alone(
    resolution: tuple[int, int], crop: tuple[int, int, int, int], spp: int
) -> None:
    """Light that the glass bent is the hero's alone; four heroes share what it reflects."""
    camera = dg.Camera(lens="double-gauss-50mm-f2", f_stop=2, focus_distance=3)
    options = {"resolution": resolution, "filter": "mitchell", "crop": crop}
    both = batch_means(prisms(), camera, 12, spp, **options)
    hero = batch_means(
        prisms(), camera, 12, 2 * spp, seed=50, dispersion="end_secondary", **options
    )
    assert not differences(both, hero)
    assert differences(both * 1.02, hero)


def test_threads_do_not_change_a_bit() -> None:
    scene = scenes.lamp_room()
    for filter_name in ("box", "gaussian", "blackman_harris", "mitchell", "tent"):
        for lens in ("thin", "double-gauss-50mm-f2"):
            camera = dg.Camera(lens=lens, focus_distance=4)
            frames = [
                dg.render(
                    scene,
                    camera,
                    resolution=(40, 30),
                    spp=4,
                    threads=t,
                    filter=filter_name,
                    aovs=True,
                )
                for t in (1, 2, 3, 8)
            ]
            for other in frames[1:]:
                assert np.array_equal(frames[0].rgb, other.rgb)
                assert np.array_equal(frames[0].variance, other.variance)
                for name, values in frames[0].aovs.items():
                    assert np.array_equal(values, other.aovs[name], equal_nan=True), name


@pytest.mark.parametrize("lens", ["thin", "double-gauss-50mm-f2"])
def test_ranges_in_any_order_give_the_bits_of_the_whole(lens: str) -> None:
    scene = scenes.lamp_room()
    camera = dg.Camera(lens=lens, focus_distance=4)
    options = {"resolution": (40, 30), "aovs": True}
    whole = dg.render(scene, camera, spp=12, **options)
    parts = Session(scene, camera, **options)
    for begin, end in ((7, 12), (0, 3), (3, 7)):
        assert parts.draw(begin, end)
    resumed = Session(scene, camera, **options)
    resumed.draw(0, 5)
    continued = Session(scene, camera, **options)
    continued.set_state(resumed.state(), resumed.ranges)
    continued.draw(5, 12)
    for frame in (parts.frame(), continued.frame()):
        assert np.array_equal(frame.rgb, whole.rgb)
        assert np.array_equal(frame.variance, whole.variance)
        assert all(np.array_equal(frame.aovs[k], whole.aovs[k], equal_nan=True) for k in whole.aovs)


def test_crop_is_a_window_of_the_whole() -> None:
    scene, camera = scenes.lamp_room(), dg.Camera(lens="thin", focus_distance=4)
    whole = dg.render(scene, camera, resolution=(40, 30), spp=4)
    part = dg.render(scene, camera, resolution=(40, 30), spp=4, crop=(5, 7, 31, 22))
    assert np.array_equal(part.rgb, whole.rgb[7:22, 5:31])


@pytest.mark.parametrize(
    ("crop", "box"),
    [
        ({"left": 5, "top": 7, "right": 31, "bottom": 22}, (5, 7, 31, 22)),
        ({"right": 31}, (-2, -2, 31, 32)),
        ({"top": 7, "left": 0}, (0, 7, 42, 32)),
        ((None, 7, None, 22), (-2, 7, 42, 22)),
        ({}, (-2, -2, 42, 32)),
    ],
)
def test_edges_of_a_crop(crop: Any, box: tuple[int, ...]) -> None:
    scene, camera = scenes.lamp_room(), dg.Camera(lens="thin", focus_distance=4)
    settings = dg.RenderSettings.of(resolution=(40, 30), crop=crop, overscan=2)
    assert Session(scene, camera, settings=settings).crop == box
    again = dg.RenderSettings.from_json(json.loads(json.dumps(settings.to_json())))
    assert again == settings


@pytest.mark.parametrize(
    ("crop", "message"),
    [
        (
            {"lft": 5},
            "crop: wanted some of left, top, right, bottom, got 'lft' .did you mean 'left'",
        ),
        ({"left": 1.5}, "crop: wanted whole numbers .left, top, right, bottom., got"),
        ((1, 2, 3), "crop: wanted whole numbers"),
        ({"left": 9, "right": 9}, "left < right within 0..40.*got left=9,top=0,right=9,bottom=30"),
        ((0, 0, 40, 31), "top < bottom within 0..30, got left=0,top=0,right=40,bottom=31"),
    ],
)
def test_edges_that_are_no_crop(crop: Any, message: str) -> None:
    with pytest.raises(dg.UsageError, match=message):
        dg.render(scenes.lamp_room(), dg.Camera(), resolution=(40, 30), spp=1, crop=crop)


def test_a_stopped_pass_leaves_no_picture_until_whole_sums_are_back() -> None:
    scene, camera = scenes.lamp_room(), dg.Camera(lens="thin", focus_distance=4)
    session = Session(scene, camera, resolution=(200, 150))
    session.draw(0, 1)
    before, saved = session.frame().rgb, {k: v.copy() for k, v in session.state().items()}
    assert not session.draw(1, 400, progress=lambda fraction: False)
    for use in (session.frame, session.state, lambda: session.draw(1, 2)):
        with pytest.raises(dg.UsageError, match="stopped midway"):
            use()
    assert session.ranges == [(0, 1)]
    session.set_state(saved, session.ranges)
    assert np.array_equal(session.frame().rgb, before)
    assert session.draw(1, 2)


def test_names_of_aovs_are_refused_where_all_or_none_are_wanted() -> None:
    with pytest.raises(dg.UsageError, match=r"aovs: wanted True or False .*, got \['depth'\]"):
        dg.render(dg.Scene(), dg.Camera(), resolution=(4, 4), aovs=["depth"])


def test_aovs_of_a_ball() -> None:
    scene = scenes.furnace(dg.Material(dg.Diffuse((0.2, 0.4, 0.6))))
    frame = dg.render(
        scene, dg.Camera(lens="pinhole"), resolution=(33, 33), spp=16, aovs=True, filter="box"
    )
    aovs = frame.aovs
    assert aovs["depth.Z"][16, 16] == pytest.approx(2, abs=0.02)
    assert [aovs[f"N.{a}"][16, 16] for a in "XYZ"] == pytest.approx([0, 0, 1], abs=0.03)
    assert aovs["P.Z"][16, 16] == pytest.approx(-2, abs=0.02)
    assert [aovs[f"albedo.{a}"][16, 16] for a in "RGB"] == pytest.approx([0.2, 0.4, 0.6], abs=1e-3)
    assert (aovs["object_id"][16, 16], aovs["object_id"][0, 0]) == (1, 0)
    assert (frame.alpha[16, 16], frame.alpha[0, 0]) == (1, 0)


def test_reported_variance_matches_the_spread_of_renders() -> None:
    scene, camera = scenes.lamp_room(), dg.Camera(lens="pinhole")
    frames = [
        dg.render(scene, camera, resolution=(16, 12), spp=16, seed=s, filter="box")
        for s in range(60)
    ]
    spread = np.var([f.rgb for f in frames], axis=0, ddof=1).mean()
    claimed = np.mean([f.variance for f in frames])
    # Stratified points do better than the sample variance of independent ones can know.
    assert 0.2 < spread / claimed < 1.3


def test_point_light_on_a_floor_obeys_photometry() -> None:
    scene = dg.Scene()
    points, faces = scenes.quad(2)
    scene.add_instance(scene.add_mesh(points, faces), dg.Material(dg.Diffuse((0.5, 0.5, 0.5))))
    at = np.eye(4)
    at[2, 3] = 2.0
    scene.add_light(dg.PointLight((100, 100, 100)), at)
    eye = np.eye(4)
    eye[2, 3] = 1.0
    frame = dg.render(
        scene, dg.Camera(transform=eye, lens="pinhole", focal_length=400), resolution=(8, 8), spp=64
    )
    # E = I / d^2 lux, L = reflectance E / pi.
    assert frame.rgb.mean(axis=(0, 1)) == pytest.approx([0.5 * 25 / math.pi] * 3, rel=0.01)


def test_nan_samples_are_counted_with_their_place() -> None:
    scene = dg.Scene()
    scene.set_environment(color=(1e30, 1e30, 1e30))  # beyond what the film can hold
    frame = dg.render(scene, dg.Camera(lens="pinhole"), resolution=(6, 4), spp=2)
    count, places = frame.bad_samples
    assert count == 6 * 4 * 2
    assert places[0] == (0, 0, 0)
    assert np.isfinite(frame.rgb).all()


def test_bad_parameters_are_one_clear_error() -> None:
    scene = scenes.furnace()
    for changes, fragment in (
        ({"lens": "duble-gauss-50mm-f2"}, "double-gauss-50mm-f2"),
        ({"f_stop": 0}, "pinhole"),
        ({"lens": "double-gauss-50mm-f2", "f_stop": 0.5}, "f"),
        ({"lens": "double-gauss-50mm-f2", "focus_distance": 0.01}, "nearest"),
        ({"lens_model": "exakt"}, "exact"),
        ({"sensor_fit": "horizontl"}, "horizontal"),
        ({"focus_on": "Nobody"}, "Nobody"),
        ({"blades": 2}, "blades"),
    ):
        with pytest.raises(dg.DaguerreError, match=fragment):
            dg.render(scene, dg.Camera().with_(**changes), resolution=(4, 4), spp=1)
    with pytest.raises(dg.UsageError, match="focus_distance"):
        dg.Camera().with_(focus_distanse=1)


def test_autofocus_finds_the_subject() -> None:
    scene = scenes.furnace(dg.Material(dg.Diffuse()))
    session = Session(scene, dg.Camera(lens="thin"), resolution=(9, 9))
    assert session.metadata["focus"] == pytest.approx(2, abs=0.02)
    assert any("autofocus" in note for note in session.notes)
    empty = Session(scenes.furnace(), dg.Camera(lens="thin"), resolution=(9, 9))
    assert math.isinf(empty.metadata["focus"])
