"""Reads lamps of Blender as lights, and area lamps as meshes that emit.

A lamp of P watts has a radiant intensity of P / (4 pi) W/sr, whether it is a point or a spot; an
area lamp a radiance of P / (pi A); a sun an irradiance of its strength in W/m2. Lamps with a power
that is not normalized have a radiance of strength / pi, a sun of its strength. A watt is
``LUMENS_PER_WATT`` lumens (``settings.py``).

Source: Blender manual, Light Objects, for the units; factors and falloffs are measured in pictures
by Cycles 5.0 (``tests/blender/test_lights.py`` repeats that).
"""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from daguerre.files.notes import Notes
from daguerre.motion.values import Dynamic, is_dynamic
from daguerre.motion.values import at as value_at
from daguerre.scene.lights import DirectionalLight, PointLight
from daguerre.scene.materials import Diffuse, Material
from daguerre.scene.scene import Scene
from daguerre.scene.transforms import without_scale

from .lamp_motion import MOST, Rigid, Times, times
from .lamp_profiles import spot_profile, spread_profile
from .lamp_shapes import area_in, ellipse, rectangle
from .settings import LUMENS_PER_WATT

if TYPE_CHECKING:
    import bpy

Color = tuple[float, float, float]
Matrix = NDArray[np.float64]
#: Most stops of exposure, either way.
_STOPS = 100.0
_ROUND = ("DISK", "ELLIPSE")
_BLACK = Diffuse((0.0, 0.0, 0.0))
#: Visibility to rays, and how it is said.
_RAYS = {
    "visible_camera": "the camera", "visible_diffuse": "diffuse surfaces",
    "visible_glossy": "glossy surfaces", "visible_transmission": "glass",
    "visible_volume_scatter": "volumes",
}  # fmt: skip


class _Shining(NamedTuple):
    """How an area lamp shines.

    Attributes:
        metres_per_unit: Length of Blender's unit, m.
        glow: :func:`glow_of`, constant or over time.
    """

    metres_per_unit: float
    glow: Color | Dynamic


def add_light(
    scene: Scene,
    matrix: Matrix | Dynamic,
    light: bpy.types.Light,
    name: str,
    notes: Notes,
    *,
    metres_per_unit: float = 1.0,
    glow: Color | Dynamic | None = None,
) -> None:
    """Adds a lamp to a scene.

    Args:
        scene: Receives the light, or the mesh that emits.
        matrix: Scene from lamp, shape (4, 4), y-up, m for each unit of Blender; it may change over
            time.
        light: Evaluated data of the lamp.
        name: Name of the object.
        notes: Receives notes on unsupported content.
        metres_per_unit: Length of Blender's unit, m.
        glow: :func:`glow_of` over time; default: the glow of ``light``.
    """
    world = np.asarray(value_at(matrix, scene.time), np.float64)
    if without_scale(world) is None:
        notes.add("a lamp with a scale of 0 is left out")
        return
    if light.type == "AREA" and getattr(getattr(light, "cycles", None), "is_portal", False):
        notes.add("a portal is left out: it gives no light")
        return
    _note_the_rest(light, notes)
    lit = glow_of(light, notes) if glow is None else glow
    if light.type == "AREA":
        _add_area(scene, matrix, light, name, notes, _Shining(metres_per_unit, lit))
        return
    factor = _factor(light, metres_per_unit)
    placed = without_scale(world) if isinstance(matrix, np.ndarray) else Rigid(matrix)
    scene.add_light(_lamp(light, _scaled(lit, factor), name, world, metres_per_unit, notes), placed)


def glow_of(light: bpy.types.Light, notes: Notes) -> Color:
    """Power of a lamp by colour: energy x colour x temperature x 2^exposure, and its node if any.

    The unit is the unit of the lamp's energy: W, or W/m2 for a sun.
    """
    tint = tuple(light.temperature_color) if light.use_temperature else (1.0, 1.0, 1.0)
    stops = min(max(light.exposure, -_STOPS), _STOPS)
    strength = light.energy * 2.0**stops
    node = _emission_node(light, notes)
    parts = [strength * c * t * n for c, t, n in zip(light.color, tint, node, strict=True)]
    if min(parts) < 0:
        notes.add("a lamp with negative power or colour is black")
    red, green, blue = (min(max(0.0, part), MOST) for part in parts)
    return red, green, blue


def note_visibility(thing: bpy.types.Object, notes: Notes) -> None:
    """Notes which rays of Blender do not see an object of a lamp: ours do.

    A point without a size is never seen, and neither is a sun.
    """
    light = thing.data
    sized = light.type == "AREA" or getattr(light, "shadow_soft_size", 0.0) > 0
    for flag, rays in _RAYS.items():
        unseen = flag == "visible_camera" and (not sized or light.type == "SUN")
        if not unseen and not getattr(thing, flag, True):
            notes.add(f"a lamp hidden from {rays} in Blender is visible in Daguerre")


