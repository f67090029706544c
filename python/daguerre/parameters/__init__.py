"""Parameters: each declared once, for flags, checks, JSON, docstrings and documentation."""
