"""Blender's evaluated data to scenes and cameras; needs ``bpy``, which Blender gives."""
