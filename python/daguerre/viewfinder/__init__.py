"""The viewfinder: a page with the picture that a camera sees, and its rings to turn."""

from __future__ import annotations
