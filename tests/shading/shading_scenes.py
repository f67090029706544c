"""Materials of tests: small MaterialX texts, pictures, and what a surface shows at a point."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
from numpy.typing import NDArray

import daguerre as dg
from daguerre.color import srgb
from daguerre.files.notes import Notes
from daguerre.scene.materials import Gltf, TextureSlot
from daguerre.shading.arithmetic import Arithmetic
from daguerre.shading.bake import Baker
from daguerre.shading.build import Builder
from daguerre.shading.evaluate import Context
from daguerre.shading.images import Images
from daguerre.shading.materialx.document import Document


class Read:
    """One material of a MaterialX text, as it comes into a scene.

    Args:
        text: Elements inside of <materialx>.
        folder: Folder of its pictures.
        material: Name of the material.
    """

    def __init__(self, text: str, folder: Path, material: str = "M", **options: Any) -> None:
        data = f'<materialx version="1.39">{text}</materialx>'.encode()
        self.notes, self.scene = Notes(), dg.Scene()
        document = Document(data, str(folder / "test.mtlx"), self.notes)
        graph = document.graph(material)
        assert graph is not None
        baker = Baker(self.notes, options.pop("limit", 1 << 30))
        images = Images(self.scene, lambda place, path: Path(path), self.notes)
        context = Context(images, self.notes, Arithmetic(baker), **options)
        builder = Builder(images, baker, 1.0)
        self.material = builder.material(graph, material, context)
        self.scene.add_material(self.material)
        assert isinstance(self.material.kind, Gltf)
        self.kind = self.material.kind


def surface(inputs: str, nodes: str = "", kind: str = "standard_surface") -> str:
    """Text of a material ``M`` whose surface has some inputs."""
    return f"""{nodes}<{kind} name="S" type="surfaceshader">{inputs}</{kind}>
    <surfacematerial name="M" type="material">
      <input name="surfaceshader" type="surfaceshader" nodename="S"/></surfacematerial>"""


def shining(nodes: str, name: str = "N", output: str = "") -> str:
    """Material that emits the value of a node, which nothing limits to 1."""
    out = f' output="{output}"' if output else ""
    return surface(
        '<input name="emission" type="float" value="1"/>'
        f'<input name="emission_color" type="color3" nodename="{name}"{out}/>',
        nodes,
    )


def write(path: Path, pixels: NDArray[Any]) -> None:
    """Writes a picture (H, W, C); uint8 as PNG, float32 as OpenEXR."""
    path.parent.mkdir(parents=True, exist_ok=True)
    height, width, channels = pixels.shape
    kind = "uint8" if pixels.dtype == np.uint8 else "float"
    output = oiio.ImageOutput.create(str(path))
    assert output is not None
    spec = oiio.ImageSpec(width, height, channels, kind)
    spec.attribute("oiio:UnassociatedAlpha", 1)
    assert output.open(str(path), spec)
    assert output.write_image(np.ascontiguousarray(pixels))
    output.close()


def looked_up(scene: dg.Scene, slot: TextureSlot, s: float, t: float) -> NDArray[np.float64]:
    """Texel nearest to texture coordinates with (0, 0) at the bottom left, decoded, RGBA."""
    texture = scene.textures[slot.texture]
    a, b, c, d, e, f = slot.transform
    u, v = s, 1 - t
    at = (a * u + b * v + c, d * u + e * v + f)
    height, width, channels = texture.pixels.shape
    index = []
    for x, count, how in zip(at, (width, height), texture.wrap, strict=True):
        i = int(np.floor(x * count))
        if how == "repeat":
            i %= count
        elif how == "mirror":
            i %= 2 * count
            i = 2 * count - 1 - i if i >= count else i
        index.append(min(max(i, 0), count - 1))
    texel = texture.pixels[index[1], index[0]].astype(np.float64)
    if texture.pixels.dtype == np.uint8:
        texel /= 255
    if channels < 3:
        texel = np.concatenate([np.repeat(texel[:1], 3), texel[1:]])
    if len(texel) == 3:
        texel = np.append(texel, 1.0)
    if texture.srgb:
        texel[:3] = srgb.to_linear(texel[:3])
    return texel


def color_at(read: Any, name: str, s: float, t: float) -> NDArray[np.float64]:
    """Colour of a field of a material at texture coordinates: factor times texture."""
    factor = np.array(getattr(read.kind, name))
    slot = getattr(read.kind, f"{name}_texture")
    if slot is None:
        return factor
    return np.asarray(factor * looked_up(read.scene, slot, s, t)[: len(factor)])
