"""Formulas in the time, written as text: read by a short list of what is allowed, never run as code.

A formula is kept as nested tuples, so that its numbers are parameters of a compiled integrator like all others.
"""

from __future__ import annotations

import ast
import math
import re
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from ..errors import InvalidValueError
from . import checks
from .algebra import Vector
from .jets import Jet, jets
from .scalars import Scalar, is_number, leaves, namespace

FUNCTIONS = ("sin", "cos", "tan", "sqrt", "exp", "log", "abs", "hypot")
_TWO_ARGUMENTS = ("hypot",)
_CONSTANTS = {"pi": math.pi}
_OPERATORS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}
_LONGEST, _DEEPEST = 500, 60
_LARGEST_POWER, _MOST_FACTORS = 20, 8
_SHOWN = 60  # characters of what is wrong


@dataclass(frozen=True, repr=False)
class Expression:
    """A formula in named variables, SI throughout.

    Parameters
    ----------
    tree : nested tuple
        As `Expression.parse` makes it.
    text : str
        As it was written.

    Examples
    --------
    >>> push = Expression.parse("0.1*sin(2*t)", ("t",), "value[0]")
    >>> push.at(t=0.0), round(push.at(t=1.0), 6)
    (0.0, 0.09093)
    """

    tree: Any
    text: str = field(compare=False)

    def __repr__(self) -> str:
        return repr(self.text) if self.text else f"Expression({self.tree!r}, '')"

    @staticmethod
    def parse(text: str, variables: tuple[str, ...], key: str) -> Expression:
        """Read a formula.

        Examples
        --------
        >>> Expression.parse("2*t + open('f')", ("t",), "rate")
        Traceback (most recent call last):
        ...
        trundle.errors.InvalidValueError: `rate` must be a formula in t; got "2*t + open('f')". Not allowed: open('f').
        """
        rule = f"must be a formula in {', '.join(variables)}"
        if len(text) > _LONGEST:
            raise InvalidValueError(key, rule, text, f"It may have {_LONGEST} characters at most.")
        try:
            parsed = ast.parse(text.strip(), mode="eval").body
            return Expression(_Reader(text.strip(), variables).read(parsed), text)
        except _RefusedError as error:
            raise InvalidValueError(key, rule, text, str(error)) from None
        except (SyntaxError, ValueError, MemoryError, RecursionError):
            example = f"0.1*sin(2*pi*0.5*{variables[0]})"
            raise InvalidValueError(key, rule, text, f"Write for instance '{example}', in SI units.") from None

    def at(self, **values: Scalar) -> Scalar:
        """Return the value where the variables have the given values: numbers, arrays or symbols."""
        return _value(self.tree, values, namespace(tuple(values.values()), self._constants))

    @cached_property
    def _constants(self) -> tuple[Any, ...]:
        """Those that are no plain numbers: they decide which functions fit."""
        return tuple(part for part in leaves(_numbers(self.tree)) if not is_number(part))

    @property
    def variables(self) -> frozenset[str]:
        """The variables that stand in it."""
        return frozenset(_names(self.tree))

    def gradient(self, variables: tuple[str, ...], **values: Scalar) -> tuple[Scalar, ...]:
        """Return the slopes in some of the variables, exact, where the variables have the given values.

        Examples
        --------
        >>> Expression.parse("x*y**2", ("x", "y"), "formula").gradient(("x", "y"), x=2.0, y=3.0)
        (9.0, 12.0)
        """
        value = self._jet(variables, values)
        return value.gradient if isinstance(value, Jet) else (0.0,) * len(variables)

    def slope(self, variable: str, **values: Scalar) -> Scalar:
        """Return the slope in one of the variables, exact, where the variables have the given values.

        Examples
        --------
        >>> Expression.parse("3*t**2", ("t",), "rate").slope("t", t=2.0)
        12.0
        """
        return self.gradient((variable,), **values)[0]

    def course(self, time: Scalar) -> tuple[Scalar, Scalar, Scalar]:
        """Return the value of a formula in t at a time, with its first and second rate.

        Examples
        --------
        >>> Expression.parse("t**3", ("t",), "angle").course(2.0)
        (8.0, 12.0, 12.0)
        """
        value = self._jet(("t",), {"t": time})
        return (value.value, value.gradient[0], value.hessian[0]) if isinstance(value, Jet) else (value, 0.0, 0.0)

    def _jet(self, variables: tuple[str, ...], values: dict[str, Scalar]) -> Any:
        moved = jets(tuple(values[name] for name in variables))
        return self.at(**{**values, **dict(zip(variables, moved, strict=True))})

    def __str__(self) -> str:
        return self.text


