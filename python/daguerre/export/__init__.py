"""Exports fitted lenses: C, GLSL, OSL for Blender's custom camera, NumPy and JSON."""

from .files import SUFFIXES, check_suffix, code, save

__all__ = ["SUFFIXES", "check_suffix", "code", "save"]
