"""A small scene with every kind of part that can be packed."""

from __future__ import annotations

import numpy as np

import daguerre as dg
from daguerre.motion.values import Composite
from daguerre.scene.materials import Gltf, TextureSlot


def everything() -> dg.Scene:
    """Meshes, curves, textures, lights, cameras, a sky, a catcher, and motion of most of them."""
    rng = np.random.default_rng(1)
    made = dg.Scene()
    picture = made.add_texture(rng.integers(0, 255, (4, 4, 3)).astype(np.uint8), srgb=True)
    surface = made.add_material(
        dg.Material(Gltf(base_color_texture=TextureSlot(picture), roughness=0.4), "checks")
    )
    grey = made.add_material(dg.Diffuse((0.5, 0.4, 0.3)))
    _surfaces(made, TextureSlot(picture))
    _meshes(made, surface, grey)
    _curves(made, grey, rng)
    _lights(made)
    made.set_environment(rng.random((4, 8, 3)).astype(np.float32), scale=3.0, rotation=20.0)
    eye = dg.keys(
        [(-0.02, dg.look_at((0, 0, 4), (0, 0, 0))), (0.02, dg.look_at((0.2, 0, 4), (0, 0, 0)))]
    )
    curve = [(0.0, 0.0), (0.5, 1.0), (1.0, 0.0)]
    made.add_camera(
        "Main",
        dg.Camera(
            eye, lens="thin", f_stop=1.4, focus_distance=4.0, shutter_time=0.02, shutter_curve=curve
        ),
        alias="eye",
        film_size=(64, 48),
    )
    made.add_camera(
        "Wide", dg.Camera(projection=dg.Projection.of_field("equidistant", (40, 30), 120))
    )
    made.add_camera(
        "Glass",
        dg.Camera(
            lens="double-gauss-50mm-f2",
            sensor="nikon-d5100",
            rolling_shutter=dg.RollingShutter("left", readout_time=0.01),
        ),
    )
    read = dg.sensors.load("nikon-d5100").with_(serial=3)
    lens = dg.lenses.load("double-gauss-50mm-f2")
    made.add_camera("Read", dg.Camera(lens=lens, sensor=read))
    made.note("something is left out (2 uses)")
    return made


def _surfaces(made: dg.Scene, slot: TextureSlot) -> None:
    """Materials of all kinds, with spectra, masks and normal maps."""
    green = dg.Spectrum((400, 550, 700), (0.1, 0.8, 0.2))
    gold = dg.Conductor.of_metal("Au", alpha=0.2, alpha_v=0.4, alpha_texture=slot)
    for kind in (
        dg.Diffuse(green, slot, (0.1, 0.2, 0.3), slot),
        gold,
        dg.Dielectric(green, 0.1, reflection_tint=green, thin=True, energy_compensation=True),
        dg.Coated(gold, absorption=green, thickness=1e-4),
        dg.Coated(dg.Diffuse((0.5, 0.2, 0.1)), alpha=0.2, nonlinear=False),
        dg.Coated(alpha=0.3, energy_compensation=False),
        dg.Conductor(alpha=0.2, distribution="beckmann"),
    ):
        made.add_material(dg.Material(kind, opacity=0.5, opacity_texture=slot, normal_texture=slot))
    made.add_material(dg.Mix(0, 1, 0.25, slot))
    shining = dg.Material(emission=(1, 2, 3), emission_texture=slot, two_sided=False)
    made.add_material(shining)


def _meshes(made: dg.Scene, surface: int, grey: int) -> None:
    square = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
    faces, facing = [[0, 1, 2], [0, 2, 3]], np.tile(np.float32([0, 0, 1]), (4, 1))
    wall = made.add_mesh(square, faces, facing, (square[:, :2] + 1) / 2, name="wall")
    back = np.eye(4)
    back[:3, 3] = (0.3, 0.2, -1)
    made.add_instances(
        wall, surface, np.stack([back, back @ np.diag([0.5, 0.5, 0.5, 1])]), name="walls"
    )
    bend = square + np.where(square[:, :1] > 0, (0, 0, 0.2), 0)
    steps = ([-0.01, 0.0, 0.02], np.stack([square, square * 0.9, bend]))
    cloth = made.add_mesh(square * 0.9, faces, facing, steps=steps, name="cloth")
    small = np.diag([0.3, 0.3, 0.3, 1.0])
    made.add_node(
        "cloth", np.array([1.0, 2.0, 3.0]), motion=dg.keys([(0, (1, 2, 3)), (1, (2, 2, 3))])
    )
    made.add_instance(
        cloth, grey, dg.keys([(-0.01, small), (0.01, small + 0.1 * np.eye(4, k=3))]), name="cloth"
    )
    made.add_instance(wall, grey, dg.spin((0, 0, 1), 2.0), name="fan", shown=False)
    made.add_instance(
        wall, grey, np.eye(4), name="blinks", shown=dg.keys([(0.0, True), (0.01, False)])
    )
    made.add_instance(
        wall,
        grey,
        [[3, 0, 0, 0], [0, 3, 0, 0], [0, 0, 1, -2], [0, 0, 0, 1]],
        name="floor",
    )
    made.set_catcher("floor", "shadow")
    made.add_node("group", np.zeros(3))
    made.group_instances("group", [0, 2])


def _curves(made: dg.Scene, grey: int, rng: np.random.Generator) -> None:
    counts = [5, 7]
    points = rng.normal((0, 0, 1), 0.4, (12, 3))
    for basis, wrap in (
        ("bspline", "pinned"),
        ("bspline", "periodic"),
        ("catmull-rom", "pinned"),
        ("linear", "nonperiodic"),
        ("linear", "periodic"),
    ):
        for colors in (None, rng.random((12, 3)), rng.random((2, 4))):
            mesh = made.add_curves(
                points,
                counts,
                rng.random(12) * 0.02,
                basis=basis,
                wrap=wrap,
                colors=colors,
                uv=rng.random((2, 2)),
                name=f"{basis} {wrap}",
            )
            made.add_instance(mesh, grey, name="hair")
    steps = ([-0.01, 0.0, 0.01], np.stack([points - 0.1, points, points + 0.1]))
    moving = made.add_curves(
        points, counts, 0.02, basis="catmull-rom", wrap="pinned", steps=steps, name="fur"
    )
    made.add_instance(moving, grey, name="fur")


def _lights(made: dg.Scene) -> None:
    place, other = np.eye(4), np.eye(4)
    place[:3, 3], other[:3, 3] = (0, 3, 3), (1, 3, 3)
    lamp = dg.PointLight(
        (90.0, 80.0, 70.0), radius=0.1, name="lamp", profile=dg.LightProfile.cone(60, 0.2)
    )
    made.add_light(lamp, place)
    made.motion.lights[0] = Composite((lamp, dg.keys([(-0.01, place), (0.01, other)])))
    made.add_light(dg.SpotLight((50.0, 50.0, 50.0), 10, 30, name="spot"), other)
    made.add_light(dg.DirectionalLight((3.0, 3.0, 3.0), angle=0.53), np.eye(4))
    made.add_light(dg.SphereLight((5.0, 5.0, 5.0), 0.2, "ball"), place)
