"""Scenes in which lenses are compared; see scenes/lens_scenes.py."""
