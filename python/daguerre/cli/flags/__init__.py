"""Flags shared by commands, by group."""
