"""Renders: sessions, passes, checkpoints, merging, ground truth."""
