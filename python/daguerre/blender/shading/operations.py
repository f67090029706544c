"""Table of the nodes that are supported, besides shaders."""

from __future__ import annotations

from collections.abc import Callable

from daguerre.shading.evaluate import Operation

from . import color_nodes, math_nodes, normal_nodes, pattern_nodes, simple_nodes, texture_nodes
from .network import GREY, MEAN


def operations(size_of: Callable[[str], float]) -> dict[str, Operation]:
    """Functions of the nodes by kind.

    Args:
        size_of: Gives the length of one unit of texture coordinates, by their name, on the surface
            of the material, in scene units.
    """
    return {**_FIXED, "ShaderNodeBump": normal_nodes.bump(size_of)}


_FIXED: dict[str, Operation] = {
    GREY: color_nodes.grey,
    MEAN: math_nodes.mean,
    "ShaderNodeTexImage": texture_nodes.image,
    "ShaderNodeTexCoord": texture_nodes.texture_coordinates,
    "ShaderNodeNewGeometry": texture_nodes.geometry,
    "ShaderNodeUVMap": texture_nodes.uv_map,
    "ShaderNodeVertexColor": texture_nodes.color_attribute,
    "ShaderNodeAttribute": texture_nodes.color_attribute,
    "ShaderNodeMapping": texture_nodes.mapping,
    "ShaderNodeTexNoise": pattern_nodes.noise,
    "ShaderNodeTexWhiteNoise": pattern_nodes.white_noise,
    "ShaderNodeTexVoronoi": pattern_nodes.voronoi_texture,
    "ShaderNodeTexWave": simple_nodes.wave,
    "ShaderNodeTexGradient": simple_nodes.gradient,
    "ShaderNodeTexMagic": simple_nodes.magic,
    "ShaderNodeTexBrick": simple_nodes.brick,
    "ShaderNodeTexChecker": simple_nodes.checker,
    "ShaderNodeTexGabor": pattern_nodes.unknown,
    "ShaderNodeFresnel": texture_nodes.fresnel,
    "ShaderNodeLayerWeight": texture_nodes.layer_weight,
    "ShaderNodeNormalMap": normal_nodes.normal_map,
    "ShaderNodeValue": math_nodes.constant,
    "ShaderNodeRGB": math_nodes.constant,
    "ShaderNodeMath": math_nodes.math,
    "ShaderNodeVectorMath": math_nodes.vector_math,
    "ShaderNodeClamp": math_nodes.clamp,
    "ShaderNodeMapRange": math_nodes.map_range,
    "ShaderNodeSeparateXYZ": math_nodes.separate_xyz,
    "ShaderNodeCombineXYZ": math_nodes.combine_xyz,
    "ShaderNodeSeparateColor": color_nodes.separate_color,
    "ShaderNodeCombineColor": color_nodes.combine_color,
    "ShaderNodeMix": color_nodes.mix,
    "ShaderNodeMixRGB": color_nodes.mix_rgb,
    "ShaderNodeInvert": color_nodes.invert,
    "ShaderNodeGamma": color_nodes.gamma,
    "ShaderNodeBrightContrast": color_nodes.brightness,
    "ShaderNodeHueSaturation": color_nodes.hue_saturation,
    "ShaderNodeRGBToBW": color_nodes.rgb_to_bw,
    "ShaderNodeValToRGB": color_nodes.color_ramp,
    "ShaderNodeRGBCurve": color_nodes.curves,
    "ShaderNodeVectorCurve": color_nodes.curves,
    "ShaderNodeFloatCurve": color_nodes.float_curve,
}
