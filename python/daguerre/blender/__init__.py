"""Translates Blender's evaluated scenes; needs ``bpy``, which Blender and its wheel have.

Nothing else of the package imports this room. Frames: Blender is z-up, in units of the scene; a
``Scene`` is y-up, in metres.
"""
