"""Cameras in a photographer's terms: mm, m, s, degrees."""
