"""Objects into a photograph: over light, and in the electrons of a raw picture."""
