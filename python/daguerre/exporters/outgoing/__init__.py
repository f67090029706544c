"""Scenes on their way to other renderers: what every writer of them shares."""
