"""Photographs as plates: matching their camera, compositing into them, and lighting by them."""
