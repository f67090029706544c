"""Scenes that motion.py makes: each shows one way in which a picture blurs."""
