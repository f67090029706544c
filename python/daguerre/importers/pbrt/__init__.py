"""Reads scenes of pbrt-v4 and pbrt-v3, and writes scenes of pbrt-v4."""
