"""Reads scenes of Mitsuba 3, and those of Mitsuba 0.5 to 2 by the rules of Mitsuba's own loader."""
