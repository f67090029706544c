"""Scenes for other renderers: the steps that all writers share."""
