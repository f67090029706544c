"""Kit of the example scenes: shapes and textures as arrays, and a small GLB writer."""
