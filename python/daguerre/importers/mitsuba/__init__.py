"""Reads and writes scenes of Mitsuba 3; reads those of 0.5 to 2 by Mitsuba's own rules."""
