"""Reads files of a single mesh: PLY, OBJ and Mitsuba's serialized meshes.

Each reader returns a :class:`~daguerre.importers.meshes.file_mesh.FileMesh` with the numbers of the
file. Readers of scenes give it a transform, a material and the direction of v of their format.
"""
