"""Reads scenes of pbrt-v4 and pbrt-v3."""
