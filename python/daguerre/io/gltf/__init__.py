"""glTF 2.0 scenes: ``reader`` is the page where nodes, meshes, materials and cameras meet."""
