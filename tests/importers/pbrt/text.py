"""Small scenes of pbrt: texts, and what is in them."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio

import daguerre as dg
from daguerre.importers.pbrt.ledger import Ledger
from daguerre.importers.pbrt.reader import read_counted

#: Scene of Daguerre from world of pbrt, unless the camera is mirrored.
MIRROR = np.diag([1.0, 1.0, -1.0])
#: A square of 2 m in the plane z = 0 that faces -z, toward a camera at the origin's front.
SQUARE = (
    'Shape "trianglemesh" "point3 P" [-1 -1 0  -1 1 0  1 1 0  1 -1 0] '
    '"integer indices" [0 1 2 0 2 3] "point2 uv" [0 0 0 1 1 1 1 0]'
)
#: Names of all directives, for counting them in a text without the reader's own lexer.
_NAMES = (
    "Accelerator|ActiveTransform|AreaLightSource|AttributeBegin|AttributeEnd|Attribute|Camera|"
    "ColorSpace|ConcatTransform|CoordSysTransform|CoordinateSystem|Film|Identity|Import|Include|"
    "Integrator|LightSource|LookAt|MakeNamedMaterial|MakeNamedMedium|Material|MediumInterface|"
    "NamedMaterial|ObjectBegin|ObjectEnd|ObjectInstance|Option|PixelFilter|Renderer|"
    "ReverseOrientation|Rotate|Sampler|Scale|Shape|SurfaceIntegrator|Texture|TransformBegin|"
    "TransformEnd|TransformTimes|Transform|Translate|VolumeIntegrator|WorldBegin|WorldEnd"
)


def written(folder: Path, world: str, options: str = "", name: str = "scene.pbrt") -> Path:
    """Writes a scene: options, ``WorldBegin`` and a world."""
    path = folder / name
    path.write_text(f"{options}\nWorldBegin\n{world}\n")
    return path


def read(folder: Path, world: str, options: str = "") -> dg.Scene:
    """Writes a scene and reads it."""
    return dg.load(written(folder, world, options))


def counted(path: Path) -> tuple[dg.Scene, Ledger]:
    """Reads a scene with the counts of its directives."""
    return read_counted(path)


def count(text: str) -> int:
    """Number of directives of a text: words outside of strings and comments."""
    plain = re.sub(r'"[^"\n]*"', '""', re.sub(r"#[^\n]*", "", text))
    return len(re.findall(rf"(?<![A-Za-z])(?:{_NAMES})(?![A-Za-z])", plain))


def picture(path: Path, pixels: Any) -> Path:
    """Writes a picture, floats or bytes, shape (H, W, C)."""
    array = np.ascontiguousarray(pixels)
    kind = oiio.UINT8 if array.dtype == np.uint8 else oiio.FLOAT
    height, width, channels = array.shape
    made = oiio.ImageBuf(oiio.ImageSpec(width, height, channels, kind))
    made.set_pixels(oiio.ROI(), array)
    assert made.write(str(path))
    return path


def world_points(scene: dg.Scene, instance: int) -> np.ndarray:
    """Vertices of an instance in the scene, shape (N, 3)."""
    placed = scene.instances[instance]
    points = scene.meshes[placed.mesh].positions.astype(float)
    return points @ placed.transform[:3, :3].T + placed.transform[:3, 3]
