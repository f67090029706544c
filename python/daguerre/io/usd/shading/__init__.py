"""Shading of USD stages: networks and MaterialX graphs to the renderer's materials."""
