"""Facts of a camera and a scene for photographers, without rendering.

Depth of field and hyperfocal distance: S. F. Ray, Applied Photographic Optics, 3rd ed., ch. 22,
for a thin lens of focal length f, f-stop N and circle of confusion c (f, c in the same unit):
H = f^2 / (N c) + f;  near = s (H - f) / (H + s - 2 f);  far = s (H - f) / (H - s).
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from daguerre.camera.ideal import WITHOUT_IRIS
from daguerre.checks import DEFAULT_RESOLUTION
from daguerre.motion.subdivision import some_breaks
from daguerre.scene.framing import bounds
from daguerre.scene.parts import Curves

from .contents import contents

if TYPE_CHECKING:
    from daguerre.camera.camera import Camera
    from daguerre.scene.materials import Material
    from daguerre.scene.parts import Instance
    from daguerre.scene.scene import Scene

    from .resolved import ResolvedCamera

#: A blur of 1/1500 of the diagonal is the classical limit of "sharp" (Ray, ch. 22).
COC_PER_DIAGONAL = 1 / 1500


@dataclass(frozen=True)
class Facts:
    """Numbers of a camera; None: unknown or meaningless.

    Attributes:
        lens: Name of the lens, or thin, or pinhole.
        focal_length_mm: Focal length at infinity focus.
        f_stop: F-stop; None for a pinhole.
        t_stop: F-stop of a lossless lens of the same brightness; None without glass.
        zoom_mm: Focal length that a zoom lens is set to.
        zoom_range_mm: Shortest and longest focal length of a zoom.
        squeeze: Factor by which an anamorphic lens narrows the picture; else 1.
        tilt_deg: Tilt of the lens about x, then y.
        decentered: Number of elements off the axis.
        sensor_mm: Width and height of the sensor.
        picture_mm: Width and height of the part of the sensor that the picture covers.
        field_of_view_deg: Field of view of the sensor: horizontal, vertical, diagonal.
        picture_field_of_view_deg: Field of view of the picture: horizontal, vertical, diagonal.
        focus_m: Distance of the plane of focus from the entrance pupil; inf: infinity.
        notes: How the focus was found, and other decisions.
        coc_mm: Diameter of the circle of confusion that still counts as sharp.
        hyperfocal_m: Hyperfocal distance: focused there, everything from half of it to infinity is
            sharp.
        near_m: Near limit of the depth of field.
        far_m: Far limit of the depth of field.
        pixel_pitch_um: Pixel pitch of the picture.
        pupil_diameter_mm: Diameter of the entrance pupil.
        shutter_s: Exposure time of a point of the film.
        shutter: Description of the shutter.
        exposure: Description of the exposure.
        ev100: Exposure value log2(N^2 / t) - log2(ISO / 100), ISO 2720.
        near_clip_m: Distance of the near clipping plane; 0: nothing is clipped.
    """

    lens: str
    focal_length_mm: float
    f_stop: float | None
    t_stop: float | None
    zoom_mm: float | None
    zoom_range_mm: tuple[float, float] | None
    squeeze: float
    tilt_deg: tuple[float, float]
    decentered: int
    sensor_mm: tuple[float, float]
    picture_mm: tuple[float, float]
    field_of_view_deg: tuple[float, float, float]
    picture_field_of_view_deg: tuple[float, float, float]
    focus_m: float
    notes: list[str]
    coc_mm: float
    hyperfocal_m: float | None
    near_m: float | None
    far_m: float | None
    pixel_pitch_um: float
    pupil_diameter_mm: float | None
    shutter_s: float
    shutter: str
    exposure: str
    ev100: float | None
    near_clip_m: float


def camera_facts(
    camera: Camera,
    scene: Scene,
    core_scene: Any = None,
    resolution: tuple[int, int] = DEFAULT_RESOLUTION,
) -> Facts:
    """Returns the numbers of a camera, resolved as for a render.

    Args:
        camera: The camera.
        scene: Scene, for ``focus_on``.
        core_scene: Built scene, for autofocus; see :func:`needs_autofocus`.
        resolution: Width and height of the picture, px.
    """
    from daguerre.setup.camera import set_up

    return facts_of(set_up(scene, camera, resolution, core_scene), camera, scene.time, resolution)


def facts_of(
    setup: ResolvedCamera, camera: Camera, time: float, resolution: tuple[int, int]
) -> Facts:
    """Returns the numbers of a camera that is set up for the core.

    Args:
        setup: The camera as it was resolved.
        camera: The camera as it was given.
        time: Scene time, s.
        resolution: Width and height of the picture, px.
    """
    from daguerre.camera.exposure import describe_exposure
    from daguerre.camera.shutter import describe, shutter_time

    camera = camera.evaluated_at(time)
    lens, glass = setup.lens, setup.lens.glass
    focal, stop, squeeze = float(lens.focal_length_mm), lens.f_stop, lens.squeeze
    focus = math.inf if lens.focus_distance_m is None else float(lens.focus_distance_m)
    coc = math.hypot(*camera.sensor_size) * COC_PER_DIAGONAL
    hyperfocal = near = far = None
    if stop is not None:
        hyperfocal = hyperfocal_m(focal, stop, coc)
        near, far = depth_of_field_m(focal, stop, coc, focus)
    shutter = shutter_time(camera)
    ev100 = None
    if stop is not None and shutter > 0:
        ev100 = math.log2(stop**2 / shutter) - math.log2(camera.iso / 100)
    full = field_of_view_deg(lens.pinhole_focal_length_mm, camera.sensor_size, squeeze)
    shown = field_of_view_deg(lens.pinhole_focal_length_mm, setup.frame_size_mm, squeeze)
    projection = camera.frozen_at(time).projection
    if projection is not None:
        full = shown = projection.field_of_view()
    return Facts(
        lens.name,
        focal,
        stop,
        lens.t_stop,
        glass.lens.zoom_mm if glass else None,
        glass.lens.zoom_range_mm if glass else None,
        squeeze,
        setup.camera.tilt,
        len(setup.camera.decenter),
        camera.sensor_size,
        setup.frame_size_mm,
        full,
        shown,
        focus,
        [*setup.notes],
        coc,
        hyperfocal,
        near,
        far,
        setup.frame_size_mm[0] / resolution[0] * 1000,
        None if stop is None else focal / stop,
        shutter,
        describe(camera, resolution),
        describe_exposure(camera, stop, shutter),
        ev100,
        setup.camera.near_clip,
    )


def needs_autofocus(camera: Camera) -> bool:
    """Whether the focus distance has to be measured in the scene."""
    if camera.lens in WITHOUT_IRIS or camera.lens_model in WITHOUT_IRIS:
        return False
    return camera.focus_distance is None or camera.focus_at is not None


def hyperfocal_m(focal_mm: float, f_stop: float, coc_mm: float) -> float:
    """H = f^2 / (N c) + f, m."""
    return (focal_mm**2 / (f_stop * coc_mm) + focal_mm) / 1000


def depth_of_field_m(
    focal_mm: float, f_stop: float, coc_mm: float, focus_m: float
) -> tuple[float, float]:
    """Near and far limit of the depth of field, m, for a focus distance from the lens, m."""
    hyper = hyperfocal_m(focal_mm, f_stop, coc_mm)
    f, s = focal_mm / 1000, focus_m
    if math.isinf(s):
        return hyper - f, math.inf
    near = s * (hyper - f) / (hyper + s - 2 * f)
    far = s * (hyper - f) / (hyper - s) if s < hyper else math.inf
    return near, far


def field_of_view_deg(
    focal_mm: float, size_mm: tuple[float, float], squeeze: float = 1.0
) -> tuple[float, float, float]:
    """Full angles, 2 atan(d / 2 f): horizontal, vertical, diagonal.

    ``focal_mm`` is the film distance of the pinhole with the same framing; the horizontal field of
    an anamorphic lens is wider by its squeeze.
    """
    width, height = size_mm[0] * squeeze, size_mm[1]
    sides = (width, height, math.hypot(width, height))
    h, v, d = (math.degrees(2 * math.atan(side / (2 * focal_mm))) for side in sides)
    return h, v, d


def camera_warnings(camera: Camera) -> list[str]:
    """Warnings about values that are probably in the wrong unit."""
    found = []
    focal, width = camera.focal_length, camera.sensor_size[0]
    if focal is not None and not 1 <= focal <= 2000:
        found.append(
            f"the camera has a focal length of {_mm(focal)}, outside 1 mm .. 2 m: check the "
            "units of the file"
        )
    if not 0.5 <= width <= 200:
        found.append(
            f"the camera has a sensor {_mm(width)} wide, outside 0.5 .. 200 mm: check the "
            "units of the file"
        )
    return found


def scene_facts(scene: Scene) -> dict[str, Any]:
    """Counts the parts of a scene."""
    triangles = [len(mesh.indices) for mesh in scene.meshes]
    corners = bounds(scene)
    environment = scene.environment
    light = None
    if environment is not None:
        image = environment.image
        light = "even sky" if image is None else f"panorama {image.shape[1]} x {image.shape[0]}"
    return {
        "file": str(scene.path) if scene.path else None,
        "meshes": len(scene.meshes),
        "triangles": sum(triangles),
        "curves": sum(len(mesh.ends) for mesh in scene.meshes if isinstance(mesh, Curves)),
        "instances": len(scene.instances),
        "triangles_placed": sum(triangles[i.mesh] for i in scene.instances),
        "bounds_m": [None, None] if corners is None else [c.tolist() for c in corners],
        "materials": len(scene.materials),
        "textures": [
            {
                "name": texture.name,
                "width": int(texture.pixels.shape[1]),
                "height": int(texture.pixels.shape[0]),
                "channels": int(texture.pixels.shape[2]),
            }
            for texture in scene.textures
        ],
        "lights": dict(Counter(type(light).__name__ for light, _ in scene.lights)),
        "emissive_instances": sum(_emits(scene, i) for i in scene.instances),
        "environment": light,
        "time_s": scene.time,
        "animation_duration_s": scene.duration,
        "moves": _moves(scene),
        "variants": list(scene.variants),
        "warnings": list(scene.warnings),
        **contents(scene),
    }


def _moves(scene: Scene) -> dict[str, Any]:
    """Counts the parts that change over time, by kind, and lists the parameters of cameras."""
    motion = scene.motion
    counts = {
        "instances": len(motion.instances),
        "shown": len(motion.shown),
        "meshes": len(motion.meshes),
        "materials": len(motion.materials),
        "lights": len(motion.lights),
        "environment": int(motion.environment is not None),
    }
    cameras = {name: list(c.motion) for name, c in scene.cameras.items() if c.motion}
    found: dict[str, Any] = {name: count for name, count in counts.items() if count}
    return found | ({"cameras": cameras} if cameras else {})


#: Warning about a scene that is not lit.
UNLIT = "the scene has no lights, so the picture will be black; add one or use --env"


def lit(scene: Scene) -> bool:
    """Whether the scene has any light, at any time."""
    return bool(scene.lights or scene.environment or any(_emits(scene, i) for i in scene.instances))


def _emits(scene: Scene, instance: Instance) -> bool:
    over_time = scene.motion.materials.get(instance.material)
    if over_time is not None:
        times = [scene.time, *some_breaks(over_time, -math.inf, math.inf, 64)]
        return any(_shines(over_time.at(t)) for t in times)
    return _shines(scene.materials[instance.material])


def _shines(material: Material) -> bool:
    own = getattr(material.kind, "emissive", (0, 0, 0))
    if getattr(material.kind, "unlit", False):
        own = getattr(material.kind, "base_color", own)
    return any(material.emission) or any(own)


def _mm(value: float) -> str:
    return f"{value / 1000:.3g} m" if abs(value) >= 1000 else f"{value:.3g} mm"
