"""Scene files of Mitsuba for tests, written as text."""

from __future__ import annotations

from pathlib import Path

import daguerre as dg

CAMERA = """
  <sensor type="perspective">
    <float name="fov" value="{fov}"/>
    <transform name="to_world"><lookat origin="{eye}" target="{target}" up="{up}"/></transform>
    <film type="hdrfilm">
      <integer name="width" value="{width}"/><integer name="height" value="{height}"/>
      <rfilter type="box"/>
    </film>
    <sampler type="independent"><integer name="sample_count" value="16"/></sampler>
  </sensor>
"""


def camera(
    eye: str = "0 0 5",
    target: str = "0 0 0",
    up: str = "0 1 0",
    fov: float = 40,
    size: tuple[int, int] = (32, 32),
) -> str:
    """A perspective sensor that looks at the origin from +z."""
    return CAMERA.format(eye=eye, target=target, up=up, fov=fov, width=size[0], height=size[1])


def written(folder: Path, *parts: str, version: str = "3.0.0", name: str = "scene.xml") -> Path:
    """Writes a scene file of some parts."""
    path = folder / name
    path.write_text(f'<scene version="{version}">\n' + "\n".join(parts) + "\n</scene>\n")
    return path


def loaded(folder: Path, *parts: str, version: str = "3.0.0", **options: object) -> dg.Scene:
    """Reads a scene file of some parts."""
    return dg.load(written(folder, *parts, version=version), **options)  # type: ignore[arg-type]
