"""Reads files of grids of numbers in space: Mitsuba's ``.vol`` and NanoVDB's ``.nvdb``."""
