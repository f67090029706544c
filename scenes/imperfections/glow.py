"""A scene of things that shine by themselves, and lamps of which all of one kind share a mesh."""

from __future__ import annotations

from daguerre.exporters.gltf import Shape
from extensions.studio import Studio
from kit import shapes, textures
from kit.pose import Point

WARM, GOLD, COOL = (1.0, 0.62, 0.30), (1.0, 0.78, 0.45), (0.60, 0.78, 1.0)
RED, TEAL, PINK, BLUE = (1.0, 0.16, 0.08), (0.15, 0.9, 0.75), (1.0, 0.25, 0.55), (0.2, 0.4, 1.0)
WHITE = (1.0, 1.0, 1.0)


class Glow(Studio):
    """A studio in which nothing needs light."""

    def __init__(self) -> None:
        super().__init__("imperfections.py")
        self._lamps: dict[tuple[float, ...], int] = {}

    def show(
        self, name: str, shape: Shape, color: Point, luminance: float, at: Point = (0, 0, 0)
    ) -> None:
        """A shape that shines evenly, cd/m2."""
        self.put(name, shape, self.shining(name, color, luminance), at)

    def hang(self, name: str, shape: Shape, picture: textures.Picture, at: Point) -> None:
        """A picture, sRGB, that is seen as it was drawn."""
        texture = self.glb.add_picture(name, textures.png(picture))
        matter = self.matter(
            name, WHITE, pbr={"baseColorTexture": texture}, extensions={"unlit": {}}
        )
        self.put(name, shape, matter, at)

    def lamp(self, at: Point, radius: float, color: Point, luminance: float) -> None:
        """A round lamp that faces +z, cd/m2."""
        key = (*color, luminance)
        if key not in self._lamps:
            matter = self.shining("lamp", color, luminance)
            self._lamps[key] = self.glb.add_mesh("lamp", shapes.disc(1.0, 16), matter)
        self.glb.add_node("lamp", mesh=self._lamps[key], translation=at, scale=[radius] * 3)
