"""The camera of a photograph: its facts, its noise and its sharpness, for objects put into it."""
