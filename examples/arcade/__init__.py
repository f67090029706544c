"""The arcade at night, in which lenses are compared; see examples/arcade.py."""
