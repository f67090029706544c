"""Polynomials as nested Horner schemes, which need no powers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from .expression import Expression, Function, Number

#: Coefficients by exponents, one exponent for each variable.
Terms = Mapping[tuple[int, ...], float]

#: Polynomials in this many last variables stay one expression; others get named parts.
INLINE_VARIABLES = 2


def horner(function: Function, terms: Terms, variables: Sequence[Expression]) -> Expression:
    """Makes the value of a polynomial, with the first variable outermost.

    Args:
        function: Function that receives statements for intermediate results.
        terms: Coefficients by exponents.
        variables: One expression for each exponent.
    """
    terms = {exponents: c for exponents, c in terms.items() if c != 0.0}
    if not variables:
        return Number(terms.get((), 0.0))
    if not terms:
        return Number(0.0)
    by_power: dict[int, dict[tuple[int, ...], float]] = {}
    for exponents, c in terms.items():
        by_power.setdefault(exponents[0], {})[exponents[1:]] = c
    x, rest = variables[0], variables[1:]
    value: Expression = Number(0.0)
    for power in range(max(by_power), -1, -1):
        value = value * x + horner(function, by_power.get(power, {}), rest)
        if len(rest) >= INLINE_VARIABLES:
            value = function.temporary(value)
    return value


def derivative(terms: Terms, variable: int) -> dict[tuple[int, ...], float]:
    """Terms of the derivative with respect to a variable, by its index."""
    return {
        (*e[:variable], e[variable] - 1, *e[variable + 1 :]): c * e[variable]
        for e, c in terms.items()
        if e[variable] > 0
    }
