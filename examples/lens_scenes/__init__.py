"""Scenes in which lenses are compared; see examples/lens_scenes.py."""
