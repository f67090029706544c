"""What the example scenes are made with: shapes and textures as arrays, and a small GLB writer."""
