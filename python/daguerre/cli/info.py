"""``daguerre info``: describes a scene and its cameras, in mm, m and s."""

from __future__ import annotations

import math
from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Annotated, Any

from . import console
from .flags.calibration import CalibrationFlags
from .flags.camera import CameraFlags
from .flags.groups import option, with_flags
from .flags.scene import SceneFlags
from .flags.scene_file import ScenePath
from .flags.shutter import ShutterFlags
from .render.views import Cameras

if TYPE_CHECKING:
    from daguerre.setup.camera_facts import Facts

#: Names of a list in the text; JSON has all.
_MOST_NAMES = 12


@with_flags(
    camera_flags=CameraFlags,
    calibration_flags=CalibrationFlags,
    shutter_flags=ShutterFlags,
    scene_flags=SceneFlags,
)
def info(
    scene_path: ScenePath,
    camera_flags: CameraFlags,
    calibration_flags: CalibrationFlags,
    shutter_flags: ShutterFlags,
    scene_flags: SceneFlags,
    res: Annotated[
        str | None,
        option(
            "--res",
            metavar="WxH",
            help="Picture size, px, for field of view and pixel pitch [from the calibration "
            "or the scene file, else 960x540].",
        ),
    ] = None,
    json: Annotated[bool, option("--json", help="Print one JSON object.")] = False,
) -> int:
    """Describes a scene and its cameras.

    For each camera it prints field of view, depth of field and exposure. Flags change the cameras
    that it describes: use them to try a lens or a stop.
    """
    from daguerre.camera.camera import Camera
    from daguerre.distortion.rectified import built
    from daguerre.setup import camera_facts as facts_of

    changes = camera_flags.changes() | shutter_flags.changes()
    flags = Cameras(camera_flags.camera, calibration_flags, changes, camera_flags.placement)
    views = flags.views(None)
    calibration_flags.check(changes)
    scene = scene_flags.load(scene_path, moments=(0.0, 0.0))
    if camera_flags.camera is None and len(views) == 1:
        views = [replace(views[0], name=name, camera=name) for name in scene.cameras]
    cameras: dict[str, Camera] = {view.name: view.view(flags).camera(scene) for view in views}
    sizes = {view.name: flags.size(view, res, scene) for view in views}
    content = facts_of.scene_facts(scene)
    core_scene = None
    focusing = [name for name, c in cameras.items() if facts_of.needs_autofocus(c)]
    if focusing:
        core_scene = built(scene, cameras[focusing[0]], sizes[focusing[0]])
    facts = {n: facts_of.camera_facts(c, scene, core_scene, sizes[n]) for n, c in cameras.items()}
    warnings = {n: facts_of.camera_warnings(c) for n, c in cameras.items()}
    if json:
        _print_json(content, facts, warnings, scene.default_camera)
        return 0
    console.show("\n".join(_scene_lines(content)))
    for name, one in facts.items():
        default = " (default)" if name == scene.default_camera else ""
        console.show(f"camera {name!r}{default}")
        console.show(
            "\n".join(f"  {key:20} {value}" for key, value in camera_rows(one, sizes[name]).items())
        )
    if not facts:
        console.show("no camera")
    for name, found in warnings.items():
        for text in found:
            console.warn(f"{scene_path}: camera {name!r}: {text}")
    return 0


def camera_rows(facts: Facts, resolution: tuple[int, int]) -> dict[str, str]:
    """Rows of the table, with units."""
    width, height = facts.sensor_mm
    rows = {
        "lens": facts.lens,
        "focal length": f"{facts.focal_length_mm:.4g} mm",
        "sensor": f"{width:.4g} x {height:.4g} mm",
        "field of view": _angles(facts.field_of_view_deg),
        f"at {resolution[0]}x{resolution[1]}": (
            f"{_angles(facts.picture_field_of_view_deg)}, "
            f"{facts.picture_mm[0]:.4g} x {facts.picture_mm[1]:.4g} mm, "
            f"pixel pitch {facts.pixel_pitch_um:.4g} um"
        ),
        "f-stop": "none (pinhole: everything is sharp)"
        if facts.f_stop is None
        else f"f/{facts.f_stop:.3g}",
    }
    if facts.t_stop is not None:
        rows["T-stop"] = f"T/{facts.t_stop:.3g} on the axis"
    if facts.zoom_mm is not None and facts.zoom_range_mm is not None:
        rows["zoom"] = "{:.4g} mm of {:.4g} to {:.4g} mm".format(
            facts.zoom_mm, *facts.zoom_range_mm
        )
    if facts.squeeze != 1:
        rows["squeeze"] = f"{facts.squeeze:.3g} (anamorphic; the pixel aspect to view it with)"
    if any(facts.tilt_deg):
        rows["tilt"] = "{:.3g} deg about x, {:.3g} deg about y".format(*facts.tilt_deg)
    if facts.decentered:
        rows["decentred"] = f"{facts.decentered} group(s) off the axis"
    if facts.pupil_diameter_mm is not None:
        rows["entrance pupil"] = f"{facts.pupil_diameter_mm:.4g} mm"
        rows["focus distance"] = _metres(facts.focus_m)
    if facts.hyperfocal_m is not None and facts.near_m is not None and facts.far_m is not None:
        rows["hyperfocal distance"] = _metres(facts.hyperfocal_m)
        rows["depth of field"] = (
            f"{_metres(facts.near_m)} to {_metres(facts.far_m)} "
            f"(circle of confusion {facts.coc_mm * 1000:.3g} um)"
        )
    if facts.near_clip_m:
        rows["near clipping plane"] = _metres(facts.near_clip_m)
    rows["shutter"] = facts.shutter
    rows["exposure"] = facts.exposure
    if facts.ev100 is not None:
        rows["EV100"] = f"{facts.ev100:.2f}"
    if facts.notes:
        rows["note"] = "; ".join(facts.notes)
    return rows


