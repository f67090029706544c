"""Shading graphs to the renderer's materials: values, pictures, nodes and surfaces."""
