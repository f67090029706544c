"""OpenEXR files: frames written and read, rows in blocks, headers."""