def _scene_lines(content: dict[str, Any]) -> list[str]:
    low, high = content["bounds_m"]
    textures = content["textures"]
    sizes = ", ".join(f"{t['width']}x{t['height']}" for t in textures[:8])
    more = ", ..." if len(textures) > 8 else ""
    lights = ", ".join(f"{n} {kind}" for kind, n in content["lights"].items())
    nodes = [node["name"] for node in content["nodes"]]
    meshed = [node["name"] for node in content["nodes"] if node["instances"]]
    materials, lamps = content["material_names"], [lamp["name"] for lamp in content["lamps"]]
    rows = {
        "scene": content["file"] or "",
        "meshes": f"{content['meshes']} ({content['triangles']} triangles)",
        "instances": f"{content['instances']} ({content['triangles_placed']} triangles)",
        "size": "empty"
        if low is None
        else " x ".join(f"{b - a:.3g}" for a, b in zip(low, high, strict=True)) + " m",
        "nodes": _listed(len(nodes), nodes),
        "with meshes": _listed(len(meshed), meshed),
        "materials": _listed(len(materials), materials),
        "textures": f"{len(textures)}" + (f" ({sizes}{more})" if textures else ""),
        "lights": _listed(lights or "none", lamps),
        "emissive": f"{content['emissive_instances']} instances",
        "environment": content["environment"] or "none",
    }
    if content["curves"]:
        rows["curves"] = f"{content['curves']}"
    if content["variants"]:
        rows["variants"] = ", ".join(content["variants"])
    if content["moves"]:
        rows["moves"] = _moving(content["moves"])
    if content["animation_duration_s"]:
        rows["animation"] = f"{content['animation_duration_s']:.4g} s"
    lines = [f"{key:12} {value}" for key, value in rows.items()]
    return lines + [f"note: {text}" for text in content["warnings"]]


def _listed(count: int | str, names: list[str]) -> str:
    """A count, and the first names in quotes; empty names are left out."""
    from daguerre.checks import short

    named = [name for name in names if name]
    first = ", ".join(short(name, 120) for name in named[:_MOST_NAMES])
    more = ", ... (--json lists all)" if len(named) > _MOST_NAMES else ""
    return f"{count}: {first}{more}" if first else f"{count}"


def _moving(moves: dict[str, Any]) -> str:
    """Describes motion, such as ``34 instances, cameras 'pan' (transform)``."""
    parts = [
        name if name == "environment" else f"{count} {name}"
        for name, count in moves.items()
        if name != "cameras"
    ]
    cameras = [f"{name!r} ({', '.join(of)})" for name, of in moves.get("cameras", {}).items()]
    return ", ".join(parts + (["cameras " + ", ".join(cameras)] if cameras else []))


def _print_json(
    content: dict[str, Any],
    facts: dict[str, Facts],
    warnings: dict[str, list[str]],
    default: str | None,
) -> None:
    from json import dumps

    from daguerre.pictures.exr.write import without_infinity

    cameras = {
        name: {**asdict(one), "default": name == default, "warnings": warnings[name]}
        for name, one in facts.items()
    }
    console.show(dumps(without_infinity({**content, "cameras": cameras}), indent=2))


def _angles(angles: tuple[float, float, float]) -> str:
    h, v, d = angles
    return f"{h:.2f} x {v:.2f} deg ({d:.2f} diagonal)"


def _metres(value: float) -> str:
    return "infinity" if math.isinf(value) else f"{value:.4g} m"
