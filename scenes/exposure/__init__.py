"""Scenes that exposure.py makes."""
