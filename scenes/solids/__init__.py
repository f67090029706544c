"""Solids in solids: a pool, the housings of a camera in it, and a paperweight."""
