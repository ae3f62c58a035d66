"""What is checked of every trajectory, and the card that shows it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mechanics.algebra import Vector
from ..mechanics.invariants import Record, invariants_of
from ..mechanics.system import RollingSystem, State
from ..solve.exact import ClosedForm, closed_form
from ..solve.exact.circle import Circle, measure
from ..solve.methods import Method
from ..solve.samples import FLIGHT, ROLLING, SLIPPING, Samples
from .again import Again
from .bounds import EXACT, SOLVER, Array, bound_of, largest, speed_of, turned_in
from .card import Card, CardFigure, checked
from .compared import cross_check, same_again
from .each_sample import EachSample
from .energy import balance
from .events import AtEvents
from .friction import contact_force, friction_law, looked_into
from .landings import landing_figures, landings_of
from .plane import reactions, straightness
from .stretches import SINGULAR, before_a_singular_end

_MOST_SAMPLES = 20_000  # looked at for integrals
_EVENTS_TOLD = 4
_LOOKS = 400  # at stretches, to balance the energy
_ROUNDING = 3e-16  # of a speed
_SHORT_OF_THE_END = 1e-3  # of the last stretch of a run that ends where its law is singular
_MEANWHILE = {"rolling": "while it rolls", "slipping": "while it slips", "flight": "in flight"}
_FITTED, _CIRCLES_FITTED = 2000, 20  # points and, where they are taken anew, circles


def card(system: RollingSystem, start: State, samples: Samples, method: Method, title: str = "") -> Card:
    """Check a trajectory and return what was found.

    Examples
    --------
    >>> import trundle as tr
    >>> run = tr.Scenario.load("tilted-turntable").run()
    >>> run.card()["no slip"].passed
    True
    """
    motion = closed_form(system, start)
    every = max(1, samples.time.size // _MOST_SAMPLES)
    some = samples.part(slice(None, None, every)) if every > 1 else samples
    rolls = bool((samples.phase == ROLLING).all()) and all(event.final for event in samples.events)
    circle = motion.circle if motion is not None and rolls else None
    bound = bound_of(method, turned_in(some))
    again, landings = Again(system, start, some, method), landings_of(system, samples.events)
    followed = not again.broken
    figures = [
        *again.figures(),
        *EachSample(system, some, bound).figures(),
        *(straightness(system, some, bound) if rolls else ()),
        *_friction(system, some, bound),
        *(_balance(again, bound) if followed else ()),
        *(reactions(system, some, bound) if rolls else ()),
        *_integrals(system, some, method),
        *(_guiding_centre(circle, start, some, method) if circle is not None else ()),
        *(same_again(system, start, again.sampled, again.samples, method, again.kept) if followed else ()),
        *cross_check(system, start, some, method, motion),
        *(_circle(system, circle, start, samples, method) if circle is not None else ()),
        *(contact_force(system, samples, looked_into(system, again.samples, again.follow)) if followed else ()),
        *landing_figures(landings),
        *(AtEvents(system, again.samples, bound, again.kinks).figures() if followed else ()),
        *_events(samples),
    ]
    return Card(title, _described(method, motion), tuple(figures))


def _events(samples: Samples) -> Iterator[CardFigure]:
    """List what happened, in short."""
    if not samples.events:
        return
    kinds = [event.kind for event in samples.events]
    told = [f"{event.kind} at {event.time:.6g} s" for event in samples.events[:_EVENTS_TOLD]]
    more = f" and {len(kinds) - len(told)} more" if len(kinds) > len(told) else ""
    yield CardFigure("events", float(len(kinds)), note=", ".join(told) + more)


def _described(method: Method, motion: ClosedForm | None) -> str:
    if method.name == "exact" and motion is not None:
        return f"closed form {motion.equation}, {motion.name} ({motion.source})"
    name = {"taylor": "Taylor series (heyoka)", "runge-kutta": "Runge-Kutta DOP853 (SciPy)"}[method.name]
    return f"{name}, tolerance {method.tolerance:g}"


def _friction(system: RollingSystem, at: Samples, bound: float) -> Iterator[CardFigure]:
    """Check the law of friction where it slips."""
    slipping = at.part(at.phase == SLIPPING)
    if slipping.time.size:
        yield friction_law(system, slipping, bound)


def _balance(again: Again, bound: float) -> Iterator[CardFigure]:
    """Balance the energy where no integral says the same, and the run can be followed."""
    system, at = again.system, again.itself
    kept = any(integral.name in ("energy", "moving energy") for integral in invariants_of(system))
    plain = kept and not any(not event.final for event in at.events)
    if plain or not again.can_be_followed:
        return
    *others, last = again.stretches
    if at.events and at.events[-1].kind in SINGULAR:  # there a rounding of the place is no longer one of the energy
        last = replace(last, end=last.end - _SHORT_OF_THE_END * last.length)
    ends = again.follow(np.array([again.start.time, last.end]))
    ends = Samples.joined([_before(again.start, ends.part(slice(0, 1))), ends.part(slice(1, 2))])
    panels = np.vstack([stretch.panels() for stretch in [*others, last]])
    struck = [(landing.gained, landing.work) for landing in landings_of(system, at.events)]
    passes = int(np.clip(_LOOKS // len(again.stretches), 2, 8))
    yield balance(system, ends, panels, again.follow, struck, bound, passes)


def _before(start: State, at: Samples) -> Samples:
    """Return the first sample as the run was started: it may have landed since, at the same instant."""
    names = ("position", "velocity", "angular_velocity", "orientation")
    given: dict[str, Any] = {name: np.array([getattr(start, name)], dtype=float) for name in names}
    return replace(at, **given, support_coordinates=np.array([start.support], dtype=float))


def _integrals(system: RollingSystem, at: Samples, method: Method) -> Iterator[CardFigure]:
    """Check each first integral over every stretch of a phase that it survives."""
    if at.phase[-1] != FLIGHT:  # where it touches, a rounding of the place is no longer one of the rest
        at = before_a_singular_end(at)
    bound, phases = bound_of(method, turned_in(at)), set()
    worst: dict[str, tuple[float, Any, set[str]]] = {}
    for part, phase in _runs_of_a_phase(at):
        record = Record(part.motion(system), Vector.of(part.contact), part.support_columns)
        phases.add(phase)
        for integral in invariants_of(system, phases=(phase,)):
            terms, sizes = integral.sized_terms(system, record)
            if not terms:  # it has nothing to say of this stretch
                continue
            total = sum(_as_array(term, part.time.size) for term in terms)
            drift = _drift(total, sizes)
            if drift > bound:
                stirred = integral.sized_terms(system, _stirred(system, part, record))[1]
                drift = min(drift, _drift(total, stirred))
            known = worst.get(integral.name, (0.0, integral, set()))
            worst[integral.name] = max(known[0], drift), integral, known[2] | {phase}
    for name, (drift, integral, held) in worst.items():
        while_ = "" if held == phases else f" {' and '.join(_MEANWHILE[phase] for phase in sorted(held))}"
        yield checked(f"drift of the {name}", drift, bound, f"{integral.formula} stays the same{while_}")


def _stirred(system: RollingSystem, at: Samples, record: Record) -> Record:
    """Return a motion with V and Ω of the size by which rounding of the speeds at the contact shows, over the bound.

    A body that hardly moves on a support that moves fast is the small difference of the two. Roundings add up as a
    random walk of about a step a radian.
    """
    V = _ROUNDING / EXACT * math.sqrt(max(1.0, turned_in(at))) * speed_of(system, at)
    Omega = V / largest(at.contact - at.position)
    motion = record.motion
    moved = replace(
        motion,
        velocity=motion.velocity + Vector(V, V, V),
        angular_velocity=motion.angular_velocity + Vector(Omega, Omega, Omega),
    )
    return replace(record, motion=moved)


def _runs_of_a_phase(at: Samples) -> Iterator[tuple[Samples, str]]:
    """Return the samples between events, with the phase of each part by its name."""
    names = {ROLLING: "rolling", SLIPPING: "slipping", FLIGHT: "flight"}
    changes = [event.time for event in at.events if not event.final]
    for index in np.split(np.arange(at.time.size), np.searchsorted(at.time, changes)):
        if index.size > 1 and int(at.phase[index[0]]) in names:
            yield at.part(index), names[int(at.phase[index[0]])]


def _as_array(term: Any, count: int) -> Array:
    array = term.array() if isinstance(term, Vector) else np.asarray(term, dtype=float)
    return np.broadcast_to(array, (count, *array.shape[1:])) if array.ndim else np.full(count, float(array))


def _drift(values: Any, sizes: Any) -> float:
    """Return by how much of the largest of its terms a sum changes."""
    change = np.abs(values - values[0]).max()
    size = max((float(np.abs(_as_array(term, len(values))).max()) for term in sizes), default=0.0)
    return 0.0 if change == 0 else float(change / max(size, 1e-300))


def _guiding_centre(circle: Circle, start: State, at: Samples, method: Method) -> Iterator[CardFigure]:
    """Check centre and radius of the circle from positions and velocities: integrals on a turning plane."""
    t, bound = at.time - start.time, bound_of(method, turned_in(at))
    kappa, drift = circle.rate, circle.drift
    if abs(kappa) * float(t[-1]) <= bound:
        return  # of a circle so large these hold whatever the motion
    zeta, rate = (a[:, 0] + 1j * a[:, 1] for a in (at.position, at.velocity))
    arm = -1j * (rate - drift) / kappa
    centre = zeta - arm - drift * t
    size = max(np.abs(zeta).max(), np.abs(arm).max(), np.abs(drift * t).max())
    yield checked(
        "drift of the circle's centre", _drift(centre, (size,)), bound, "ζ + i(ζ̇ − v_d)/κ − v_d t stays the same"
    )
    yield checked("drift of the circle's radius", _drift(np.abs(arm), (size,)), bound, "|ζ̇ − v_d|/κ stays the same")


def _circle(
    system: RollingSystem, circle: Circle, start: State, samples: Samples, method: Method
) -> Iterator[CardFigure]:
    """Measure rate, centre and drift from the positions alone, beside the formula's."""
    yield CardFigure("circle rate by the formula", circle.rate, "rad/s", note=circle.said)
    turns = abs(circle.rate) * float(samples.time[-1] - start.time) / (2 * math.pi)
    too_little = CardFigure("circle not measured", turns, "turns", note="the run shows too little of the circle")
    if turns <= bound_of(method):
        yield too_little
        return
    t, path = _even_path(system, start, samples, method, abs(circle.rate))
    found = measure(t, path) if circle.arm else None
    if not circle.arm:
        moved = float(np.abs(path - path[0] - circle.drift * t).max())
        size = max(float(np.abs(path).max()), 1e-300)
        yield checked("stays where it was put", moved / size, bound_of(method), "largest departure over the distance")
        return
    if found is None or turns < 0.25 or found.rate_error > 1e-6 * abs(circle.rate):
        yield too_little
        return
    slack = max(10.0, SOLVER * method.tolerance / 2.2e-16)
    for name, value, formula, error, unit in (
        ("circle rate measured", found.rate, circle.rate, found.rate_error, "rad/s"),
        ("centre measured", found.centre, circle.centre, found.centre_error, "m"),
        ("drift measured", found.drift, circle.drift, found.drift_error, "m/s"),
    ):
        scale = max(abs(formula), 1e-300)
        shown = f"{value:.12g} {unit}" if isinstance(value, float) else _pair(value, unit)
        wanted = f"{formula:.12g}" if isinstance(value, float) else _pair(formula, "")
        if abs(formula) <= error:
            yield checked(f"{name}, off the formula's", abs(value - formula), slack * error, f"{shown}", unit)
        else:
            bound = max(slack * error / scale, EXACT)
            note = f"{shown}; formula {wanted}"
            yield checked(f"{name}, off the formula's", abs(value - formula) / scale, bound, note)


