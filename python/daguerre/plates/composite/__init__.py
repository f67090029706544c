"""Composites rendered objects into photographs: in linear light, or in electrons of a raw file."""
