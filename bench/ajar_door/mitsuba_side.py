"""Mitsuba's side of ``bench/ajar.py``, its path tracer through LLVM."""

from __future__ import annotations

from typing import Any

import mitsuba as mi  # type: ignore[import-not-found]
import numpy as np
import room
from side import DEPTH, answer, arguments, cpu_seconds

mi.set_variant("llvm_ad_rgb")
import drjit as dr  # type: ignore[import-not-found]  # noqa: E402


def rgb(color: tuple[float, ...]) -> dict[str, Any]:
    """A colour or a radiance."""
    return {"type": "rgb", "value": list(color)}


def bsdf(name: str) -> dict[str, Any]:
    """One of the room's materials."""
    kind, color = room.MATERIALS[name]
    if kind == "diffuse":
        return {"type": "twosided", "b": {"type": "diffuse", "reflectance": rgb(color)}}
    glossy = {"type": "roughconductor", "material": "none", "distribution": "ggx"}
    return {
        "type": "twosided",
        "b": glossy | {"alpha": room.ALPHA, "specular_reflectance": rgb(color)},
    }


def mesh(name: str, points: np.ndarray, faces: np.ndarray, **parts: Any) -> Any:
    """A mesh with flat faces; ``parts`` are its material and its light."""
    props = mi.Properties()
    props["face_normals"] = True
    for key, part in parts.items():
        props[key] = mi.load_dict(part)
    made = mi.Mesh(name, len(points), len(faces), props=props)
    values = mi.traverse(made)
    values["vertex_positions"] = np.ascontiguousarray(points, np.float32).ravel()
    values["faces"] = np.ascontiguousarray(faces, np.uint32).ravel()
    values.update()
    return made


def scene(width: int, height: int, spp: int, sampler: str) -> Any:
    """The room as a scene."""
    matrix = room.camera_matrix() @ np.diag([-1, 1, -1, 1])  # it looks along +z, x to the left
    focal = room.CAMERA["focal_mm"]
    film = {"type": "hdrfilm", "width": width, "height": height, "rfilter": {"type": "box"}}
    made: dict[str, Any] = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": DEPTH + 1},
        "sensor": {
            "type": "thinlens",
            "fov": float(2 * np.degrees(np.arctan(18 / focal))),
            "fov_axis": "x",
            "near_clip": 0.01,
            "far_clip": 1000.0,
            "aperture_radius": focal / room.CAMERA["f_stop"] / 2 * 1e-3,
            "focus_distance": room.focus_distance(),
            "to_world": mi.ScalarTransform4f(matrix),
            "film": film | {"pixel_format": "rgb", "component_format": "float32"},
            "sampler": {"type": sampler, "sample_count": spp},
        },
    }
    for name, (shape, material) in room.build().items():
        made[name] = mesh(name, *shape, bsdf=bsdf(material))
    black = {"type": "diffuse", "reflectance": rgb((0, 0, 0))}
    light = {"type": "area", "radiance": rgb(room.LAMP["radiance"])}
    made["lamp"] = mesh("lamp", *room.lamp(), bsdf=black, emitter=light)
    return mi.load_dict(made)


def main() -> None:
    """Renders once and reports; a picture before that compiles for this number of samples."""
    options = arguments(sampler=str)
    dr.set_thread_count(options.threads)
    made = scene(options.w, options.h, options.spp, options.sampler)
    np.array(mi.render(made, spp=options.spp, seed=999))
    before = cpu_seconds()
    picture = np.array(mi.render(made, spp=options.spp, seed=options.seed))
    answer(
        options.out, picture, f"mitsuba {mi.__version__} {options.sampler}", cpu_seconds() - before
    )


if __name__ == "__main__":
    main()
