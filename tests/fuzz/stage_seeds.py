"""Good stages of USD: text, binary and packages, with variants, clips and layers beside them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

#: A file's name and bytes.
Seed = tuple[str, bytes]

_HEAD = """#usda 1.0
(
    defaultPrim = "World"
    metersPerUnit = 1
    upAxis = "Y"
    timeCodesPerSecond = 24
)
"""
_BODY = """def Xform "World" (
    variants = { string shape = "ball" }
    prepend variantSets = "shape"
)
{
    variantSet "shape" = {
        "ball" {
            def Sphere "ball" {
                double radius = 0.5
            }
        }
        "cube" (references = @beside.usda@</card>) {
            over "card" {
            }
        }
    }
    def Camera "cam" {
        float focalLength = 35
        double3 xformOp:translate.timeSamples = { 0: (0, 0, 5), 9: (0, 1, 5) }
        uniform token[] xformOpOrder = ["xformOp:translate"]
    }
    def Mesh "card" (prepend apiSchemas = ["MaterialBindingAPI"]) {
        point3f[] points = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
        int[] faceVertexCounts = [4]
        int[] faceVertexIndices = [0, 1, 2, 3]
        normal3f[] normals = [(0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1)]
        texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] (interpolation = "vertex")
        color3f[] primvars:displayColor = [(0.5, 0.4, 0.3)]
        rel material:binding = </World/paint>
    }
    def Material "paint" {
        token outputs:surface.connect = </World/paint/surface.outputs:surface>
        def Shader "surface" {
            uniform token info:id = "UsdPreviewSurface"
            color3f inputs:diffuseColor.connect = </World/paint/picture.outputs:rgb>
            float inputs:roughness = 0.4
            token outputs:surface
        }
        def Shader "picture" {
            uniform token info:id = "UsdUVTexture"
            asset inputs:file = @beside.png@
            float2 inputs:st.connect = </World/paint/reader.outputs:result>
            float3 outputs:rgb
        }
        def Shader "reader" {
            uniform token info:id = "UsdPrimvarReader_float2"
            string inputs:varname = "st"
            float2 outputs:result
        }
    }
    def SphereLight "lamp" {
        float inputs:radius = 0.2
        float inputs:intensity = 9
    }
    def DomeLight "sky" {
        color3f inputs:color = (1, 0.9, 0.8)
    }
    def PointInstancer "many" {
        rel prototypes = [</World/many/one>]
        int[] protoIndices = [0, 0, 0]
        point3f[] positions = [(0, 0, 0), (1, 0, 0), (2, 0, 0)]
        def Cube "one" {
            double size = 0.1
        }
    }
    def BasisCurves "hair" {
        uniform token type = "cubic"
        uniform token basis = "bspline"
        int[] curveVertexCounts = [4]
        point3f[] points = [(0, 0, 0), (0, 1, 0), (0, 2, 0), (0, 3, 1)]
        float[] widths = [0.05] (interpolation = "constant")
    }
    def Xform "moved" (
        clips = { dictionary default = {
            asset[] assetPaths = [@clip.usda@]
            string primPath = "/card"
            double2[] active = [(0, 0)]
            double2[] times = [(0, 0), (9, 9)]
        } }
    ) {
        double3 xformOp:translate
        uniform token[] xformOpOrder = ["xformOp:translate"]
        def Cylinder "rod" {
            double height = 1
            double radius = 0.1
            token axis = "Z"
        }
    }
}
"""
_BESIDE = """#usda 1.0
def Xform "card" {
    double3 xformOp:translate.timeSamples = { 0: (0, 0, 0), 5: (1, 0, 0) }
    uniform token[] xformOpOrder = ["xformOp:translate"]
    def Mesh "square" {
        point3f[] points = [(-1, -1, 0), (1, -1, 0), (1, 1, 0)]
        int[] faceVertexCounts = [3]
        int[] faceVertexIndices = [0, 1, 2]
    }
}
"""


def _folder(folder: Path) -> Path:
    """Writes the files that stages name, and the stage."""
    from tests.support.formats.make_gltf import png

    (folder / "beside.usda").write_text(_BESIDE)
    (folder / "clip.usda").write_text(_BESIDE)
    (folder / "beside.png").write_bytes(png(np.full((4, 4, 3), 99, np.uint8)))
    stage = folder / "stage.usda"
    stage.write_text(_HEAD + _BODY)
    return stage


def usdas(folder: Path) -> Iterator[Seed]:
    yield "stage.usda", _folder(folder).read_bytes()


def usdcs(folder: Path) -> Iterator[Seed]:
    from pxr import Sdf

    layer = Sdf.Layer.FindOrOpen(str(_folder(folder)))
    assert layer.Export(str(folder / "stage.usdc"))
    yield "stage.usdc", (folder / "stage.usdc").read_bytes()
    rng = np.random.default_rng(3)
    numbers = ", ".join(f"({a:.5f}, {b:.5f}, {c:.5f})" for a, b, c in rng.random((900, 3)))
    long = Sdf.Layer.CreateAnonymous()
    assert long.ImportFromString(
        f'{_HEAD}def Points "p" {{\npoint3f[] points = [{numbers}]\nfloat[] widths = [0.01] '
        '(interpolation = "constant")\n}\n'
    )
    assert long.Export(str(folder / "long.usdc"))
    yield "long.usdc", (folder / "long.usdc").read_bytes()


def usdzs(folder: Path) -> Iterator[Seed]:
    from pxr import Sdf, UsdUtils

    stage = _folder(folder)
    for suffix in ("usda", "usdc"):
        layer = Sdf.Layer.FindOrOpen(str(stage))
        assert layer.Export(str(folder / f"whole.{suffix}"))
        package = folder / f"{suffix}.usdz"
        assert UsdUtils.CreateNewUsdzPackage(
            Sdf.AssetPath(str(folder / f"whole.{suffix}")), str(package)
        )
        yield "package.usdz", package.read_bytes()
