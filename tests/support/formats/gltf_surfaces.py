"""Materials of a stage as those of glTF: standard_surface of ``.mtlx`` files, and constants.

The package ``MaterialX`` reads the documents. An input without a counterpart in glTF is an error.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import MaterialX as mx
import numpy as np
import OpenImageIO as oiio
from numpy.typing import NDArray
from pxr import Sdf, Usd, UsdShade

from daguerre.exporters.gltf import Glb

from .make_gltf import png

#: Inputs that glTF has, or whose light glTF shows as diffuse (see ``_checked``).
_KNOWN = {
    *("base_color", "metalness", "specular_roughness", "normal"),
    *("transmission", "transmission_color"),
    *("subsurface", "subsurface_color", "subsurface_radius", "subsurface_scale"),
}


class Surfaces:
    """Materials of a stage in a file of glTF, each once.

    Args:
        glb: Receives the materials.
        stage: The stage.
    """

    def __init__(self, glb: Glb, stage: Usd.Stage) -> None:
        self._glb = glb
        self._stage = stage
        self._made: dict[object, int] = {}

    def index(self, path: Sdf.Path) -> int:
        """Index of the material at a path; there need be no prim if a document has it."""
        prim = self._stage.GetPrimAtPath(path)
        if prim and prim.IsA(UsdShade.Material):
            return self._once(path, lambda: _preview(self._glb, UsdShade.Material(prim)))
        file, name = _document(self._stage, path), path.name
        return self._once((file, name), lambda: _standard(self._glb, name, file))

    def _once(self, key: object, make: Callable[[], int]) -> int:
        if key not in self._made:
            self._made[key] = make()
        return self._made[key]


def _preview(glb: Glb, material: UsdShade.Material) -> int:
    """UsdPreviewSurface of three constants."""
    shader, _, _ = material.ComputeSurfaceSource()
    values = {one.GetBaseName(): one.Get() for one in shader.GetInputs()}
    assert values.keys() == {"diffuseColor", "metallic", "roughness"}, values
    return glb.add_material(
        material.GetPrim().GetName(),
        pbrMetallicRoughness={
            "baseColorFactor": [*map(float, values["diffuseColor"]), 1.0],
            "metallicFactor": values["metallic"],
            "roughnessFactor": values["roughness"],
        },
    )


def _document(stage: Usd.Stage, path: Sdf.Path) -> Path:
    """File of the ``.mtlx`` reference that brings the prims around a path."""
    scope = stage.GetPrimAtPath(path.GetParentPath())
    for spec in scope.GetPrimStack():
        for reference in spec.referenceList.GetAddedOrExplicitItems():
            if reference.assetPath.endswith(".mtlx"):
                return Path(Sdf.ComputeAssetPathRelativeToLayer(spec.layer, reference.assetPath))
    raise LookupError(f"{path}: no reference to a .mtlx file")


def _standard(glb: Glb, name: str, file: Path) -> int:
    document = mx.createDocument()
    mx.readFromXmlFile(document, str(file))
    (shader,) = mx.getShaderNodes(document.getNode(name))
    _checked(shader)
    values: dict[str, Any] = {"pbrMetallicRoughness": _reflection(glb, shader, file.parent)}
    normal = _source(shader, "normal")
    if normal is not None:
        assert normal.getCategory() == "normalmap", name
        picture = _file(normal.getConnectedNode("in"), file.parent)
        values["normalTexture"] = glb.add_picture(picture.name, picture.read_bytes())
    through = _number(shader, "transmission", 0.0)
    if through:
        values["extensions"] = {
            "KHR_materials_transmission": {"transmissionFactor": through},
            "KHR_materials_volume": {"thicknessFactor": 1.0},
            "KHR_materials_ior": {"ior": 1.5},
        }
    return glb.add_material(name, **values)


def _checked(shader: mx.Node) -> None:
    """Refuses what glTF cannot show.

    glTF has no subsurface scattering; where its colour is that of the surface, it is diffuse light.
    """
    given = {one.getName() for one in shader.getInputs()}
    assert given <= _KNOWN, given - _KNOWN
    if "subsurface" in given:
        same = (_source(shader, name) for name in ("subsurface_color", "base_color"))
        assert len({node and node.getNamePath() for node in same}) == 1
    assert _number(shader, "transmission", 0.0) in (0.0, 1.0)


def _reflection(glb: Glb, shader: mx.Node, folder: Path) -> dict[str, Any]:
    values: dict[str, Any] = {}
    tint = "transmission_color" if _number(shader, "transmission", 0.0) else "base_color"
    base = _source(shader, tint)
    if base is None:
        given = shader.getInput(tint)
        values["baseColorFactor"] = [*given.getValue().asTuple(), 1.0]
    else:
        assert base.getInput("file").getActiveColorSpace() == "srgb_texture"
        picture = _file(base, folder)
        values["baseColorTexture"] = glb.add_picture(picture.name, picture.read_bytes())
    found: list[NDArray[np.uint8] | None] = []
    for name, factor, default in (
        ("specular_roughness", "roughnessFactor", 0.2),
        ("metalness", "metallicFactor", 0.0),
    ):
        source = _source(shader, name)
        found.append(None if source is None else _grey(_file(source, folder)))
        values[factor] = _number(shader, name, default) if source is None else 1.0
    rough, metal = found
    some = rough if rough is not None else metal
    if some is not None:
        full = np.full_like(some, 255)
        planes = [full, full if rough is None else rough, full if metal is None else metal]
        values["metallicRoughnessTexture"] = glb.add_picture("mr", png(np.stack(planes, axis=-1)))
    return values


def _source(shader: mx.Node, name: str) -> mx.Node | None:
    """Node that an input is connected to, through the output of a graph."""
    found = shader.getInput(name)
    if found is None:
        return None
    output = found.getConnectedOutput()
    return output.getConnectedNode() if output else found.getConnectedNode()


def _number(shader: mx.Node, name: str, default: float) -> float:
    found = shader.getInput(name)
    return default if found is None else float(found.getValue())


def _file(image: mx.Node, folder: Path) -> Path:
    assert image.getCategory() == "image"
    return folder / image.getInput("file").getValueString()


def _grey(path: Path) -> NDArray[np.uint8]:
    buffer = oiio.ImageBuf(str(path))
    assert buffer.nchannels == 1, path
    return np.asarray(buffer.get_pixels(oiio.UINT8))[..., 0]
