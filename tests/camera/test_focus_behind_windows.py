"""Autofocus behind clear glass that fills the picture: the apparent distance, by refraction."""

from __future__ import annotations

import math

import pytest

import daguerre as dg
from daguerre.rendering.session import Session
from daguerre.viewfinder.sight import distance_at
from tests.support.scene.scenes import at, quad, sphere

GLASS, WATER = 1.5, 1.333
WALL_M = 5.0
SIZE = (36, 24)
CAMERA = dg.Camera(focal_length=35, f_stop=4)


def with_wall(*, wall: bool = True) -> dg.Scene:
    """A scene with a wall 5 m before the camera, or with a surface behind it alone."""
    scene = dg.Scene()
    scene.add_instance(scene.add_mesh(*quad(8.0)), dg.Diffuse(), at(0, 0, -WALL_M if wall else 9))
    return scene


def add_ball(scene: dg.Scene, material: object, z: float, radius: float) -> None:
    points, faces, normals = sphere(96)
    mesh = scene.add_mesh(points * radius, faces, normals)
    scene.add_instance(mesh, material, at(0, 0, z))


def add_slab(scene: dg.Scene, material: object, near: float, far: float, half: float = 4.0) -> None:
    """A slab from ``near`` to ``far`` before the camera, by its eight corners."""
    points = [(x, y, -z) for z in (far, near) for y in (-half, half) for x in (-half, half)]
    faces = (
        *((0, 3, 1), (0, 2, 3), (4, 7, 6), (4, 5, 7), (0, 5, 4), (0, 1, 5)),
        *((2, 7, 3), (2, 6, 7), (0, 6, 2), (0, 4, 6), (1, 7, 5), (1, 3, 7)),
    )
    scene.add_instance(scene.add_mesh(points, faces), material)


def focus(scene: dg.Scene, camera: dg.Camera = CAMERA) -> float:
    """Distance that autofocus chooses and that a click of the viewfinder finds, which agree, m."""
    session = Session(scene, camera, resolution=SIZE, spp=1)
    chosen = session.focused_camera.focus_distance
    assert chosen is not None
    assert distance_at(session, SIZE[0] / 2, SIZE[1] / 2) == pytest.approx(chosen, rel=1e-4)
    return chosen


def test_a_thick_window_brings_the_subject_nearer() -> None:
    scene = with_wall()
    add_slab(scene, dg.Dielectric(GLASS), 1.0, 2.2)
    assert focus(scene) == pytest.approx(WALL_M - 1.2 * (1 - 1 / GLASS), rel=1e-3)


def test_two_windows_add() -> None:
    scene = with_wall()
    add_slab(scene, dg.Dielectric(GLASS), 1.0, 2.2)
    add_slab(scene, dg.Dielectric(WATER), 3.0, 4.0)
    expected = WALL_M - 1.2 * (1 - 1 / GLASS) - (1 - 1 / WATER)
    assert focus(scene) == pytest.approx(expected, rel=1e-3)


def test_water_behind_a_pane() -> None:
    """A wall in a tank: each length counts by its index."""
    scene = with_wall()
    add_slab(scene, dg.Material(dg.Dielectric(GLASS), nesting=1), 1.0, 1.5, half=8)
    add_slab(scene, dg.Dielectric(WATER), 1.4, 7.0, half=7)
    expected = 1 + 0.5 / GLASS + (WALL_M - 1.5) / WATER
    assert focus(scene) == pytest.approx(expected, rel=1e-3)


def test_a_dome_brings_the_subject_near() -> None:
    """A camera in the middle of a bubble in water."""
    scene = with_wall()
    add_ball(scene, dg.Dielectric(WATER), 0, 30.0)
    add_ball(scene, dg.Dielectric(1.0), 0, 0.1)
    vergence = (WATER - 1) / 0.1 + WATER / (WALL_M - 0.1)
    assert focus(scene) == pytest.approx(0.1 + 1 / vergence, rel=0.02)


def test_a_thin_pane_changes_nothing() -> None:
    scene = with_wall()
    scene.add_instance(scene.add_mesh(*quad(2.0)), dg.Dielectric(GLASS, thin=True), at(0, 0, -1))
    assert focus(scene) == pytest.approx(WALL_M, rel=1e-3)


def test_nothing_behind_a_window_is_infinity() -> None:
    scene = with_wall(wall=False)
    add_slab(scene, dg.Dielectric(GLASS), 1.0, 2.2)
    assert focus(scene) == math.inf


def test_glass_in_the_picture_is_the_subject() -> None:
    scene = with_wall()
    add_ball(scene, dg.Dielectric(GLASS), -2.0, 0.2)
    assert focus(scene) == pytest.approx(1.8, rel=1e-3)


def test_glass_behind_a_window_is_the_subject() -> None:
    scene = with_wall()
    add_slab(scene, dg.Dielectric(GLASS), 1.0, 2.2)
    add_ball(scene, dg.Dielectric(GLASS), -4.0, 0.2)
    assert focus(scene) == pytest.approx(3.8 - 1.2 * (1 - 1 / GLASS), rel=1e-3)


def test_frosted_glass_is_the_subject() -> None:
    scene = with_wall()
    add_slab(scene, dg.Dielectric(GLASS, alpha=0.3), 1.0, 2.2)
    assert focus(scene) == pytest.approx(1.0, rel=1e-3)


def test_a_ball_lens_forms_no_virtual_image() -> None:
    """Glass that fills the picture, but behind which light converges."""
    scene = with_wall()
    add_ball(scene, dg.Dielectric(GLASS), -0.6, 0.5)
    assert focus(scene, dg.Camera(focal_length=85, f_stop=4)) == pytest.approx(0.1, rel=1e-2)


def test_a_note_gives_both_distances() -> None:
    scene = with_wall()
    add_slab(scene, dg.Dielectric(GLASS), 1.0, 2.2)
    notes = Session(scene, CAMERA, resolution=SIZE, spp=1).notes
    told = "autofocus: centre ray meets a surface 5 m away behind clear glass, which appears 4."
    assert any(note.startswith(told) for note in notes)


def test_a_window_far_from_the_origin() -> None:
    """The steps of the derivatives are larger than what positions lose there."""
    scene = dg.Scene()
    square, pane = scene.add_mesh(*quad(8.0)), dg.Dielectric(GLASS, thin=True)
    scene.add_instance(square, dg.Diffuse(), at(400, 300, -200 - WALL_M))
    scene.add_instance(square, pane, at(400, 300, -201))
    camera = CAMERA.with_(transform=at(400, 300, -200))
    assert focus(scene, camera) == pytest.approx(WALL_M, rel=0.01)
