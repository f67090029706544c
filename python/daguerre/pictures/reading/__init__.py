"""Reads pictures of other programs: their kind by their bytes, checks of their heads, their pixels.

PNG, JPEG, WebP, Radiance, plain TIFF and TGA are decoded in this process, all others apart.
"""
