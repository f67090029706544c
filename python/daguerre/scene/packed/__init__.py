"""Scenes as they are, packed into a chunk of a .glb file beside glTF's own content.

``parts.py`` takes a scene apart, ``rebuild.py`` puts one together and checks each part,
and ``chunk.py`` writes and reads the bytes. Files may come from strangers: ``values.py`` lists all
classes that a file may name, and makes each value by the checks of its class.
"""

#: Type of the chunk: the letters DGSC.
CHUNK = int.from_bytes(b"DGSC", "little")
