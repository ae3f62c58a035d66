"""All that is checked of a trajectory, gathered on its card."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from ..mechanics.invariants import invariants_of
from ..mechanics.system import RollingSystem, State
from ..solve.exact import ClosedForm, closed_form
from ..solve.methods import Method
from ..solve.samples import ROLLING, SLIPPING, Samples
from .again import Again
from .bounds import SINGULAR, bound_of, turned_in
from .card import Card, CardFigure
from .circle import guiding_centre, measured_circle
from .compared import cross_check, finer, same_again
from .each_sample import EachSample
from .energy import balance
from .events import AtEvents
from .friction import contact_force, friction_law, looked_into
from .integrals import drifts
from .landings import landing_figures, landings_of
from .plane import reactions, straightness

_MOST_SAMPLES = 20_000  # looked at for integrals
_EVENTS_TOLD = 4
_LOOKS = 400  # at stretches, to balance the energy
_SHORT_OF_THE_END = 1e-3  # of the last stretch of a run that ends where its law is singular


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
        *drifts(system, some, method),
        *(guiding_centre(circle, start, some, method) if circle is not None else ()),
        *(same_again(system, start, again.sampled, again.samples, method, again.kept) if followed else ()),
        *(finer(system, start, again.itself, method, again.kept) if followed else ()),
        *cross_check(system, start, some, method, motion, again.kept if followed else None),
        *(measured_circle(system, circle, start, samples, method) if circle is not None else ()),
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
    name = {"taylor": "Taylor series (heyoka)", "runge-kutta": "Runge-Kutta DOP853"}[method.name]
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
