"""Writes cameras as USD."""