def _even_path(
    system: RollingSystem, start: State, samples: Samples, method: Method, kappa: float
) -> tuple[Array, NDArray[np.complex128]]:
    """Return times and path for a fit: the samples at an even step, or new ones where they are too far apart."""
    t = samples.time
    step = float(t[1] - t[0])
    count = t.size - bool(t.size > 2 and t[-1] - t[-2] < 0.999 * step)  # the last may be the run's end
    keep = _fitted(count, step * kappa)
    even = step > 0 and np.allclose(np.diff(t[keep]), keep.step * step, rtol=1e-6)
    if count < 32 or not even or step * kappa > 1:
        span = min(float(t[-1] - start.time), _CIRCLES_FITTED * 2 * math.pi / kappa)
        samples = method.solve(system, start, start.time + np.linspace(0.0, span, _FITTED))
        keep = _fitted(samples.time.size, float(samples.time[1] - samples.time[0]) * kappa)
    place = samples.position[keep]
    return samples.time[keep] - start.time, place[:, 0] + 1j * place[:, 1]


def _fitted(count: int, turned: float) -> slice:
    """Return which of many points to fit, given how far the circle turns from one to the next."""
    stride = max(1, int(0.5 / turned) if turned > 0 else 1, count // _FITTED // 100)
    return slice(0, min(count, stride * _FITTED), stride)


def _pair(value: complex, unit: str) -> str:
    return f"({value.real:.9g}, {value.imag:.9g}) {unit}".rstrip()


__all__ = ["Card", "CardFigure", "card"]
