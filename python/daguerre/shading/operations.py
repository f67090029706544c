"""Table of the shading nodes that are supported."""

from __future__ import annotations

import numpy as np

from . import coordinate_nodes, math_nodes, texture_nodes
from .evaluate import Operation

_READERS = ("float", "float2", "float3", "float4", "int", "point", "normal", "vector")
_MATERIALX_READERS = ("vector2", "vector3", "vector4", "integer", "boolean")

OPERATIONS: dict[str, Operation] = {
    "UsdUVTexture": texture_nodes.usd_texture,
    "UsdTransform2d": coordinate_nodes.usd_transform,
    "UsdPrimvarReader": coordinate_nodes.usd_primvar,
    **{
        f"UsdPrimvarReader_{kind}": coordinate_nodes.usd_primvar
        for kind in (*_READERS, *_MATERIALX_READERS)
    },
    "image": texture_nodes.image,
    "tiledimage": texture_nodes.tiled_image,
    "gltf_image": texture_nodes.gltf_image,
    "gltf_colorimage": texture_nodes.gltf_color_image,
    "gltf_normalmap": texture_nodes.gltf_normal_map,
    "normalmap": texture_nodes.normal_map,
    "texcoord": coordinate_nodes.texture_coordinates,
    "geomcolor": coordinate_nodes.geometry_color,
    "geompropvalue": coordinate_nodes.geometry_property,
    "geompropvalueuniform": coordinate_nodes.geometry_property,
    "place2d": coordinate_nodes.place,
    "rotate2d": coordinate_nodes.rotate,
    "constant": math_nodes.constant,
    "dot": math_nodes.passed,
    "convert": math_nodes.convert,
    "add": math_nodes.binary("add", 0.0, 0.0),
    "subtract": math_nodes.binary("subtract", 0.0, 0.0),
    "multiply": math_nodes.binary("multiply", 0.0, 1.0),
    "divide": math_nodes.binary("divide", 0.0, 1.0),
    "power": math_nodes.binary("power", 0.0, 1.0),
    "safepower": math_nodes.each_of_two(lambda a, b: np.sign(a) * np.power(np.abs(a), b), 0.0, 1.0),
    "modulo": math_nodes.each_of_two(lambda a, b: a - b * np.floor(a / b), 0.0, 1.0),
    "min": math_nodes.each_of_two(np.minimum, 0.0, 0.0),
    "max": math_nodes.each_of_two(np.maximum, 0.0, 0.0),
    "absval": math_nodes.unary(np.abs),
    "sign": math_nodes.unary(np.sign),
    "floor": math_nodes.unary(np.floor),
    "ceil": math_nodes.unary(np.ceil),
    "round": math_nodes.unary(lambda v: np.floor(v + 0.5)),
    "fract": math_nodes.unary(lambda v: v - np.floor(v)),
    "sqrt": math_nodes.unary(np.sqrt),
    "exp": math_nodes.unary(np.exp),
    "ln": math_nodes.unary(np.log),
    "sin": math_nodes.unary(np.sin),
    "cos": math_nodes.unary(np.cos),
    "tan": math_nodes.unary(np.tan),
    "mix": math_nodes.mix,
    "clamp": math_nodes.clamp,
    "invert": math_nodes.invert,
    "remap": math_nodes.remap,
    "smoothstep": math_nodes.smoothstep,
    "contrast": math_nodes.contrast,
    "luminance": math_nodes.luminance,
    "saturate": math_nodes.saturate,
    "rgbtohsv": math_nodes.of_three(math_nodes.hsv_from_rgb),
    "hsvtorgb": math_nodes.of_three(math_nodes.rgb_from_hsv),
    "dotproduct": math_nodes.dot_product,
    "magnitude": math_nodes.magnitude,
    "normalize": math_nodes.normalize,
    "combine2": math_nodes.combine,
    "combine3": math_nodes.combine,
    "combine4": math_nodes.combine,
    "separate2": math_nodes.separate,
    "separate3": math_nodes.separate,
    "separate4": math_nodes.separate,
    "extract": math_nodes.extract,
    "swizzle": math_nodes.swizzle,
    "ifgreater": math_nodes.compared(lambda a, b: a > b),
    "ifgreatereq": math_nodes.compared(lambda a, b: a >= b),
    "ifequal": math_nodes.compared(lambda a, b: a == b, first=0.0),
    "switch": math_nodes.switch,
}
