"""A law made ready for the compiler: traced once on a tape, what never changes during a run taken out, time made local.

What depends on the system's numbers alone becomes a parameter, worked out once a run instead of at every step. Time
counts from an instant of one's choice: a support that has turned for a million seconds is known to 10⁻¹⁶ of a turn only
if whole turns are dropped exactly, which no float of ωt can do.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from ..mechanics.parameters import numbers, with_numbers
from ..mechanics.scalars import less, namespace
from ..mechanics.system import RollingSystem
from . import corner_events
from .charts import LAWS_OWN, TURN, Chart
from .laws import Law
from .normal_form import NormalForm, Sum
from .tape import Node, Tape

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
    chart : Chart
        Whose numbers the state has.
    """

    names: tuple[str, ...]
    event_functions: tuple[str, ...]
    outputs: tuple[Any, ...]
    tape: Tape
    parameters: int
    values: Callable[[Sequence[float], float], list[float]]
    tidy: Callable[[Sequence[float]], list[float]]
    chart: Chart = LAWS_OWN

    @property
    def operations(self) -> int:
        """How many operations depend on time or state."""
        return len(self._weights)

    @property
    def cost(self) -> int:
        """About how long the outputs take: an operation whose series is a sum of products counts twice."""
        return sum(self._weights)

    @cached_property
    def _weights(self) -> list[int]:
        fixed: set[int] = set()
        weights = []
        for index in self.tape.needed(self.outputs):
            operation, *operands = self.tape.steps[index]
            nodes = [part.index for part in operands if isinstance(part, Node)]
            if all(one in fixed for one in nodes) and (operation != "input" or operands[0] > len(self.names)):
                fixed.add(index)
            elif operation != "input":
                linear = operation in _SUMS or (operation in "*/" and sum(one not in fixed for one in nodes) == 1)
                weights.append(1 if linear and (operation != "/" or nodes[0] not in fixed) else 2)
        return weights

    def heyoka(self) -> tuple[list[tuple[Any, Any]], list[Any]]:
        """Return equations and event functions as `heyoka.taylor_adaptive` takes them."""
        import heyoka

        size = len(self.names)
        variables = heyoka.make_vars(*self.names)
        inputs = [heyoka.time, *variables, *(heyoka.par[i] for i in range(self.parameters))]
        expressions = _as_heyoka(self.tape, self.outputs, inputs)
        stops = [stop * _SMALL for stop in expressions[size:]]
        return list(zip(variables, expressions[:size], strict=True)), stops


def lower(system: RollingSystem, law: Law, chart: Chart = LAWS_OWN, zeros: Collection[int] = ()) -> Lowered:
    """Trace a law, in a chart, and make it ready for the compiler.

    Which of the system's numbers are 0 may be taken for a part of its structure: what they multiply is left out.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.solve.laws import RollingLaw
    >>> table = tr.Support(tr.Plane(), motion=tr.Spin(0.25))
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.5, 1.0), table)
    >>> ready = lower(system, RollingLaw())  # its weight alone presses the ball on, so it never lifts off
    >>> ready.event_functions, len(ready.outputs)
    ((), 10)
    """
    names, count = chart.names(system, law), len(numbers(system))
    tape = Tape()
    time, *rest = tape.inputs(1 + len(names) + count + law.event_parameters + corner_events.count(system))
    state, given = rest[: len(names)], rest[len(names) :]
    symbolic = with_numbers(system, [0.0 if i in zeros else node for i, node in enumerate(given[:count])])
    traced = chart.traced(symbolic, law, time, state, given[count:])
    tidied = chart.tidied(symbolic, law, time, state)
    lowering = _Lowering(tape, len(names), len(given), traced.positive)
    for length, known in traced.lengths:
        lowering.take_for(length, known)
    lowering.take_for_unit(tuple(traced.normal))
    needed = lowering.needed(traced.event_functions)
    copies = lowering.copies([*traced.rates, *needed.values()])
    rates, stops = copies[: len(names)], dict(zip(needed, copies[len(names) :], strict=True))
    stops = {name: stop for name, stop in stops.items() if lowering.varies(stop)}
    outputs = (*rates, *stops.values())
    parameters = lowering.count_of(outputs)
    lowering.forget()  # what holds on the support only
    tidy = lowering.new.function([lowering.copy(part) for part in tidied])  # it may want parameters of its own
    return Lowered(names, tuple(stops), outputs, lowering.new, parameters, lowering.values(), tidy, chart)


