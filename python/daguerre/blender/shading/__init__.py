"""Node trees of Blender's materials to the renderer's materials."""
