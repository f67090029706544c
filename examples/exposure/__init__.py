"""Scenes of examples/exposure.py."""
