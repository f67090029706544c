"""File formats: each folder or file converts between a format's bytes and Daguerre's objects."""
