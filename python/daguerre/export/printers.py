"""Print `expression` in each language."""

from __future__ import annotations

from typing import ClassVar

from .expression import (
    Binary,
    Call,
    Condition,
    Expression,
    Function,
    Let,
    LetCall,
    LetOneOf,
    Name,
    Number,
    Select,
)

#: Precedence of operators.
BINDING = {"+": 1, "-": 1, "*": 2, "/": 2}

Words = dict[str, str]
FUNCTIONS = ("sqrt", "sin", "cos", "abs", "min", "max", "floor")


class Printer:
    """Shared syntax of the languages of C's family."""

    number_type = "float"
    digits = 9  # digits of a number, enough for its type
    functions: ClassVar[Words] = {n: n for n in FUNCTIONS}
    prefix = ""  # prefix of a function's definition
    comment = "//"

    def number(self, value: float) -> str:
        """Prints a number so that no language reads an integer."""
        text = f"{value:.{self.digits}g}"
        return text if any(c in text for c in ".en") else text + ".0"

    def show(self, e: Expression, within: int = 0) -> str:
        """Prints an expression, in parentheses if its context has a higher precedence."""
        match e:
            case Number(value):
                text = self.number(value)
                return f"({text})" if value < 0 and within else text
            case Name(name):
                return name
            case Binary(operator, left, right):
                # The right operand gets parentheses at equal precedence, too: a - (b - c).
                tight = BINDING[operator]
                text = f"{self.show(left, tight)} {operator} {self.show(right, tight + 1)}"
                return f"({text})" if tight < within else text
            case Call(function, arguments):
                return f"{self.functions[function]}({', '.join(self.show(a) for a in arguments)})"
            case Select():
                text = self.selection(e)
                return f"({text})" if within else text
        raise TypeError(e)

    def selection(self, e: Select) -> str:
        """Prints a choice of two values."""
        return f"{self.condition(e.condition)} ? {self.show(e.yes, 1)} : {self.show(e.no, 1)}"

    def condition(self, c: Condition) -> str:
        """Prints ``a < b``."""
        return f"{self.show(c.left, 1)} < {self.show(c.right, 1)}"

    def signature(self, f: Function) -> str:
        """Prints the first line of a definition."""
        inputs = [f"{self.number_type} {name}" for name in f.inputs]
        outputs = [self.output(name) for name in f.outputs]
        return f"{self.prefix}void {f.name}({', '.join(inputs + outputs)})"

    def output(self, name: str) -> str:
        """Prints an output in a signature."""
        return f"out {self.number_type} {name}"

    def passed(self, name: str) -> str:
        """Prints a variable that receives an output of a call."""
        return name

    def assigned(self, name: str) -> str:
        """Prints an output on the left of an assignment."""
        return name

    def define(self, f: Function) -> str:
        """Prints a whole function."""
        lines = [f"{self.comment} {line}" for line in f.comment.splitlines()]
        lines += [self.signature(f), "{"]
        for s in f.statements:
            lines += ["    " + line for line in self.statement(s, f)]
        return "\n".join([*lines, "}"])

    def statement(self, s: Let | LetCall | LetOneOf, f: Function) -> list[str]:
        """Lines of one statement."""
        match s:
            case Let(name, value):
                if name in f.outputs:
                    return [f"{self.assigned(name)} = {self.show(value)};"]
                return [f"{self.number_type} {name} = {self.show(value)};"]
            case LetCall(names, function, arguments):
                return [self._declared(names), self._call(function, arguments, names)]
            case LetOneOf(names, conditions, functions, arguments):
                lines = [self._declared(names)]
                for i, function in enumerate(functions):
                    head = "else " if i else ""
                    if i < len(conditions):
                        head += f"if ({self.condition(conditions[i])}) "
                    lines.append(head + self._call(function, arguments, names))
                return lines

    def _declared(self, names: tuple[str, ...]) -> str:
        return f"{self.number_type} {', '.join(names)};"

    def _call(self, f: Function, arguments: tuple[Expression, ...], names: tuple[str, ...]) -> str:
        passed = [self.show(a) for a in arguments] + [self.passed(n) for n in names]
        return f"{f.name}({', '.join(passed)});"


#: Suffixes of functions for users, and the macro that sets their visibility.
CALLED = ("_sample", "_evaluate")
VISIBLE = "DAGUERRE_API"


class C(Printer):
    """C99 in double."""

    number_type = "double"
    digits = 17
    functions: ClassVar[Words] = {
        **Printer.functions,
        "abs": "fabs",
        "min": "fmin",
        "max": "fmax",
    }
    prefix = "static "

    def signature(self, f: Function) -> str:
        """Prints a signature; functions for users get ``VISIBLE``, others stay static."""
        line = super().signature(f)
        return line.replace(self.prefix, f"{VISIBLE} ", 1) if f.name.endswith(CALLED) else line

    def output(self, name: str) -> str:
        """Prints a pointer."""
        return f"double *{name}"

    def passed(self, name: str) -> str:
        """Prints the address of a variable."""
        return "&" + name

    def assigned(self, name: str) -> str:
        """Dereferences a pointer."""
        return "*" + name


class Glsl(Printer):
    """GLSL 3.30 and GLSL ES 3.00."""


class NumPy(Printer):
    """Python on whole arrays; all branches are computed before the choice."""

    digits = 17
    functions: ClassVar[Words] = {n: f"np.{n}" for n in FUNCTIONS} | {
        "min": "np.minimum",
        "max": "np.maximum",
    }
    comment = "#"

    def selection(self, e: Select) -> str:
        """Prints a choice of two values."""
        parts = self.condition(e.condition), self.show(e.yes), self.show(e.no)
        return f"np.where({', '.join(parts)})"

    def define(self, f: Function) -> str:
        """Prints a whole function."""
        lines = [f"def {f.name}({', '.join(f.inputs)}):"]
        if f.comment:
            lines.append(f'    """{f.comment}"""')
        for s in f.statements:
            lines += ["    " + line for line in self.statement(s, f)]
        return "\n".join([*lines, f"    return {', '.join(f.outputs)}"])

    def statement(self, s: Let | LetCall | LetOneOf, f: Function) -> list[str]:
        """Lines of one statement."""
        match s:
            case Let(name, value):
                return [f"{name} = {self.show(value)}"]
            case LetCall(names, function, arguments):
                shown = ", ".join(self.show(a) for a in arguments)
                return [f"{', '.join(names)} = {function.name}({shown})"]
            case LetOneOf(names, conditions, functions, arguments):
                shown = ", ".join(self.show(a) for a in arguments)
                cases = ", ".join(map(self.condition, conditions))
                branches = ", ".join(function.name for function in functions)
                return [f"{', '.join(names)} = _one_of([{cases}], [{branches}], {shown})"]
