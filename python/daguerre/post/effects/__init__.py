"""Effects of the darkroom, one file each."""
