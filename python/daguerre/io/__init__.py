"""File formats: one folder or file each, bytes on one side and the object model on the other."""
