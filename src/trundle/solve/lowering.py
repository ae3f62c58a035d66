"""A law made ready for the compiler: traced once on a tape, what never changes during a run taken out, time made local.

What depends on the system's numbers alone becomes a parameter, worked out once a run instead of at every step. Time
counts from an instant of one's choice: a support that has turned for a million seconds is known to 10⁻¹⁶ of a turn only
if whole turns are dropped exactly, which no float of ωt can do.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from ..mechanics.parameters import numbers, with_numbers
from ..mechanics.scalars import Scalar, less, namespace
from ..mechanics.system import RollingSystem
from . import corners
from .laws import Law
from .tape import Node, Tape, apply

# 2π to 60 digits
_TURN = Fraction("6.28318530717958647692528676655900576839433879875021164194988")
# Only the sign of a stop matters; made small, it leaves the size of the steps to the state.
_SMALL = 2.0**-20


@dataclass(frozen=True)
class Lowered:
    """A law as a compiler takes it.

    Parameters
    ----------
    names : tuple of str
        Of the state's numbers.
    stops : tuple of str
        Of the event functions.
    outputs : tuple
        Rates and event functions, on `tape`, of the time since the reference, the state and the parameters.
    tape : Tape
        Holds them.
    parameters : int
        How many the outputs take.
    values : callable
        (the system's numbers and the law's extras, the reference time in s) -> the parameters, and those of `tidy`.
    tidy : callable
        [0, *state, *values] -> the state with p on the support and q of length 1, at the reference time.
    """

    names: tuple[str, ...]
    event_functions: tuple[str, ...]
    outputs: tuple[Any, ...]
    tape: Tape
    parameters: int
    values: Callable[[Sequence[float], float], list[float]]
    tidy: Callable[[Sequence[float]], list[float]]

    def heyoka(self) -> tuple[list[tuple[Any, Any]], list[Any]]:
        """Return equations and event functions as `heyoka.taylor_adaptive` takes them."""
        import heyoka

        size = len(self.names)
        variables = heyoka.make_vars(*self.names)
        inputs = [heyoka.time, *variables, *(heyoka.par[i] for i in range(self.parameters))]
        expressions = _as_heyoka(self.tape, self.outputs, inputs)
        stops = [stop * _SMALL for stop in expressions[size:]]
        return list(zip(variables, expressions[:size], strict=True)), stops


def lower(system: RollingSystem, law: Law) -> Lowered:
    """Trace a law and make it ready for the compiler.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.solve.laws import RollingLaw
    >>> table = tr.Support(tr.Plane(), motion=tr.Spin(0.25))
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.5, 1.0), table)
    >>> ready = lower(system, RollingLaw())
    >>> ready.event_functions, len(ready.outputs)
    (('lift',), 11)
    """
    names, count = law.names(system), len(numbers(system))
    tape = Tape()
    time, *rest = tape.inputs(1 + len(names) + count + law.event_parameters + corners.count(system))
    state, given = rest[: len(names)], rest[len(names) :]
    symbolic = with_numbers(system, given[:count])
    rates = law.rates(symbolic, time, state)
    stops = corners.all_event_functions(symbolic, law, time, state, given[count:])
    tidied = _tidied(symbolic, law, time, state)
    lowering = _Lowering(tape, len(names), len(given))
    # A stop that never changes is passed at the start or never.
    stops = {name: stop for name, stop in stops.items() if isinstance(stop, Node) and not lowering.fixed[stop.index]}
    outputs = tuple(lowering.copy(part) for part in (*rates, *stops.values()))
    parameters = len(lowering.wanted)
    tidy = lowering.new.function([lowering.copy(part) for part in tidied])  # it may want some of its own
    return Lowered(names, tuple(stops), outputs, lowering.new, parameters, lowering.values(), tidy)


def _tidied(system: RollingSystem, law: Law, time: Scalar, state: Sequence[Scalar]) -> list[Scalar]:
    """Return the state with p moved along the normal to φ(p) = 0, by one step of Newton's method, and q/|q|.

    What rounding leaves of both is so small that the step's own error is its square.
    """
    p, q, _, _, coordinates = law.split(state)
    support = system.support.motion.at(time, *coordinates)
    p = p + support.rotation @ system.support.surface.step_onto(support.local(p))
    length = namespace(*q).sqrt(sum((part * part for part in q), 0.0))
    return [*p, *(part / length for part in q), *state[7:]]


class _Lowering:
    """Copies a tape to a new one on which the parameters are what a run needs, and time counts from a reference."""

    def __init__(self, tape: Tape, size: int, given: int) -> None:
        self.old, self.new, self.given = tape, Tape(), range(1 + size, 1 + size + given)
        self.inputs = self.new.inputs(1 + size)
        self.wanted: dict[tuple[Any, ...], Node] = {}  # the parameters, in the order in which they came up
        self.copies: dict[int, Any] = {}
        self.fixed = self._fixed()
        self.growing = self._growing()

    def copy(self, part: Any) -> Any:
        """Return a step's copy on the new tape."""
        if isinstance(part, Node):
            for index in self.old.needed([part]):
                if index not in self.copies and not self.fixed[index]:
                    self.copies[index] = self._copied(index)
        return self._operand(part)

    def values(self) -> Callable[[Sequence[float], float], list[float]]:
        """Return the function that works the parameters out."""
        kinds = [kind for kind, *_ in self.wanted]
        worked_out = self.old.function([part for _, *parts in self.wanted for part in parts])
        unused = [0.0] * self.given.start

        def values(given: Sequence[float], reference: float) -> list[float]:
            found = iter(worked_out([*unused, *given]))
            return [_value(kind, found, reference) for kind in kinds]

        return values

    def _fixed(self) -> list[bool]:
        """Tell of each step whether it depends on the given numbers only."""
        fixed: list[bool] = []
        for operation, *operands in self.old.steps:
            inputs = [part for part in operands if isinstance(part, Node)]
            fixed.append(operands[0] in self.given if operation == "input" else all(fixed[i.index] for i in inputs))
        return fixed

    def _growing(self) -> dict[int, tuple[Any, Any]]:
        """Return slope and offset of each step that grows steadily with time, both fixed."""
        found: dict[int, tuple[Any, Any]] = {0: (1.0, 0.0)}
        for index, (operation, *operands) in enumerate(self.old.steps[1:], start=1):
            if operation in ("+", "-", "*", "/", "neg") and not self.fixed[index]:
                lines = [found.get(part.index) if isinstance(part, Node) else None for part in operands]
                still = [self._is_fixed(part) for part in operands]
                if all(line is not None or fixed for line, fixed in zip(lines, still, strict=True)):
                    grown = _grown(operation, [line or (0.0, part) for line, part in zip(lines, operands, strict=True)])
                    found |= {index: grown} if grown is not None else {}
        self.fixed += [True] * (len(self.old.steps) - len(self.fixed))  # the slopes and offsets just recorded
        return found

    def _is_fixed(self, part: Any) -> bool:
        return not isinstance(part, Node) or part.index >= len(self.fixed) or self.fixed[part.index]

    def _parameter(self, kind: str, *parts: Any) -> Node:
        key = (kind, *parts)
        if key not in self.wanted:
            (self.wanted[key],) = self.new.inputs(1)
        return self.wanted[key]

    def _operand(self, part: Any) -> Any:
        if not isinstance(part, Node):
            return part
        return self._parameter("constant", part) if self.fixed[part.index] else self.copies[part.index]

    def _copied(self, index: int) -> Any:
        operation, *operands = self.old.steps[index]
        if operation == "input":
            which = operands[0]
            return self.inputs[which] if which else self._parameter("clock") + self.inputs[0]
        if operation in ("sin", "cos") and operands[0].index in self.growing:
            slope, offset = self.growing[operands[0].index]
            angle = self._operand(slope) * self.inputs[0]
            c, s = (self._parameter(name, slope, offset) for name in ("cos", "sin"))
            cosine, sine = apply(self.new, "cos", angle), apply(self.new, "sin", angle)
            return sine * c + cosine * s if operation == "sin" else cosine * c - sine * s
        return apply(self.new, operation, *(self._operand(part) for part in operands))