def is_formula(text: Any, variables: tuple[str, ...] = ("t",)) -> bool:
    """Tell whether a text is a formula that one of the variables stands in, rather than a number with a unit.

    Examples
    --------
    >>> is_formula("0.1*sin(t)"), is_formula("0.1 N"), is_formula("3 t")
    (True, False, False)
    """
    if not isinstance(text, str):
        return False
    if len(text) > _LONGEST:  # too long to be parsed: its reader says so
        return not {*variables, *FUNCTIONS}.isdisjoint(re.findall(r"[A-Za-z_]\w*", text))
    try:
        names = [node.id for node in ast.walk(ast.parse(text.strip(), mode="eval")) if isinstance(node, ast.Name)]
    except (SyntaxError, ValueError, MemoryError, RecursionError):
        return False
    return any(name in variables or name in FUNCTIONS for name in names)


def varying(value: Any, kind: str, key: str) -> Any:
    """Return a number in SI or a formula in the time, whichever the user gave.

    Examples
    --------
    >>> varying("30 rpm", "angular velocity", "rate") == math.pi, varying("2*t", "angular velocity", "rate").at(t=3.0)
    (True, 6.0)
    """
    if isinstance(value, Expression):
        return value
    return Expression.parse(value, ("t",), key) if is_formula(value) else checks.real(value, kind, key)


def varying_vector(value: Any, kind: str, key: str) -> Vector:
    """Return three components, each a number in SI or a formula in the time.

    Examples
    --------
    >>> varying_vector(["1 cm", "2*t", 0.0], "length", "position").x
    0.01
    """
    formulas = isinstance(value, (list, tuple, Vector)) and any(map(_varies, value))
    plain = tuple(0.0 if _varies(part) else part for part in value) if formulas else value
    numbers = checks.components(plain, kind, key)
    if not formulas:
        return Vector(*numbers)
    mixed = zip(value, numbers, strict=True)
    return Vector(*(varying(p, kind, f"{key}[{i}]") if _varies(p) else number for i, (p, number) in enumerate(mixed)))


def _varies(part: Any) -> bool:
    return isinstance(part, Expression) or is_formula(part)


def course(value: Any, time: Scalar) -> tuple[Scalar, Scalar, Scalar]:
    """Return a number or formula in the time at a time, with its first and second rate.

    Examples
    --------
    >>> course(0.5, 1.0)
    (0.5, 0.0, 0.0)
    """
    return value.course(time) if isinstance(value, Expression) else (value, 0.0, 0.0)


def now(value: Any, time: Scalar) -> Scalar:
    """Return a number or formula in the time at a time.

    Examples
    --------
    >>> now(0.5, 1.0)
    0.5
    """
    return value.at(t=time) if isinstance(value, Expression) else value


class _RefusedError(Exception):
    """Something in a formula that is not allowed."""


