"""Readers of scene formats, meshes, grids and light profiles, one folder or file each."""
