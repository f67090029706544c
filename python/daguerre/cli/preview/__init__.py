"""Previews of pictures that are being drawn, in a terminal or in a file."""
