"""Flat test charts: coloured polygons in a plane, with ground truth.

A chart lies in the plane z = 0, in m, +x right and +y up as seen by a camera on +z. Its colours are
linear Rec.709, as shares of its white. Everything in it is geometry, so edges are sharp at any
distance.
"""

from __future__ import annotations

import json
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.argument_checks import guarded
from daguerre.checks import number
from daguerre.errors import UsageError
from daguerre.files.value import BriefRecord

if TYPE_CHECKING:
    import os

    from daguerre.camera.camera import Camera
    from daguerre.exporters.gltf import Glb
    from daguerre.scene.scene import Scene

FloatArray = NDArray[np.float64]
Rgb = tuple[float, float, float]
#: Distance between layers of a chart, as a share of its larger side, or of a metre if that is
#: smaller; large enough for single precision.
LAYER = 5e-6
#: Size of the ground over the chart's, as distortion and focus bring surroundings into the frame.
GROUND = 2.0


@guarded
@dataclass(frozen=True, repr=False)
class Patch(BriefRecord):
    """A polygon of one colour.

    Attributes:
        name: Name in the truth; several patches may share one.
        points: Corners, m, shape (N, 2), convex, counter-clockwise.
        rgb: Share of the chart's white, linear Rec.709.
        layer: Patches of higher layers cover patches of lower layers.
    """

    name: str
    points: FloatArray
    rgb: Rgb
    layer: int = 1


@guarded
@dataclass(frozen=True)
class Chart:
    """A chart and its ground truth.

    Attributes:
        name: Kind of chart.
        size: Width and height, m.
        patches: Patches on the ground.
        ground: Colour of the ground.
        truth: Ground truth for measurements, JSON-compatible.
    """

    name: str
    size: tuple[float, float]
    patches: tuple[Patch, ...]
    ground: Rgb
    truth: dict[str, Any] = field(default_factory=dict)

    def camera(self, focal_length: float = 50.0, sensor_width: float = 36.0) -> Camera:
        """Returns a pinhole camera square to the chart; the chart fills its frame.

        Args:
            focal_length: Focal length, mm.
            sensor_width: Sensor width, mm; the height follows from the chart.
        """
        from daguerre.camera.camera import Camera

        pose = np.eye(4)
        pose[2, 3] = self.distance(focal_length, sensor_width)
        return Camera(
            transform=pose,
            lens="pinhole",
            focal_length=focal_length,
            sensor_size=(sensor_width, sensor_width * self.size[1] / self.size[0]),
            focus_distance=float(pose[2, 3]),
        )

    def distance(self, focal_length: float, sensor_width: float) -> float:
        """Returns the distance, m, from which the chart fills the frame's width.

        Args:
            focal_length: Focal length, mm.
            sensor_width: Sensor width, mm.
        """
        number(focal_length, "chart: focal_length", above=0)
        number(sensor_width, "chart: sensor_width", above=0)
        return self.size[0] * focal_length / sensor_width

    def scene(self, luminance: float = 100.0) -> Scene:
        """Makes a scene of the chart, shining by itself in the dark, with a camera that it fills.

        Args:
            luminance: Luminance of the chart's white, cd/m2.
        """
        from daguerre.scene.materials import Diffuse, Material
        from daguerre.scene.scene import Scene

        scene = Scene()
        for rgb, (positions, indices) in self.meshes().items():
            r, g, b = (luminance * x for x in rgb)
            material = Material(Diffuse((0.0, 0.0, 0.0)), emission=(r, g, b))
            mesh = scene.add_mesh(positions, indices)
            scene.add_instance(mesh, scene.add_material(material))
        scene.add_camera("chart", self.camera())
        return scene

    def meshes(self) -> dict[Rgb, tuple[NDArray[np.float32], NDArray[np.uint32]]]:
        """Returns positions (N, 3), m, and triangles (T, 3) by colour."""
        width, height = (GROUND * side / 2 for side in self.size)
        ground = Patch("ground", rectangle((0, 0), (2 * width, 2 * height)), self.ground, 0)
        by_color: dict[Rgb, list[Patch]] = defaultdict(list)
        for patch in (ground, *self.patches):
            by_color[patch.rgb].append(patch)
        apart = LAYER * max(1.0, *self.size)
        return {rgb: _mesh(patches, apart) for rgb, patches in by_color.items()}

    def save(
        self,
        path: str | os.PathLike[str],
        *,
        luminance: float | None = 100.0,
        focal_length: float = 50.0,
        sensor_width: float = 36.0,
        f_stop: float = 8.0,
    ) -> None:
        """Writes the chart as .glb with a camera that it fills, and its truth beside it as .json.

        Args:
            path: Path of the .glb.
            luminance: Luminance of the chart's white, which shines by itself, cd/m2; None: matt
                paint for light of your own.
            focal_length: Focal length of the camera, mm.
            sensor_width: Sensor width of the camera, mm.
            f_stop: F-stop of the camera.

        Raises:
            UsageError: The path has another suffix, or a number is out of range.
            OutputError: A file cannot be written.
        """
        from daguerre.checks import number
        from daguerre.exporters.gltf import Glb, Shape
        from daguerre.files.atomic import write_bytes

        if Path(path).suffix.lower() != ".glb":
            got = repr(Path(path).suffix) if Path(path).suffix else "none"
            raise UsageError(f"{path}: chart: wanted a name ending in .glb, got {got}")
        if luminance is not None:
            number(luminance, "chart: luminance", 0, 1e9, above=0)
        number(focal_length, "chart: focal_length", 1e-3, 1e6)
        number(sensor_width, "chart: sensor_width", 1e-3, 1e5)
        number(f_stop, "chart: f_stop", 1e-2, 1e9)
        glb = Glb("daguerre")
        for i, (rgb, (positions, indices)) in enumerate(self.meshes().items()):
            normals = np.broadcast_to(np.array([0, 0, 1], np.float32), positions.shape)
            shape = Shape(positions, normals, np.zeros((len(positions), 2), np.float32), indices)
            material = _shining(glb, rgb, luminance) if luminance is not None else _paint(glb, rgb)
            glb.add_node(f"color-{i}", mesh=glb.add_mesh(f"color-{i}", shape, material))
        distance = self.distance(focal_length, sensor_width)
        sensor = (sensor_width, sensor_width * self.size[1] / self.size[0])
        camera = glb.add_camera("chart", focal_length, f_stop, distance, sensor)
        glb.add_node("camera", camera=camera, translation=(0, 0, distance))
        glb.write(Path(path))
        truth = {
            "chart": self.name,
            "size_m": list(self.size),
            "white_cd_m2": luminance,
            **self.truth,
        }
        write_bytes(Path(path).with_suffix(".json"), json.dumps(truth, indent=1).encode() + b"\n")


