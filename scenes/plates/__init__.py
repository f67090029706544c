"""Scenes of the page "Into the plate"."""
