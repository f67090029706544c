"""Cluster: many machines draw a picture or a sequence, bit for bit as a single machine."""