def _shining(glb: Glb, rgb: Rgb, luminance: float) -> int:
    return int(
        glb.add_material(
            f"{rgb}",
            pbrMetallicRoughness={"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0},
            emissiveFactor=list(rgb),
            extensions={
                "KHR_materials_emissive_strength": {"emissiveStrength": luminance},
                "KHR_materials_specular": {"specularFactor": 0},
            },
        )
    )


def _paint(glb: Glb, rgb: Rgb) -> int:
    return int(
        glb.add_material(
            f"{rgb}",
            pbrMetallicRoughness={
                "baseColorFactor": [*rgb, 1],
                "metallicFactor": 0,
                "roughnessFactor": 1,
            },
            extensions={"KHR_materials_specular": {"specularFactor": 0}},
        )
    )


def _mesh(patches: list[Patch], apart: float) -> tuple[NDArray[np.float32], NDArray[np.uint32]]:
    """Triangle fans of convex patches; layers are ``apart`` m apart."""
    points = [np.c_[p.points, np.full(len(p.points), p.layer * apart)] for p in patches]
    fans, first = [], 0
    for corners in points:
        second = np.arange(1, len(corners) - 1)
        fans.append(first + np.c_[np.zeros_like(second), second, second + 1])
        first += len(corners)
    return np.concatenate(points).astype(np.float32), np.concatenate(fans).astype(np.uint32)


def rectangle(center: ArrayLike, size: ArrayLike, turned: float = 0.0) -> FloatArray:
    """Corners of a rectangle, counter-clockwise, shape (4, 2).

    Args:
        center: m.
        size: Width and height, m.
        turned: Counter-clockwise, degrees.
    """
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * np.asarray(size, np.float64) / 2
    a = np.radians(turned)
    turn = np.array([[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]])
    return np.asarray(np.asarray(center, np.float64) + corners @ turn)


def grey(value: float) -> Rgb:
    """Neutral colour with this share of white."""
    return (value, value, value)
