"""Distributions of the normals of microfacets."""

from __future__ import annotations

from typing import Literal

#: GGX (Walter et al. 2007), or Beckmann's.
Distribution = Literal["ggx", "beckmann"]
DISTRIBUTIONS: tuple[Distribution, ...] = ("ggx", "beckmann")
