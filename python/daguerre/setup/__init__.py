"""Set-up: converts scenes and cameras to the core's form and units."""
