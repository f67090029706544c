"""Formulas of Blender's pattern textures in numpy, on coordinates of single precision."""
