"""The library's models and their parameters, read from its own table: a new model needs nothing here.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import html
import inspect
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Union

from ._library import ffi, lib, text
from ._material import Material

Default = Union[float, str, "tuple[float, float, float]"]


@dataclass(frozen=True)
class Parameter:
    """One parameter of a model: its kind, its range, its default."""

    name: str
    kind: str
    """"number", "colour" (one number, or red, green and blue) or "choice"."""
    low: float
    """The least value, included; 0 for a choice."""
    high: float
    """The greatest value, included."""
    default: Default
    """A number, three numbers, or the name of a choice."""
    unit: str
    """"1" for what has no unit."""
    choices: tuple[str, ...]
    """The names of a choice, else empty."""
    description: str

    @property
    def range(self) -> str:
        """The range in words: "0 to 1", "correlated|separable"."""
        return "|".join(self.choices) if self.choices else f"{self.low:g} to {self.high:g}"

    @property
    def default_text(self) -> str:
        """The default as it is written in a specification."""
        if isinstance(self.default, tuple):
            same = len(set(self.default)) == 1
            return f"{self.default[0]:g}" if same else ",".join(f"{x:g}" for x in self.default)
        return self.default if isinstance(self.default, str) else f"{self.default:g}"


_KINDS = {lib.FACET_NUMBER: "number", lib.FACET_COLOUR: "colour", lib.FACET_CHOICE: "choice"}


def _parameter(c: Any) -> Parameter:
    kind = _KINDS[c.kind]
    choices = tuple(text(c.choices).split("|")) if kind == "choice" else ()
    initial = (c.initial[0], c.initial[1], c.initial[2])
    default: Default = initial if kind == "colour" else choices[int(initial[0])] if choices else initial[0]
    return Parameter(text(c.name), kind, c.low, c.high, default, text(c.unit), choices, text(c.description))


class Model:
    """A reflection model: call it with parameters by name to make a material.

    >>> import facet
    >>> facet.ggx(alpha=0.2)
    facet.material('ggx alpha=0.2')
    >>> facet.ggx.parameters["alpha"].high
    4.0
    """

    name: str
    """As it is written in specifications."""
    summary: str
    """One line."""
    source: str
    """The paper and equations that it implements."""
    parameters: Mapping[str, Parameter]
    """The table of parameters, by name, in order."""

    def __init__(self, info: Any) -> None:
        self.name = self.__name__ = text(info.name)
        self.summary = text(info.summary)
        self.source = text(info.source)
        table = [_parameter(info.parameters[i]) for i in range(info.n_parameters)]
        self.parameters = MappingProxyType({p.name: p for p in table})
        self.__doc__ = self._describe(table)
        self.__signature__ = inspect.Signature(
            [inspect.Parameter(p.name, inspect.Parameter.KEYWORD_ONLY, default=p.default) for p in table],
            return_annotation=Material)

    def _describe(self, table: list[Parameter]) -> str:
        lines = [f"{self.summary}.", "", f"Source: {self.source}.", "", "Parameters, by name:", ""]
        for p in table:
            unit = "" if p.unit in ("1", "") or p.choices else f" [{p.unit}]"
            lines.append(f"{p.name}: {p.kind}, {p.range}{unit}, default {p.default_text}")
            lines.append(f"    {p.description}")
        return "\n".join(lines)

    def __call__(self, *args: Any, **values: Any) -> Material:
        if args:
            raise TypeError(f"{self.name}() takes its parameters by name: {', '.join(self.parameters)}")
        for name in values:
            if name not in self.parameters:
                raise TypeError(f"{self.name}() has no parameter '{name}'; it has {', '.join(self.parameters)}")
        return Material._of_values(self.name, values)

    def __repr__(self) -> str:
        return f"facet.{self.name}"

    def __reduce__(self) -> Any:
        return _model_called, (self.name,)

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td><code>{html.escape(p.name)}</code></td><td>{p.kind}</td><td>{html.escape(p.range)}</td>"
            f"<td>{html.escape(p.default_text)}</td><td>{html.escape(p.description)}</td></tr>"
            for p in self.parameters.values())
        return (f"<p><b>{html.escape(self.name)}</b>: {html.escape(self.summary)}</p><table><tr><th>parameter</th>"
                f"<th>kind</th><th>range</th><th>default</th><th></th></tr>{rows}</table>")


MODELS: dict[str, Model] = {}
for _i in range(lib.facet_model_count()):
    _info = lib.facet_model_get(_i)
    if _info != ffi.NULL:
        MODELS[text(_info.name)] = Model(_info)


def _model_called(name: str) -> Model:
    return MODELS[name]


def models() -> Mapping[str, Model]:
    """All models by name, in the order of the library's table.

    >>> "gtr" in models()
    True
    """
    return MappingProxyType(MODELS)
