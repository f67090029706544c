"""Writers of scenes and cameras for other programs, one folder or file each."""
