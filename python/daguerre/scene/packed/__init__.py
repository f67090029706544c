"""Scenes as they are, packed into a chunk of a .glb file beside glTF's own content.

``parts.py`` takes a scene apart, ``rebuild.py`` puts one together and checks each part,
and ``chunk.py`` writes and reads the bytes. What is read may come from strangers: ``values.py``
lists all classes that it may name, and makes each by its own checks.
"""

#: Type of the chunk: the letters DGSC.
CHUNK = int.from_bytes(b"DGSC", "little")
