"""Kinds of surfaces: one file each, plain values whose fields ``checks.py`` checks."""
