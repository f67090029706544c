"""Scenes of examples/calibrated.py, and files of calibrations."""
