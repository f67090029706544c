"""Mitsuba's side of ``bench/rooms.py``: a scene file by its path tracer through LLVM."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from side import answer, arguments, cpu_seconds

#: Most samples per pixel in one call, which keeps Mitsuba's memory small.
CALL_SPP = 256
#: Seeds of the calls of one picture are this far apart from those of the next.
SEEDS_APART = 1000


def edited(path: Path, settings: dict[str, Any]) -> str:
    """Text of a scene file with another film, sampler and integrator.

    Args:
        path: The file; its sensor must stand in it, not in an include.
        settings: Width ``w``, height ``h``, samples per pixel ``spp``, ``sampler``, and ``depth``,
            the surfaces of a path.
    """
    root = ElementTree.parse(path).getroot()
    sensor = root.find("sensor")
    if sensor is None:
        raise SystemExit(f"{path}: wanted a sensor in the file, got none")
    for parent, tag in ((root, "integrator"), (sensor, "film"), (sensor, "sampler")):
        for found in parent.findall(tag):
            parent.remove(found)
    integrator = ElementTree.Element("integrator", type="path")
    root.insert(0, integrator)
    _add(integrator, "integer", "max_depth", settings["depth"] + 1)  # edges of a path
    film = ElementTree.SubElement(sensor, "film", type="hdrfilm")
    _add(film, "integer", "width", settings["w"])
    _add(film, "integer", "height", settings["h"])
    _add(film, "string", "pixel_format", "rgb")
    _add(film, "string", "component_format", "float32")
    ElementTree.SubElement(film, "rfilter", type="box")
    sampler = ElementTree.SubElement(sensor, "sampler", type=settings["sampler"])
    _add(sampler, "integer", "sample_count", min(settings["spp"], CALL_SPP))
    return ElementTree.tostring(root, encoding="unicode")


def _add(parent: ElementTree.Element, tag: str, name: str, value: object) -> None:
    ElementTree.SubElement(parent, tag, name=name, value=str(value))


def drawn(mi: Any, scene: Any, spp: int, seed: int) -> np.ndarray:
    """Mean of calls of at most `CALL_SPP` samples per pixel, (H, W, 3)."""
    total, left = np.zeros(1), spp
    for call in range(SEEDS_APART):
        part = min(left, CALL_SPP)
        picture = np.array(mi.render(scene, spp=part, seed=seed * SEEDS_APART + call), np.float64)
        total = total + picture[:, :, :3] * part
        left -= part
        if left == 0:
            break
    return total / spp


def main() -> None:
    """Renders once and reports; a picture before that compiles for this number of samples."""
    options = arguments(room=Path, sampler=str, depth=int)
    before = cpu_seconds()
    import mitsuba as mi  # type: ignore[import-not-found]

    mi.set_variant("llvm_ad_rgb")
    import drjit as dr  # type: ignore[import-not-found]

    dr.set_thread_count(options.threads)
    mi.file_resolver().prepend(str(options.room.resolve().parent))
    scene = mi.load_string(edited(options.room, vars(options)))
    read = cpu_seconds()
    # Samplers are compiled with the number of samples.
    np.array(mi.render(scene, spp=min(options.spp, CALL_SPP), seed=0))
    ready = cpu_seconds()
    picture = drawn(mi, scene, options.spp, options.seed)
    cpu = cpu_seconds() - ready
    answer(
        options.out,
        picture,
        f"mitsuba {mi.__version__} {options.sampler}",
        cpu,
        scene_cpu_s=round(read - before, 2),
    )


if __name__ == "__main__":
    main()