def _grown(operation: str, pairs: list[tuple[Any, Any]]) -> tuple[Any, Any] | None:
    """Return slope and offset of a result from those of the operands; None where it does not grow steadily."""
    (a, b), *others = pairs
    if operation == "neg":
        return -a, -b
    ((c, d),) = others
    if operation in ("+", "-"):
        return (a + c, b + d) if operation == "+" else (a - c, b - d)
    if _is_zero(c):
        return (a * d, b * d) if operation == "*" else (a / d, b / d)
    return (b * c, b * d) if operation == "*" and _is_zero(a) else None  # a square of the time is no line


def _is_zero(slope: Any) -> bool:
    return not isinstance(slope, Node) and slope == 0


def _value(kind: str, found: Iterator[float], reference: float) -> float:
    """Return the next parameter."""
    if kind == "clock":
        return reference
    if kind == "constant":
        return next(found)
    slope, offset = next(found), next(found)
    # A float of slope × time would lose what a million turns leave; a fraction does not.
    angle = float((Fraction(slope) * Fraction(reference) + Fraction(offset)) % _TURN)
    return math.cos(angle) if kind == "cos" else math.sin(angle)


def _as_heyoka(tape: Tape, outputs: Sequence[Any], inputs: Sequence[Any]) -> list[Any]:
    """Return what a tape holds as heyoka expressions."""
    import heyoka

    made: dict[int, Any] = {}

    def operand(part: Any) -> Any:
        return made[part.index] if isinstance(part, Node) else heyoka.expression(float(part))

    xp = namespace(heyoka.time)
    for index in tape.needed(outputs):
        operation, *operands = tape.steps[index]
        if operation == "input":
            made[index] = inputs[operands[0]]
        else:
            made[index] = _HEYOKA[operation](xp, *(operand(part) for part in operands))
    return [operand(part) for part in outputs]


def _square_or_product(_: Any, a: Any, b: Any) -> Any:
    return a**2 if a is b else a * b  # a square costs half


_HEYOKA: dict[str, Callable[..., Any]] = {
    "+": lambda _, a, b: a + b,
    "-": lambda _, a, b: a - b,
    "*": _square_or_product,
    "/": lambda _, a, b: a / b,
    "neg": lambda _, a: -a,
    "<": lambda _, a, b: less(a, b),
    ">": lambda _, a, b: less(b, a),
    **{
        name: (lambda xp, *parts, name=name: getattr(xp, name)(*parts))
        for name in ("sqrt", "sin", "cos", "tan", "exp", "expm1", "log", "abs", "atan2", "where")
    },
}
