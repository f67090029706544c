"""Reads glTF 2.0 scenes; ``reader`` joins nodes, meshes, materials and cameras."""
