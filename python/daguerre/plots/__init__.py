"""Drawings of lenses, sensors and measurements, as SVG or with matplotlib."""
