"""Scenes of examples/motion.py: each shows one way in which a picture blurs."""
