"""``daguerre render``: from flags to finished files."""
