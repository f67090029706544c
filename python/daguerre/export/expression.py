"""Arithmetic as a value: what every target language writes in its own words.

A `Function` is a list of statements on scalars without loops. Numbers, names and operators look the
same in C, GLSL, OSL and Python; the rest is for `printers`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

Operand: TypeAlias = "Expression | float"


class Expression:
    """Something with a value; operators make larger ones."""

    def __add__(self, other: Operand) -> Expression:
        return _sum(self, lift(other))

    def __radd__(self, other: float) -> Expression:
        return _sum(lift(other), self)

    def __sub__(self, other: Operand) -> Expression:
        return self if lift(other) == Number(0.0) else Binary("-", self, lift(other))

    def __rsub__(self, other: float) -> Expression:
        return Binary("-", lift(other), self)

    def __mul__(self, other: Operand) -> Expression:
        return _product(self, lift(other))

    def __rmul__(self, other: float) -> Expression:
        return _product(lift(other), self)

    def __truediv__(self, other: Operand) -> Expression:
        return Binary("/", self, lift(other))

    def __rtruediv__(self, other: float) -> Expression:
        return Binary("/", lift(other), self)

    def __neg__(self) -> Expression:
        return Binary("-", Number(0.0), self)

    def __lt__(self, other: Operand) -> Condition:
        return Condition(self, lift(other))

    def __gt__(self, other: Operand) -> Condition:
        return Condition(lift(other), self)


@dataclass(frozen=True)
class Number(Expression):
    """A constant."""

    value: float


@dataclass(frozen=True)
class Name(Expression):
    """An input, or what a statement has named."""

    name: str


@dataclass(frozen=True)
class Binary(Expression):
    """Two operands and one of + - * /."""

    operator: str
    left: Expression
    right: Expression


@dataclass(frozen=True)
class Call(Expression):
    """A function that all languages have: sqrt, sin, cos, abs, min, max, floor."""

    function: str
    arguments: tuple[Expression, ...]


@dataclass(frozen=True)
class Condition:
    """Left < right."""

    left: Expression
    right: Expression


@dataclass(frozen=True)
class Select(Expression):
    """One of two values; both are computed."""

    condition: Condition
    yes: Expression
    no: Expression


def lift(value: Operand) -> Expression:
    """A number as an expression."""
    return value if isinstance(value, Expression) else Number(float(value))


def call(function: str, *arguments: Operand) -> Expression:
    """A function's value, such as that of max."""
    return Call(function, tuple(lift(a) for a in arguments))


def select(condition: Condition, yes: Operand, no: Operand) -> Expression:
    """``condition ? yes : no``."""
    return Select(condition, lift(yes), lift(no))


def _sum(left: Expression, right: Expression) -> Expression:
    if left == Number(0.0):
        return right
    return left if right == Number(0.0) else Binary("+", left, right)


def _product(left: Expression, right: Expression) -> Expression:
    if Number(0.0) in (left, right):
        return Number(0.0)
    if left == Number(1.0):
        return right
    return left if right == Number(1.0) else Binary("*", left, right)


@dataclass(frozen=True)
class Let:
    """A new name for a value."""

    name: str
    value: Expression


@dataclass(frozen=True)
class LetCall:
    """New names for the outputs of a function."""

    names: tuple[str, ...]
    function: Function
    arguments: tuple[Expression, ...]


@dataclass(frozen=True)
class LetOneOf:
    """New names for the outputs of the first function whose condition holds, else of the last."""

    names: tuple[str, ...]
    conditions: tuple[Condition, ...]
    functions: tuple[Function, ...]
    arguments: tuple[Expression, ...]


@dataclass
class Function:
    """Scalars in, scalars out; statements in order. Outputs are names that statements give."""

    name: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    comment: str = ""
    statements: list[Let | LetCall | LetOneOf] = field(default_factory=list)
    _count: int = 0

    def let(self, name: str, value: Operand) -> Name:
        """Names a value; returns the name."""
        self.statements.append(Let(name, lift(value)))
        return Name(name)

    def temporary(self, value: Operand) -> Expression:
        """A value that is used more than once, under a name of its own."""
        expression = lift(value)
        if isinstance(expression, Number | Name):
            return expression
        self._count += 1
        return self.let(f"t{self._count}", expression)

    def results(self, function: Function, *arguments: Operand) -> tuple[Name, ...]:
        """Calls a function."""
        return self.one_of((), (function,), *arguments)

    def one_of(
        self,
        conditions: tuple[Condition, ...],
        functions: tuple[Function, ...],
        *arguments: Operand,
    ) -> tuple[Name, ...]:
        """Calls the first function whose condition holds, the last if none does."""
        names = []
        for _ in functions[0].outputs:
            self._count += 1
            names.append(f"t{self._count}")
        lifted = tuple(lift(a) for a in arguments)
        if conditions:
            self.statements.append(LetOneOf(tuple(names), conditions, functions, lifted))
        else:
            self.statements.append(LetCall(tuple(names), functions[0], lifted))
        return tuple(Name(n) for n in names)