class _Reader:
    """From Python's syntax tree to nested tuples, by a list of what is allowed."""

    def __init__(self, text: str, variables: tuple[str, ...]) -> None:
        self.text, self.variables = text, variables

    def read(self, node: ast.expr, depth: int = 0) -> Any:
        if depth > _DEEPEST:
            raise _RefusedError("It is nested too deep.")
        match node:
            case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
                return self._number(value, node)
            case ast.Name(id=name) if name in self.variables:
                return name
            case ast.Name(id=name) if name in _CONSTANTS:
                return _CONSTANTS[name]
            case ast.UnaryOp(op=ast.USub(), operand=inner):
                return ("neg", self.read(inner, depth + 1))
            case ast.UnaryOp(op=ast.UAdd(), operand=inner):
                return self.read(inner, depth + 1)
            case ast.BinOp(op=ast.Pow(), left=base, right=exponent):
                return ("**", self.read(base, depth + 1), self._power(exponent))
            case ast.BinOp(op=operator, left=left, right=right) if type(operator) in _OPERATORS:
                # Terms stand beside each other, though the tree has each sum inside of the next.
                return (_OPERATORS[type(operator)], self.read(left, depth), self.read(right, depth + 1))
            case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]) if name in FUNCTIONS:
                wanted = 2 if name in _TWO_ARGUMENTS else 1
                if len(arguments) != wanted:
                    raise _RefusedError(f"{name} takes {wanted} argument{'s' * (wanted > 1)}.")
                return _called(name, [self.read(argument, depth + 1) for argument in arguments])
        raise _RefusedError(f"Not allowed: {self._segment(node)}.")

    def _number(self, value: float, node: ast.expr) -> float:
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        if not math.isfinite(number):
            raise _RefusedError(f"{self._segment(node)} is too large.")
        return number

    def _segment(self, node: ast.expr) -> str:
        found = ast.get_source_segment(self.text, node) or self.text
        return found if len(found) <= _SHOWN else found[:_SHOWN] + "..."

    def _power(self, node: ast.expr) -> str:
        """Return a whole power as text: it belongs to the formula's structure, not to its numbers."""
        sign, inner = (-1, node.operand) if isinstance(node, ast.UnaryOp) else (1, node)
        if isinstance(inner, ast.Constant) and type(inner.value) is int and inner.value <= _LARGEST_POWER:
            return str(sign * inner.value)
        raise _RefusedError(f"A power must be a whole number up to {_LARGEST_POWER}; use sqrt and exp for others.")


def _called(name: str, arguments: list[Any]) -> tuple[Any, ...]:
    """Return a function of its arguments; √u² is |u|, whose kink is found, and which keeps its digits beside it."""
    match name, arguments:
        case ("sqrt", [("**", inner, "2")]):
            return ("abs", inner)
        case ("sqrt", [("*", inner, other)]) if inner == other:
            return ("abs", inner)
    return (name, *arguments)


def _numbers(tree: Any) -> tuple[Any, ...]:
    if isinstance(tree, tuple):
        return tuple(_numbers(part) for part in tree[1:])
    return () if isinstance(tree, str) else (tree,)


def _names(tree: Any) -> tuple[str, ...]:
    if isinstance(tree, tuple):
        operands = tree[1:2] if tree[0] == "**" else tree[1:]
        return tuple(name for part in operands for name in _names(part))
    return (tree,) if isinstance(tree, str) else ()


def _power(base: Scalar, exponent: int) -> Scalar:
    """Return a whole power; a high one by squares, since heyoka would take logarithms of it, which 0 has not."""
    if abs(exponent) <= _MOST_FACTORS:
        return base**exponent
    half, odd = divmod(abs(exponent), 2)
    square = _power(base, half) ** 2
    power = square * base if odd else square
    return power if exponent > 0 else 1 / power


def _value(tree: Any, values: dict[str, Scalar], xp: Any) -> Scalar:
    if isinstance(tree, str):
        return values[tree]
    if not isinstance(tree, tuple):
        return tree
    operator, *rest = tree
    if operator == "**":
        return _power(_value(rest[0], values, xp), int(rest[1]))
    parts = [_value(part, values, xp) for part in rest]
    if operator in FUNCTIONS:
        return getattr(xp, operator)(*parts)
    if operator == "neg":
        return -parts[0]
    a, b = parts
    return a + b if operator == "+" else a - b if operator == "-" else a * b if operator == "*" else a / b
