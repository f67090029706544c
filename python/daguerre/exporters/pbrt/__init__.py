"""Writes scenes of pbrt-v4."""
