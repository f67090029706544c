"""Groups of flags that several commands share: data classes with the flags as fields.

A command has a group as one of its parameters, and :func:`with_flags` puts the group's fields into
the signature that Typer reads. Annotations must be real objects here, so no ``annotations`` future.
"""

import inspect
from collections.abc import Callable
from dataclasses import MISSING, Field, fields
from typing import Any

import typer

Text = str | None


def option(*names: str, help: str, metavar: str | None = None, panel: str | None = None) -> Any:
    """Declares a flag."""
    return typer.Option(
        *names, help=help, metavar=metavar, rich_help_panel=panel, show_default=False
    )


def _parameter(field: Field[Any]) -> inspect.Parameter:
    default = inspect.Parameter.empty if field.default is MISSING else field.default
    kind = inspect.Parameter.KEYWORD_ONLY
    return inspect.Parameter(field.name, kind, default=default, annotation=field.type)


def with_flags(**groups: type) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Replaces the parameters named in ``groups`` by the flags of those data classes."""

    def decorate(command: Callable[..., Any]) -> Callable[..., Any]:
        parameters = []
        for parameter in inspect.signature(command, eval_str=True).parameters.values():
            group = groups.get(parameter.name)
            parameters += (
                [parameter.replace(kind=parameter.KEYWORD_ONLY)]
                if group is None
                else [_parameter(one) for one in fields(group)]
            )

        def run(**values: object) -> Any:
            made = {
                name: group(**{f.name: values.pop(f.name) for f in fields(group)})
                for name, group in groups.items()
            }
            return command(**values, **made)

        run.__name__, run.__doc__ = command.__name__, command.__doc__
        run.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
        run.__annotations__ = {p.name: p.annotation for p in parameters}
        return run

    return decorate
