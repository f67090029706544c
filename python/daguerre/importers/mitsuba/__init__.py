"""Reads and writes scenes of Mitsuba 3; reads scenes of 0.5 to 2 by Mitsuba's upgrade rules."""
