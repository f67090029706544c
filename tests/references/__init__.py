"""Pictures of an independent renderer, and the scenes that they show."""