def _factor(light: bpy.types.Light, metres_per_unit: float) -> float:
    """Candelas, or lux of a sun, for each unit of energy."""
    if light.type == "SUN":
        half = light.angle / 2
        bare = 1.0 if light.normalize or half == 0 else math.pi * math.sin(half) ** 2
        return LUMENS_PER_WATT * bare
    radius = light.shadow_soft_size
    bare = 1 / (4 * math.pi) if light.normalize else (radius**2 if radius > 0 else 1 / math.pi)
    return LUMENS_PER_WATT * bare * metres_per_unit**2


def _lamp(
    light: bpy.types.Light,
    rgb: Any,
    name: str,
    world: Matrix,
    metres_per_unit: float,
    notes: Notes,
) -> DirectionalLight | PointLight:
    if light.type == "SUN":
        return DirectionalLight(rgb, name, angle=math.degrees(light.angle))
    radius = light.shadow_soft_size * metres_per_unit
    if radius > 0 and light.use_soft_falloff:
        notes.add("soft falloff of a lamp is left out: within ten radii it is brighter")
    profile = None
    if light.type == "SPOT":
        lengths = np.linalg.norm(world[:3, :3], axis=0)
        if np.ptp(lengths) > 1e-4 * lengths.max():
            notes.add("the cone of a spot lamp is not stretched by the scale of its object")
        profile = spot_profile(light.spot_size / 2, light.spot_blend)
    return PointLight(rgb, radius=radius, name=name, profile=profile)


def _add_area(
    scene: Scene,
    matrix: Matrix | Dynamic,
    light: bpy.types.Light,
    name: str,
    notes: Notes,
    shining: _Shining,
) -> None:
    width = light.size
    height = light.size_y if light.shape in ("RECTANGLE", "ELLIPSE") else width
    if not width * height > 0:
        notes.add("an area lamp with an area of 0 is left out")
        return
    if light.spread <= 0:
        notes.add("an area lamp with a spread of 0 is left out: no lamp makes parallel rays")
        return
    positions, triangles = (ellipse if light.shape in _ROUND else rectangle)(width, height)
    world = np.asarray(value_at(matrix, scene.time), np.float64)
    size = area_in(world, width, height, light.shape in _ROUND) / shining.metres_per_unit**2
    factor = LUMENS_PER_WATT / math.pi / (size if light.normalize else 1.0)
    material = scene.add_material(
        Material(
            _BLACK,
            name=name,
            emission=_scaled(shining.glow, factor),
            profile=spread_profile(light.spread),
        )
    )
    facing = np.tile(np.array([(0.0, 0.0, -1.0)]), (len(positions), 1))
    mesh = scene.add_mesh(positions, triangles, facing, name=name)
    scene.add_instance(mesh, material, matrix, name=name)


def _has_nodes(light: bpy.types.Light) -> bool:
    """Whether a lamp shines by its nodes; the switch is to go in Blender 6.0, and warns before."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        return getattr(light, "use_nodes", True) and light.node_tree is not None


def _emission_node(light: bpy.types.Light, notes: Notes) -> Color:
    """Factor of the emission node of a lamp; 1 without nodes, or with nodes that are not read."""
    if not _has_nodes(light):
        return 1.0, 1.0, 1.0
    output = next(
        (n for n in light.node_tree.nodes if n.bl_idname == "ShaderNodeOutputLight"), None
    )
    links = output.inputs["Surface"].links if output is not None else ()
    node = links[0].from_node if links else None
    if node is None:
        return 0.0, 0.0, 0.0
    inputs = [node.inputs.get(key) for key in ("Color", "Strength")]
    if node.bl_idname != "ShaderNodeEmission" or any(i is None or i.is_linked for i in inputs):
        linked = [i.links[0].from_node.bl_label for i in inputs if i is not None and i.is_linked]
        notes.add(f"nodes of a lamp are left out: {', '.join(linked) or node.bl_label}")
        return 1.0, 1.0, 1.0
    color, strength = inputs[0].default_value, inputs[1].default_value
    return color[0] * strength, color[1] * strength, color[2] * strength


def _note_the_rest(light: bpy.types.Light, notes: Notes) -> None:
    """Notes settings of a lamp that are left out."""
    if not light.use_shadow:
        notes.add("a lamp without shadows casts shadows")
    factors = ("diffuse_factor", "specular_factor", "transmission_factor", "volume_factor")
    if any(getattr(light, name, 1.0) != 1.0 for name in factors):
        notes.add("a lamp's own factor for a kind of surface is left out")
    if getattr(light, "use_square", False) and light.type == "SPOT":
        notes.add("the square cone of a spot lamp is drawn round")


def _scaled(lit: Any, factor: float) -> Any:
    return Times(lit, factor) if is_dynamic(lit) else times(lit, factor)
