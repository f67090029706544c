"""Reads scenes of pbrt-v4 and pbrt-v3, and writes those of pbrt-v4."""
