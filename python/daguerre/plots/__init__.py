"""Draws lenses, sensors and measurements, as SVG or with matplotlib."""