class _Lowering:
    """Copies a tape to a new one on which the parameters are what a run needs, and time counts from a reference."""

    def __init__(self, tape: Tape, size: int, given: int, positive: Sequence[Any] = ()) -> None:
        self.old, self.new, self.given = tape, Tape(), range(1 + size, 1 + size + given)
        self.inputs = self.new.inputs(1 + size)
        self.wanted: dict[tuple[Any, ...], Node] = {}  # the parameters, in the order in which they came up
        self.fixed = self._fixed()
        self.growing = self._growing()
        self.form = NormalForm(self.new, self._constant)
        self.sums: dict[int, Sum] = {}
        self.positive = {part.index for part in positive}

    def copies(self, parts: Sequence[Any]) -> list[Any]:
        """Return the copies of some steps; the simplest are written first, for the others to make use of.

        What is known to stay as it is comes last: as an event function it is left out, and wants no parameter.
        """
        self._multiplied(parts)
        sizes = [(self._stays(part), len(self.old.needed([part]))) for part in parts]
        order = sorted(range(len(parts)), key=sizes.__getitem__)
        made = {i: self.copy(parts[i]) for i in order}
        return [made[i] for i in range(len(parts))]

    def _stays(self, part: Any) -> bool:
        return isinstance(part, Node) and part.index in self.sums and self.sums[part.index].keys() <= {()}

    def _multiplied(self, parts: Sequence[Any]) -> None:
        """Look up which inputs are multiplied as they are: there c·x is no factor of its own."""
        for index in self.old.needed(parts):
            operation, *operands = self.old.steps[index]
            if operation in ("*", "/") and not any(self._is_fixed(part) for part in operands):
                for part in operands:
                    step = self.old.steps[part.index]
                    if step[0] == "input" and step[1]:
                        self.form.take_as_it_is(self.inputs[step[1]])

    def needed(self, event_functions: dict[str, Any]) -> dict[str, Any]:
        """Return event functions without those that only fall through zero after another has."""
        for stop in event_functions.values():
            self._bring(stop)
        sums = {name: self._as_sum(stop) for name, stop in event_functions.items()}

        def later(name: str) -> bool:
            apart = (self.form.apply("-", sums[name], other) for other in sums.values())
            return any(len(one) == 1 and isinstance(one.get(()), float) and one[()] > 0 for one in apart)

        return {name: stop for name, stop in event_functions.items() if not later(name)}

    def copy(self, part: Any) -> Any:
        """Return a step's copy on the new tape, brought to normal form."""
        self._bring(part)
        return self.form.node(self._as_sum(part))

    def _bring(self, part: Any) -> None:
        """Bring a step, and what it leans on, to normal form."""
        if isinstance(part, Node):
            for index in self.old.needed([part], self.sums):
                if not self.fixed[index]:
                    self.sums[index] = self._in_form(index)
                    if index in self.positive:
                        self.form.take_for_positive(self.sums[index])

    def take_for(self, part: Any, known: Any) -> None:
        """Know from now on that a step comes to what is worked out more easily."""
        if isinstance(part, Node) and not self._is_fixed(part):
            self._bring(known)
            self.sums[part.index] = self._as_sum(known)

    def forget(self) -> None:
        """Know no more than what holds anywhere."""
        self.form, self.sums = NormalForm(self.new, self._constant), {}

    def take_for_unit(self, vector: Sequence[Any]) -> None:
        """Know from now on that a vector has length 1."""
        for part in vector:
            self._bring(part)
            if isinstance(part, Node) and not self._is_fixed(part):
                self.sums[part.index] = self.form.factor(self.form.node(self.sums[part.index]))
        self.form.take_for_unit([self._as_sum(part) for part in vector])

    def varies(self, part: Any) -> bool:
        """Tell whether a step of the new tape depends on time or state."""
        return any(which < len(self.inputs) for which in self._inputs_of([part]))

    def count_of(self, parts: Sequence[Any]) -> int:
        """Return how many of the parameters, from the first, steps of the new tape take."""
        return max(len(self.inputs), 1 + max(self._inputs_of(parts), default=0)) - len(self.inputs)

    def _inputs_of(self, parts: Sequence[Any]) -> list[int]:
        steps = (self.new.steps[index] for index in self.new.needed(parts))
        return [operands[0] for operation, *operands in steps if operation == "input"]

    def _in_form(self, index: int) -> Sum:
        operation, *operands = self.old.steps[index]
        form = self.form
        if operation == "input":
            which = operands[0]
            now = form.factor(self.inputs[which])
            return now if which else form.apply("+", form.factor(self._parameter("clock")), now)
        if operation in ("sin", "cos") and operands[0].index in self.growing:
            slope, offset = self.growing[operands[0].index]
            angle = form.apply("*", self._as_sum(slope), form.factor(self.inputs[0]))
            c, s = (form.factor(self._parameter(name, slope, offset)) for name in ("cos", "sin"))
            cosine, sine = form.apply("cos", angle), form.apply("sin", angle)
            if operation == "sin":
                return form.apply("+", form.apply("*", sine, c), form.apply("*", cosine, s))
            return form.apply("-", form.apply("*", cosine, c), form.apply("*", sine, s))
        return form.apply(operation, *(self._as_sum(part) for part in operands))

    def _as_sum(self, part: Any) -> Sum:
        if isinstance(part, Node) and not self._is_fixed(part):
            return self.sums[part.index]
        return {(): part} if isinstance(part, Node) or part else {}

    def _constant(self, coefficient: Any) -> Any:
        return self._parameter("constant", coefficient) if isinstance(coefficient, Node) else coefficient

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
    angle = float((Fraction(slope) * Fraction(reference) + Fraction(offset)) % TURN)
    return math.cos(angle) if kind == "cos" else math.sin(angle)


