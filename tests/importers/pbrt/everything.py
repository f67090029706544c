"""A scene with one of everything that the reader knows."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .text import picture

_OPTIONS = """# options
Option "string seed" "1"
ColorSpace "srgb"
Scale 1 1 1 LookAt 0 0 -5  0 0 0  0 1 0
Rotate 0 0 0 1
CoordinateSystem "eye"
Camera "perspective" "float fov" 40 "float lensradius" 0.01 "float focaldistance" 5
Film "rgb" "integer xresolution" 32 "integer yresolution" 24 "float iso" 200
Sampler "zsobol" "integer pixelsamples" 16
Integrator "volpath" "integer maxdepth" 5
PixelFilter "gaussian"
Accelerator "bvh"
"""
_WORLD = """
MakeNamedMedium "smoke" "string type" "homogeneous" "rgb sigma_a" [0.1 0.2 0.3]
MakeNamedMedium "grid" "string type" "uniformgrid" "integer nx" 2 "integer ny" 1 "integer nz" 1
    "float density" [0 1] "point3 p0" [0 0 0] "point3 p1" [1 2 3]
Texture "check" "spectrum" "checkerboard" "float uscale" 4 "float vscale" 4
Texture "image" "spectrum" "imagemap" "string filename" "colors.png"
Texture "twice" "spectrum" "scale" "texture tex" "image" "float scale" 0.5
Texture "both" "spectrum" "mix" "texture tex1" "image" "rgb tex2" [1 0 0] "float amount" 0.25
Texture "noise" "float" "fbm"
Texture "unused" "float" "constant" "float value" 2
MakeNamedMaterial "paper" "string type" "diffuse" "texture reflectance" "twice"
MakeNamedMaterial "metal" "string type" "conductor" "spectrum eta" "metal-Au-eta"
    "spectrum k" "metal-Au-k" "float roughness" 0.1
MakeNamedMaterial "mixed" "string type" "mix" "string materials" ["paper" "metal"]
Attribute "shape" "float radius" 0.5
AttributeBegin
    AreaLightSource "diffuse" "blackbody L" 3000 "float power" 100 "bool twosided" true
    Translate 0 2 0
    Shape "disk"
AttributeEnd
AttributeBegin
    ReverseOrientation
    MediumInterface "smoke" ""
    Material "dielectric" "spectrum eta" "glass-BK7"
    Shape "sphere"
    MediumInterface "grid" "smoke"
    Material "interface"
    Shape "cylinder"
AttributeEnd
NamedMaterial "mixed"
Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2]
Material "coateddiffuse" "texture reflectance" "both" "texture roughness" "noise"
Shape "loopsubdiv" "point3 P" [0 0 0 1 0 0 0 1 0 0 0 1] "integer indices" [0 2 1 0 1 3 1 2 3 2 0 3]
    "integer levels" 1
Material "thindielectric"
Shape "bilinearmesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 1]
Material "diffusetransmission" "texture reflectance" "check"
Shape "curve" "point3 P" [0 0 0 0 1 0 1 1 0 1 2 0] "float width" 0.1
Shape "curve" "point3 P" [1 0 0 1 1 0 2 1 0 2 2 0] "float width" 0.1
Shape "nurbs"
Material "coatedconductor"
ObjectBegin "thing"
    Identity
    Shape "plymesh" "string filename" "triangle.ply"
    Shape "sphere" "float radius" 0.1
ObjectEnd
ObjectInstance "thing"
AttributeBegin
    TransformTimes 0 1
    ActiveTransform EndTime Translate 1 0 0 ActiveTransform All
    ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1]
    Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 1 0 1]
    ActiveTransform EndTime Translate 1 0 0 ActiveTransform All
    ObjectInstance "thing"
AttributeEnd
CoordSysTransform "eye"
CoordSysTransform "no such"
LightSource "infinite" "string filename" "sky.exr"
LightSource "infinite" "rgb L" [0.1 0.2 0.3] "float scale" 2
LightSource "point" "rgb I" [1 2 3] "point3 from" [0 1 0]
LightSource "spot" "point3 from" [0 3 0] "point3 to" [0 0 0] "float power" 100
LightSource "distant" "float illuminance" 1000
LightSource "goniometric" "string filename" "grey.exr"
LightSource "projection" "string filename" "colors.png" "float fov" 30
LightSource "laser"
Include "more.pbrt"
Import "more.pbrt"
"""
_MORE = """# more
AttributeBegin
    Shape "sphere"
AttributeEnd
"""
_PLY = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
0 0 0
1 0 0
0 1 0
3 0 1 2
"""


def everything(folder: Path) -> tuple[Path, list[str]]:
    """Writes the scene; returns its path, and the texts of all directives that it reads."""
    rng = np.random.default_rng(2)
    picture(folder / "colors.png", rng.integers(0, 256, (8, 8, 3)).astype(np.uint8))
    picture(folder / "sky.exr", rng.random((8, 8, 3)).astype(np.float32))
    picture(folder / "grey.exr", rng.random((8, 8, 3)).astype(np.float32))
    (folder / "more.pbrt").write_text(_MORE)
    (folder / "triangle.ply").write_text(_PLY)
    path = folder / "scene.pbrt"
    text = f"{_OPTIONS}WorldBegin{_WORLD}"
    path.write_text(text)
    return path, [text, _MORE, _MORE]
