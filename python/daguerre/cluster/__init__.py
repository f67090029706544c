"""Cluster: one picture or sequence, drawn by many machines with the bits of one."""
