"""Fitted lenses as code: C, GLSL, OSL for Blender's custom camera, NumPy; and as JSON."""
