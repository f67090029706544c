"""Arithmetic expressions, which `printers` write in each target language.

A `Function` is a list of statements on scalars without loops. Numbers, names and operators are
similar in C, GLSL, OSL and Python; `printers` handle the differences.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

Operand: TypeAlias = "Expression | float"


class Expression:
    """Expression; operators combine expressions."""

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
    """Name of an input, or of a statement's result."""

    name: str


@dataclass(frozen=True)
class Binary(Expression):
    """Binary operation: + - * /."""

    operator: str
    left: Expression
    right: Expression


@dataclass(frozen=True)
class Call(Expression):
    """Call of a function of all languages: sqrt, sin, cos, abs, min, max, floor."""

    function: str
    arguments: tuple[Expression, ...]


@dataclass(frozen=True)
class Condition:
    """Condition: left < right."""

    left: Expression
    right: Expression


@dataclass(frozen=True)
class Select(Expression):
    """One of two values; both may be computed."""

    condition: Condition
    yes: Expression
    no: Expression


def lift(value: Operand) -> Expression:
    """Converts a number to an expression."""
    return value if isinstance(value, Expression) else Number(float(value))


def call(function: str, *arguments: Operand) -> Expression:
    """Calls a function, such as max."""
    return Call(function, tuple(lift(a) for a in arguments))


def select(condition: Condition, yes: Operand, no: Operand) -> Expression:
    """Selects a value: ``condition ? yes : no``."""
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
    """Statement that names a value."""

    name: str
    value: Expression


@dataclass(frozen=True)
class LetCall:
    """Statement that names the outputs of a function."""

    names: tuple[str, ...]
    function: Function
    arguments: tuple[Expression, ...]


@dataclass(frozen=True)
class LetOneOf:
    """Statement that names outputs of the first function with a true condition, else the last."""

    names: tuple[str, ...]
    conditions: tuple[Condition, ...]
    functions: tuple[Function, ...]
    arguments: tuple[Expression, ...]


@dataclass
class Function:
    """Function of scalars, with statements in order; statements must name all outputs."""

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
        """Names a value that is used more than once."""
        expression = lift(value)
        if isinstance(expression, Number | Name):
            return expression
        self._count += 1
        return self.let(f"t{self._count}", expression)

    def results(self, function: Function, *arguments: Operand) -> tuple[Name, ...]:
        """Calls a function; returns the names of its outputs."""
        return self.one_of((), (function,), *arguments)

    def one_of(
        self,
        conditions: tuple[Condition, ...],
        functions: tuple[Function, ...],
        *arguments: Operand,
    ) -> tuple[Name, ...]:
        """Calls the first function with a true condition, or else the last."""
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
