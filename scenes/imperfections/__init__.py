"""Scenes that show one imperfection of lenses each."""
