"""Translates Blender's evaluated scenes, cameras and settings; needs ``bpy``, which Blender has.

Nothing else of the package imports this room. Blender is z-up and measures in units of
``scale_length`` metres; a ``Scene`` is y-up and in metres: (x, y, z) of Blender is (x, z, -y).
Objects keep their own axes, so that lights and cameras look along their -z in both. ``settings.py``
says how light is converted.
"""
