"""Photographs as plates: their light, and what is put into them."""
