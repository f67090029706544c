"""Where the pixels of a camera look: rays of its own, and maps that straighten its pictures."""
