"""Indices of refraction by name, at 589 nm.

Source: the table in the documentation of Mitsuba's ``dielectric``, mostly from Hecht, Optics,
4th edition.
"""

from __future__ import annotations

from .node import Node

IOR = {
    "vacuum": 1.0,
    "helium": 1.000036,
    "hydrogen": 1.000132,
    "air": 1.000277,
    "carbon dioxide": 1.00045,
    "water": 1.3330,
    "acetone": 1.36,
    "ethanol": 1.361,
    "carbon tetrachloride": 1.461,
    "glycerol": 1.4729,
    "benzene": 1.501,
    "silicone oil": 1.52045,
    "bromine": 1.661,
    "water ice": 1.31,
    "fused quartz": 1.458,
    "pyrex": 1.470,
    "acrylic glass": 1.49,
    "polypropylene": 1.49,
    "bk7": 1.5046,
    "sodium chloride": 1.544,
    "amber": 1.55,
    "pet": 1.5750,
    "diamond": 2.419,
}


def relative_index(node: Node, inside: str) -> float:
    """Ratio of the indices inside and outside of a surface.

    Args:
        node: Material with ``int_ior`` and ``ext_ior``.
        inside: Name of the default inside; the default outside is air.

    Raises:
        InputError: A name is unknown, or a number out of its range.
    """
    found = _index(node, "int_ior", inside) / _index(node, "ext_ior", "air")
    if not 0.1 <= found <= 10:
        node.fail(f"int_ior: wanted 0.1 to 10 times ext_ior, got {found:g}")
    return found


def _index(node: Node, name: str, default: str) -> float:
    found = node.find(name)
    if found is not None and found.tag in ("float", "integer"):
        return node.number(name, 1.0, above=0)
    word = node.text(name, default).strip().lower()
    if word not in IOR:
        node.fail(f"{name}: wanted a number or one of {', '.join(IOR)}, got {word[:40]!r}")
    return IOR[word]
