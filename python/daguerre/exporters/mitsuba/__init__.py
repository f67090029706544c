"""Writes scenes of Mitsuba 3."""
