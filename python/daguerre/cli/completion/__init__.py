"""Completion of command lines by shells: ``daguerre __complete`` answers a TAB.

It must be quick, so it loads neither Typer nor NumPy: ``words.json`` holds the commands, flags and
words that the program knows (``making.py`` writes it; a test compares it with the program).
"""
