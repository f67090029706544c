"""Matches the camera of a photograph: settings, noise and sharpness, for compositing objects."""
