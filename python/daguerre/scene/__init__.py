"""Scenes: meshes, instances, materials, lights, cameras, environment, and their motion."""