def _as_heyoka(tape: Tape, outputs: Sequence[Any], inputs: Sequence[Any]) -> list[Any]:
    """Return what a tape holds as heyoka expressions."""
    import heyoka

    made: dict[int, Any] = {}

    def operand(part: Any) -> Any:
        return made[part.index] if isinstance(part, Node) else heyoka.expression(float(part))

    needed = tape.needed(outputs)
    inner = _inner_sums(tape, needed, outputs)
    xp = namespace(heyoka.time)
    for index in needed:
        operation, *operands = tape.steps[index]
        if index in inner:
            continue
        if operation == "input":
            made[index] = inputs[operands[0]]
        elif operation in _SUMS:
            made[index] = _long_sum([(operand(part), sign) for part, sign in _terms(tape, index, inner)])
        else:
            made[index] = _HEYOKA[operation](xp, *(operand(part) for part in operands))
    return [operand(part) for part in outputs]


_SUMS = {"+": (1, 1), "-": (1, -1), "neg": (-1,)}  # the signs of their terms


def _inner_sums(tape: Tape, needed: list[int], outputs: Sequence[Any]) -> set[int]:
    """Return the sums that are used once, in another sum: one long sum takes heyoka less time than many short ones."""
    parts = [(part.index, index) for index in needed for part in tape.steps[index][1:] if isinstance(part, Node)]
    uses = Counter(index for index, _ in parts) + Counter(part.index for part in outputs if isinstance(part, Node))
    users, sums = dict(parts), {index for index in needed if tape.steps[index][0] in _SUMS}
    return {index for index in sums if uses[index] == 1 and users.get(index) in sums}


def _terms(tape: Tape, index: int, inner: set[int]) -> Iterator[tuple[Any, int]]:
    """Yield the terms of a long sum, and their signs."""
    operation, *operands = tape.steps[index]
    for part, sign in zip(operands, _SUMS[operation], strict=True):
        if isinstance(part, Node) and part.index in inner:
            yield from ((term, own * sign) for term, own in _terms(tape, part.index, inner))
        else:
            yield part, sign


def _long_sum(terms: list[tuple[Any, int]]) -> Any:
    import heyoka

    added, taken = ([part for part, sign in terms if sign == which] for which in (1, -1))
    total = [heyoka.sum(parts) if len(parts) > 1 else parts[0] for parts in (added, taken) if parts]
    return total[0] - total[1] if len(total) > 1 else total[0] if added else -total[0]


def _square_or_product(_: Any, a: Any, b: Any) -> Any:
    return a**2 if a is b else a * b  # a square costs half


_HEYOKA: dict[str, Callable[..., Any]] = {
    "*": _square_or_product,
    "/": lambda _, a, b: a / b,
    "<": lambda _, a, b: less(a, b),
    ">": lambda _, a, b: less(b, a),
    **{
        name: (lambda xp, *parts, name=name: getattr(xp, name)(*parts))
        for name in ("sqrt", "sin", "cos", "tan", "exp", "expm1", "log", "abs", "atan2", "where")
    },
}
