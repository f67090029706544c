"""A described scene, built for Daguerre."""

from __future__ import annotations

import math

import numpy as np

import daguerre as dg

from .description import Array, Description, Lamp, Surface

SKY_SIZE = (1024, 512)


def grey(value: float) -> tuple[float, float, float]:
    """One value three times."""
    return (value, value, value)


def material(surface: Surface) -> dg.Material:
    """The material of a surface."""
    if surface.kind == "diffuse":
        return dg.Material(dg.Diffuse(grey(surface.value)))
    if surface.kind == "conductor":
        return dg.Material(dg.Conductor(grey(surface.value), surface.alpha))
    if surface.kind == "dielectric":
        return dg.Material(dg.Dielectric(surface.value, surface.alpha))
    return dg.Material(dg.Diffuse(grey(0)), emission=grey(surface.value))


def light(lamp: Lamp) -> tuple[dg.scene.Light, Array]:
    """The light of a lamp, and its transform: it shines along its -z."""
    d = np.array(lamp.direction, float)
    x = np.cross((0.3, 0.5, 0.8), d)
    x /= np.linalg.norm(x)
    transform = np.eye(4)
    transform[:3, :] = np.stack([x, np.cross(-d, x), -d, lamp.position], axis=1)
    strength = grey(lamp.strength)
    lights: dict[str, dg.scene.Light] = {
        "point": dg.PointLight(strength),
        "spot": dg.SpotLight(strength, lamp.inner, lamp.outer),
        "directional": dg.DirectionalLight(strength),
        "sphere": dg.SphereLight(strength, lamp.radius),
    }
    return lights[lamp.kind], transform


def sky_directions() -> Array:
    """Directions of the pixels of an environment picture, (H, W, 3).

    Row 0 at the zenith, centre column along -z, +x to the right, as seen from inside.
    """
    width, height = SKY_SIZE
    theta, phi = np.meshgrid(
        (np.arange(height) + 0.5) / height * math.pi,
        ((np.arange(width) + 0.5) / width - 0.5) * 2 * math.pi,
        indexing="ij",
    )
    return np.stack(
        [np.sin(theta) * np.sin(phi), np.cos(theta), -np.sin(theta) * np.cos(phi)], axis=-1
    )


def build(description: Description) -> dg.Scene:
    """Daguerre's scene."""
    scene = dg.Scene()
    for (vertices, faces), surface in description.parts:
        scene.add_instance(scene.add_mesh(vertices, faces), material(surface))
    for lamp in description.lamps:
        scene.add_light(*light(lamp))
    if callable(description.sky):
        picture = description.sky(sky_directions())
        scene.set_environment(np.repeat(picture[..., None], 3, axis=-1))
    elif description.sky > 0:
        scene.set_environment(color=grey(description.sky))
    return scene


def camera(description: Description) -> dg.Camera:
    """Daguerre's camera."""
    view = description.view
    ideal = dg.Camera(transform=view.world_from_camera(), focal_length=view.focal_length)
    if view.aperture is None:
        return ideal.with_(lens="pinhole")
    return ideal.with_(lens="thin", aperture_diameter=view.aperture, focus_distance=view.focus)
