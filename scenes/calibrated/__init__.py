"""Parts of the scene that calibrated.py makes, and files of calibrations."""
