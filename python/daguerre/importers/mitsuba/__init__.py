"""Reads scenes of Mitsuba 3, and scenes of 0.5 to 2 by Mitsuba's upgrade rules."""
