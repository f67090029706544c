"""Files: parsed values that keep their place for error messages, and atomic writing."""
