"""Scenes and cameras as the core takes them, in its units and its order."""
