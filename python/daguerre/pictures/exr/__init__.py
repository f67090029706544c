"""Reads and writes OpenEXR files: frames, blocks of rows, headers."""
