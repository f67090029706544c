"""Faults from outside: kills, full disks, lost power, closed streams, long nights."""
