"""Kinds of surfaces: one file each, plain values with fields that ``checks.py`` checks."""
